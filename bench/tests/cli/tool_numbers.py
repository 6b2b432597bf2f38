"""What the tool makes of text that is no number, or none that an option allows."""
import re

from tool_user import all_of

# No option of any command takes these.
WRONG = ["-1", "-3", "99999999999999999999", "1e400", "nan", "-nan", "inf", "-inf", "infinity", "1x", "x", "0x10", " 1",
         "+1", "1 ", "1,", ",1", "1,,1", "", "-", "--"]
# Options by command that are known to take numbers: --help must list these at least.
KNOWN = {"roots": {"--seconds", "--stride"}, "kernels": {"--seconds", "--pairs", "--leak-rays"},
         "trace": {"--threads", "--seconds", "--samples", "--batch", "--subdivide"},
         "points": {"--count", "--threads", "--seconds", "--holes", "--accuracy", "--beta", "--subdivide"},
         "trees": {"--threads", "--seconds", "--rounds", "--copies", "--subdivide"}, "report": {"--seconds"},
         "isa": set()}
# Options that take several numbers in one text, with words of their messages.
SEVERAL = {"trace": {"--size": "WIDTHxHEIGHT", "--camera": "number"}, "points": {"--grid": "NxNxN"},
           "trees": {"--size": "WIDTHxHEIGHT", "--camera": "number"}}


def numbers_in_help(text):
    """(option, type, least, most) of all options that take numbers."""
    options = re.findall(r"^  (--[a-z-]+) (INT|FLOAT|UINT)\b(.*)$", text, re.MULTILINE)
    for option, kind, limits in options:
        found = re.match(r" in \[(\S+) - (\S+)\]", limits)
        yield option, kind, *(found.groups() if found else (None, None))


def beyond(kind, least, most):
    """Numbers just outside of the limits, and no integers."""
    if kind == "FLOAT":
        return [repr(float(least) - 1e-9), repr(float(most) * (1 + 1e-9))]
    return [str(int(least) - 1), str(int(most) + 1), "1.5", "1e2"]


def test_numbers(tool, _folder):
    """Every option that takes numbers refuses all others, in a line that names it, what was given and its limits."""
    for command in tool.commands:
        result = tool.run(command, "--help")
        options = list(numbers_in_help(result.stdout))
        tool.check({option for option, *_ in options} >= KNOWN[command], f"{command}: options with numbers", result)
        tool.check(not options or all_of(most is not None for *_, most in options), f"{command}: limits in --help",
                   result)
        more = ["--frames"] if command == "trees" else []
        for option, kind, least, most in options:
            for value in [*WRONG, *(beyond(kind, least, most) if most else [])]:
                words = [f'{option}: "{value}" is not ', f" from {least} to {most}"]
                # Without the words where the parser takes the value for the end of the options.
                tool.expect_error(words if value != "--" else [option], command, *more, option, value)
    for command, options in SEVERAL.items():
        for option, word in options.items():
            for value in WRONG + ["1x1x1x1", "-1x1", "-1x1x1", "nan,0,0,0,0,1", "inf,0,0,0,0,1", "1,2,3,4,5,6x"]:
                tool.expect_error([option] if value == "--" else [option, word if value else ""], command, option,
                                  value)
    tool.expect_error(["--grid", "16777216"], "points", "--grid", "2000x2000x2000")
    tool.expect_error(["--samples", "5", "square"], "trace", "--samples", "5")
