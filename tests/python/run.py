"""Runs tests by pytest and reports as GoogleTest does, for tests/summary.py.

usage: run.py [--gtest_output=xml:FILE] TEST_FILE…
Exit status: 0 good, 1 a failure, 77 (Meson's skip) without pytest.
"""
import sys



def main(arguments):
    try:
        import pytest
    except ImportError:
        print("SKIPPED: tests of the Python module, there is no pytest for", sys.executable)
        return 77
    report = "--gtest_output=xml:"
    arguments = [a.replace(report, "--junitxml=") for a in arguments]
    return pytest.main(["-q", "-p", "no:cacheprovider", "-W", "error",
                        "-W", "ignore::raylanes.MeshWarning", *arguments])


if __name__ == "__main__":  # processes that tests spawn import this file
    sys.exit(main(sys.argv[1:]))
