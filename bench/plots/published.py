#!/usr/bin/env python3
"""The published figures of ray batches, made from a measured file: the table of docs/intersections.md and the chart of
README.md. Nobody types them.

usage: published.py RESULTS.json SOURCE_FOLDER           writes docs/pictures/rays.svg and prints the table
       published.py --check RESULTS.json SOURCE_FOLDER   exits with 1 if the page or the chart has other figures
Exit status 77 (Meson's skip): there is no matplotlib.
"""
import json
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
try:
    import plot_style
except ImportError:
    print('SKIPPED: published figures, there is no matplotlib')
    sys.exit(77)

KINDS = {'primary': 'primary', 'shadow': 'shadow', 'diffuse': 'diffuse', 'ao': 'ambient occlusion'}
INK = '#808080'  # readable on a light and on a dark page


class Figures:
    def __init__(self, file):
        self.rows = json.loads(pathlib.Path(file).read_text(encoding='utf-8'))['rows']
        self.scenes = list(dict.fromkeys(row['scene'] for row in self.rows))

    def values(self, path, rays, key):
        return [row[key] for row in self.rows if row['path'] == path and row['rays'] == rays]

    def mean(self, path, rays, key='ratio'):
        return statistics.geometric_mean(self.values(path, rays, key))

    def robust(self, path, rays):
        """Embree's robust mode, × its best mode."""
        return self.mean(path, rays) / self.mean(path, rays, 'ratio_to_robust')


def table(figures):
    def line(name, cell):
        return f'| {name} | ' + ' | '.join(cell(rays) for rays in KINDS) + ' |'

    def both(key):
        return lambda rays: f"{figures.mean('avx512', rays, key):.2f}, {figures.mean('avx2', rays, key):.2f}"

    lines = [line(scene, lambda rays, i=i: f"{figures.values('avx512', rays, 'ratio')[i]:.2f}")
             for i, scene in enumerate(figures.scenes)]
    return lines + [
        line('geometric mean, avx512', lambda rays: f"{figures.mean('avx512', rays):.2f}"),
        line('geometric mean (least), avx2', lambda rays: f"{figures.mean('avx2', rays):.2f} "
             f"({min(figures.values('avx2', rays, 'ratio')):.2f})"),
        line('× its robust mode, avx512, avx2', both('ratio_to_robust')),
        line('× rays packed before the clock starts', both('ratio_to_packed'))]


def chart(figures):
    plt = plot_style.plt
    figure, panels = plt.subplots(1, 2, figsize=(8.4, 2.9), layout='constrained', sharey=True)
    bars = [('Embree, robust mode', plot_style.ROBUST, '..', figures.robust),
            ('Embree, best mode', plot_style.THEIRS, '//', lambda path, rays: 1.0),
            ('raylanes, exact', plot_style.OURS, None, figures.mean)]
    for axes, path in zip(panels, ('avx512', 'avx2')):
        for k, (name, colour, hatch, height) in enumerate(bars):
            for i, rays in enumerate(KINDS):
                value = height(path, rays)
                axes.bar(i + 0.28 * (k - 1), value, 0.26, color=colour, hatch=hatch, edgecolor='white', linewidth=0,
                         label=name if i == 0 else None)
                axes.annotate(f'{value:.2f}', (i + 0.28 * (k - 1), value), ha='center', va='bottom', fontsize=7)
        axes.set_xticks(range(len(KINDS)), [name.replace(' ', '\n') for name in KINDS.values()])
        axes.set_title(path, fontsize=10, loc='left')
        axes.grid(axis='x', visible=False)
    panels[0].set_ylabel("speed, × Embree's best mode")
    panels[0].set_ylim(0, 2.2)
    panels[1].legend(fontsize=8, loc='upper right')
    bars_drawn = ' '.join(text.get_text() for axes in panels for text in axes.texts)
    svg = plot_style.svg_of(figure, 'Batches of rays: raylanes and Embree 3.13 by kind of ray')
    return svg.replace('var(--ink)', INK).replace('var(--grid)', INK + '40') + f'\n<!-- {bars_drawn} -->\n'


def main(arguments):
    check = arguments[:1] == ['--check']
    results, source = arguments[1:] if check else arguments
    figures, root = Figures(results), pathlib.Path(source)
    file, lines, drawn = root / 'docs/pictures/rays.svg', table(figures), chart(figures)
    if not check:
        file.write_text(drawn, encoding='utf-8')
        print('\n'.join(lines))
        return 0
    page = (root / 'docs/intersections.md').read_text(encoding='utf-8').splitlines()
    faults = [f'docs/intersections.md lacks: {line}' for line in lines if line not in page]
    # Another matplotlib draws other lines: the heights of the bars are compared.
    if file.read_text(encoding='utf-8').splitlines()[-1] != drawn.splitlines()[-1]:
        faults.append(f'{file} was not drawn from {results}')
    print('\n'.join(faults or [f'good: {len(lines)} lines and a chart']))
    return 1 if faults else 0


if __name__ == '__main__':
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
