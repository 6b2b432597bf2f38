"""Makes mutants of the source as it is: an operator, a number or a condition changed at one place."""
import random
import re

from mutant import FOLDERS, Mutant, folder_of

# Left out: the vocabulary, of which each unit has a part and a suite tests all.
LEFT_OUT = ('kernels/simd/',)
# Text that is code but decides nothing at run time.
NOT_CODE = re.compile(r'//[^\n]*|/\*[\s\S]*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|^[ ]*#.*(?:\\\n.*)*$|'
                      r'^.*\b(?:static_assert|template|using|typename|alignas|operator)\b.*$|\[\[[^\]]*\]\]|'
                      r'->\s*\w+|\bassert\([^\n]*', re.M)

SWAPPED = {' < ': ' <= ', ' <= ': ' < ', ' > ': ' >= ', ' >= ': ' > ', ' == ': ' != ', ' != ': ' == ', ' + ': ' - ',
           ' - ': ' + ', ' * ': ' + ', ' && ': ' || ', ' || ': ' && ', ' & ': ' | ', ' | ': ' & ', ' += ': ' -= ',
           ' -= ': ' += ', 'min(': 'max(', 'max(': 'min(', 'true': 'false', 'false': 'true'}
OPERATOR = re.compile('|'.join(rf'\b{re.escape(o)}' if o[0].isalpha() else re.escape(o)
                               for o in sorted(SWAPPED, key=len, reverse=True)))
CONDITION = re.compile(r'\bif (?:constexpr )?\(([^;{}\n]*)\)(?= (?:\{|return|continue|break|\w))')
NUMBER = re.compile(r'(?<![\w.])(?:0x[0-9a-f.]+p[+-]?\d+|\d+\.\d*(?:e[+-]?\d+)?|\d+)(?:[fu]|ULL|u?LL)?(?![\w.\'])',
                    re.I)


def blanked(text):
    """The text with spaces for all that is not code to mutate, at the same places."""
    return NOT_CODE.sub(lambda match: re.sub(r'[^\n]', '\0', match[0]), text)


def other_number(number):
    """A number next to it: one more of an integer, a thousandth more of a fraction."""
    is_fraction = '.' in number or 'p' in number.lower()
    return f'({number} * 1.0009765625{"f" if number[-1] in "fF" else ""})' if is_fraction else f'({number} + 1)'


def is_balanced(text):
    return text.count('(') == text.count(')')


def changes_of(text):
    """Each change of the text: where it begins and ends, and what replaces that."""
    code = blanked(text)
    for match in OPERATOR.finditer(code):
        yield match.start(), match.end(), SWAPPED[match[0]]
    for match in NUMBER.finditer(code):
        yield match.start(), match.end(), other_number(match[0])
    for match in CONDITION.finditer(code):
        if is_balanced(match[1]) and '\0' not in match[1] and ' = ' not in match[1]:
            yield match.start(1), match.end(1), f'!({match[1]})'


def files_of(root, folder):
    """The files of a folder that can be mutated: of units of kernels/ all, elsewhere each .cpp and its header."""
    for file in sorted((root / folder).rglob('*.[ch]pp')):
        name = file.relative_to(root).as_posix()
        if folder_of(name) != folder or name.startswith(LEFT_OUT):
            continue
        if FOLDERS[folder][0] or file.suffix == '.cpp' or file.with_suffix('.cpp').is_file():
            yield name


def mutants_of_file(root, name):
    text = (root / name).read_text()
    unit, programs = FOLDERS[folder_of(name)]
    source = '' if unit or name.endswith('.cpp') else name[:-len('.hpp')] + '.cpp'
    for begin, end, new in changes_of(text):
        old, line = text[begin:end], text.count('\n', 0, begin) + 1
        yield Mutant(f'{name}:{line}: {old.strip()} -> {new.strip()}', name, old, new, programs, source=source,
                     at=begin)


def mutants_of_folder(root, folder):
    return [mutant for name in files_of(root, folder) for mutant in mutants_of_file(root, name)]


def drawn(root, seed, folders=tuple(FOLDERS)):
    """Mutants without end, other ones for each seed: one of each folder in turn, so that small folders count alike."""
    chooser = random.Random(seed)
    made = {folder: mutants_of_folder(root, folder) for folder in folders}
    for mutants in made.values():
        chooser.shuffle(mutants)
    order = chooser.sample(sorted(made), len(made))
    while any(made.values()):
        for folder in order:
            if made[folder]:
                yield made[folder].pop()


def folders_without_mutants(root):
    """Why the generator misses a part of the source: a folder that gives nothing, or a file of no folder."""
    for folder in FOLDERS:
        if not mutants_of_folder(root, folder):
            yield f'{folder}: no mutant can be made there'
    for top in ('kernels', 'dispatch', 'accel', 'python/native'):
        for file in sorted((root / top).rglob('*.cpp')):
            name = file.relative_to(root).as_posix()
            if not folder_of(name) and not name.startswith(LEFT_OUT):
                yield f'{name}: of no folder that FOLDERS in tests/mutants/mutant.py has'
