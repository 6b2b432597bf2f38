"""The rounds of measured rows: their quartiles, and ratios of two rows that took turns."""


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
