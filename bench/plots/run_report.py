#!/usr/bin/env python3
"""Measures this machine and writes DIR/index.html, one page without links to elsewhere, and its figures as
DIR/report.json. Called by `raylanes report`.

usage: run_report.py TOOL --out=DIR [--seconds S] [--resume] [--scene=SCENE]…
       run_report.py TOOL --compare=A.json --compare=B.json
       run_report.py TOOL --summary=DIR
Exit status: that of the tool (0 good, 1 wrong answers or a regression, 2 usage, 3 input, 4 output).
"""
import argparse
import io
import json
import pathlib
import sys

sys.dont_write_bytecode = True
from compare_reports import compare  # noqa: E402
from report_steps import BUILT_IN, ProgressLine, StepFailed, run_steps, steps_for  # noqa: E402
from summary import summary  # noqa: E402
from whole_file import write_whole  # noqa: E402

GOOD, WRONG, USAGE, INPUT, OUTPUT = range(5)


def ringed_differences(exact, other):
    """A picture of `other` with rings around the pixels that differ; returns its file and how many differ."""
    import matplotlib.image
    import numpy as np
    pixels, reference = (matplotlib.image.imread(file)[..., :3] for file in (other, exact))
    differs = np.any(pixels != reference, axis=-1)
    rows, columns = np.mgrid[:differs.shape[0], :differs.shape[1]]
    shown = 0.4 * pixels + 0.6
    for row, column in np.argwhere(differs)[:2000]:
        distance = np.hypot(rows - row, columns - column)
        shown[(distance > 4) & (distance < 6)] = (0.84, 0.37, 0.0)
    file = other.with_name(other.stem + '-differences.png')
    png = io.BytesIO()
    matplotlib.image.imsave(png, shown, format='png')
    write_whole(file, png.getvalue())
    return file, int(differs.sum())


def report(options):
    try:
        from report_page import page
    except ModuleNotFoundError as error:
        if error.name != 'matplotlib':
            raise
        print('raylanes: report: needs matplotlib (Debian: python3-matplotlib)', file=sys.stderr)
        return INPUT
    folder = options.out
    folder.mkdir(parents=True, exist_ok=True)
    scenes = options.scenes or BUILT_IN
    data, machine = run_steps(options.tool, steps_for(scenes, folder, options.seconds), folder, options.resume,
                              ProgressLine(sys.stderr))
    write_whole(folder / 'report.json',
                json.dumps({'schema_version': 1, 'machine': machine, 'scenes': scenes, 'steps': data}))
    write_whole(folder / 'index.html', page(data, machine, scenes, folder, ringed_differences))
    print(f'{folder / "index.html"} and report.json')
    return GOOD


def main():
    parser = argparse.ArgumentParser(prog='raylanes report', description='measure this machine and write one page')
    parser.add_argument('tool', type=pathlib.Path)
    parser.add_argument('--scene', action='append', dest='scenes')
    parser.add_argument('--out', type=pathlib.Path)
    parser.add_argument('--seconds', type=float, default=0.2)
    parser.add_argument('--resume', action='store_true')
    parser.add_argument('--compare', action='append', type=pathlib.Path)
    parser.add_argument('--summary', type=pathlib.Path)
    options = parser.parse_args()
    try:
        if options.compare:
            return compare(*options.compare)
        if options.summary:
            return summary(options.summary) or GOOD
        return report(options)
    except StepFailed as failure:
        print(f'raylanes: report: {failure}', file=sys.stderr)
        return failure.status
    except (OSError, ValueError, KeyError, TypeError) as error:
        print(f'raylanes: report: {error}', file=sys.stderr)
        return INPUT if options.compare or options.summary else OUTPUT


if __name__ == '__main__':
    sys.exit(main())
