#!/usr/bin/env python3
"""Puts every block of C++ in the pages, and every example, into one unit: compiled once, run one by one.

usage: unit.py SOURCE_FOLDER OUTPUT.hpp DEPENDENCIES.d

A block with a main() is a program of its own. One that defines functions stays at namespace level. All others are
statements, which see what given.hpp has: `vertices`, `triangles`, `mesh`, `rays`, `hits`, `points` and so on.
"""
import pathlib
import re
import sys

sys.dont_write_bytecode = True
from page import all_blocks, pages_of  # noqa: E402

INCLUDE = re.compile(r'^#include .*$\n?', re.M)
MAIN = re.compile(r'^int main\((.*)\) \{$', re.M)
DEFINITION = re.compile(r'^[A-Za-z][\w:<>,&* ]* \w+\(.*\) (?:const )?\{$', re.M)


def without_includes(text, includes, folder):
    for line in INCLUDE.findall(text):
        line = line.split('//')[0].strip()
        includes.setdefault(re.sub('"(.*)"', lambda m: f'"{folder / m.group(1)}"', line))
    return INCLUDE.sub('\n', text)  # line numbers stay


def program(text):
    """main() as a function that takes the folder for pictures; like main() it may end without a return."""
    text = MAIN.sub(lambda m: 'int run(' + (m.group(1) or 'int, char**') + ') {', text)
    head, _, tail = text.rpartition('}')
    return head + 'return 0; }' + tail


def unit_of(root):
    includes, bodies, runs = {'#include "given.hpp"': None}, [], []
    texts = [(block.name, block.line + 1, block.text, root) for block in all_blocks(root) if block.language == 'cpp']
    texts += [(str(file.relative_to(root)), 1, file.read_text(encoding='utf-8'), file.parent)
              for file in sorted((root / 'docs/examples').rglob('*.cpp'))]
    for number, (name, line, text, folder) in enumerate(texts):
        text = without_includes(text, includes, folder)
        where = f'#line {line} "{root / name.split(":")[0]}"\n'
        if MAIN.search(text):
            runs.append((name, f'[](int n, char** folder) {{ return block_{number}::run(n, folder); }}'))
            text = program(text)
        elif not DEFINITION.search(text):
            runs.append((name, f'[](int, char**) {{ block_{number}::Block().run(); return 0; }}'))
            text = f'struct Block : Given {{ void run() {{\n{where}{text}}} }};\n'
        bodies.append(f'namespace block_{number} {{\n{where}{text}}}\n')
    rows = ''.join(f'  {{"{name}", {run}}},\n' for name, run in runs)
    return '\n'.join([*sorted(includes), *bodies, f'const Row rows[] = {{\n{rows}}};', ''])


def read_files(root):
    """What the unit is made of; the folders tell of files that come."""
    folders = [f for f in [root / 'docs', *(root / 'docs').rglob('*')] if f.is_dir()]
    scripts = [pathlib.Path(__file__), pathlib.Path(__file__).with_name('page.py')]
    return [*(root / page for page in pages_of(root)), *folders, *scripts, *(root / 'docs/examples').rglob('*pp')]


def main(source, output, dependencies):
    root = pathlib.Path(source).resolve()
    pathlib.Path(output).write_text(unit_of(root), encoding='utf-8')
    files = ' '.join(str(file).replace(' ', '\\ ') for file in read_files(root))
    pathlib.Path(dependencies).write_text(f'{output}: {files}\n', encoding='utf-8')


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 4 else __doc__)
