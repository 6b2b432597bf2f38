#!/usr/bin/env python3
"""Keeps what is published of measured files: the machine, the command, and of each row the keys that tables read.

usage: collect KIND NAME PROCESSOR COMMAND FILE.json…   writes bench/results/NAME-KIND.json

NAME begins with the machine's: MACHINES of results.py. The first file of cliffs, lengths, short and embree_calls is of
`raylanes isa --json`, for the machine; the others are of raylanes_bench with repetitions and of compare_libraries.
"""
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from whole_file import write_whole  # noqa: E402

KEYS = {
    'rays': ('scene', 'triangles', 'rays', 'ray_count', 'path', 'mode', 'test', 'build', 'mrays_per_second', 'spread',
             'rounds', 'ratio', 'ratio_quartiles', 'ratio_to', 'ratio_to_robust', 'ratio_to_packed'),
    'roots': ('function', 'method', 'grade', 'path', 'inputs', 'max_ulp', 'max_ulp_at', 'correctly_rounded', 'serves',
              'nanoseconds', 'ratio_to_hardware', 'pareto'),
    'kernels': ('kernel', 'test', 'grade', 'form', 'query', 'path', 'nanoseconds_per_primitive', 'spread',
                'instructions_per_primitive', 'wrong_per_million', 'leaks_per_million', 'max_t_ulp'),
    'points': ('scene', 'triangles', 'points', 'contender', 'path', 'point_count', 'mpoints_per_second', 'spread',
               'bvh_ratio', 'bvh_ratio_quartiles'),
    'doubles': ('scene', 'triangles', 'offset', 'rays', 'ray_count', 'contender', 'path', 'mode', 'mrays_per_second',
                'spread', 'ratio', 'ratio_quartiles', 'ratio_to_floats', 'ratio_to_floats_quartiles', 'wrong', 'hits'),
    'sizes': ('scene', 'triangles', 'pixels', 'rays', 'ray_count', 'path', 'contender', 'mode', 'mrays_per_second',
              'spread', 'ratio', 'ratio_to', 'nodes_per_ray', 'leaves_per_ray', 'bytes'),
    'modes': ('scene', 'triangles', 'pixels', 'rays', 'ray_count', 'path', 'mode', 'mrays_per_second', 'spread'),
    'parts': ('scene', 'triangles', 'parts', 'rays', 'ray_count', 'path', 'contender', 'mode', 'mrays_per_second',
              'spread', 'ratio', 'ratio_to', 'ratio_to_tree'),
    'batches': ('scene', 'triangles', 'rays', 'ray_count', 'contender', 'path', 'mode', 'batch', 'build',
                'mrays_per_second', 'spread', 'ratio', 'ratio_to', 'ratio_to_calls', 'ratio_to_robust'),
    'embree_calls': ('scene', 'rays', 'call', 'mode', 'path', 'count', 'seconds', 'embree_seconds', 'ratio', 'spread',
                     'rounds'),
    'filters': ('scene', 'triangles', 'query', 'rays', 'ray_count', 'contender', 'path', 'mrays_per_second'),
    'cliffs': ('name', 'nanoseconds'),
    'trees': ('scene', 'triangles', 'contender', 'build', 'build_seconds', 'spread', 'sah_cost', 'bytes', 'peak_bytes',
              'speed_of_rays')}
KEYS['lengths'] = KEYS['short'] = KEYS['cliffs']
KEYS['other_roots'] = KEYS['roots']
KEYS['calls'] = KEYS['exact'] = KEYS['skips'] = KEYS['rays']


def rounded(value):
    if isinstance(value, float):
        # An error just above half an ULP is not correct rounding.
        return float(f'{value:.9g}' if 0.5 < value < 0.51 else f'{value:.5g}')
    if isinstance(value, list):
        return [rounded(element) for element in value]
    if isinstance(value, dict):
        return {key: rounded(element) for key, element in value.items()}
    return value


def kept(row, keys):
    if 'elements_per_second' in row:
        row['nanoseconds'] = 1e9 / row['elements_per_second'] if row['elements_per_second'] else None
    if 'traces' in row:
        row['speed_of_rays'] = {trace['rays']: trace['ratio_to_first'][0] for trace in row['traces']}
    return {key: rounded(row[key]) for key in keys if key in row}


def rows_of(content):
    """The rows of a file of the tool; or of Google Benchmark, the median of its repetitions, an item."""
    if 'benchmarks' not in content:
        return content['rows']
    return [{'name': re.sub('^(cliff|length)/', '', row['run_name']).removesuffix(f"/repeats:{row['repetitions']}"),
             'nanoseconds': 1e9 / row['items_per_second']}
            for row in content['benchmarks'] if row.get('aggregate_name') == 'median']


def is_shown(kind, row):
    if kind in ('cliffs', 'lengths', 'short'):
        return 'nanoseconds' in row
    if kind == 'embree_calls':
        return 'call' in row
    if kind == 'other_roots':
        return row['function'] != 'sqrt'
    if kind == 'kernels':
        return row['kernel'] == 'triangle' and row['form'] == '1xN' and row['path'] in ('avx2', 'avx512')
    if kind == 'parts':
        return row['contender'].startswith('scene')
    if kind == 'batches':
        is_rival = row['build'] != 'robust' and not re.search('^call|_packed$', row['mode'])
        # The last call of a picture may have a few rays less.
        return (row['contender'] == 'raylanes' or is_rival) and row['batch'] < 1.5 * row['ray_count']
    return kind not in ('rays', 'calls', 'exact', 'sizes', 'modes', 'skips') or row['contender'] == 'raylanes'


def main(kind, name, processor, command, *files):
    contents = [json.loads(pathlib.Path(file).read_text(encoding='utf-8')) for file in files]
    machine = {**contents[0]['machine'], 'processor': processor}
    for key in ('system', 'commit', 'load_average'):
        machine.pop(key, None)
    rows = [kept(row, KEYS[kind]) for content in contents for row in rows_of(content)
            if is_shown(kind, row)]
    lines = ',\n'.join(json.dumps(row, ensure_ascii=False) for row in rows)
    target = pathlib.Path(__file__).resolve().parents[2] / f'results/{name}-{kind}.json'
    head = f'{{"machine": {json.dumps(machine)},\n"command": {json.dumps(command)},\n'
    write_whole(target, f'{head}"rows": [\n{lines}\n]}}\n')


if __name__ == '__main__':
    if len(sys.argv) < 6:
        sys.exit(__doc__)
    main(*sys.argv[1:])
