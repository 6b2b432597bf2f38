"""Scenes: rays a second by ISA path beside Embree on the same instruction set."""
from plot_style import OURS, ROBUST, THEIRS, Tooltips, legend_above, panel
from report_steps import title_of
from rounds import speeds, whisker


def best(rows):
    return max(rows, key=lambda row: row['mrays_per_second'], default=None)


def of(rows, **wanted):
    return [row for row in rows if all(row.get(key) == value for key, value in wanted.items())]


def is_packed(row):
    """Whether Embree's rays were laid out for it before the clock started."""
    return row['mode'].endswith('_packed')


def families(rows, isa):
    """The best rows of one instruction set: ours, Embree's, and those of its robust mode."""
    ours = best(of(rows, contender='raylanes', isa=isa))
    theirs = [row for row in of(rows, contender='embree', isa=isa) if not is_packed(row)]
    return {'raylanes, exact': ours, 'Embree': best([row for row in theirs if row['build'] != 'robust']),
            'Embree, robust': best([row for row in theirs if row['build'] == 'robust'])}


def tooltip(name, row):
    first, _, third = speeds(row)
    return (f"{name}: {row['mrays_per_second']:.3g} Mrays/s, half of the rounds {first:.3g} to {third:.3g}, "
            f"{row['path']}, {row['build']}, {row['mode']}")


def speed_panel(scene, rays, rows):
    """Bars for each instruction set: ours beside Embree's best modes."""
    sets = [isa for isa in dict.fromkeys(row['isa'] for row in rows) if of(rows, contender='raylanes', isa=isa)]
    figure, axes = panel(f'{title_of(scene)}: {rays} rays')
    tooltips = Tooltips(f'speed-{scene}-{rays}')
    colours = {'raylanes, exact': OURS, 'Embree': THEIRS, 'Embree, robust': ROBUST}
    hatches = {'raylanes, exact': None, 'Embree': '//', 'Embree, robust': '..'}
    for k, name in enumerate(colours):
        labelled = False
        for i, isa in enumerate(sets):
            row = families(rows, isa)[name]
            if row is None:
                continue
            bar = axes.bar(i + 0.27 * (k - 1), row['mrays_per_second'], 0.25, color=colours[name], hatch=hatches[name],
                           edgecolor='white', linewidth=0, yerr=whisker(row),
                           error_kw={'elinewidth': 0.8}, label=None if labelled else name)
            labelled = True
            tooltips.add(bar.patches[0], tooltip(name, row))
    axes.set_xticks(range(len(sets)), sets)
    axes.set_ylabel('Mrays/s, one thread')
    axes.grid(axis='x', visible=False)
    legend_above(axes)
    return figure, tooltips


def speed_panels(rows):
    for scene in dict.fromkeys(row['scene'] for row in rows):
        for rays in dict.fromkeys(row['rays'] for row in rows):
            some = of(rows, scene=scene, rays=rays)
            if some:
                yield f'{title_of(scene)}, {rays} rays a second', speed_panel(scene, rays, some)
