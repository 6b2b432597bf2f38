"""The tables of docs/figures.md, made from the measured files of bench/results."""
import roots
from results import KINDS, TWO_PATHS, mean, pair, table

TRIANGLE_TESTS = ('exact', 'watertight', 'moller_trumbore', 'precomputed', 'plane_edges')


def by_scene(results, kinds, name, also=()):
    """Ratios on avx512 and avx2 by scene and kind of rays, then their means, and the means of other ratios."""
    def line(title, value):
        return [title, *(pair(value(path, kind) for path in TWO_PATHS) for kind in kinds)]

    lines = [line(scene, lambda path, kind, scene=scene: results.one(scene=scene, path=path, rays=kind)['ratio'])
             for scene in results.names('scene')]
    lines.append(line('**geometric mean**', lambda path, kind: results.mean(path=path, rays=kind)))
    lines += [line(title, lambda path, kind, key=key: results.mean(key, path=path, rays=kind)) for title, key in also]
    return table([name, *(KINDS[kind] for kind in kinds)], lines)


def rays_table(results):
    return by_scene(results, KINDS, 'avx512, avx2', [
        ("compared with Embree's robust mode", 'ratio_to_robust'),
        ('compared with rays packed before the clock starts', 'ratio_to_packed')])


def calls_table(results):
    return by_scene(results, ['primary', 'shadow', 'diffuse'], 'avx512, avx2',
                    [("compared with Embree's robust mode", 'ratio_to_robust'),
                     ('compared with rays packed before the clock starts', 'ratio_to_packed')])


def exact_table(results):
    def ratio(path, test, **values):
        row, rounded = (results.one(path=path, test=name, **values) for name in ('exact', test))
        return rounded['mrays_per_second'] / row['mrays_per_second']

    lines = [[scene, f'`{test}`', *(pair(ratio(path, test, scene=scene, rays=kind) for path in TWO_PATHS)
                                    for kind in KINDS)]
             for scene in results.names('scene') for test in ('watertight', 'moller_trumbore')]
    return table(['scene', 'compared with', *KINDS.values()], lines)


def kernels_table(results):
    def row_of(path, test, query='closest'):
        return results.one(kernel='triangle', path=path, test=test, form='1xN', query=query,
                           grade='fast' if test == 'moller_trumbore' else 'reproducible')

    def line(test):
        row = row_of('avx512', test)
        wrong = row_of('avx512', test, 'any')['wrong_per_million']
        return [f'`{test}`', pair(row_of(path, test)['nanoseconds_per_primitive'] for path in TWO_PATHS),
                *(f'{wrong[kind]:,.0f}' for kind in ('edges', 'plane', 'far')),
                f"{row['leaks_per_million']:,.0f}", f"{row['max_t_ulp']:.1f}"]

    return table(['test', 'ns: avx512, avx2', 'wrong: edges', 'plane', 'far', 'leaks', 'error of t, ULP'],
                 [line(test) for test in TRIANGLE_TESTS])


def points_table(results):
    def line(scene, points):
        ours = results.one(scene=scene, points=points, contender='bvh')
        others = [results.one(scene=scene, points=points, contender=name)['bvh_ratio'] for name in ('embree', 'cgal')]
        return [f'{scene}, {points}', f"{ours['mpoints_per_second']:.2f}", *(f'{ratio:.1f}' for ratio in others)]

    return table(['points', 'million points/s', "times as fast as Embree", "times as fast as CGAL"],
                 [line(scene, points) for scene in results.names('scene') for points in ('box', 'surface')])


def trees_table(results):
    def line(scene, build):
        row = results.one(scene=scene, build=build, contender='raylanes')
        medium = results.one(scene=scene, contender='embree', build='medium')
        ratio = medium['build_seconds'] / row['build_seconds']
        return [scene, f'`{build}`', f"{row['build_seconds'] * 1e3:.1f}", f'{ratio:.2f}', f"{row['sah_cost']:.3g}",
                f"{row['bytes'] / row['triangles']:.0f}", pair(row['speed_of_rays'][kind] for kind in
                                                               ('primary', 'diffuse'))]

    return table(['scene', 'builder', 'build, ms', '× Embree', 'SAH cost', 'bytes a triangle', 'primary, diffuse'],
                 [line(scene, build) for scene in results.names('scene')
                  for build in ('binned_sah', 'sweep_sah', 'spatial_splits', 'morton')])


def doubles_table(results):
    """Near zero: speed by Embree's calls, and time by floats. Far away, where floats have no mesh, speed alone."""
    def cells(scene, rays, offset):
        def values(mode, key, of=lambda value: value):
            rows = [results.one(scene=scene, rays=rays, offset=offset, contender='raylanes', mode=mode, path=path)
                    for path in TWO_PATHS]
            if not all(key in row for row in rows):
                return '–'
            return ', '.join(f'{of(row[key]):,.{2 if row[key] < 100 else 0}f}' for row in rows)

        def wrong(contender):
            rows = results.where(scene=scene, rays=rays, offset=offset, contender=contender)
            return f"{rows[0]['wrong']:,} of {rows[0]['ray_count']:,}" if rows else '–'

        return [values('call', 'ratio'), values('batch', 'ratio'),
                values('call', 'ratio_to_floats', lambda ratio: 1 / ratio),
                values('batch', 'ratio_to_floats', lambda ratio: 1 / ratio), wrong('embree'), wrong('cgal')]

    lines = [[f'{scene}, {KINDS.get(rays, rays)}' + (f', at {offset:,.0f}' if offset else ''),
              *cells(scene, rays, offset)]
             for offset in results.names('offset') for scene in results.names('scene')
             for rays in results.names('rays') if results.where(scene=scene, rays=rays, offset=offset)]
    return table(['rays', '× Embree: calls', 'batch', 'time / floats: calls', 'batch', 'wrong: Embree', 'CGAL'], lines)


def lines_of(row):
    """Lines of 64 bytes that a single ray reads: four of a node, five of a leaf."""
    return 4 * row['nodes_per_ray'] + 5 * row['leaves_per_ray']


def sizes_table(results):
    """Rays by the number of triangles: batches of two sizes of picture, and one ray a call."""
    small, large = sorted(results.names('pixels'))

    def line(scene, triangles, rays):
        def row(mode, pixels=large):
            return results.one(scene=scene, triangles=triangles, rays=rays, mode=mode, pixels=pixels)
        batch, call = row('automatic'), row('call')
        return [f'{scene}, {triangles:,}', KINDS[rays], f"{1e3 / batch['mrays_per_second']:.0f}",
                f"{batch['ratio']:.2f}", f"{row('automatic', small)['ratio']:.2f}",
                f"{1e3 / call['mrays_per_second']:.0f}", f"{call['ratio']:.2f}",
                f"{lines_of(row('single')):.0f}", f"{batch['bytes'] / triangles:.0f}"]

    cases = dict.fromkeys((row['scene'], row['triangles'], row['rays']) for row in results.rows)
    return table(['triangles', 'rays', 'batch, ns', '× Embree', f'{small:,} pixels', 'calls, ns',
                  '× Embree', 'lines a ray', 'bytes a triangle'], [line(*case) for case in cases])


def parts_table(results):
    """Scenes of many parts by calls and batches, beside one tree and Embree; then parts that will move."""
    kinds = results.names('rays')
    cases = dict.fromkeys((row['scene'], row['parts']) for row in results.rows)

    def cells(value, contender, keys):
        return [pair(value(rays=kind, contender=contender, mode=mode, key=key) for kind in kinds)
                for mode in ('call', 'automatic') for key in keys]

    def table_of(contender, keys, titles):
        lines = [[f'{scene}, {parts:,}', path, *cells(
            lambda key, **values: results.one(scene=scene, parts=parts, path=path, **values)[key], contender, keys)]
                 for scene, parts in cases for path in TWO_PATHS]
        lines += [['**mean**', path, *cells(lambda key, **values: results.mean(key, path=path, **values), contender,
                                            keys)] for path in TWO_PATHS]
        return table(['scene, parts', 'ISA path', *titles], lines)

    return [
        *table_of('scene', ('ratio_to_tree', 'ratio'), [
            'calls / one tree', "calls × Embree's flat scene", 'batches / one tree', 'batches × the same']), '',
        *table_of('scene_moving', ('ratio',), ["moving: calls × Embree's instances", 'moving: batches × the same'])]


def batches_table(results):
    """Batches by the number of their rays: speed by a loop of calls, and by Embree's best with no more rays a call."""
    kinds, paths = results.names('rays'), results.paths()

    def cell(key, path, **case):
        found = [results.where(path=path, mode='automatic', rays=kind, **case) for kind in kinds]
        return ', '.join(pair([row[key] for row in rows]) or '–' for rows in found)  # scenes with fewer rays

    return table(['scene, rays in a call', *(f'{path}: × {rival}' for path in paths
                                             for rival in ('a loop of calls', 'Embree'))],
                 [[f'{scene}, {batch:,}', *(cell(key, path, scene=scene, batch=batch) for path in paths
                                            for key in ('ratio_to_calls', 'ratio'))]
                  for scene in results.names('scene')
                  for batch in sorted({row['batch'] for row in results.where(mode='automatic', scene=scene)})])


def embree_calls_table(results):
    """Calls of Embree's interface by raylanes and by Debian's Embree: pictures, then what else scenes have, then
    commits."""
    paths, title = results.paths(), ', '.join(results.paths())
    pictures = dict.fromkeys((row['scene'], row['rays']) for row in results.where(mode='fast'))

    def cell(**case):
        rows = [results.where(path=path, **case) for path in paths]
        return pair(row['ratio'] for row, in rows) if all(rows) else '–'

    def line(call, mode):
        return [f'`{call}`' if mode == 'fast' else '… against robust mode',
                *(cell(scene=scene, rays=rays, call=call, mode=mode) for scene, rays in pictures)]

    lines = [line(row['call'], mode) for row in results.where(scene=next(iter(pictures))[0], rays='camera', mode='fast',
                                                              path=paths[0]) for mode in ('fast', 'robust')]
    others = dict.fromkeys(row['mode'] for row in results.where(rays='random'))
    commits = dict.fromkeys((row['scene'], row['count'], row['mode']) for row in results.where(call='rtcCommitScene'))

    def milliseconds(case, key):
        (scene, count, mode), path = case, paths[0]
        return f"{1e3 * results.where(scene=scene, count=count, mode=mode, path=path)[0][key]:.3g}"

    return [
        *table([title, *(f'{scene} {rays}' for scene, rays in pictures)],
               [line for line in lines if any(cell != '–' for cell in line[1:])]), '',
        *table(['random rays at the dragon', '`rtcIntersect1`', '`rtcOccluded1`'],
               [[mode, *(cell(rays='random', mode=mode, call=call) for call in ('rtcIntersect1', 'rtcOccluded1'))]
                for mode in others]), '',
        *table(['`rtcCommitScene`', 'raylanes, ms', 'Embree, ms'],
               [[f"{scene}, {count} {'geometry' if count == 1 else 'geometries'}: {mode}",
                 *(milliseconds((scene, count, mode), key) for key in ('seconds', 'embree_seconds'))]
                for scene, count, mode in commits])]


def modes_table(results):
    """The time of automatic by the least of any mode and of a loop of calls, for each size of picture."""
    def regret(path, **case):
        times = {row['mode']: 1 / row['mrays_per_second'] for row in results.where(path=path, **case)}
        return times.pop('automatic') / min(times.values())

    def cell(**case):
        return pair(regret(path, **case) for path in TWO_PATHS)

    kinds = results.names('rays')
    cases = dict.fromkeys((row['scene'], row['triangles'], row['pixels']) for row in results.rows)
    lines = [[f'{scene}, {triangles:,}', f'{pixels:,}',
              *(cell(scene=scene, triangles=triangles, rays=kind, pixels=pixels) for kind in kinds)]
             for scene, triangles, pixels in cases]
    lines.append(['**geometric mean**', '', *(
        pair(mean(regret(path, scene=scene, triangles=triangles, rays=kind, pixels=pixels)
                  for scene, triangles, pixels in cases) for path in TWO_PATHS) for kind in kinds)])
    return table(['scene, triangles', 'pixels', *(KINDS.get(kind, kind) for kind in kinds)], lines)


def nanoseconds_of(results, name):
    time = results.one(name=name)['nanoseconds']
    return f'{time:,.0f}' if time >= 100 else f'{time:.3g}'


def cliffs_table(results):
    def both(case):
        return [nanoseconds_of(results, f'{case}/{test}') for test in ('exact', 'watertight')]

    lines = [['rays straight down at corners of a terrain', *both('down/corners')],
             ['within its cells', *both('down/cells')],
             ['rays in the plane of a flat floor', *both('floor/in_plane')],
             ['a millionth above it', *both('floor/above')]]
    lines += [[f'closest point from {2 * 10 ** power:,} radii of a ball',
               nanoseconds_of(results, f'closest/{power}'), ''] for power in range(7)]
    lines += [['first winding number of a soup of 100,000 triangles', nanoseconds_of(results, 'winding/first'), '']]
    lines += [[f'ray through a ball of size 1e{power}', nanoseconds_of(results, f'size/{power}'), '']
              for power in (0, -18, -22, -26, -30, -34, -36)]
    return table(['case', 'exact, ns', 'watertight, ns'], lines)


TABLES = {'sizes': ('sizes', sizes_table), 'batches': ('batches', batches_table), 'parts': ('parts', parts_table),
          'modes': ('modes', modes_table), 'cliffs': ('cliffs', cliffs_table),
          'cliff_roots': ('cliffs', roots.cliff_roots_table),
          'short_roots': ('short', roots.short_roots_table), 'doubles': ('doubles', doubles_table),
          'rays': ('rays', rays_table), 'calls': ('calls', calls_table), 'exact': ('exact', exact_table),
          'roots': ('roots', roots.roots_table), 'lengths': ('lengths', roots.lengths_table),
          'root_methods': ('roots', roots.root_methods_table), 'kernels': ('kernels', kernels_table),
          'points': ('points', points_table), 'trees': ('trees', trees_table)}
TABLES_OF_EMBREE = {'embree_calls': ('embree_calls', embree_calls_table)}
