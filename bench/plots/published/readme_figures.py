"""What README.md says of speed, from the measured files, and whether each sentence that does so names its machine."""
import re

from results import KINDS, MACHINES, TWO_PATHS, Results, machines_of, newest
from tables import exact_table

FIGURE = r'\d[\d.,]*(?: to \d[\d.,]*)? ?(?:times|ns|µs|%|×)'
ROUNDS = 1.02  # methods whose times differ by less are as fast


def ends(rays, key):
    """The least and the greatest of the means by kind of rays and ISA path."""
    means = [rays.mean(key, path=path, rays=kind) for path in TWO_PATHS for kind in KINDS]
    return min(means), max(means)


def root_row(roots, accuracy, path='avx512'):
    return next(row for row in roots.where(function='sqrt', path=path) if accuracy in row['serves'])


def longest_of_test(exact):
    """How much longer the exact test takes, at most, through trees."""
    ratios = (float(value) for line in exact_table(exact) if 'watertight' in line
              for value in re.findall(r'\d\.\d\d', line))
    return 100 * (max(ratios) - 1)


def longest_over_arrays(kernels):
    def time(test, **chosen):
        return kernels.one(kernel='triangle', form='1xN', test=test, grade='reproducible',
                           **chosen)['nanoseconds_per_primitive']
    return 100 * (max(time('exact', path=path, query=query) / time('watertight', path=path, query=query)
                      for path in TWO_PATHS for query in ('any', 'closest')) - 1)


def figures(folder):
    """The figures of README's sentences, in their words, each with the machines that its sentence must name: times are
    from the newest file, ratios run over all machines."""
    found = {}

    def add(kind, words, *values):
        machines = machines_of(folder, kind)
        numbers = [value(Results(folder, kind, machine)) for machine in machines for value in values]
        ends = [max(numbers)] if words[0] == 'up to ' else [min(numbers), max(numbers)]
        found[words[0] + ' to '.join(dict.fromkeys(format(end, words[1]) for end in ends)) + words[2]] = machines

    for key in ('ratio', 'ratio_to_robust'):
        add('rays', ('', '.1f', ' times'), *(lambda rays, key=key, k=k: ends(rays, key)[k] for k in (0, 1)))
    for accuracy in ('correctly_rounded', 'within_2^-11'):
        machine = newest(folder, 'roots')
        found[f"{root_row(Results(folder, 'roots', machine), accuracy)['nanoseconds']:.3f} ns"] = [machine]
        add('roots', ('', '.1f', ' times'), lambda roots, to=accuracy: root_row(roots, to)['ratio_to_hardware'])
    for key in ('ratio', 'ratio_to_packed'):
        add('calls', ('', '.2f', ' times'), lambda calls, key=key: calls.mean(key, path='avx512'))
    for mode in ('automatic', 'call'):
        add('skips', ('', '.2f', ' times'),
            lambda skips, mode=mode: skips.mean(path='avx512', rays='shadow', mode=mode))
    add('exact', ('up to ', '.0f', ' % longer'), longest_of_test)
    add('kernels', ('', '.0f', ' % over arrays'), longest_over_arrays)
    return found


def sentences(readme):
    """The sentences and cells of README outside its blocks of code, pictures and links' targets left out."""
    text = re.sub(r'```.*?```', '', readme, flags=re.DOTALL)
    text = re.sub(r'\]\([^)]*\)', ']', text)
    return re.split(r'(?<=[.:])\s+(?=[A-Z*`\[])|\||\n\n|\n- ', ' '.join(text.replace('\n\n', '|').split(' ')))


def slower_methods(folder):
    """The accuracies whose method is not the fastest checked one within its error, which README says of AVX2 and
    AVX-512."""
    roots = Results(folder, 'roots', newest(folder, 'roots'))
    for path in ('avx2', 'avx512'):
        rows = [row for row in roots.where(function='sqrt', path=path) if row['method'] != 'estimate_unchecked']
        for row in (row for row in rows if row['serves']):
            best = min((other for other in rows if other['max_ulp'] <= row['max_ulp']), key=lambda r: r['nanoseconds'])
            if row['nanoseconds'] > ROUNDS * best['nanoseconds']:
                yield f"{path}: {row['method']} serves {row['serves'][0]}, and {best['method']} is faster"


def faults(readme, folder):
    """What README should say, which of its figures come from no file, and which sentences name no machine."""
    said, known = [' '.join(sentence.split()) for sentence in sentences(readme)], figures(folder)
    for figure, machines in known.items():
        holding = [sentence for sentence in said if figure in sentence]
        if not holding:
            yield f'README.md should say: {figure}'
        yield from (f'README.md: {figure} without the machine, {MACHINES[machine]}: {sentence}' for sentence in holding
                    for machine in machines if MACHINES[machine] not in sentence)
    for sentence in said:
        yield from (f'README.md: {found} is of no measured file: {sentence}' for found in re.findall(FIGURE, sentence)
                    if not any(found in figure for figure in known))
    yield from slower_methods(folder)
