"""A mutant, and which part of the build and which tests belong to a folder of the source."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Mutant:
    name: str
    file: str  # the mutated file
    old: str  # what the file has there
    new: str  # what replaces it
    programs: tuple  # the tests of which one must fail
    path: str = ''  # the ISA path that it is compiled for, if another one would not notice
    unit: str = ''  # the unit of kernels/ that is compiled, if not that of the folder
    source: str = ''  # the .cpp that is compiled, if the file is a header of no unit of kernels/
    at: int = -1  # where `old` begins; -1 if the file has it once

    def mutated(self, text):
        at = text.index(self.old) if self.at < 0 else self.at
        return text[:at] + self.new + text[at + len(self.old):]


# Queries of doubles are judged beside those of floats; what only doubles have is judged apart.
DOUBLES = ('test_doubles', 'test_queries')


def rows_of(file, programs, *rows, **more):
    """Mutants of one file that a test, or one of some, must notice: tuples of a name, what is there, and what replaces
    it."""
    programs = (programs,) if isinstance(programs, str) else programs
    return [Mutant(name, file, old, new, programs, **more) for name, old, new in rows]


# The units of kernels/, as meson.build has them: library UNIT_PATH of the build, and its source.
UNITS = {
    'roots': 'kernels/roots/root_kernels.cpp',
    'triangles': 'kernels/triangle/triangle_kernels.cpp',
    'boxes': 'kernels/box/box_kernels.cpp',
    'spheres': 'kernels/sphere/sphere_kernels.cpp',
    'queries': 'kernels/query/queries.cpp',
    'traversal': 'kernels/traverse/traversal.cpp',
    'counted': 'kernels/traverse/traversal.cpp',
    'kdtree': 'kernels/kdtree/kd_kernels.cpp',
    'points': 'kernels/point/point_kernels.cpp',
    'winding': 'kernels/winding/winding_kernels.cpp',
    'doubles': 'kernels/doubles/double_kernels.cpp',
}
# The unit of a folder, none outside kernels/, and the tests that cover it. The longest name that fits counts.
TREES = ('test_trees', 'test_bvh', 'test_kdtree')
FOLDERS = {
    'kernels/box': ('boxes', ('test_boxes', 'test_every_row')),
    'kernels/doubles': ('doubles', DOUBLES + ('test_every_row',)),
    'kernels/exact': ('traversal', ('test_exact', 'test_bvh', 'test_queries')),
    'kernels/kdtree': ('kdtree', ('test_kdtree', 'test_queries', 'test_bvh', 'test_every_row')),
    'kernels/point': ('points', ('test_points', 'test_every_row')),
    'kernels/query': ('queries', ('test_queries', 'test_scenes', 'test_every_row')),
    'kernels/ray': ('triangles', ('test_triangles', 'test_triangle_meshes', 'test_every_row')),
    'kernels/roots': ('roots', ('test_roots', 'test_root_answers', 'test_every_row')),
    'kernels/sphere': ('spheres', ('test_spheres', 'test_every_row')),
    'kernels/traverse': ('traversal', ('test_bvh', 'test_exact', 'test_every_row', 'test_scenes')),
    'kernels/triangle': ('triangles', ('test_triangles', 'test_triangle_meshes', 'test_every_row')),
    'kernels/winding': ('winding', ('test_queries', 'test_every_row')),
    'dispatch': ('', ('test_dispatch', 'test_every_row', 'test_roots', 'test_boxes', 'test_spheres', 'test_triangles',
                      'test_points')),
    'accel/batch': ('', TREES + ('test_scenes', 'test_points')),
    'accel/builders': ('', ('test_builders',) + TREES),
    'accel/c': ('', ('test_c_calls',)),
    'accel/doubles': ('', DOUBLES),
    'accel/file': ('', TREES),
    'accel/layout': ('', ('test_builders',) + TREES),
    'accel/mesh': ('', ('test_bvh', 'test_points', 'test_queries')),
    'accel/queries': ('', ('test_queries', 'test_points', 'test_transport')),
    'accel/scene': ('', ('test_scenes',)),
    'accel/trees': ('', ('test_builders', 'test_doubles', 'test_queries') + TREES),
    'python/native': ('', ('python_arrays', 'python_trees', 'python_doubles', 'python_scene_hits',
                           'python_scene_changes', 'python_scenes_within', 'python_ray_parts', 'python_sharing',
                           'python_skip', 'python_sphere_trees')),
}


def folder_of(file):
    """The key of FOLDERS that a file belongs to, or ''."""
    return max((name for name in FOLDERS if file.startswith(name + '/')), key=len, default='')
