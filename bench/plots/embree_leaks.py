#!/usr/bin/env python3
"""Draws docs/pictures/embree_leaks.png: the vertices of a sphere that rays miss by Embree and by raylanes.

usage: bench/plots/embree_leaks.py BUILD_FOLDER PICTURE.png     prints the leaks of each library
"""
import os
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use('Agg')
from matplotlib import pyplot  # noqa: E402


def main():
    build, picture = pathlib.Path(sys.argv[1]), sys.argv[2]
    debian = next(pathlib.Path('/usr/lib').glob('*/libembree3.so.3')).parent
    figure, axes = pyplot.subplots(1, 3, figsize=(12, 2.6), layout='constrained')
    for axis, (name, folder, mode) in zip(axes, [('Embree 3.13, fast', debian, 'fast'),
                                                 ('Embree 3.13, robust', debian, 'robust'),
                                                 ('raylanes', build / 'embree', 'fast')]):
        with tempfile.TemporaryDirectory() as work:
            file = pathlib.Path(work, 'lost.pgm')
            said = subprocess.run([build / 'tests/embree/embree_leaks', mode, file], text=True, capture_output=True,
                                  env=os.environ | {'LD_LIBRARY_PATH': str(folder)}).stdout
            print(f'{name}:\n{said}', end='')
            lost = pyplot.imread(file)
        axis.imshow(lost, cmap='gray', vmin=0, vmax=255, interpolation='none', aspect='auto')
        axis.set_title(f'{name}: {int((lost == 0).sum()):,} vertices leak')
        axis.set_xticks([]), axis.set_yticks([])
    figure.savefig(picture, dpi=110)


if __name__ == '__main__':
    main()
