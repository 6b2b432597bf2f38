"""Measures the tables of docs/figures.md on this machine, and publishes them: the work of bench/publish.

usage: measure.py BUILD_FOLDER [--only TABLE,…] [--scenes DIR] [--machine NAME] [--dry-run]

TABLE is a name between the marks of docs/figures.md. Tables of one command are measured together: root_methods with
roots, cliff_roots with cliffs. short_roots has the name short, and other_roots is a picture. skips and filters are
lines of the first table. DIR has scenes.tsv and the meshes (default: RAYLANES_SCENES). NAME is the machine's in
MACHINES of results.py (default: by the processor).
--dry-run prints the commands.

Each command's rows go to bench/results/, in place of older ones of this machine. Then the pages and charts are made
again, and what README.md must say otherwise is printed. Exit status: 0 measured; 1 a command failed; 2 usage.
"""
import argparse
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
import collect_results  # noqa: E402
from results import MACHINES  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[3]


def each(**words):
    """The cases of all combinations: {'SCENE': 'bunny', 'SIZE': '64x64'}, …"""
    cases = [{}]
    for name, values in words.items():
        cases = [{**case, name: str(value)} for case in cases for value in values]
    return cases


BUILT_IN = 'foliage'  # made by the tool
SIX = ('bunny', 'sibenik', 'sponza', 'staircase', 'conference', 'kitchen')
TWO_SIZES = ('1024x1024', '256x256')
# By kind of file: the command as it is published, and what replaces its words in capitals, one run after the other.
COMMANDS = {
    'rays': ('raylanes trace SCENE --against embree --mode automatic --rays primary,shadow,diffuse,ao --path '
             'avx512,avx2 --seconds 0.6', each(SCENE=SIX)),
    'sizes': ('raylanes trace SCENE --subdivide K --size SIZE --mode automatic,single,call --counters --rays RAYS '
              '--path avx512 --against embree --seconds 0.3',
              each(SCENE=['dragon'], K=range(5), SIZE=TWO_SIZES, RAYS=['primary,diffuse']) +
              each(SCENE=['kitchen'], K=[0], SIZE=TWO_SIZES, RAYS=['primary,shadow,diffuse,ao'])),
    'parts': ('raylanes trace SCENE --parts N --mode automatic,call --rays primary,shadow,diffuse --size 512x512 '
              '--path avx512,avx2 --against scene,embree --seconds 0.4',
              each(SCENE=['sibenik', 'kitchen', 'office', 'staircase'], N=[100]) +
              each(SCENE=['sibenik', 'kitchen', 'staircase'], N=[1000])),
    'modes': ('raylanes trace SCENE --subdivide K --size SIZE --mode automatic,single,packet,stream,call --rays '
              'primary,shadow,diffuse,random --path avx512,avx2 --seconds 0.25',
              [{**case, **size}
               for case in (each(SCENE=['teapot', 'bunny'], K=[0]) + each(SCENE=['dragon'], K=[0, 2, 3]) +
                            each(SCENE=['sponza', 'armadillo', 'staircase'], K=[0]))
               for size in each(SIZE=['64x64', '256x256', '1024x1024'])]),
    'batches': ('raylanes trace SCENE --size SIZE --order tiles --mode automatic,call --batch '
                '1,2,4,8,16,32,64,128,256,512,1024,4096,16384,65536,262144,1048576 --streams 8,64,1024 --rays '
                'primary,shadow,diffuse --path avx512,avx2 --against embree --seconds 0.3',
                each(SCENE=['sibenik'], SIZE=['1024x1024']) + each(SCENE=['kitchen'], SIZE=['512x512'])),
    'embree_calls': ('compare_libraries SCENE WHAT --parts PARTS --path avx512,avx2 --rounds 5',
                     each(SCENE=['sponza', 'dragon'], WHAT=['calls'], PARTS=[1]) +
                     each(SCENE=['kitchen'], WHAT=['calls'], PARTS=[500]) +
                     each(SCENE=['dragon'], WHAT=['others'], PARTS=[1])),
    'calls': ('raylanes trace SCENE --mode call --against embree --rays primary,shadow,diffuse --path avx512,avx2 '
              '--size 256x256 --seconds 1',
              each(SCENE=['bunny', 'dragon', 'sibenik', 'sponza', 'classroom', *SIX[3:]])),
    'exact': ('raylanes trace SCENE --test exact,watertight,moller_trumbore --mode single --rays '
              'primary,shadow,diffuse,ao --path avx2,avx512 --size 256x256 --seconds 1',
              each(SCENE=['sibenik', 'sponza', 'conference'])),
    'skips': ('raylanes trace SCENE --skip --against embree --mode automatic,call --rays shadow,diffuse,ao --path '
              'avx512,avx2 --size 512x512 --seconds 0.6', each(SCENE=['bunny', 'sibenik', 'conference'])),
    'filters': ('raylanes trace SCENE --query kept,spheres,own --against embree --rays primary,shadow,diffuse --path '
                'avx512,avx2 --size 384x384 --seconds 0.4', each(SCENE=['bunny', 'sibenik', 'conference', BUILT_IN])),
    'kernels': ('raylanes kernels --path all', each()),
    'roots': ('raylanes roots --path all --stride 1024 --seconds 20', each()),
    'other_roots': ('raylanes roots --path all --stride 1024 --seconds 20', each()),
    'short': ('raylanes_bench "--benchmark_filter=^(short|few)/" --benchmark_repetitions=9 '
              '--benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true '
              '--benchmark_min_time=0.02', each()),
    'lengths': ('raylanes_bench --benchmark_filter=^length/ --benchmark_repetitions=9 '
                '--benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true '
                '--benchmark_min_time=0.05', each()),
    'points': ('raylanes points SCENE --query closest --against embree,cgal --seconds 2',
               each(SCENE=['bunny', 'armadillo', 'sibenik'])),
    'doubles': ('raylanes trace SCENE --doubles --offset OFFSET --path avx512,avx2 --against embree,cgal --rays '
                'primary,diffuse,ao --size SIZE --seconds 2',
                each(SCENE=['bunny', 'sibenik', 'conference', 'kitchen'], OFFSET=[0], SIZE=['256x256']) +
                each(SCENE=['bunny', 'conference'], OFFSET=[5000000], SIZE=['48x48'])),
    'trees': ('raylanes trees SCENE --against embree --mode single --seconds 1',
              each(SCENE=['bunny', 'sponza', 'sibenik', 'conference'])),
    'cliffs': ('raylanes_bench --benchmark_filter=^cliff/ --benchmark_repetitions=9 '
               '--benchmark_report_aggregates_only=true --benchmark_min_time=0.03', each())}


def processor():
    """(the machine's name in MACHINES, or None; its name in pages), by /proc/cpuinfo."""
    text = pathlib.Path('/proc/cpuinfo').read_text(encoding='utf-8')

    def field(name):
        found = re.search(rf'^{name}\s*: (.*)$', text, re.M)
        return found[1] if found else ''

    family, model, cores = field('cpu family'), int(field('model') or 0), os.cpu_count()
    maker = field('model name').split('@')[0].strip()
    if family == '26':
        return 'zen5', f'{maker} (Zen 5 class, {cores} virtual cores)'
    if family == '25' and model < 0x10:
        return 'zen3', f'{maker} (Zen 3 class, {cores} virtual cores)'
    if family == '25' and (0x10 <= model < 0x20 or 0x60 <= model < 0xb0):
        return 'zen4', f'{maker} (Zen 4 class, {cores} virtual cores)'
    if 'Xeon' in maker and ' avx512_fp16' in text:
        return 'xeon', f'Intel Xeon (Sapphire Rapids class, {cores} virtual cores)'
    return None, f'{maker} ({cores} virtual cores)'


def on_this_processor(command):
    """The command without AVX-512 where there is none."""
    has_avx512 = ' avx512f' in pathlib.Path('/proc/cpuinfo').read_text(encoding='utf-8')
    return command if has_avx512 else re.sub('avx512,|,avx512', '', command)


def mesh_files(folder):
    """The file of each scene, by scenes.tsv."""
    lines = (pathlib.Path(folder) / 'scenes.tsv').read_text(encoding='utf-8').splitlines()
    rows = [line.split('\t') for line in lines if line and not line.startswith('#')]
    return {row[0]: pathlib.Path(folder) / row[1] for row in rows}


def runs_of(kind, build, meshes, work):
    """(arguments, JSON file) of each run of a kind; before runs of raylanes_bench comes the machine's."""
    command, cases = on_this_processor(COMMANDS[kind][0]), COMMANDS[kind][1]
    tool = build / 'bench/raylanes'
    if not command.startswith('raylanes '):
        yield [tool, 'isa', '--json', work / 'isa.json'], work / 'isa.json'
    for number, case in enumerate(cases):
        words = [case.get(word, word) for word in shlex.split(command)]
        program, file = build / 'bench' / words[0], work / f'{kind}-{number}.json'
        arguments = [meshes.get(word, word) if word == case.get('SCENE') else word for word in words[1:]]
        if words[0] == 'compare_libraries':
            program, arguments = ROOT / 'bench/programs' / words[0], [build, *arguments]
        out = [f'--benchmark_out={file}'] if words[0] == 'raylanes_bench' else ['--json', file]
        yield [program, *arguments, *out], file


def measure(kind, options, meshes, work):
    """Runs the commands of a kind, and keeps its rows. Returns whether all were good."""
    name, shown = processor()
    runs, began = list(runs_of(kind, options.build, meshes, work)), time.monotonic()
    for arguments, _ in runs:
        words = [str(argument) for argument in arguments]
        if options.dry_run:
            print(shlex.join(words))
        elif subprocess.run(words, stdout=subprocess.DEVNULL, check=False).returncode != 0:
            print(f'bench/publish: {kind} is left out, this failed: {shlex.join(words)}', file=sys.stderr)
            return False
    if options.dry_run:
        return True
    machine, results = options.machine or name, ROOT / 'bench/results'
    older = list(results.glob(f'{machine}-*-{kind}.json'))
    target = f'{machine}-{compiler(options.build)}-{time.strftime("%Y-%m-%d")}'
    collect_results.main(kind, target, shown, on_this_processor(COMMANDS[kind][0]), *(file for _, file in runs))
    for file in older:
        if file.name != f'{target}-{kind}.json':
            file.unlink()
    print(f'{kind}: {len(runs)} runs, {time.monotonic() - began:.0f} s')
    return True


def compiler(build):
    """Such as gcc12, by the compiler that the build folder uses."""
    found = subprocess.run([build / 'bench/raylanes', 'isa', '--json', '-'], capture_output=True, text=True, check=True)
    name, version = re.search(r'"compiler": "(\S+) (\d+)', found.stdout).groups()
    return {'g++': 'gcc', 'clang++': 'clang'}.get(name, name) + version


def main():
    kinds = {**{kind: kind for kind in COMMANDS}, 'root_methods': 'roots', 'cliff_roots': 'cliffs',
             'short_roots': 'short'}
    parser = argparse.ArgumentParser(prog='bench/publish', description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS)
    parser.add_argument('build', type=pathlib.Path)
    parser.add_argument('--only', metavar='TABLE,…', default=','.join(COMMANDS), help='tables (default: all)')
    parser.add_argument('--scenes', metavar='DIR', default=os.environ.get('RAYLANES_SCENES'))
    parser.add_argument('--machine', choices=MACHINES, help='default: by the processor')
    parser.add_argument('--dry-run', action='store_true', help='print the commands')
    options = parser.parse_args()
    unknown = [table for table in options.only.split(',') if table not in kinds]
    if unknown:
        parser.error(f"--only: there is no table {unknown[0]}; known are {', '.join(kinds)}")
    if not options.machine and not processor()[0]:
        parser.error(f'{processor()[1]} has no name in MACHINES of results.py: add it, then pass --machine')
    wanted = list(dict.fromkeys(kinds[table] for table in options.only.split(',')))
    names = {case['SCENE'] for kind in wanted for case in COMMANDS[kind][1] if 'SCENE' in case} - {BUILT_IN}
    meshes = mesh_files(options.scenes) if names and options.scenes else {}
    if names - meshes.keys():
        parser.error(f"--scenes: meshes are missing: {', '.join(sorted(names - meshes.keys()))}")
    with tempfile.TemporaryDirectory() as work:
        good = [measure(kind, options, meshes, pathlib.Path(work)) for kind in wanted]
    if not options.dry_run and any(good):
        published = pathlib.Path(__file__).with_name('published.py')
        for arguments in ([ROOT], ['--check', ROOT]):
            subprocess.run([sys.executable, published, *arguments], check=False)
    return 0 if all(good) else 1


if __name__ == '__main__':
    sys.exit(main())
