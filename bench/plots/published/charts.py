"""The charts of README.md and docs/, made from the measured files of bench/results. Needs matplotlib."""
import plot_style
from results import KINDS, TWO_PATHS, newest_of_path, speeds_by_batch
from roots import (ROOT_LENGTHS, ROOT_SHARES, ROOT_WAYS, SHORT_LENGTHS, SHORT_WAYS, root_gains, root_times,
                   short_times)

INK = '#808080'  # readable on a light and on a dark page
FRONTS = ('sse2', 'avx', 'avx2', 'avx512')
FEW = (4, 8, 16, 32, 64)  # primitives; prepared rays take all but the last
# Above a plot, where no line crosses it.
LEGEND = {'fontsize': 8, 'loc': 'lower left', 'borderaxespad': 0, 'handletextpad': 0.5}


def legend_over(figure, axes, columns):
    """The legend of several panels, in a line of its own above them."""
    figure.get_layout_engine().set(rect=(0, 0, 1, 0.93))
    figure.legend(*axes.get_legend_handles_labels(), fontsize=8, loc='upper center', borderaxespad=0, ncols=columns,
                  handletextpad=0.5, columnspacing=1.4).set_in_layout(False)


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
        axes.set_title(f'{path}, rays without skip', fontsize=9, loc='left')
        axes.grid(axis='x', visible=False)
    panels[0].set_ylabel("speed, × Embree's best mode")
    panels[0].set_ylim(0, 1.8)
    legend_over(figure, panels[0], 3)
    shown = ' '.join(text.get_text() for axes in panels for text in axes.texts)
    return finished(figure, 'Batches of rays: raylanes and Embree 3.13 by kind of ray', shown)


def front_of(rows):
    """The methods that no other one beats in both error and time."""
    front = []
    for row in sorted(rows, key=lambda row: (row['nanoseconds'], row['max_ulp'])):
        if not front or row['max_ulp'] < front[-1]['max_ulp']:
            front.append(row)
    return front


# The accuracies of calls, as errors in ULP of floats: a relative error d is at most d * 2^24 of them.
BOUNDS = {'correctly rounded': (0.5, 'right'), '1 ULP': (1.0, 'center'), '2^-22': (4.0, 'center'),
          '2^-16': (256.0, 'center'), '2^-11': (8192.0, 'center'), '2^-4': (2.0**20, 'center')}
NAMES = {'goldschmidt_beside_hardware': ('goldschmidt\nbeside the divider', (-7, -1), 'right'),
         'estimate_residual_beside_hardware': ('one residual\nbeside the divider', (-19, -10), 'right'),
         'estimate_beside_hardware': ('estimate\nbeside the divider', (4, -21), 'left'),
         'classic_2': ('bit trick, 2 Newton steps', (7, -2), 'left'),
         'hardware': ("the processor's\ninstruction", (-7, -5), 'right')}


def name_methods(axes, rows):
    """Names beside the marks of one path."""
    for method, (name, offset, side) in NAMES.items():
        axes.annotate(name, (rows[method]['max_ulp'], rows[method]['nanoseconds']), offset, ha=side,
                      textcoords='offset points', fontsize=7)
    return [f"{rows[method]['nanoseconds']:.3f}" for method in NAMES]


def draw_fronts(axes, results, function):
    """The methods of a function, and a front for each ISA path; returns what that shows."""
    shown = []
    for (colour, marker), path in zip(plot_style.SERIES, FRONTS):
        # No accuracy takes the unchecked method.
        rows = [row for row in results.where(function=function, path=path) if row['method'] != 'estimate_unchecked']
        front = front_of(rows)
        errors, times = [row['max_ulp'] for row in front], [row['nanoseconds'] for row in front]
        axes.plot([row['max_ulp'] for row in rows], [row['nanoseconds'] for row in rows], marker, color=colour,
                  markersize=3, alpha=0.35)
        axes.plot(errors, times, marker=marker, color=colour, drawstyle='steps-post', markersize=5, linewidth=1.2,
                  label=path)
        shown += [path, *(f'{time:.3f}' for time in times)]
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.yaxis.set_minor_formatter(lambda y, _: '')
    axes.grid(axis='x', visible=False)
    return shown


def other_roots_chart(results):
    """Time against the largest error of reciprocal roots of floats, and of roots of doubles."""
    functions = {'rsqrt': '1/√x of floats', 'double_sqrt': '√x of doubles', 'double_rsqrt': '1/√x of doubles'}
    figure, panels = plot_style.plt.subplots(1, 3, figsize=(8.4, 3.4), layout='constrained', sharey=True)
    shown = []
    for axes, (function, title) in zip(panels, functions.items()):
        shown += draw_fronts(axes, results, function)
        axes.set_title(title, fontsize=9, loc='left')
        axes.set_xlabel('largest error [ULP]')
        axes.set_yticks([0.02, 0.05, 0.1, 0.2, 0.5, 1, 2], ['0.02', '0.05', '0.1', '0.2', '0.5', '1', '2'])
    panels[0].set_ylabel('time [ns a value]')
    legend_over(figure, panels[0], 4)
    return finished(figure, 'Reciprocal roots of floats, and roots of doubles: error against time', ' '.join(shown))


def roots_chart(results):
    """Time against the largest error of square roots of floats: a front for each ISA path."""
    figure, axes = plot_style.plt.subplots(figsize=(8.4, 4.6), layout='constrained')
    shown = draw_fronts(axes, results, 'sqrt')
    for name, (bound, side) in BOUNDS.items():
        axes.axvline(bound, linestyle=(0, (1, 3)), color=INK, linewidth=1)
        axes.annotate(name, (bound, 1), (0, 3), xycoords=('data', 'axes fraction'), textcoords='offset points',
                      ha=side, fontsize=8)
    shown += name_methods(axes, {row['method']: row for row in results.where(function='sqrt', path=FRONTS[-1])})
    axes.set_xlabel('largest error [ULP]; names: methods on avx512; vertical lines: accuracies of calls')
    axes.set_ylabel('time [ns a value]')
    axes.set_xlim(0.04, 3e6)
    axes.set_ylim(0.03, 0.7)
    axes.set_yticks([0.05, 0.1, 0.2, 0.5], ['0.05', '0.1', '0.2', '0.5'])
    axes.legend(bbox_to_anchor=(0, 1.06), ncols=4, title='the fastest methods for their error, by ISA path',
                title_fontsize=8, alignment='left', **LEGEND)
    return finished(figure, 'Square roots: error against time, a front for each ISA path', ' '.join(shown))


def ratios_by_size(sizes, lines, labels, title):
    """A chart of ratios, from zero on with a line at one, against sizes that grow by factors. Lines are (words of its
    comment, label, ratios); labels name the two axes."""
    figure, axes = plot_style.plt.subplots(figsize=(8.4, 3.2), layout='constrained')
    shown = []
    for (colour, marker), (words, label, ratios) in zip(plot_style.SERIES, lines):
        axes.plot(sizes, ratios, marker=marker, color=colour, markersize=4, linewidth=1.2, label=label)
        shown += [*words, *(f'{ratio:.2f}' for ratio in ratios)]
    if 'instruction' in labels[1]:
        axes.annotate('the instruction', (sizes[0], 1), (0, -10), textcoords='offset points', fontsize=8)
    axes.axhline(1, linestyle='--', color=INK, linewidth=1)
    axes.set_xscale('log')
    axes.set_xticks(sizes, [f'{n:,}' for n in sizes], fontsize=8)
    axes.minorticks_off()
    axes.set_ylim(bottom=0)
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    axes.legend(bbox_to_anchor=(0, 1.02), ncols=len(lines), **LEGEND)
    return finished(figure, title, ' '.join(shown))


def lengths_chart(results):
    """How many times as fast as the instruction roots are, against the length of the array."""
    lines = [([way], way.replace('_', ' '), root_gains(results, way)) for way in ROOT_WAYS[1:-1]]
    labels = 'floats in the array; in and out take 8 bytes each', 'speed, × instruction'
    return ratios_by_size(ROOT_LENGTHS, lines, labels, 'Square roots: gain over the instruction by length of the array')


def short_chart(results):
    """Time of roots of arrays of one number and more: loops, and calls that take few numbers inline."""
    figure, axes = plot_style.plt.subplots(figsize=(8.4, 3.4), layout='constrained')
    shown = []
    for (colour, marker), (way, words) in zip(plot_style.SERIES, SHORT_WAYS.items()):
        times = short_times(results, way)
        axes.plot(SHORT_LENGTHS, times, marker=marker, color=colour, markersize=3, linewidth=1.2,
                  linestyle='--' if 'std' in way else '-', label=words.replace('`', ''))
        shown += [way, *(f'{time:.3f}' for time in times)]
    axes.set_xscale('log', base=2)
    axes.set_xticks([4 ** k for k in range(7)], [f'{4 ** k:,}' for k in range(7)])
    axes.set_yscale('log')
    axes.set_yticks([0.05, 0.1, 0.2, 0.5, 1, 2, 5], ['0.05', '0.1', '0.2', '0.5', '1', '2', '5'])
    axes.yaxis.set_minor_formatter(lambda y, _: '')
    axes.set_xlabel('floats in the array')
    axes.set_ylabel('time [ns a value]')
    axes.legend(bbox_to_anchor=(0, 1.02), ncols=2, **LEGEND)
    return finished(figure, 'Roots: time by the length of the array', ' '.join(shown))


def few_chart(results):
    """Time of a call with one ray and few primitives, by a prepared ray and by calls that check it."""
    figure, panels = plot_style.plt.subplots(1, 2, figsize=(8.4, 3.2), layout='constrained', sharey=True)
    shown = []
    for axes, path in zip(panels, ('avx512', 'avx2')):
        for (colour, marker), kind in zip(plot_style.SERIES, ('boxes', 'spheres', 'triangles')):
            for way, style, words in (('prepared_', '-', 'prepared ray'), ('', '--', 'call')):
                counts = FEW[:-1] if way else FEW
                times = [results.one(name=f'few/{way}{kind}/{path}/{n}')['nanoseconds'] * n for n in counts]
                axes.plot(counts, times, style, marker=marker, color=colour, markersize=4, linewidth=1.2,
                          label=f'{kind}, {words}')
                shown += [way + kind, path, *(f'{time:.1f}' for time in times)]
        axes.set_xscale('log', base=2)
        axes.set_xticks(FEW, [str(n) for n in FEW])
        axes.set_title(path, fontsize=9, loc='left')
        axes.set_xlabel('primitives')
    panels[0].set_ylim(bottom=0)
    panels[0].set_ylabel('time [ns a call]')
    legend_over(figure, panels[0], 6)
    return finished(figure, 'One ray and few boxes, spheres or triangles: time of a call', ' '.join(shown))


def sizes_chart(results):
    """Speed of batches and of calls by Embree's best, against the number of triangles."""
    rows = results.where(scene='dragon', pixels=1 << 20)
    triangles, lines = sorted({row['triangles'] for row in rows}), []
    for mode, name in (('automatic', 'a batch'), ('call', 'one ray a call')):
        for rays in ('primary', 'diffuse'):
            ratio_of = {row['triangles']: row['ratio'] for row in rows if (row['rays'], row['mode']) == (rays, mode)}
            lines.append(([rays, mode], f'{KINDS[rays]}, {name}', [ratio_of[n] for n in triangles]))
    return ratios_by_size(triangles, lines, ('triangles', 'speed, × Embree'),
                          'Rays through one mesh cut finer and finer: speed beside Embree')


def batches_chart(results):
    """Speed of calls against the number of their rays: ours, our loop of single rays, Embree's modes. Each ISA path is
    of the newest file that has it."""
    figure, panels = plot_style.plt.subplots(2, 3, figsize=(8.4, 5.4), layout='constrained', sharex=True, sharey='col')
    scene, folder, shown = results.names('scene')[0], results.folder, []
    lines = {'raylanes': 'automatic', 'raylanes, a loop of calls': 'call', 'Embree, single rays': 'single',
             'packets of 8': 'packet8', 'packets of 16': 'packet16', 'streams of packets': 'packet_stream'}
    for row_of_panels, path in zip(panels, TWO_PATHS):
        results = newest_of_path(folder, 'batches', path)
        for axes, rays in zip(row_of_panels, ('primary', 'shadow', 'diffuse')):
            for (colour, marker), (label, mode) in zip(plot_style.SERIES, lines.items()):
                sizes, speeds = speeds_by_batch(results, scene, rays, path, mode)
                axes.plot(sizes, speeds, '--' if mode == 'call' else '-', marker=marker, color=colour, markersize=3,
                          linewidth=1.2, label=label)
                shown += [path, rays, mode, *(f'{speed:.2f}' for speed in speeds)]
            axes.set_xscale('log')
            axes.set_yscale('log')
            axes.set_yticks([1, 2, 5, 10, 20, 50], ['1', '2', '5', '10', '20', '50'])
            axes.yaxis.set_minor_formatter(lambda y, _: '')
            axes.set_title(f'{KINDS[rays]}, {path}, {results.name}', fontsize=9, loc='left')
        row_of_panels[0].set_ylabel('million rays a second')
    for axes in panels[-1]:
        axes.set_xlabel('rays in a call')
    legend_over(figure, panels[0][0], 6)
    return finished(figure, f'Rays through {scene}: speed by the number of rays in a call', ' '.join(shown))


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
        axes.set_yticks([0.02, 0.05, 0.1, 0.2, 0.5], ['0.02', '0.05', '0.1', '0.2', '0.5'])
        axes.yaxis.set_minor_formatter(lambda y, _: '')
    panels[0].set_ylabel('time [ns a value]')
    legend_over(figure, panels[0], 6)
    return finished(figure, 'Square roots: time against the share of zeros and of subnormal numbers', ' '.join(shown))


def finished(figure, description, shown):
    """The SVG, and in a comment what it shows: another matplotlib draws other lines."""
    svg = plot_style.svg_of(figure, description)
    return svg.replace('var(--ink)', INK).replace('var(--grid)', INK + '40') + f'\n<!-- {shown} -->\n'


# By picture: the kind of file, whose newest one it shows, and who draws it.
CHARTS = {'rays': ('rays', rays_chart), 'roots': ('roots', roots_chart), 'lengths': ('lengths', lengths_chart),
          'sizes': ('sizes', sizes_chart), 'cliffs': ('cliffs', cliffs_chart), 'short': ('short', short_chart),
          'few': ('short', few_chart), 'batches': ('batches', batches_chart),
          'other_roots': ('other_roots', other_roots_chart)}
