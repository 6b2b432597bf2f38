"""A tetrahedron, two rays and two points, from Python without the module: closest.py LIBRARY"""
import ctypes
import math
import sys
from ctypes import POINTER, byref, c_char_p, c_float, c_int, c_size_t, c_uint8, c_uint32, c_void_p

library = ctypes.CDLL(sys.argv[1])  # libraylanes.so.0.2, or raylanes.dll


class Ray(ctypes.Structure):
    _fields_ = [('origin', c_float * 3), ('tmin', c_float), ('direction', c_float * 3), ('tmax', c_float)]


class Hit(ctypes.Structure):
    _fields_ = [('t', c_float), ('u', c_float), ('v', c_float), ('primitive', c_uint32)]


def declare(name, result, *arguments):
    """ctypes takes every number for an int until it is told otherwise."""
    function = getattr(library, name)
    function.restype, function.argtypes = result, arguments
    return function


last_message = declare('raylanes_last_message', c_char_p)
create = declare('raylanes_bvh_create', c_int, POINTER(c_void_p), c_void_p, c_size_t, c_size_t, c_void_p, c_size_t,
                 c_size_t, c_void_p)
closest = declare('raylanes_bvh_closest', c_int, c_void_p, c_void_p, c_size_t, c_size_t, c_void_p, c_size_t, c_void_p)
locate = declare('raylanes_bvh_locate', c_int, c_void_p, c_void_p, c_size_t, c_size_t, c_void_p, c_void_p)
destroy = declare('raylanes_bvh_destroy', None, c_void_p)


def check(status):
    if status != 0:
        raise ValueError(last_message().decode())


vertices = (c_float * 12)(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)
triangles = (c_uint32 * 12)(0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3)
rays = (Ray * 2)(((0.25, 0.25, 2), 0, (0, 0, -1), math.inf), ((2, 2, 2), 0, (0, 0, -1), math.inf))
points = (c_float * 6)(0.125, 0.125, 0.125, 2, 2, 2)
tree, hits, locations = c_void_p(), (Hit * 2)(), (c_uint8 * 2)()
check(create(byref(tree), vertices, 4, 0, triangles, 4, 0, None))
check(closest(tree, rays, 2, 0, hits, 0, None))
check(locate(tree, points, 2, 0, locations, None))
destroy(tree)
print(f'triangle {hits[0].primitive} at t = {hits[0].t:g}')
print('no hit' if hits[1].primitive == 0xffffffff else 'hit')
print('inside:', *locations)
