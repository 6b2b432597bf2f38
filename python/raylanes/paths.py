"""Which builds of the kernels there are, and which one calls use."""

from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple

from . import _native
from .scalars import word


class Path(NamedTuple):
    """A build of all kernels: `isa` is its instruction set, `library` what spells it, `lanes` floats fit a register,
    `supported` says whether this machine can run it."""

    name: str
    isa: str
    library: str
    lanes: int
    supported: bool


_chosen: ContextVar[str | None] = ContextVar("raylanes_path", default=None)


def paths() -> tuple:
    """All paths of this build, worst first."""
    return tuple(Path(*row) for row in _native.paths())


def chosen() -> str | None:
    """The name of the path that use_path asks for; None: the library's choice."""
    return _chosen.get()


def active_path() -> str:
    """The path of calls from here: that of use_path, else of the variable RAYLANES_PATH, else the best one."""
    return _chosen.get() or _native.active_path()


@contextmanager
def use_path(name: str):
    """with raylanes.use_path("avx2"): calls use that path, of the thread or task that asks for it alone; a new thread
    begins without. Answers by the exact test have the same bytes on every path. ValueError if there is no such path or
    this machine lacks it.
    """
    token = _chosen.set(_native.find_path(word("path", name)))
    try:
        yield
    finally:
        _chosen.reset(token)
