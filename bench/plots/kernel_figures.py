"""Intersection kernels: what a test costs beside how often it decides wrongly, and how far off its t is."""
from plot_style import SERIES, Tooltips, panel

MEASURES = {'wrong decisions at edges [per million]': lambda row: (row['wrong_per_million'] or {}).get('edges'),
            'boxes too many at edges, no error [per million]':
                lambda row: (row['extra_per_million'] or {}).get('edges'),
            'leaks of a closed mesh [per million rays]': lambda row: row['leaks_per_million'],
            'largest error of t [ULP]': lambda row: row['max_t_ulp']}


def chosen(rows, kernel, path):
    """One ray against many primitives, any hit of it: the form in which tests differ most."""
    return [row for row in rows if row['kernel'] == kernel and row['path'] == path and row['form'] == '1xN'
            and row['query'] == 'closest']


def trade_panel(rows, kernel, path, measure):
    """Draws the time of each test against what it gets wrong; None if no test has such a figure."""
    value_of, identifier = MEASURES[measure], measure[:5]
    if kernel == 'box':
        measure = measure.replace('wrong decisions', 'boxes missed')
    rows = [row for row in chosen(rows, kernel, path) if value_of(row) is not None]
    if not rows:
        return None
    figure, axes = panel(f'{kernel}, {path}: {measure}')
    tooltips = Tooltips(f'{kernel}-{path}-{identifier}')
    least = min((value_of(row) for row in rows if value_of(row) > 0), default=1.0)
    for test in dict.fromkeys(row['test'] for row in rows):
        colour, marker = SERIES[list(dict.fromkeys(row['test'] for row in rows)).index(test) % len(SERIES)]
        for row in (row for row in rows if row['test'] == test):
            fast = row['grade'] == 'fast'
            mark, = axes.plot(value_of(row), row['nanoseconds_per_primitive'], marker, color=colour, markersize=6,
                              fillstyle='none' if fast else 'full', label=None if fast else test)
            tooltips.add(mark, f"{test}, {row['grade']}: {row['nanoseconds_per_primitive']:.3g} ns, "
                               f'{measure}: {value_of(row):.4g}')
    axes.set_xscale('symlog', linthresh=least)
    axes.set_ylim(bottom=0)
    axes.set_xlabel(measure)
    axes.set_ylabel('time [ns a primitive]')
    axes.legend(fontsize=7, title='filled: reproducible, open: fast', title_fontsize=7)
    return figure, tooltips


def trade_panels(rows, path):
    """Pairs of a description and a panel."""
    for kernel in dict.fromkeys(row['kernel'] for row in rows):
        for measure in MEASURES:
            drawn = trade_panel(rows, kernel, path, measure)
            if drawn:
                yield f'{kernel} {measure}', drawn
