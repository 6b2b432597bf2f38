#!/usr/bin/env python3
"""Counts the instructions of the yes/no loops in compiled objects, and holds them to their budgets.

usage: instruction_counts.py [--json FILE] [--budget] NAME=OBJECT...
NAME is a path, OBJECT its object or archive of intersections.cpp. Counted is the body of the innermost loop:
one trip tests `lanes` primitives (8 of them where registers have fewer). Left out is loop control: the
arithmetic, comparison and jump on general registers that end or bump the loop. Loads and stores that are
instructions of their own are counted apart, as (arithmetic + moves); with --budget the arithmetic, with what
moves the mask out of its register, is held to the budget on paths that have FMA, and others are reported.
Needs objdump (binutils).
"""
import json
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
    vector = lambda l: sum('mm' in operands for _, _, operands in body[l[0]:l[1] + 1])
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


def main(arguments):
    out, budget, objects = None, False, []
    while arguments:
        argument = arguments.pop(0)
        if argument == '--json':
            out = arguments.pop(0)
        elif argument == '--budget':
            budget = True
        else:
            objects.append(argument.split('=', 1))
    if not objects:
        print(__doc__, file=sys.stderr)
        return 2
    rows, failed = [], False
    for path, file in objects:
        fused = path.startswith(('avx2', 'avx512'))
        per_trip = max(8, LANES[path])
        for symbol, body in functions_of(file):
            key = kernel_of(symbol)
            loop = loop_of(body) if key else []
            if not loop:
                continue
            arithmetic, moves = count(loop)
            kernel, grade, form = key
            rows.append({'path': path.replace('_', '-'), 'kernel': kernel, 'grade': grade, 'form': form,
                         'arithmetic': arithmetic, 'moves': moves, 'primitives': per_trip})
            limit = BUDGETS.get(kernel) if grade == 'fast' and form == '1xN/any' else None
            if limit:
                vectors = per_trip // LANES[path]
                over = arithmetic > limit * vectors
                failed = failed or (fused and over)
                note = 'OVER' if fused and over else ('good' if fused else 'no FMA: reported only')
                print(f'{path}: {kernel}: {arithmetic} + {moves} moves for {vectors} vector(s), budget {limit} '
                      f'each: {note}')
    found = {(r['path'], r['kernel']) for r in rows}
    for path, _ in objects:
        for kernel in BUDGETS:
            if (path.replace('_', '-'), kernel) not in found:
                print(f'{path}: {kernel}: no loop found')
                failed = True
    if out:
        with open(out, 'w') as stream:
            json.dump(rows, stream, indent=0)
    return 1 if failed and budget else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
