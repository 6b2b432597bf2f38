#!/usr/bin/env python3
"""The published figures, made from the measured files of bench/results: the tables of docs/figures.md and the charts of
README.md. Nobody types them.

usage: published.py SOURCE_FOLDER           writes the tables between the page's marks, and docs/pictures/*.svg
       published.py --check SOURCE_FOLDER   exits with 1 if the page or a chart has other figures
Exit status 77 (Meson's skip): there is no matplotlib.
"""
import pathlib
import re
import sys
import textwrap

sys.path.insert(0, str(pathlib.Path(__file__).parent))
try:
    import plot_style
except ImportError:
    print('SKIPPED: published figures, there is no matplotlib')
    sys.exit(77)
from published_tables import (KINDS, ROOT_SHARES, ROOT_WAYS, TABLES, TWO_PATHS, Results,  # noqa: E402
                              exact_table, root_times)
from whole_file import write_whole  # noqa: E402

INK = '#808080'  # readable on a light and on a dark page
FRONTS = ('sse2', 'avx', 'avx2', 'avx512')


def rays_chart(results):
    """Bars by kind of rays for two instruction sets: raylanes, Embree's best mode, its robust mode."""
    figure, panels = plot_style.plt.subplots(1, 2, figsize=(8.4, 2.9), layout='constrained', sharey=True)
    mean = results.mean
    bars = [('Embree, robust mode', plot_style.ROBUST, '..',
             lambda **chosen: mean(**chosen) / mean('ratio_to_robust', **chosen)),
            ('Embree, best mode', plot_style.THEIRS, '//', lambda **chosen: 1.0),
            ('raylanes, exact', plot_style.OURS, None, mean)]
    for axes, path in zip(panels, ('avx512', 'avx2')):
        for k, (name, colour, hatch, height) in enumerate(bars):
            for i, rays in enumerate(KINDS):
                value = height(path=path, rays=rays)
                axes.bar(i + 0.28 * (k - 1), value, 0.26, color=colour, hatch=hatch, edgecolor='white', linewidth=0,
                         label=name if i == 0 else None)
                axes.annotate(f'{value:.2f}', (i + 0.28 * (k - 1), value), ha='center', va='bottom', fontsize=7)
        axes.set_xticks(range(len(KINDS)), [name.replace(' ', '\n') for name in KINDS.values()])
        axes.set_title(path, fontsize=10, loc='left')
        axes.grid(axis='x', visible=False)
    panels[0].set_ylabel("speed, × Embree's best mode")
    panels[0].set_ylim(0, 2.2)
    panels[1].legend(fontsize=8, loc='upper right')
    shown = ' '.join(text.get_text() for axes in panels for text in axes.texts)
    return finished(figure, 'Batches of rays: raylanes and Embree 3.13 by kind of ray', shown)


def front_of(rows):
    """The methods that no other one beats in both error and time."""
    front = []
    for row in sorted(rows, key=lambda row: (row['nanoseconds'], row['max_ulp'])):
        if not front or row['max_ulp'] < front[-1]['max_ulp']:
            front.append(row)
    return front


def roots_chart(results):
    """Time against the largest error of square roots of floats: a front for each ISA path."""
    figure, axes = plot_style.plt.subplots(figsize=(8.4, 3.4), layout='constrained')
    shown = []
    for (colour, marker), path in zip(plot_style.SERIES, FRONTS):
        rows = results.where(function='sqrt', path=path)
        front = front_of(rows)
        errors, times = [row['max_ulp'] for row in front], [row['nanoseconds'] for row in front]
        axes.plot([row['max_ulp'] for row in rows], [row['nanoseconds'] for row in rows], marker, color=colour,
                  markersize=3, alpha=0.35)
        axes.plot(errors, times, marker=marker, color=colour, drawstyle='steps-post', markersize=5, linewidth=1.2,
                  label=path)
        shown += [path, *(f'{time:.3f}' for time in times)]
    widest = {row['method']: row for row in results.where(function='sqrt', path=FRONTS[-1])}
    steps = [widest[f'classic_{n}'] for n in range(4)]
    axes.plot([row['max_ulp'] for row in steps], [row['nanoseconds'] for row in steps], ':', color=INK, linewidth=1)
    axes.annotate('bit trick and 0 to 3 Newton steps, avx512', (steps[2]['max_ulp'], steps[2]['nanoseconds']),
                  (10, 0.42), fontsize=8, arrowprops={'arrowstyle': '-', 'color': INK})
    axes.axhline(widest['hardware']['nanoseconds'], linestyle='--', color=INK, linewidth=1)
    axes.annotate("the processor's instruction", (3e4, widest['hardware']['nanoseconds']), (0, 3),
                  textcoords='offset points', fontsize=8)
    shown += [f"{row['nanoseconds']:.3f}" for row in (*steps, widest['hardware'])]
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.set_xlabel('largest error [ULP]; 0.5 is correctly rounded')
    axes.set_ylabel('time [ns a value]')
    axes.set_yticks([0.05, 0.1, 0.2, 0.5, 1], ['0.05', '0.1', '0.2', '0.5', '1'])
    axes.yaxis.set_minor_formatter(lambda y, _: '')
    axes.legend(fontsize=8, loc='upper right', title='fastest for its error', title_fontsize=8)
    return finished(figure, 'Square roots: error against time, a front for each ISA path', ' '.join(shown))


def cliffs_chart(results):
    """Time of square roots against the share of zeros, and of numbers that are subnormal."""
    figure, panels = plot_style.plt.subplots(1, 2, figsize=(8.4, 3.2), layout='constrained', sharey=True)
    places, shown = range(len(ROOT_SHARES)), []
    for axes, special in zip(panels, ('zeros', 'subnormals')):
        for (colour, marker), way in zip(plot_style.SERIES, ROOT_WAYS):
            times = root_times(results, way, special)
            axes.plot(places, times, marker=marker, color=INK if way == 'instruction' else colour, markersize=4,
                      linestyle='--' if way == 'instruction' else '-', linewidth=1.2, label=way.replace('_', ' '))
            shown += [way, *(f'{time:.3f}' for time in times)]
        axes.set_xticks(places, [f'{share * 100:g}' for share in ROOT_SHARES])
        axes.set_xlabel(f'share of {special} [%]')
        axes.set_yscale('log')
    panels[0].set_ylabel('time [ns a value]')
    panels[0].legend(fontsize=7, loc='upper left')
    return finished(figure, 'Square roots: time against the share of zeros and of subnormal numbers', ' '.join(shown))


def finished(figure, description, shown):
    """The SVG, and in a comment what it shows: another matplotlib draws other lines."""
    svg = plot_style.svg_of(figure, description)
    return svg.replace('var(--ink)', INK).replace('var(--grid)', INK + '40') + f'\n<!-- {shown} -->\n'


def caption(results):
    machine = results.machine
    return (f"{machine['processor']}, {machine['compiler']}, {machine['date']}.\n\n```sh\n" +
            ' \\\n  '.join(textwrap.wrap(results.command, 112, break_on_hyphens=False)) + '\n```\n')


def readme_figures(folder):
    """What README.md says in words, from the measured files."""
    rays, calls, roots = (Results(folder, kind) for kind in ('rays', 'calls', 'roots'))
    def ends(key):
        means = [rays.mean(key, path=path, rays=kind) for path in TWO_PATHS for kind in KINDS]
        return f'{min(means):.1f} to {max(means):.1f} times'

    def root(accuracy):
        row, = (row for row in roots.where(function='sqrt', path='avx512') if accuracy in row['serves'])
        return f"{row['nanoseconds']:.3f} ns", f"{row['ratio_to_hardware']:.1f} times"

    longest = max(float(value) for line in exact_table(Results(folder, 'exact')) if 'watertight' in line
                  for value in re.findall(r'\d\.\d\d', line))
    kernels = Results(folder, 'kernels')
    def time(test, **chosen):
        return kernels.one(kernel='triangle', form='1xN', test=test, grade='reproducible',
                           **chosen)['nanoseconds_per_primitive']

    over_arrays = max(time('exact', path=path, query=query) / time('watertight', path=path, query=query)
                      for path in TWO_PATHS for query in ('any', 'closest'))
    return [ends('ratio'), ends('ratio_to_robust'), *root('correctly_rounded'), *root('within_2^-11'),
            f"{calls.mean(path='avx512'):.2f} times", f"{calls.mean('ratio_to_packed', path='avx512'):.2f} times",
            f'up to {(longest - 1) * 100:.0f} % longer', f'{(over_arrays - 1) * 100:.0f} % over arrays']


def page_with_tables(page, folder):
    for name, (kind, make) in TABLES.items():
        results = Results(folder, kind)
        block = '\n'.join([f'<!-- begin {name} -->', caption(results), *make(results), f'<!-- end {name} -->'])
        page, count = re.subn(rf'<!-- begin {name} -->.*?<!-- end {name} -->', lambda _, block=block: block, page,
                              flags=re.DOTALL)
        assert count == 1, f'the page has {count} places for {name}'
    return page


def main(arguments):
    check, root = arguments[:1] == ['--check'], pathlib.Path(arguments[-1])
    folder, file, faults = root / 'bench/results', root / 'docs/figures.md', []
    page = file.read_text(encoding='utf-8')
    made = page_with_tables(page, folder)
    charts = {'rays': rays_chart, 'roots': roots_chart, 'cliffs': cliffs_chart}
    drawn = {root / f'docs/pictures/{name}.svg': make(Results(folder, name)) for name, make in charts.items()}
    if not check:
        write_whole(file, made)
        for picture, svg in drawn.items():
            write_whole(picture, svg)
        return 0
    faults += [f'docs/figures.md should say: {line}' for line in made.splitlines() if line not in page.splitlines()]
    readme = ' '.join((root / 'README.md').read_text(encoding='utf-8').split())
    faults += [f'README.md should say: {text}' for text in readme_figures(folder) if text not in readme]
    for picture, svg in drawn.items():
        if picture.read_text(encoding='utf-8').splitlines()[-1] != svg.splitlines()[-1]:
            faults.append(f'{picture} was drawn from other figures')
    print('\n'.join(faults or [f'good: {len(TABLES)} tables and {len(drawn)} charts']))
    return 1 if faults else 0


if __name__ == '__main__':
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
