"""Scenes: rays a second by ISA path beside Embree on the same instruction set, and what to call."""
from plot_style import OURS, ROBUST, THEIRS, Tooltips, panel
from report_steps import title_of


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
    spread = 100 * row['spread']
    return (f"{name}: {row['mrays_per_second']:.3g} Mrays/s ± {spread:.2g} %, {row['path']}, {row['build']}, "
            f"{row['mode']}")


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
                           edgecolor='white', linewidth=0, yerr=0.5 * row['spread'] * row['mrays_per_second'],
                           error_kw={'elinewidth': 0.8}, label=None if labelled else name)
            labelled = True
            tooltips.add(bar.patches[0], tooltip(name, row))
    axes.set_xticks(range(len(sets)), sets)
    axes.set_ylabel('Mrays/s, one thread')
    axes.grid(axis='x', visible=False)
    axes.legend(fontsize=7, loc='upper left')
    return figure, tooltips


def speed_panels(rows):
    for scene in dict.fromkeys(row['scene'] for row in rows):
        for rays in dict.fromkeys(row['rays'] for row in rows):
            some = of(rows, scene=scene, rays=rays)
            if some:
                yield f'{title_of(scene)}, {rays} rays a second', speed_panel(scene, rays, some)


def call_for(row):
    """The C++ call behind a row."""
    call = 'occluded' if row['rays'] in ('shadow', 'light', 'ao') else 'closest'
    options = [] if row['mode'] == 'automatic' else [f'.mode = TraversalMode::{row["mode"]}']
    if row['mode'] == 'call':
        return f'tree.{call}(ray)', 'one ray a call'
    reason = {'automatic': 'the default', 'single': 'rays that have little in common', 'packet': 'rays of one origin',
              'stream': 'many rays in any order'}[row['mode']]
    return f'tree.{call}(rays, out{", {" + ", ".join(options) + "}" if options else ""})', reason


def advice(rows):
    """For each scene and ray set: the fastest of our rows on the active ISA path, and the reason to take it."""
    for scene in dict.fromkeys(row['scene'] for row in rows):
        for rays in dict.fromkeys(row['rays'] for row in rows):
            ours = of(rows, scene=scene, rays=rays, contender='raylanes')
            row = best([row for row in ours if row['mode'] != 'call'])
            if row is None:
                continue
            default = best([other for other in ours if other['path'] == row['path'] and other['mode'] == 'automatic'])
            # The default unless another mode is faster beyond the noise of both.
            if default is not None:
                noise = 1 + max(default['spread'], row['spread'])
                row = row if row['mrays_per_second'] > noise * default['mrays_per_second'] else default
            yield scene, rays, row, *call_for(row)
