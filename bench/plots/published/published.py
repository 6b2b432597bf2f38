#!/usr/bin/env python3
"""The published figures, made from the measured files of bench/results: the tables of docs/figures.md and of the page
of Embree's programs, and the charts of README.md. Nobody types them.

usage: published.py SOURCE_FOLDER           writes the tables between the pages' marks, and docs/pictures/*.svg
       published.py --check SOURCE_FOLDER   exits with 1 if a page, README or a chart has other figures, or if a
                                            sentence of README with a figure does not name its machine
Exit status 77 (Meson's skip): there is no matplotlib.
"""
import pathlib
import re
import sys
import textwrap

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
try:
    import plot_style  # noqa: F401
except ImportError:
    print('SKIPPED: published figures, there is no matplotlib')
    sys.exit(77)
import readme_figures  # noqa: E402
from charts import CHARTS  # noqa: E402
from machines import machines_of_lines, machines_table  # noqa: E402
from results import MACHINES, Results, machines_of, newest  # noqa: E402
from tables import TABLES, TABLES_OF_EMBREE  # noqa: E402
from whole_file import write_whole  # noqa: E402


def caption(results):
    machine = results.machine
    return (f"{machine['processor']}, {machine['compiler']}, {machine['date']}.\n\n```sh\n" +
            ' \\\n  '.join(textwrap.wrap(results.command, 112, break_on_hyphens=False)) + '\n```\n')


def block(folder, kind, make):
    """A table for each machine that has a file of this kind, and which machines have none."""
    measured = machines_of(folder, kind)
    lines = []
    for results in (Results(folder, kind, machine) for machine in measured):
        lines += [caption(results), *make(results), '']
    missing = [MACHINES[machine] for machine in machines_of_lines(folder) if machine not in measured]
    return lines + [f"Not measured on the {' and the '.join(missing)}."] if missing else lines[:-1]


def with_tables(page, blocks):
    """The text of a page with these lines between the marks of each block."""
    for name, lines in blocks.items():
        text = '\n'.join([f'<!-- begin {name} -->', *lines, f'<!-- end {name} -->'])
        page, count = re.subn(rf'<!-- begin {name} -->.*?<!-- end {name} -->', lambda _, text=text: text, page,
                              flags=re.DOTALL)
        assert count == 1, f'the page has {count} places for {name}'
    return page


def pages_of(root, folder):
    """(file, its text, its text with the tables) of each page."""
    def blocks(tables):
        return {name: block(folder, *of_table) for name, of_table in tables.items() if machines_of(folder, of_table[0])}

    for name, tables in (('docs/figures.md', {**blocks(TABLES), 'machines': machines_table(folder)}),
                         ('docs/guide/embree_programs.md', blocks(TABLES_OF_EMBREE))):
        page = (root / name).read_text(encoding='utf-8')
        yield root / name, page, with_tables(page, tables)


def main(arguments):
    check, root = arguments[:1] == ['--check'], pathlib.Path(arguments[-1])
    folder, pages = root / 'bench/results', list(pages_of(root, root / 'bench/results'))
    drawn = {root / f'docs/pictures/{name}.svg': draw(Results(folder, kind, newest(folder, kind)))
             for name, (kind, draw) in CHARTS.items()}
    if not check:
        for file, content in [*((file, made) for file, _, made in pages), *drawn.items()]:
            write_whole(file, content)
        return 0
    faults = [f'{file.relative_to(root)} should say: {line}' for file, page, made in pages
              for line in made.splitlines() if line not in page.splitlines()]
    faults += readme_figures.faults((root / 'README.md').read_text(encoding='utf-8'), folder)
    for picture, svg in drawn.items():
        if picture.read_text(encoding='utf-8').splitlines()[-1] != svg.splitlines()[-1]:
            faults.append(f'{picture} was drawn from other figures')
    print('\n'.join(faults or [f'good: {len(TABLES) + len(TABLES_OF_EMBREE)} tables and {len(drawn)} charts']))
    return 1 if faults else 0


if __name__ == '__main__':
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
