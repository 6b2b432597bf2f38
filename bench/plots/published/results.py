"""The measured files of bench/results: machines, rows, means; and tables in Markdown."""
import json
import pathlib
import statistics

KINDS = {'primary': 'primary', 'shadow': 'shadow', 'diffuse': 'diffuse', 'ao': 'ambient occlusion'}
TWO_PATHS = ('avx512', 'avx2')
mean = statistics.geometric_mean


# The machines by the first word of their files, and their names in pages.
MACHINES = {'xeon': 'Xeon', 'zen3': 'Zen 3', 'zen4': 'Zen 4', 'zen5': 'Zen 5'}


def machines_of(folder, kind='*'):
    """The machines that have a file of this kind."""
    return [machine for machine in MACHINES if list(pathlib.Path(folder).glob(f'{machine}-*-{kind}.json'))]


def newest(folder, kind):
    """Of the machines that have a file of this kind, the one whose file is the newest."""
    return max(machines_of(folder, kind), key=lambda machine: Results(folder, kind, machine).machine['date'])


def newest_of_path(folder, kind, path):
    """The newest file of this kind that has rows of an ISA path; of one day, the one with most rows."""
    files = [Results(folder, kind, machine) for machine in machines_of(folder, kind)]
    return max((file for file in files if file.where(path=path)),
               key=lambda file: (file.machine['date'], len(file.where(path=path))))


class Results:
    """One measured file: its machine, its command, its rows."""

    def __init__(self, folder, kind, machine):
        self.folder, self.name = folder, MACHINES[machine]
        file, = pathlib.Path(folder).glob(f'{machine}-*-{kind}.json')
        content = json.loads(file.read_text(encoding='utf-8'))
        self.machine, self.command, self.rows = content['machine'], content['command'], content['rows']

    def paths(self):
        """Those of the two ISA paths that this machine has."""
        return [path for path in TWO_PATHS if self.where(path=path)]

    def names(self, key):
        return list(dict.fromkeys(row[key] for row in self.rows))

    def where(self, **values):
        return [row for row in self.rows if all(row.get(key) == value for key, value in values.items())]

    def one(self, **values):
        found = self.where(**values)
        assert len(found) == 1, (values, len(found))
        return found[0]

    def mean(self, key='ratio', **values):
        return mean(row[key] for row in self.where(**values))


def speeds_by_batch(results, scene, rays, path, mode):
    """(sizes of batches, million rays a second of a mode at each). Modes that were measured with fewer rays a call make
    several calls; Embree's have the best of their trees and hints."""
    sizes = sorted({row['batch'] for row in results.where(mode='automatic')})
    rows = [row for row in results.where(scene=scene, rays=rays) if row['path'].removeprefix('embree-') == path and
            row['mode'].removesuffix('_coherent') == mode]
    speeds = {}
    for row in rows:
        speeds[row['batch']] = max(row['mrays_per_second'], speeds.get(row['batch'], 0))
    sizes = sorted(speeds) if mode == 'automatic' else [size for size in sizes if speeds and size >= min(speeds)]
    return sizes, [speeds[max(batch for batch in speeds if batch <= size)] for size in sizes]


def table(head, lines):
    return [f"| {' | '.join(head)} |", '|---' * len(head) + '|', *(f"| {' | '.join(line)} |" for line in lines)]


def pair(values, digits=2):
    return ', '.join(f'{value:.{digits}f}' for value in values)
