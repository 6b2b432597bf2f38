#!/usr/bin/env python3
"""Counts the instructions of the intersection loops in compiled objects, and holds them to their budgets.

usage: instruction_counts.py [--header FILE] [--budget] NAME=OBJECT...
NAME is a path, OBJECT its object or archive of kernels/intersections.cpp. Counted is the body of the innermost
loop; one trip tests `primitives` of them. Left out is loop control: arithmetic, comparison and jump on
general registers. Loads, stores and copies that are instructions of their own are counted apart, as `moves`:
a load that does not fold is no work of the test. What moves the mask out of its register counts.
  --header FILE  writes the counts as rows of C++ for the tool
  --budget       exits with 1 if a yes/no loop on a path with FMA is over its budget; without FMA the counts
                 are printed only: each multiply-add is two instructions there. The path scalar is left out: how
                 many primitives a trip of its loops tests is the compiler's choice
`cycles` is a lower bound for one trip on AMD's Zen 3 from its ports, registers of up to 256 bits, each figure
measured there by loops of independent instructions: two pipes multiply, fuse and blend; two others add, compare
and take minimum and maximum; any of the four does logic; a cycle has one MOVMSK, three loads, two of them of
vectors, one store and six instructions; the divider takes 3 cycles for a quotient and 5 for a root, and each of
them two slots of the multiplying pipes. Latencies do not count.
`window` is an estimate of what they cost: trips overlap only as far as the processor can hold their results until
they retire in order. By Little's law a trip takes at least results × longest chain / registers, of which Zen 3
has 160 for vectors, 32 of them taken by what the program sees and by microcode.
Needs objdump (binutils).
"""
import re
import subprocess
import sys

BUDGETS = {'sphere/line': 12, 'box/conservative': 25, 'box/plain': 25, 'box/directional': 19,
           'triangle/directional': 28}
LANES = {'scalar': 1, 'sse2': 4, 'avx': 8, 'avx2': 8, 'avx2_highway': 8, 'avx512': 16, 'avx512_highway': 16}
GRADES = {'(raylanes::Grade)0': 'reproducible', '(raylanes::Grade)1': 'fast'}
TRIANGLES = {'PlaneEdgesPlainForm': 'plane_edges_plain', 'PlaneEdgesForm': 'plane_edges',
             'MollerTrumboreForm': 'moller_trumbore', 'MollerTrumboreEdgesForm': 'moller_trumbore_edges',
             'WatertightForm': 'watertight', 'PrecomputedForm': 'precomputed', 'DirectionalForm': 'directional'}
BOXES = ['conservative', 'plain', 'directional']
SPHERES = ['perpendicular', 'textbook']


def kernel_of(symbol):
    """(kernel/test, grade, form/query) of a demangled function name, or None."""
    grades = re.findall(r'\(raylanes::Grade\)\d', symbol)
    if not grades or '.cold' in symbol or 'lambda' in symbol:
        return None
    grade = GRADES[grades[0]]
    form = re.search(r'(\w+Form)<', symbol)
    test = re.search(r'\(raylanes::(BoxTest|SphereTest)\)(\d)', symbol)
    name = re.search(r'(\w+)<', symbol.replace('(anonymous namespace)', '')).group(1)
    wanted = re.search(r'\(raylanes::Wanted\)(\d)', symbol)
    if wanted and form and wanted.group(1) == '1':
        return ('triangle/' + TRIANGLES[form.group(1)], grade,
                '1xN/closest' if name == 'closest_of_triangles' else 'Nx1/closest')
    others = {'interval_of_boxes': '1xN/closest', 'box_interval_of_rays': 'Nx1/closest',
              'distances_of_spheres': '1xN/closest', 'sphere_distances_of_rays': 'Nx1/closest'}
    if name in others and test:
        names = BOXES if test.group(1) == 'BoxTest' else SPHERES
        return ('box/' if names is BOXES else 'sphere/') + names[int(test.group(2))], grade, others[name]
    if name == 'line_of_spheres':
        return 'sphere/line', grade, '1xN/any'
    if name == 'decide_triangles' and form:
        return 'triangle/' + TRIANGLES[form.group(1)], grade, '1xN/any' if 'HalfLine' in symbol else '1xN/any-segment'
    if name == 'any_of_rays' and form:
        return 'triangle/' + TRIANGLES[form.group(1)], grade, 'Nx1/any'
    if name in ('any_of_boxes', 'box_any_of_rays') and test:
        return 'box/' + BOXES[int(test.group(2))], grade, '1xN/any' if name == 'any_of_boxes' else 'Nx1/any'
    if name in ('any_of_spheres', 'sphere_any_of_rays') and test:
        return 'sphere/' + SPHERES[int(test.group(2))], grade, '1xN/any' if name == 'any_of_spheres' else 'Nx1/any'
    return None


def functions_of(file):
    """(demangled name, [(address, mnemonic, operands)]) of each function."""
    text = subprocess.run(['objdump', '-dC', '--no-show-raw-insn', file], check=True, capture_output=True,
                          text=True).stdout
    name, body = None, []
    for line in text.splitlines():
        start = re.match(r'^[0-9a-f]+ <(.*)>:$', line)
        if start:
            if name:
                yield name, body
            name, body = start.group(1), []
            continue
        instruction = re.match(r'^\s+([0-9a-f]+):\t(\S+)\s*(.*)$', line)
        if instruction and name:
            body.append((int(instruction.group(1), 16), instruction.group(2),
                         instruction.group(3).split('#')[0].strip()))
    if name:
        yield name, body


def loop_of(body):
    """The loop that tests primitives: of the innermost backward jumps the one around most vector work."""
    loops = []
    for index, (address, mnemonic, operands) in enumerate(body):
        target = re.match(r'^([0-9a-f]+) <', operands)
        if mnemonic.startswith('j') and target and body[0][0] <= int(target.group(1), 16) < address:
            first = next(i for i, b in enumerate(body) if b[0] >= int(target.group(1), 16))
            loops.append((first, index))
    loops = [l for l in loops if not any(o != l and l[0] <= o[0] and o[1] <= l[1] for o in loops)]
    # Packed arithmetic, so that the loop that gathers lanes at the end does not pass for it; none on `scalar`.
    packed = any(mnemonic.endswith('ps') and 'mov' not in mnemonic and 'xor' not in mnemonic and
                 'and' not in mnemonic for _, mnemonic, _ in body)
    vector = lambda l: sum(mnemonic.endswith('ps' if packed else 'ss') for _, mnemonic, _ in body[l[0]:l[1] + 1])
    return body[slice(max(loops, key=vector)[0], max(loops, key=vector)[1] + 1)] if loops else []


MOVE = re.compile(r'^v?(mov(u|a|dq|d|s|hl|lh)?\w*|broadcasts[sd])$')


def count(loop):
    """(arithmetic, moves) of a loop. Moves: loads, stores, copies between registers, broadcasts."""
    arithmetic = moves = 0
    for _, mnemonic, operands in loop:
        general = '%xmm' not in operands and '%ymm' not in operands and '%zmm' not in operands and '%k' not in operands
        if general and (mnemonic.startswith(('j', 'cmp', 'add', 'sub', 'inc', 'dec', 'nop', 'lea', 'test')) or
                        mnemonic in ('data16', 'cs', 'xchg')):
            continue
        if 'movmsk' in mnemonic or mnemonic.startswith('kmov'):
            arithmetic += 1
        elif MOVE.match(mnemonic):
            moves += 1
        else:
            arithmetic += 1
    return arithmetic, moves


# What runs where, by the beginnings of mnemonics without the v.
MULTIPLIERS = ('mul', 'fm', 'fnm', 'blendv', 'rcp', 'rsqrt')
ADDERS = ('add', 'sub', 'min', 'max', 'cmp')
LOGIC = ('and', 'or', 'xor', 'blendp', 'p')
DIVIDER, DIVIDER_SLOTS = {'div': 3.0, 'sqrt': 5.0}, 2


def cycles(loop):
    """The lower bound of the docstring for one trip."""
    multiply = add = logic = masks = loads = vector_loads = stores = divider = slow = 0
    for _, mnemonic, operands in loop:
        name = mnemonic.lstrip('v')
        in_memory, is_vector = '(' in operands, 'mm' in operands
        stored = in_memory and operands.endswith(')') and name.startswith(('mov', 'set'))
        loads += in_memory and not stored
        vector_loads += in_memory and not stored and is_vector
        stores += stored
        for beginning, price in DIVIDER.items():
            if name.startswith(beginning):
                slow += 1
                divider += price
        multiply += is_vector and name.startswith(MULTIPLIERS)
        add += is_vector and name.startswith(ADDERS)
        logic += is_vector and name.startswith(LOGIC) and not name.startswith(('blendv', 'pmovmsk'))
        masks += 'movmsk' in name
    multiply += DIVIDER_SLOTS * slow
    vector = multiply + add + logic + masks
    return max(multiply / 2, (add + masks) / 2, vector / 4, masks, vector_loads / 2, loads / 3,
               stores, divider, len(loop) / 6)


# Cycles from operand to result on Zen 3, by the beginnings of mnemonics; the first that fits counts.
LATENCIES = (('mul', 3), ('fm', 4), ('fnm', 4), ('add', 3), ('sub', 3), ('div', 10.5), ('sqrt', 14), ('movmsk', 5),
             ('rcp', 3), ('rsqrt', 3), ('', 1))
LOAD_LATENCY = 8
VECTOR_REGISTERS = 160 - 32


def window(loop):
    """The estimate of the docstring for one trip."""
    ready, results, longest = {}, 0, 0
    for _, mnemonic, operands in loop:
        name = mnemonic.lstrip('v')
        registers = re.findall(r'%[xyz]mm\d+', operands)
        if not registers:
            continue
        latency = next(price for beginning, price in LATENCIES if name.startswith(beginning))
        written = None if operands.endswith(')') or 'movmsk' in name else registers[-1]
        read = registers if name.startswith(('fm', 'fnm')) or not written else registers[:-1]
        is_zero = name.startswith(('xor', 'pxor')) and len(set(registers[:-1])) == 1
        start = 0 if is_zero else max([ready.get(r[4:], 0) for r in read] + [LOAD_LATENCY if '(' in operands else 0])
        longest = max(longest, start + latency)
        if written:
            results += 1
            ready[written[4:]] = start + (0 if name.startswith('mov') else latency)
    return results * longest / VECTOR_REGISTERS


def rows_of(path, file):
    for symbol, body in functions_of(file):
        key = kernel_of(symbol)
        loop = loop_of(body) if key else []
        if not loop:
            continue
        lanes = LANES[path]
        arithmetic, moves = count(loop)
        yield {'path': path.replace('_', '-'), 'kernel': key[0], 'grade': key[1], 'form': key[2],
               'arithmetic': arithmetic, 'moves': moves, 'cycles': cycles(loop), 'window': window(loop),
               'primitives': lanes if key[2].endswith('closest') else max(8, lanes)}


def over_budget(row, path):
    """Prints a row that has a budget; whether it is over it where that counts."""
    limit = BUDGETS.get(row['kernel']) if row['grade'] == 'fast' and row['form'] == '1xN/any' else None
    if limit is None:
        return False
    fused = path.startswith(('avx2', 'avx512'))
    vectors = row['primitives'] // LANES[path]
    over = row['arithmetic'] > limit * vectors
    verdict = ('OVER' if over else 'good') if fused else 'reported only, no FMA'
    print(f"{row['path']}: {row['kernel']}: {row['arithmetic']} instructions + {row['moves']} moves for {vectors} "
          f"vector(s), {row['arithmetic'] / row['primitives']:.2f} a primitive, budget {limit} a vector: {verdict}")
    return fused and over


def main(arguments):
    header, budget, objects = None, False, []
    while arguments:
        argument = arguments.pop(0)
        if argument == '--header':
            header = arguments.pop(0)
        elif argument == '--budget':
            budget = True
        else:
            objects.append(argument.split('=', 1))
    if not objects:
        print(__doc__, file=sys.stderr)
        return 2
    rows, failed = [], False
    for path, file in objects:
        if path == 'scalar':  # one lane: the compiler chooses how many primitives a trip has
            continue
        found = list(rows_of(path, file))
        failed = any([over_budget(row, path) for row in found]) or failed
        for kernel in BUDGETS:
            if not any(row['kernel'] == kernel for row in found):
                print(f'{path}: {kernel}: no loop found')
                failed = True
        rows += found
    if header:
        with open(header, 'w') as stream:
            for row in rows:
                stream.write('{{"{path}", "{kernel}", "{grade}", "{form}", {arithmetic}, {moves}, {primitives}, '
                             '{cycles:.2f}, {window:.2f}}},\n'.format(**row))
    return 1 if failed and budget else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
