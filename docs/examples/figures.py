"""What the examples with matplotlib share: how a figure begins, and how it is saved."""
import hashlib
import pathlib
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def panels(*titles):
    """(figure, axes) of square panels side by side, without ticks."""
    figure, axes = plt.subplots(1, len(titles), figsize=(3.6 * len(titles), 3.9), layout="constrained", squeeze=False)
    for panel, title in zip(axes[0], titles):
        panel.set_title(title, fontsize=10)
        panel.set(xticks=[], yticks=[], aspect="equal")
    return figure, axes[0]


def save(figure, name, *drawn):
    """Write the figure to the folder that the command line names.

    The file's Description is a digest of the arrays that are drawn. Equal numbers have equal digests: matplotlib may
    draw them in another way, and the tests compare what is shown.
    """
    digest = hashlib.sha256()
    for array in drawn:
        numbers = np.asarray(array, np.float64)
        digest.update(repr(numbers.shape).encode())
        digest.update((np.where(np.isnan(numbers), np.nan, numbers) + 0.0).astype("<f8").tobytes())
    figure.savefig(pathlib.Path(sys.argv[1]) / name, dpi=100, metadata={"Description": digest.hexdigest()})
