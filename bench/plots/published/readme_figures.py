"""What README.md says of speed, from the measured files, and whether each sentence that does so names its machine."""
import re

from results import KINDS, MACHINES, TWO_PATHS, Results
from tables import exact_table

MACHINE = 'xeon'  # whose figures README has
FIGURE = r'\d[\d.,]*(?: to \d[\d.,]*)? ?(?:times|ns|µs|%|×)'
ROUNDS = 1.02  # methods whose times differ by less are as fast


def ends(rays, key):
    """The least and the greatest of the means by kind of rays and ISA path."""
    means = [rays.mean(key, path=path, rays=kind) for path in TWO_PATHS for kind in KINDS]
    return min(means), max(means)


def root_row(roots, accuracy, path='avx512'):
    return next(row for row in roots.where(function='sqrt', path=path) if accuracy in row['serves'])


def figures(folder):
    """The figures of README's sentences, in their words."""
    rays, calls, roots, exact, kernels = (Results(folder, kind, MACHINE)
                                          for kind in ('rays', 'calls', 'roots', 'exact', 'kernels'))

    def between(key):
        least, greatest = ends(rays, key)
        return f'{least:.1f} to {greatest:.1f} times'

    def root(accuracy):
        row = root_row(roots, accuracy)
        return f"{row['nanoseconds']:.3f} ns", f"{row['ratio_to_hardware']:.1f} times"

    def time(test, **chosen):
        return kernels.one(kernel='triangle', form='1xN', test=test, grade='reproducible',
                           **chosen)['nanoseconds_per_primitive']

    longest = max(float(value) for line in exact_table(exact) if 'watertight' in line
                  for value in re.findall(r'\d\.\d\d', line))
    over_arrays = max(time('exact', path=path, query=query) / time('watertight', path=path, query=query)
                      for path in TWO_PATHS for query in ('any', 'closest'))
    return [between('ratio'), between('ratio_to_robust'), *root('correctly_rounded'), *root('within_2^-11'),
            f"{calls.mean(path='avx512'):.2f} times", f"{calls.mean('ratio_to_packed', path='avx512'):.2f} times",
            f'up to {(longest - 1) * 100:.0f} % longer', f'{(over_arrays - 1) * 100:.0f} % over arrays']


def sentences(readme):
    """The sentences and cells of README outside its blocks of code, pictures and links' targets left out."""
    text = re.sub(r'```.*?```', '', readme, flags=re.DOTALL)
    text = re.sub(r'\]\([^)]*\)', ']', text)
    return re.split(r'(?<=[.:])\s+(?=[A-Z*`\[])|\||\n\n|\n- ', ' '.join(text.replace('\n\n', '|').split(' ')))


def slower_methods(folder):
    """The accuracies whose method is not the fastest checked one within its error, which README says of AVX2 and
    AVX-512."""
    roots = Results(folder, 'roots', MACHINE)
    for path in ('avx2', 'avx512'):
        rows = [row for row in roots.where(function='sqrt', path=path) if row['method'] != 'estimate_unchecked']
        for row in (row for row in rows if row['serves']):
            best = min((other for other in rows if other['max_ulp'] <= row['max_ulp']), key=lambda r: r['nanoseconds'])
            if row['nanoseconds'] > ROUNDS * best['nanoseconds']:
                yield f"{path}: {row['method']} serves {row['serves'][0]}, and {best['method']} is faster"


def faults(readme, folder):
    """What README should say, which of its figures come from no file, and which sentences name no machine."""
    said, known = [' '.join(sentence.split()) for sentence in sentences(readme)], figures(folder)
    for figure in known:
        holding = [sentence for sentence in said if figure in sentence]
        if not holding:
            yield f'README.md should say: {figure}'
        yield from (f'README.md: {figure} without the machine, {MACHINES[MACHINE]}: {sentence}' for sentence in holding
                    if MACHINES[MACHINE] not in sentence)
    for sentence in said:
        yield from (f'README.md: {found} is of no measured file: {sentence}' for found in re.findall(FIGURE, sentence)
                    if not any(found in figure for figure in known))
    yield from slower_methods(folder)
