"""Square roots: error against time, with the front of each ISA path."""
import math

from plot_style import SERIES, Tooltips, legend_above, panel
from rounds import error_text

GROUPS = [('classic_', 'bit trick and Newton steps', 2), ('hardware', 'hardware instruction', 1)]


def nanoseconds(row):
    return 1e9 / row['elements_per_second']


def group_of(row):
    for prefix, label, series in GROUPS:
        if row['method'].startswith(prefix):
            return label, series
    return ('fastest for its error', 0) if row['pareto'] else ('other methods', 6)


def tooltip(row):
    return (f"{row['method']} ({row['grade']}): {nanoseconds(row):.3g} ns, error ≤ {error_text(row['max_ulp'])} ULP "
            f"(bound {row['max_ulp_promised']:.4g}), worst argument {row['max_ulp_at']}")


def front_of(rows):
    """The rows of the front, from the largest error to the smallest."""
    return sorted((row for row in rows if row['pareto']), key=lambda row: (-row['max_ulp'], nanoseconds(row)))


def ends_of(rows):
    """The axes that all ISA paths share."""
    times = [nanoseconds(row) for row in rows]
    errors = [max(row['max_ulp'], 0.4) for row in rows]
    return (0.3, 3 * max(errors)), (0.7 * min(times), 1.6 * max(times))


def root_panel(path, rows, ends):
    """Draws the square roots of one ISA path; returns the figure and its tooltips."""
    figure, axes = panel(f'square roots on {path}')
    tooltips = Tooltips(f'roots-{path}')
    front = front_of(rows)
    axes.plot([max(row['max_ulp'], 0.4) for row in front], [nanoseconds(row) for row in front],
              drawstyle='steps-post', color=SERIES[0][0], linewidth=1, alpha=0.6)
    labelled = set()
    for row in sorted(rows, key=lambda row: group_of(row)[1] != 6):
        label, series = group_of(row)
        colour, marker = SERIES[series]
        mark, = axes.plot(max(row['max_ulp'], 0.4), nanoseconds(row), marker, color=colour, markersize=5,
                          label=None if label in labelled else label)
        labelled.add(label)
        tooltips.add(mark, tooltip(row))
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.set_xlim(*ends[0])
    axes.set_ylim(*ends[1])
    axes.set_xlabel('largest error [ULP]')
    axes.set_ylabel('time [ns a value]')
    axes.yaxis.set_major_formatter(lambda y, _: f'{y:g}')
    axes.yaxis.set_minor_formatter(lambda y, _: f'{y:g}' if str(f'{y:e}')[0] in '25' else '')
    legend_above(axes, 2)
    return figure, tooltips


def root_panels(rows):
    """A pair of path and panel for each ISA path."""
    roots = [row for row in rows if row['function'] == 'sqrt' and math.isfinite(row['max_ulp'])]
    ends = ends_of(roots)
    for path in dict.fromkeys(row['path'] for row in roots):
        yield path, root_panel(path, [row for row in roots if row['path'] == path], ends)
