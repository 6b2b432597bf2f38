"""Calls the module again and again, each time with another allocation that fails, until none is left.

usage: LD_PRELOAD=failing_allocations.so PYTHONMALLOC=malloc python3 every_failure.py

Each failure must be a MemoryError or harmless, leave no memory behind, and let the next call give the right bytes.
Prints a line for each call: its name and how many failures it had. Exits with 1 if one of them did otherwise; a process
that aborts prints no further lines.
"""
import ctypes
import os
import signal
import sys
import warnings

import raylanes
from calls import calls_of_scenes, calls_of_trees, first_calls, native_calls, other_calls

warnings.simplefilter("ignore", raylanes.MeshWarning)
allocations = ctypes.CDLL(None)
allocations.fail_allocation.argtypes = [ctypes.c_long, ctypes.c_int]
allocations.live_allocations.restype = ctypes.c_size_t


def attempt(name, call, expected, failures, everyone):
    """Calls once and returns whether an allocation failed."""
    result, error = None, None
    allocations.fail_allocation(failures, everyone)
    try:
        result = call()
    except MemoryError:
        error = "MemoryError"
    except BaseException as other:  # not kept: its traceback holds what the call has made
        error = f"{type(other).__name__}: {other}"
    has_failed = stopped()
    if error is not None and not (has_failed and error == "MemoryError"):
        raise AssertionError(f"{name}: failure {failures} raised {error}")
    if error is None and result != expected:
        raise AssertionError(f"{name}: another result after failure {failures}")
    return has_failed


def stopped():
    """Whether an allocation failed; the next one may be that of this call."""
    try:
        return allocations.stop_failing() != 0
    except MemoryError:
        return allocations.stop_failing() != 0


def expect_clean(name, call, everyone=False):
    """Returns the number of failures. everyone: allocations of Python fail, too."""
    for _ in range(2):  # the second time without what is made once
        expected = call()
    failures, has_failed = 0, True
    while has_failed:
        lives = []
        for _ in range(3):  # Python's own caches settle
            has_failed = attempt(name, call, expected, failures, everyone)
            lives.append(allocations.live_allocations())
        if lives[2] > lives[1]:
            raise AssertionError(f"{name}: failure {failures} leaves {lives[2] - lives[1]} allocations behind")
        failures += has_failed
    if call() != expected:
        raise AssertionError(f"{name}: another result after {failures} failures")
    return failures


def expect_clean_of_everyone(name, call):
    return expect_clean(name, call, everyone=True)


def expect_clean_at_first(name, call):
    """The same in processes of which each has the first call fail: at one allocation of three if not exhaustive."""
    failures, status = 0, 0
    step = 1 if os.environ.get("RAYLANES_LEVEL") == "exhaustive" else 3
    while True:
        child = os.fork()
        if child == 0:
            signal.alarm(5)  # seconds until a process that waits forever ends
            os._exit(first_status(call, failures))
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        if status == 2:
            return failures
        if status != 0:
            raise AssertionError(f"{name}: the process of failure {failures} ended with status {status}")
        failures += step


def count_processors():
    """oneTBB does this once, within the first call. If memory runs out there, the next call waits forever."""
    try:
        ctypes.CDLL("libtbb.so.12")._ZN3tbb6detail2r124numa_default_concurrencyEi(-1)
    except (AttributeError, OSError):  # a build without oneTBB, or with another one
        pass


def first_status(call, failures):
    """0 if a failure was harmless, 2 if there was none, else 1."""
    count_processors()
    allocations.fail_allocation(failures, False)
    try:
        call()
    except MemoryError:
        pass
    except BaseException:
        return 1
    has_failed = stopped()
    try:
        return 1 if call() != call() else 0 if has_failed else 2
    except BaseException:
        return 1


def main():
    faulty = False
    # The order matters: these are lazy, and the first ones need a process without a call.
    for expect, calls in ((expect_clean_at_first, first_calls()), (expect_clean_of_everyone, native_calls()),
                          (expect_clean, calls_of_trees()), (expect_clean, calls_of_scenes()),
                          (expect_clean, other_calls())):
        for name, call in calls:
            try:
                print(f"{name}: {expect(name, call)}", flush=True)
            except AssertionError as error:
                print("FAULT", error, flush=True)
                faulty = True
    return faulty


if __name__ == "__main__":
    sys.exit(main())
