"""One table of docs/figures.md: what each machine has that was measured, side by side."""
from results import MACHINES, TWO_PATHS, Results, machines_of, mean, pair, table
from roots import ACCURACIES, ROOT_LENGTHS, root_gains
from readme_figures import root_row


def on_two_paths(key):
    return lambda results: pair(results.mean(key, path=path) for path in TWO_PATHS)


def doubles_by(mode):
    return lambda results: pair(results.mean(contender='raylanes', mode=mode, path=path, offset=0.0)
                                for path in TWO_PATHS)


def roots_by(accuracy):
    return lambda results: pair(root_row(results, accuracy, path)['ratio_to_hardware'] for path in TWO_PATHS)


def lengths_by(accuracy):
    def cell(results):
        gains = root_gains(results, accuracy)
        return f'{gains[0]:.2f} to {gains[-1]:.2f}'
    return cell


def over_points(contender):
    return lambda results: f"{mean(row['bvh_ratio'] for row in results.where(contender=contender)):.1f}"


def time_of_tests(results):
    def time(path, test):
        return results.one(kernel='triangle', form='1xN', test=test, grade='reproducible', path=path,
                           query='closest')['nanoseconds_per_primitive']
    return pair(time(path, 'exact') / time(path, 'watertight') for path in TWO_PATHS)


def builds(results):
    def seconds(scene, contender, build):
        return results.one(scene=scene, contender=contender, build=build)['build_seconds']
    ratios = (seconds(scene, 'embree', 'medium') / seconds(scene, 'raylanes', 'binned_sah')
              for scene in results.names('scene'))
    return f'{mean(ratios):.2f}'


def words(accuracy):
    return accuracy.replace('_', ' ')


def where_two_paths(**chosen):
    return lambda results: pair(results.mean(path=path, **chosen) for path in TWO_PATHS)


def few_rays(results):
    return f"{results.mean(mode='automatic', pixels=min(results.names('pixels'))):.2f}"


def query(contender, name, **chosen):
    """The speed of calls or batches with a query, by the best that Embree has of it: batches by its packets, too."""
    def ratio(results, row):
        same = {key: row[key] for key in ('scene', 'rays', 'query')}
        best = max(rival['mrays_per_second'] for rival in results.where(path='best', **same)
                   if contender.endswith('batch') or 'packets' not in rival['contender'])
        return row['mrays_per_second'] / best

    return lambda results: pair(mean(ratio(results, row) for row in results.where(
        contender=contender, query=name, path=path, **chosen)) for path in TWO_PATHS)


def lines_of_queries(beginning, contender):
    yield from ((f"{beginning}, a filter rejects {share} %, × Embree's filters", 'filters',
                 query(contender, f'kept, {share} % rejected')) for share in (0, 50, 90))
    yield (f"{beginning}, leaves cut out of foliage, × Embree's filters", 'filters',
           query(contender, 'kept, leaves cut out', scene='foliage'))
    yield f"{beginning}, spheres, × Embree's sphere points", 'filters', query(contender, 'spheres')
    yield f"{beginning}, a test of one's own, × Embree's user geometry", 'filters', query(contender, 'own spheres')


# What each headline figure is, then what it is in the cases that a reader may have.
LINES = [
    ("batches of rays, × Embree's best mode", 'rays', on_two_paths('ratio')),
    ("batches of rays, × Embree's robust mode", 'rays', on_two_paths('ratio_to_robust')),
    ("batches of 65,536 rays, avx512, × Embree's best mode", 'sizes', few_rays),
    ("batches with `skip`, × Embree's best mode", 'skips', where_two_paths(mode='automatic')),
    ("batches through 100 to 500 parts, × Embree's flat scene", 'parts',
     where_two_paths(contender='scene', mode='automatic')),
    ("batches through 100 to 500 parts that move, × Embree's instances", 'parts',
     where_two_paths(contender='scene_moving', mode='automatic')),
    *lines_of_queries('batches', 'raylanes, a batch'),
    ('one ray a call, × Embree', 'calls', on_two_paths('ratio')),
    ('one ray a call with `skip`, × Embree', 'skips', where_two_paths(mode='call')),
    ("one ray a call through 100 to 500 parts, × Embree's flat scene", 'parts',
     where_two_paths(contender='scene', mode='call')),
    ("one ray a call through 100 to 500 parts that move, × Embree's instances", 'parts',
     where_two_paths(contender='scene_moving', mode='call')),
    *lines_of_queries('one ray a call', 'raylanes'),
    ('rays of doubles, calls, × Embree with doubles', 'doubles', doubles_by('call')),
    ('rays of doubles, batches, × Embree with doubles', 'doubles', doubles_by('batch')),
    ('exact test over arrays, time / watertight', 'kernels', time_of_tests),
    *((f'roots {words(accuracy)}, × instruction', 'roots', roots_by(accuracy)) for accuracy in ACCURACIES),
    *((f'the same, {ROOT_LENGTHS[0]:,} to {ROOT_LENGTHS[-1]:,} floats, avx512: {words(accuracy)}', 'lengths',
       lengths_by(accuracy)) for accuracy in ACCURACIES),
    ('closest points, × Embree', 'points', over_points('embree')),
    ('closest points, × CGAL', 'points', over_points('cgal')),
    ("builds by `binned_sah`, × Embree's medium", 'trees', builds)]


def machines_of_lines(folder):
    """The machines that have one of these figures."""
    return [machine for machine in machines_of(folder)
            if any(machine in machines_of(folder, kind) for _, kind, _ in LINES)]


def machines_table(folder):
    machines = machines_of_lines(folder)

    def cell(kind, machine, value):
        return value(Results(folder, kind, machine)) if machine in machines_of(folder, kind) else 'not measured'
    return ['', *table(['geometric means', *(MACHINES[machine] for machine in machines)],
                       [[name, *(cell(kind, machine, value) for machine in machines)]
                        for name, kind, value in LINES if machines_of(folder, kind)]), '']
