"""Whether one report is faster or slower than another beyond the noise: ratios of the same rows, by rounds."""
import json
import math
from statistics import geometric_mean, median

KEYS = ('scene', 'rays', 'tree', 'build', 'test', 'grade', 'path', 'contender', 'mode', 'batch')
LEVEL = 0.01  # of a row, divided by the rows: Bonferroni


def rounds_of(file):
    """The speeds of each round of a report, by what was timed."""
    report = json.loads(file.read_text())
    if report.get('schema_version') != 1:
        raise ValueError(f'{file}: not a report of schema version 1')
    rows = {}
    for name, step in report['steps'].items():
        for row in step:
            if 'rounds_mrays_per_second' in row:
                rows[name, *(row.get(key) for key in KEYS)] = row['rounds_mrays_per_second']
    return rows


def mann_whitney(a, b):
    """The two-sided p of equal distributions (Mann, Whitney 1947), normal approximation with ties."""
    both = sorted([(x, 0) for x in a] + [(x, 1) for x in b])
    ranks, ties, i = [0.0, 0.0], 0.0, 0
    while i < len(both):
        end = i
        while end < len(both) and both[end][0] == both[i][0]:
            end += 1
        for k in range(i, end):
            ranks[both[k][1]] += 0.5 * (i + 1 + end)
        ties += (end - i) ** 3 - (end - i)
        i = end
    n, m = len(a), len(b)
    u = ranks[0] - n * (n + 1) / 2
    size = n + m
    variance = n * m / 12 * (size + 1 - ties / (size * (size - 1))) if size > 1 else 0
    if variance == 0:
        return 1.0
    z = (abs(u - n * m / 2) - 0.5) / math.sqrt(variance)
    return math.erfc(max(z, 0) / math.sqrt(2))


def compare(first, second):
    """Prints the rows whose speed changed; returns 1 if one of ours is slower."""
    before, after = rounds_of(first), rounds_of(second)
    shared = [key for key in before if key in after]
    if not shared:
        raise ValueError(f'{first} and {second} have no row in common')
    changed, ratios = [], []
    for key in shared:
        ratio = median(after[key]) / median(before[key])
        ours = key[1 + KEYS.index('contender')] == 'raylanes'
        if ours:
            ratios.append(ratio)
        if mann_whitney(before[key], after[key]) < LEVEL / len(shared):
            changed.append((ratio, ours, key))
    for ratio, ours, key in sorted(changed, key=lambda entry: entry[0]):
        print(f'{ratio:6.3f}  {"faster" if ratio > 1 else "SLOWER" if ours else "slower"}  '
              f'{", ".join(str(part) for part in key[1:] if part is not None)}')
    mean = geometric_mean(ratios) if ratios else math.nan
    print(f'{len(shared)} rows compared, {len(changed)} changed beyond the noise; speed of ours, second by first, '
          f'geometric mean {mean:.3f}')
    return 1 if any(ours and ratio < 1 for ratio, ours, _ in changed) else 0
