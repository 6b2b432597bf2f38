"""ISA paths: the builds of the kernels, and the one that calls use."""

from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple

from . import _native
from ._scalars import word


class Path(NamedTuple):
    """An ISA path: one build of all kernels.

    Attributes
    ----------
    name : str
        The name that use_path() and the variable RAYLANES_PATH accept.
    isa : str
        Its instruction set.
    library : str
        The SIMD library that it is written over: "none", "xsimd" or "highway".
    lanes : int
        The floats in a vector.
    supported : bool
        Whether this machine can run it.
    """

    name: str
    isa: str
    library: str
    lanes: int
    supported: bool


_chosen: ContextVar[str | None] = ContextVar("raylanes_path", default=None)


def paths() -> tuple:
    """List the ISA paths of this build, slowest first.

    Returns
    -------
    tuple of Path
        The first is "scalar".

    Examples
    --------
    >>> raylanes.paths()[0].name
    'scalar'
    """
    return tuple(Path(*row) for row in _native.paths())


def chosen() -> str | None:
    """The name of the path that use_path asks for; None: the library's choice."""
    return _chosen.get()


def active_path() -> str:
    """Name the ISA path of calls from here.

    Returns
    -------
    str
        The path of use_path(), else of the variable RAYLANES_PATH, else the fastest one that this machine supports.
    """
    return _chosen.get() or _native.active_path()


@contextmanager
def use_path(name: str):
    """Use an ISA path within a with statement, in this thread or task only. A new thread begins without.

    Results by the test "exact" have the same bytes on every path.

    Parameters
    ----------
    name : str
        A name of paths().

    Returns
    -------
    context manager

    Raises
    ------
    ValueError
        If there is no such path, or this machine does not support it.

    Examples
    --------
    >>> with raylanes.use_path("scalar"):
    ...     raylanes.active_path()
    'scalar'
    """
    token = _chosen.set(_native.find_path(word("path", name)))
    try:
        yield
    finally:
        _chosen.reset(token)
