#!/usr/bin/env python3
"""One line: what `bench/run` measured beside what README.md says of another machine.

usage: beside_readme.py RESULTS FOLDER      bench/results, and where trace.json and roots.json are
"""
import pathlib
import sys
from statistics import geometric_mean

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from results import MACHINES, Results, newest  # noqa: E402
from readme_figures import ends, root_row  # noqa: E402
from summary import printable, rows_of  # noqa: E402


def batches(rows, least, greatest):
    """By the path of the fastest rows, as README has them: whole batches in the default mode."""
    ours = [row for row in rows if row['contender'] == 'raylanes' and row['mode'] == 'automatic' and row.get('ratio')]
    if not ours:
        return 'rays not compared, there is no Embree'
    path = max(ours, key=lambda row: row['mrays_per_second'])['path']
    ratios = [row['ratio'] for row in ours if row['path'] == path]
    return (f"batches {geometric_mean(ratios):.2f} × Embree's best mode ({min(ratios):.2f} to {max(ratios):.2f}; "
            f'{path}; other scenes, fewer rays), in README {least:.1f} to {greatest:.1f}')


def roots(rows, published):
    """Correctly rounded roots of floats on the path where they are fastest."""
    ours = [row for row in rows if row['function'] == 'sqrt' and 'correctly_rounded' in row['serves']]
    best = max(ours, key=lambda row: row['elements_per_second'])
    return (f"correctly rounded roots {best['ratio_to_hardware']:.1f} × the instruction ({best['path']}), in README "
            f'{published:.1f}')


def line(results, folder):
    machine = newest(results, 'rays')
    least, greatest = ends(Results(results, 'rays', machine), 'ratio')
    published = root_row(Results(results, 'roots', newest(results, 'roots')), 'correctly_rounded')['ratio_to_hardware']
    (traced, _), (rooted, _) = (rows_of(folder / f'{name}.json') for name in ('trace', 'roots'))
    return (f'here: {batches(traced, least, greatest)}; {roots(rooted, published)}; '
            f'README has the {MACHINES[machine]} of {Results(results, "rays", machine).machine["date"]}')


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    print(printable(line(*map(pathlib.Path, sys.argv[1:]))))
