"""The tables of square roots in docs/figures.md."""
import math

from results import table
from rounds import error_text

ACCURACIES = ('correctly_rounded', 'within_1_ulp', 'within_2^-22', 'within_2^-11')
ROOT_SHARES = (0.0, 1e-4, 1e-3, 0.01, 0.05, 0.2, 1.0)
ROOT_WAYS = ('instruction', 'correctly_rounded', 'within_1_ulp', 'within_2^-22', 'within_2^-11', 'reciprocal_root')
SHORT_LENGTHS = (1, 2, 3, 4, 6, 8, 12, 15, 16, 17, 24, 31, 32, 33, 48, 64, 65, 96, 128, 192, 256, 512, 700, 1024, 2048,
                 4096)
ROOT_LENGTHS = (3072, 10_000, 30_000, 100_000, 300_000, 1_000_000, 4_000_000, 16_000_000)


def roots_table(results):
    def cell(path, accuracy):
        rows = [row for row in results.where(function='sqrt', path=path) if accuracy in row['serves']]
        return f"{rows[0]['nanoseconds']:.3f}, {rows[0]['ratio_to_hardware']:.2f}" if rows else '–'

    paths = results.names('path')
    lines = [[accuracy.replace('_', ' '), *(cell(path, accuracy) for path in paths)] for accuracy in ACCURACIES]
    return table(['accuracy', *paths], lines)


def rounded_share(row):
    share = math.floor(row['correctly_rounded'] * 1e5) / 1e3
    return '> 99.99 %' if share == 100 and row['max_ulp'] > 0.5 else f'{share:.5g} %'


def root_methods_table(results):
    lines = [[f"`{row['method']}`", row['grade'], f"{row['nanoseconds']:.3f}", error_text(row['max_ulp']),
              rounded_share(row), 'yes' if row['pareto'] else '']
             for row in sorted(results.where(function='sqrt', path='avx512'), key=lambda row: row['max_ulp'])]
    head = ['method, avx512', 'grade', 'ns a value', 'largest error, ULP', 'correctly rounded', 'on the front']
    return table(head, lines)


def root_times(results, way, special):
    return [results.one(name=f'roots/{way}/{special}/{share:.6f}')['nanoseconds'] for share in ROOT_SHARES]


def cliff_roots_table(results):
    lines = [[f"{way.replace('_', ' ')}, {special}", *(f'{time:.3f}' for time in root_times(results, way, special))]
             for special in ('zeros', 'subnormals') for way in ROOT_WAYS]
    return table(['share', *(f'{share * 100:g} %' for share in ROOT_SHARES)], lines)


def short_roots_table(results):
    counts = (1, 2, 4, 8, 16, 17, 32, 33, 64, 256, 1024)
    lines = [[words, *(f'{time * n:.1f}' for n, time in zip(counts, short_times(results, way, counts)))]
             for way, words in SHORT_WAYS.items()]
    return table(['ns a call, of floats', *(f'{n:,}' for n in counts)], lines)


# And their words.
SHORT_WAYS = {'std': 'a loop of `std::sqrt`', 'raylanes': '`raylanes::sqrt`',
              'std_reciprocal_root': 'a loop of `1 / std::sqrt`',
              'reciprocal_root': '`raylanes::rsqrt` within 2 ULP'}


def short_times(results, way, lengths=SHORT_LENGTHS):
    return [results.one(name=f'short/{way}/{n}')['nanoseconds'] for n in lengths]


def root_gains(results, way):
    """How many times as fast as the instruction roots of so many floats are."""
    def time(name, n):
        return results.one(name=f'{name}/{n}')['nanoseconds']
    return [time('instruction', n) / time(way, n) for n in ROOT_LENGTHS]


def lengths_table(results):
    times = [f"{results.one(name=f'instruction/{n}')['nanoseconds']:.3f}" for n in ROOT_LENGTHS]
    lines = [['instruction, ns a value', *times]]
    lines += [[f"{way.replace('_', ' ')}, × instruction", *(f'{gain:.2f}' for gain in root_gains(results, way))]
              for way in ROOT_WAYS[1:-1]]
    return table(['floats', *(f'{n:,}' for n in ROOT_LENGTHS)], lines)
