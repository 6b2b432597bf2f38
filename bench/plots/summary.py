"""What isa, roots and trace wrote into a folder, on one screen."""
import json


def rows_of(file):
    data = json.loads(file.read_text(encoding='utf-8'))
    if not isinstance(data, dict) or not isinstance(data.get('rows'), list):
        raise ValueError(f'{file}: is not what --json of this tool writes')
    return data['rows'], data.get('machine')


def print_table(rows):
    """Columns in line, numbers to the right."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        cells = (cell.rjust(width) if cell[:1].isdigit() else cell.ljust(width) for cell, width in zip(row, widths))
        print(printable('  '.join(cells).rstrip()))


def printable(text):
    return ''.join(c if c.isprintable() else c.encode('unicode_escape').decode() for c in text)


def print_paths(rows):
    here = ' '.join(row['path'] for row in rows if row['supported'])
    active = next((row['path'] for row in rows if row['active']), '')
    print(printable(f'paths on this machine: {here}; active is {active}'))


def print_roots(rows):
    """A row an accuracy, a column a path: the fastest method that keeps it."""
    rows = [row for row in rows if row['function'] == 'sqrt' and row['serves']]
    paths = list(dict.fromkeys(row['path'] for row in rows))
    # From the most accurate on: what serves a bound serves the looser ones, unless another one is faster.
    bounds = dict.fromkeys(bound for row in sorted(rows, key=lambda row: row['max_ulp']) for bound in row['serves'])
    shown = {(bound, row['path']): f"{1e9 / row['elements_per_second']:.3g} {row['ratio_to_hardware']:.2g}×"
             for row in rows for bound in row['serves']}
    print("\nns a value in the first-level cache, and how many times as fast as the path's hardware root")
    print_table([['square roots', *paths], *([bound, *(shown.get((bound, path), '') for path in paths)]
                                             for bound in bounds)])


def ratio_of(row):
    if row.get('ratio') is None:
        return ''
    first, third = row['ratio_quartiles']
    return f"{row['ratio']:.2g} ({first:.2g}…{third:.2g})"


def print_traces(rows):
    """Of each scene and ray set our fastest path and mode."""
    best = {}
    for row in rows:
        key = row['scene'], row['rays']
        if row['contender'] == 'raylanes' and row['mrays_per_second'] > best.get(key, row | {'mrays_per_second': 0})[
                'mrays_per_second']:
            best[key] = row
    print("\nour fastest path and mode on one thread, beside Embree's best on the same instruction set")
    print_table([['scene', 'rays', 'path', 'mode', 'Mrays/s', '× Embree (half of the rounds)', "Embree's best mode"],
                 *([row['scene'], row['rays'], row['path'], row['mode'], f"{row['mrays_per_second']:.3g}",
                    ratio_of(row), row.get('ratio_to', '')] for row in best.values())])
    for note in dict.fromkeys(row['embree_note'] for row in rows if 'embree_note' in row):
        print(printable(note))


def print_parts(rows):
    """Scenes of many parts, by calls with one ray and by batches."""
    rows = [row for row in rows if row['contender'] == 'scene']
    print(f"\n{rows[0]['scene']} as a scene of {rows[0]['parts']} parts, beside one tree of all and Embree's scene of "
          "as many geometries")
    print_table([['rays', 'mode', 'Mrays/s', '× one tree', '× Embree (half of the rounds)', "Embree's best mode"],
                 *([row['rays'], row['mode'], f"{row['mrays_per_second']:.3g}", f"{row['ratio_to_tree']:.2f}",
                    ratio_of(row), row.get('ratio_to', '')] for row in rows)])


def summary(folder):
    (paths, _), (roots, _), (traces, machine) = (rows_of(folder / f'{name}.json') for name in ('isa', 'roots', 'trace'))
    print(printable(f"{machine['processor']}, {machine['cores']} cores, {machine['compiler']}, {machine['date']}"))
    print_paths(paths)
    print_roots(roots)
    print_traces(traces)
    if (folder / 'parts.json').is_file():
        print_parts(rows_of(folder / 'parts.json')[0])
