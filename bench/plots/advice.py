"""What to call on the measured machine, from rows of one run, in which all ISA paths and modes took turns."""
from statistics import median

from rounds import ratios, speeds

NOISY = 0.25  # the usual distance of the quartiles of a ratio, by its median, beyond which nothing is advised
EQUAL = 1.02  # rows that are faster by less are equal

REASONS = {'automatic': 'the default mode', 'single': 'rays that have little in common', 'packet': 'rays of one origin',
           'stream': 'many rays in any order'}


def call_for(row):
    """The C++ call behind a row, and the reason to take it."""
    call = 'occluded' if row['rays'] in ('shadow', 'light', 'ao') else 'closest'
    options = '' if row['mode'] == 'automatic' else f', {{.mode = TraversalMode::{row["mode"]}}}'
    return f'tree.{call}(rays, out{options})', REASONS[row['mode']]


def noise_of(rows, best):
    """How far apart the middle half of the rounds has the ratio of a row to the best one; the median of all rows."""
    widths = [(third - first) / middle for first, middle, third in
              (ratios(best, row) for row in rows if row is not best)]
    return median(widths) if widths else (speeds(best)[2] - speeds(best)[0]) / speeds(best)[1]


def choice(rows, paths):
    """(row, noise): the row to take, or None if the run was too noisy to tell. A row equals
    the fastest one if it is within 2 % of it in a quarter of the rounds. Among equals: the widest ISA path, the active
    one, the default mode. `paths` are the rows of `isa`."""
    best = max(rows, key=lambda row: row['mrays_per_second'])
    noise = noise_of(rows, best)
    if noise > NOISY:
        return None, noise
    rank = {row['path']: (row['lanes'], row['active']) for row in paths}
    equal = [row for row in rows if ratios(best, row)[0] <= EQUAL]
    return max(equal, key=lambda row: (*rank[row['path']], row['mode'] == 'automatic', row['mrays_per_second'])), noise


def advice(rows, paths):
    """(scene, rays, row or None, noise) of each scene and ray set."""
    for scene in dict.fromkeys(row['scene'] for row in rows):
        for rays in dict.fromkeys(row['rays'] for row in rows if row['scene'] == scene):
            yield scene, rays, *choice([row for row in rows if row['scene'] == scene and row['rays'] == rays], paths)
