"""Compiles a mutant, links it into the test programs in place of the right object, and runs them."""
import dataclasses
import functools
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import time

from mutant import UNITS, FOLDERS, folder_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
NATIVE = 'python/native/'
EMBREE = 'embree/libembree3.so.3'  # what is made of embree/
OF_LIBRARY = ('kernels/exact/predicate.cpp', 'kernels/exact/cross_product.cpp')  # not of a path
BOUNDARY_LOOP = 'kernels/winding/boundary_loop.cpp'  # of a library of its own
TIMED_OUT = 'time-out'
MEMORY = 16 << 30  # bytes that a mutated program may have


@dataclasses.dataclass(frozen=True)
class Place:
    """Where a mutant is compiled and linked."""
    build: pathlib.Path
    path: str
    library: str  # of the build
    source: str
    work: pathlib.Path


def unit_of(mutant):
    """The unit of kernels/ that is compiled again; '' for a .cpp of its own."""
    changed = mutant.source or mutant.file
    if changed in (*OF_LIBRARY, BOUNDARY_LOOP) or not changed.startswith('kernels/'):
        return ''
    return mutant.unit or FOLDERS.get(folder_of(mutant.file), ('',))[0]


def place_of(mutant, build, path, work):
    changed, unit = mutant.source or mutant.file, unit_of(mutant)
    if unit:
        return Place(build, path, f"lib{unit}_{path.replace('-', '_')}.a", UNITS[unit], work)
    if changed == BOUNDARY_LOOP:
        return Place(build, path, 'libboundary_loop.a', changed, work)
    if changed.startswith(NATIVE):
        module = next((build / 'python/raylanes').glob('_native*.so'))
        return Place(build, path, str(module.relative_to(build)), changed, work)
    if changed.startswith('embree/'):
        return Place(build, path, EMBREE, changed, work)
    for folder, library in ('bench/support/oracles/', 'bench/liboracles.a'), ('bench/support/roots/',
                                                                             'bench/libroot_survey.a'):
        if changed.startswith(folder):
            return Place(build, path, library, changed, work)
    return Place(build, path, 'libraylanes.a', changed, work)


def commands(build, target):
    out = subprocess.run(['ninja', '-C', build, '-t', 'commands', target], check=True, capture_output=True, text=True)
    return out.stdout.splitlines()


def compile_command(place, tree, output):
    """None for a source that this build has not."""
    line = next((c for c in commands(place.build, place.library) if c.endswith(f'/{place.source}')), None)
    if line is None:
        return None
    words = shlex.split(line)
    # Optimized less: it compiles in half the time.
    words = ['-O1' if w == '-O3' else w for w in words]
    for flag in ('-MF', '-MQ'):
        at = words.index(flag)
        del words[at:at + 2]
    words.remove('-MD')
    if '-include' in words:  # a compiled header, which has public ones as they were
        at = words.index('-include')
        del words[at:at + 2]
    words[words.index('-o') + 1] = str(output)
    words = [in_copy(w, place.build, tree) for w in words]  # public headers may be mutated, too
    words[-1] = str(tree / place.source)
    return words + ['-w']


def in_copy(word, build, tree):
    """A folder of the source that is searched for headers, in the copy of the source."""
    folder = os.path.normpath(build / word[2:])
    is_of_source = word.startswith('-I..') and folder.startswith(f'{ROOT}/')
    return f'-I{tree}/{os.path.relpath(folder, ROOT)}' if is_of_source else word


def link_command(build, program, replacement, output):
    words = shlex.split(commands(build, f'tests/{program}')[-1])
    words[words.index('-o') + 1] = str(output)
    first = next(i for i, w in enumerate(words) if w.endswith('.o'))
    words.insert(first, str(replacement))
    return words


def link_module(place, replacement, output):
    """The command that makes the Python module, or Embree's interface, with one object replaced. It comes first: of the
    inline functions that objects share the linker takes the first."""
    words = shlex.split(commands(place.build, place.library)[-1]) + [f'-Wl,-rpath,{place.build}']
    words[words.index('-o') + 1] = str(output)
    name = pathlib.Path(place.source).name
    words.remove(next(w for w in words if w.endswith((f'native_{name}.o', f'/{name}.o'))))
    words.insert(next(i for i, w in enumerate(words) if w.endswith('.o')), str(replacement))
    return words


def load_error(link, program, build):
    """Why a program does not link, or does not start to list its tests; None if it does."""
    for command in (link, [str(program), '--gtest_list_tests']):
        run = subprocess.run(command, cwd=build, capture_output=True, text=True, errors='replace')
        if run.returncode != 0:
            return (run.stderr.strip().splitlines() or [f'exit {run.returncode}'])[-1]
    return None


def first_failure(program, level, place, limit):
    """What fails in the program within so many seconds, or None."""
    # The tests that run out of memory set limits of their own.
    environment = {'RAYLANES_LEVEL': level, 'RAYLANES_TEST_PATHS': f'scalar,{place.path}', 'GTEST_FAIL_FAST': '1',
                   'GTEST_FILTER': '-*run_out_of_memory*'}
    try:
        run = subprocess.run(['prlimit', f'--as={MEMORY}', str(program)], cwd=place.build, capture_output=True,
                             text=True, errors='replace', timeout=limit, env={**os.environ, **environment})
    except subprocess.TimeoutExpired:
        return TIMED_OUT
    failed = [l.split(']')[1].split()[0].rstrip(',') for l in run.stdout.splitlines()
              if l.startswith('[  FAILED  ]') and '(' in l]
    return None if run.returncode == 0 else failed[0] if failed else f'exit {run.returncode}'


@functools.cache
def seconds_unmutated(program, level, path, build, limit):
    """What the program takes as it was built, or None where it fails: then nothing is shown."""
    begin = time.monotonic()
    failure = first_failure(build / 'tests' / program, level, Place(build, path, '', '', build), limit)
    if failure:
        print(f'{program} fails without a mutation on {path}: {failure}', flush=True)
    return None if failure else time.monotonic() - begin


def command_of(program, build):
    """What runs a test of the build, and its environment."""
    tests = json.loads((build / 'meson-info/intro-tests.json').read_text())
    return next((test['cmd'], test['env']) for test in tests if test['name'] == program)


def python_run(program, package, build, arguments, limit):
    """A command of the Python that runs a test of the module, with the package of that folder."""
    command, given = command_of(program, build)
    environment = {**given, 'PYTHONPATH': str(package), 'LD_LIBRARY_PATH': str(build)}
    return subprocess.run([command[0], *arguments] if arguments else command + ['-x'], cwd=build, capture_output=True,
                          text=True, timeout=limit, env={**os.environ, **environment})


def import_error(program, package, build, limit):
    """Why the package cannot be imported, or None."""
    run = python_run(program, package, build, ['-c', 'import raylanes, raylanes.trimesh'], limit)
    return (run.stderr.strip().splitlines() or ['?'])[-1] if run.returncode else None


def python_failure(program, package, build, limit):
    """What fails in a test of the Python module; None if nothing does."""
    try:
        run = python_run(program, package, build, [], limit)
    except subprocess.TimeoutExpired:
        return TIMED_OUT
    failed = re.findall(r'^(?:FAILED|ERROR) \S*?(?:::(\S+)|$)', run.stdout, re.M)
    return None if run.returncode == 0 else failed[0] if failed else f'exit {run.returncode}'


@functools.cache
def python_passes(program, build, limit):
    return python_failure(program, build / 'python', build, limit) is None


def compile_error(mutant, place, tree, limit):
    """Compiles a mutant to mutant.o in that folder; returns why that fails, or None."""
    for room in ('include', 'kernels', 'dispatch', 'accel', 'embree', 'python', 'bench'):
        shutil.copytree(ROOT / room, tree / room)
    text = (tree / mutant.file).read_text()
    (tree / mutant.file).write_text(mutant.mutated(text))
    command = compile_command(place, tree, tree / 'mutant.o')
    if command is None:
        return f'{place.source} is not of this build'
    try:
        compiled = subprocess.run(command, cwd=place.build, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return TIMED_OUT
    errors = [line for line in compiled.stderr.splitlines() if 'error' in line]
    return (errors or ['?'])[0] if compiled.returncode != 0 else None


def python_verdict_of(mutant, place, limit):
    for program in mutant.programs:
        if not python_passes(program, place.build, limit):
            return 'NOT SHOWN', f'{program} fails without it'
    with tempfile.TemporaryDirectory(dir=place.work) as folder:
        package = pathlib.Path(folder) / 'package'
        shutil.copytree(place.build / 'python', package)
        if mutant.file.startswith(NATIVE):
            error = compile_error(mutant, place, pathlib.Path(folder), limit)
            if error:
                return 'DOES NOT COMPILE', error
            module = package / pathlib.PurePath(place.library).relative_to('python')
            subprocess.run(link_module(place, pathlib.Path(folder) / 'mutant.o', module), cwd=place.build, check=True)
        else:
            file = package / pathlib.PurePath(mutant.file).relative_to('python')
            file.write_text(mutant.mutated(file.read_text()))
        error = import_error(mutant.programs[0], package, place.build, limit)
        if error:
            return 'DOES NOT LOAD', error
        failures = (python_failure(program, package, place.build, limit) for program in mutant.programs)
        failure = next(filter(None, failures), None)
        return ('killed', failure) if failure else ('SURVIVED', ' '.join(mutant.programs))


def embree_failure(program, folder, build, limit):
    """What fails in a test of Embree's interface with the library of that folder; None if nothing does."""
    command = [str(folder) if word == str(build / 'embree') else word for word in command_of(program, build)[0]]
    environment = {**os.environ, 'LD_LIBRARY_PATH': str(folder)}
    try:
        run = subprocess.run(command, cwd=build, capture_output=True, text=True, timeout=limit, env=environment)
    except subprocess.TimeoutExpired:
        return TIMED_OUT
    return (run.stdout.strip().splitlines() or [f'exit {run.returncode}'])[0] if run.returncode else None


def embree_verdict_of(mutant, place, limit):
    with tempfile.TemporaryDirectory(dir=place.work) as folder:
        tree = pathlib.Path(folder)
        error = compile_error(mutant, place, tree, limit)
        if error:
            return 'DOES NOT COMPILE', error
        library = tree / 'mutated/embree'
        library.mkdir(parents=True)
        link = subprocess.run(link_module(place, tree / 'mutant.o', library / 'libembree3.so.3'), cwd=place.build,
                              capture_output=True, text=True)
        if link.returncode:
            return 'DOES NOT LOAD', link.stderr.strip()[-200:]
        for program in mutant.programs:
            failure = embree_failure(program, place.build / 'embree', place.build, limit)
            if failure:
                return 'NOT SHOWN', f'{program} fails without it: {failure}'
            failure = embree_failure(program, library, place.build, limit)
            if failure:
                return 'killed', failure
        return 'SURVIVED', ' '.join(mutant.programs)


def is_of_module(mutant):
    return mutant.file.endswith('.py') or mutant.file.startswith(NATIVE)


def failure_in(program, place, tree, limit, levels):
    """A verdict other than SURVIVED of one test program, or None."""
    error = load_error(link_command(place.build, program, tree / 'mutant.o', tree / program), tree / program,
                       place.build)
    if error:
        return 'DOES NOT LOAD', error
    for level in levels:
        seconds = seconds_unmutated(program, level, place.path, place.build, limit)
        if seconds is None:
            return 'NOT SHOWN', f'{program} fails without it'
        failure = first_failure(tree / program, level, place, min(limit, 20 + 10 * seconds))
        if failure:
            return 'killed', failure
    return None


def verdict_of(mutant, place, limit, levels):
    """('killed' | 'SURVIVED' | 'DOES NOT COMPILE' | 'DOES NOT LOAD' | 'NOT SHOWN', what said so)."""
    if is_of_module(mutant):
        return python_verdict_of(mutant, place, limit)
    if place.library == EMBREE:
        return embree_verdict_of(mutant, place, limit)
    with tempfile.TemporaryDirectory(dir=place.work) as folder:
        tree = pathlib.Path(folder)
        error = compile_error(mutant, place, tree, limit)
        if error:
            return 'DOES NOT COMPILE', error
        for program in mutant.programs:
            verdict = failure_in(program, place, tree, limit, levels)
            if verdict:
                return verdict
        return 'SURVIVED', ' '.join(mutant.programs)


def runs_here(build, path):
    """Whether the build has the path and this processor can take it: else its mutants would survive."""
    program = build / 'tests/print_active_path'
    name = path.replace('_', '-')
    run = subprocess.run([program], env={**os.environ, 'RAYLANES_PATH': name}, capture_output=True, text=True)
    return run.returncode == 0 and run.stdout.strip() == name
