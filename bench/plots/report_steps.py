"""What a report measures: commands of the tool, each of which writes JSON into a folder. A step that has its file and
the same command is not run again."""
import json
import pathlib
import subprocess
import time
from dataclasses import dataclass, field

from whole_file import write_whole

BUILT_IN = ['spheres', 'hall', 'fractal']
ROUNDED_TESTS = 'exact,watertight,moller_trumbore'


@dataclass
class Step:
    name: str  # of its JSON file
    seconds: float  # expected, on two cores
    arguments: list
    files: list = field(default_factory=list)  # others that it writes


def name_of(scene):
    return scene.replace('/', '_')


def title_of(scene):
    """What a reader calls the scene: the file's name without its folder."""
    return pathlib.PurePath(scene).stem


def steps_for(scenes, folder, seconds):
    """seconds: what each set of rays is timed."""
    yield Step('isa', 1, ['isa'])
    for scene in scenes:
        name = name_of(scene)
        picture, heat = folder / f'picture-{name}.png', folder / f'heat-{name}'
        heat.mkdir(exist_ok=True)
        size = ['--size', '256x256']
        yield Step(f'trace-{name}', 150 * seconds + 2,
                   ['trace', scene, '--path', 'all', '--mode', 'single,automatic,call', '--against', 'embree',
                    '--seconds', str(seconds), *size])
        # Without Embree all paths take turns, so that their speeds can be compared.
        yield Step(f'advice-{name}', 40 * seconds + 4,
                   ['trace', scene, '--path', 'all', '--mode', 'single,automatic', '--seconds', str(seconds), *size])
        yield Step(f'tests-{name}', 12 * seconds + 2,
                   ['trace', scene, '--test', ROUNDED_TESTS, '--grade', 'fast', '--mode', 'single', '--seconds',
                    str(seconds), *size])
        yield Step(f'heat-{name}', 4 * seconds + 2,
                   ['trace', scene, '--mode', 'single', '--rays', 'primary,shadow', '--counters', '--heatmap',
                    str(heat), '--image', str(picture), '--seconds', '0', *size], [picture])
        for test in ROUNDED_TESTS.split(','):
            image = folder / f'picture-{name}-{test}.png'
            yield Step(f'picture-{name}-{test}', 2,
                       ['trace', scene, '--test', test, '--grade', 'fast', '--mode', 'single', '--rays',
                        'primary,shadow', '--image', str(image), '--seconds', '0', '--size', '512x512'], [image])
        yield Step(f'kdtree-{name}', 8 * seconds + 2,
                   ['trace', scene, '--tree', 'kdtree', '--mode', 'single', '--seconds', str(seconds), *size])
        yield Step(f'trees-{name}', 30 * seconds + 4,
                   ['trees', scene, '--seconds', str(seconds), '--size', '128x128'])
    kernels = str(min(5.0, 25 * seconds))
    stride, pairs = ('2048', '10000') if seconds > 0 else ('65536', '100')
    yield Step('roots', 25, ['roots', '--path', 'all', '--stride', stride, '--seconds', kernels])
    # Instructions are counted one by one, which takes long: on the active ISA path only.
    yield Step('kernels', 30, ['kernels', '--pairs', pairs, '--leak-rays', f'{pairs}0', '--seconds', kernels])


class ProgressLine:
    """On a terminal one line that is written over, else nothing."""

    def __init__(self, stream):
        self.stream, self.shown = stream, stream.isatty()

    def show(self, done, left, what):
        if self.shown:
            filled = int(24 * done)
            self.stream.write(f'\r[{"#" * filled}{"." * (24 - filled)}] {100 * done:3.0f} %, '
                              f'{left:4.0f} s left: {what:<24}')
            self.stream.flush()

    def end(self):
        if self.shown:
            self.stream.write('\r' + ' ' * 78 + '\r')


class StepFailed(Exception):
    """A command of the tool failed: its status and its message."""

    def __init__(self, step, status, message):
        super().__init__(f'{" ".join(step.arguments[:2])}: {message}')
        self.status = status


def is_done(step, file, record):
    return (file.is_file() and record.get(step.name) == step.arguments
            and all(other.is_file() for other in step.files))


def run_steps(tool, steps, folder, resume, progress):
    """Runs the steps; returns the rows of each, and the machine. The record of what is done is kept up to date."""
    steps = list(steps)
    record_file = folder / 'steps.json'
    record = json.loads(record_file.read_text()) if resume and record_file.is_file() else {}
    left = sum(step.seconds for step in steps)
    whole, pace = left, 1.0  # seconds by those expected
    for step in steps:
        file = folder / f'{step.name}.json'
        progress.show(1 - left / whole, left * pace, step.name)
        if not is_done(step, file, record):
            begin = time.monotonic()
            run = subprocess.run([str(tool), *step.arguments, '--json', str(file)], capture_output=True, text=True)
            if run.returncode != 0:
                message = (run.stderr.strip().splitlines() or ['failed'])[-1]
                raise StepFailed(step, run.returncode, message)
            record[step.name] = step.arguments
            write_whole(record_file, json.dumps(record))
            ratio = (time.monotonic() - begin) / max(step.seconds, 1.0)
            pace = 0.5 * pace + 0.5 * max(0.2, min(5.0, ratio))
        left -= step.seconds
    progress.end()
    read = {step.name: json.loads((folder / f'{step.name}.json').read_text()) for step in steps}
    return {name: data['rows'] for name, data in read.items()}, read['isa']['machine']
