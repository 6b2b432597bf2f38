"""The rounds of measured rows: their quartiles, ratios of two rows that took turns, and how errors are written."""


def quartiles(numbers):
    """(first quartile, median, third quartile), between the numbers where a position is not whole."""
    ordered = sorted(numbers)

    def at(share):
        position = share * (len(ordered) - 1)
        below = int(position)
        above = min(below + 1, len(ordered) - 1)
        return ordered[below] + (position - below) * (ordered[above] - ordered[below])
    return at(0.25), at(0.5), at(0.75)


def speeds(row):
    """The quartiles of a row's speeds, in Mrays/s."""
    return quartiles(row['rounds_mrays_per_second'])


def whisker(row):
    """How far a bar's whisker goes down, to the first quartile of the rounds, and up, to the third."""
    first, _, third = speeds(row)
    return [[max(0.0, row['mrays_per_second'] - first)], [max(0.0, third - row['mrays_per_second'])]]


def ratios(row, other):
    """The quartiles of a row's speed divided by another row's, round by round: rows of one run took turns, so noise
    that lasts longer than a round hits both."""
    return quartiles([a / b for a, b in zip(row['rounds_mrays_per_second'], other['rounds_mrays_per_second'])])


def error_text(max_ulp):
    """With so many digits that an error above half an ULP does not look like half an ULP."""
    return next(text for text in (f'{max_ulp:.{digits}g}' for digits in range(4, 18))
                if (float(text) > 0.5) == (max_ulp > 0.5))
