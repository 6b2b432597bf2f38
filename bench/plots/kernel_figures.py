"""Intersection kernels: what a test costs beside how often it decides wrongly, and how far off its t is."""
import math

from plot_style import SERIES, Tooltips, legend_above, panel

MEASURES = {'wrong decisions at edges [per million]': lambda row: (row['wrong_per_million'] or {}).get('edges'),
            'boxes too many at edges, no error [per million]':
                lambda row: (row['extra_per_million'] or {}).get('edges'),
            'leaks of a closed mesh [per million rays]': lambda row: row['leaks_per_million'],
            'largest error of t [ULP]': lambda row: row['max_t_ulp']}


def chosen(rows, kernel, path):
    """One ray against many primitives, any hit of it: the form in which tests differ most."""
    return [row for row in rows if row['kernel'] == kernel and row['path'] == path and row['form'] == '1xN'
            and row['query'] == 'closest']


def ticks_between(least, greatest):
    """At most six numbers with one digit from `least` to `greatest`, both above zero."""
    exponents = range(math.floor(math.log10(least)), math.ceil(math.log10(greatest)) + 1)
    decades = [10.0 ** e for e in exponents if 0.99 * least <= 10.0 ** e <= 1.01 * greatest]
    finer = [digit * 10.0 ** e for e in exponents for digit in (1, 2, 5)
             if 0.99 * least <= digit * 10.0 ** e <= 1.01 * greatest]
    return finer if len(finer) <= 6 else decades[::-(-len(decades) // 6)]


def axis_of_errors(axes, values):
    """Logarithmic, but for zeros, which have a place of their own; with numbers on it, however few decades it spans."""
    positive = [value for value in values if value > 0] or [1.0]
    low, high = min(positive) / 1.6, max(positive) * 1.6
    axes.set_xscale('symlog', linthresh=low, linscale=0.4)
    axes.set_xlim(-0.25 * low if 0 in values else low, high)
    ticks = ([0] if 0 in values else []) + ticks_between(low, high)
    axes.set_xticks(ticks, [f'{tick:,.0f}' if tick >= 10 else f'{tick:g}' for tick in ticks])
    axes.minorticks_off()


def trade_panel(rows, kernel, path, measure):
    """Draws the time of each test against what it gets wrong; None if no test has such a figure."""
    value_of, identifier = MEASURES[measure], measure[:5]
    if kernel == 'box':
        measure = measure.replace('wrong decisions', 'boxes missed')
    rows = [row for row in chosen(rows, kernel, path) if value_of(row) is not None]
    if not rows:
        return None
    figure, axes = panel(f'{kernel}, {path}: {measure.split(" [")[0]}')
    tooltips = Tooltips(f'{kernel}-{path}-{identifier}')
    for test in dict.fromkeys(row['test'] for row in rows):
        colour, marker = SERIES[list(dict.fromkeys(row['test'] for row in rows)).index(test) % len(SERIES)]
        for row in (row for row in rows if row['test'] == test):
            fast = row['grade'] == 'fast'
            mark, = axes.plot(value_of(row), row['nanoseconds_per_primitive'], marker, color=colour, markersize=6,
                              fillstyle='none' if fast else 'full', label=None if fast else test)
            tooltips.add(mark, f"{test}, {row['grade']}: {row['nanoseconds_per_primitive']:.3g} ns, "
                               f'{measure}: {value_of(row):.4g}')
    axis_of_errors(axes, [value_of(row) for row in rows])
    axes.set_ylim(0, 1.1 * max(row['nanoseconds_per_primitive'] for row in rows))
    axes.set_xlabel(measure)
    axes.set_ylabel('time [ns a primitive]')
    legend_above(axes, title='filled: reproducible, open: fast')
    return figure, tooltips


def trade_panels(rows, path):
    """Pairs of a description and a panel."""
    for kernel in dict.fromkeys(row['kernel'] for row in rows):
        for measure in MEASURES:
            drawn = trade_panel(rows, kernel, path, measure)
            if drawn:
                yield f'{kernel} {measure}', drawn
