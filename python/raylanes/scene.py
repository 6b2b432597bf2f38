"""Scenes of trees that are placed any number of times."""

import numpy as np

from . import _native
from ._arrays import DOUBLE_SCENES, FLOATS, SCENES, faces_of, numbers, numbers_for, require_kept, vertices_of
from ._meshes import is_mesh, parts_of
from ._places import Places, geometry_index
from ._scalars import threads_of
from ._scene_points import ScenePoints
from ._scene_queries import SceneQueries
from ._stored import Stored
from ._traces import words_of
from .sphere_tree import SphereTree
from .tree import Bvh


class Scene(SceneQueries, ScenePoints, Places, Stored):
    """Geometries, and instances that place them: trees of triangles and of spheres, each in any number of places.

    Geometries and instances are numbered from 0, in the order in which they are added. Call update() after any change,
    before the next query: a query of a changed scene raises RuntimeError. A scene of float32 needs no update() after
    set_mask(). Without instances, nothing is hit.

    The first geometry decides the type of the scene's numbers, as vertices decide that of a Bvh. A mesh of float64 or
    integers makes a scene of float64, a mesh of float32 or float16 one of float32. A Bvh makes one of its own dtype,
    a SphereTree one of float32, and a scene one of its dtype. `dtype` asks for a type, and scene.dtype tells it. Rays,
    points and transforms are converted to that type, and results have it. Meshes are converted if that changes no
    number; trees and scenes of the other type raise ValueError.

    A ray is moved to the space of an instance by the inverse of its transform, and rounded once to the type of the
    scene. A scene of float32 moves it in float64, a scene of float64 with twice the digits of float64. The tree then
    decides as it does alone; t is the same in both spaces. Hits are ordered by t, then instance, then primitive. By the
    test "exact", and of spheres, their bytes do not depend on ISA path, mode or number of threads.

    A scene of float64 has no test but "exact", and takes no spheres: these raise ValueError. A scene made with
    dtype=numpy.float32 has them.

    An instance is never hit if its mask has no bit in common with the mask of the call; if its geometry is empty; if
    its transform is not finite, or singular; or if it reaches beyond the largest number of the type. A ray misses an
    instance if its origin or direction is not finite there, or, unless the transform is the identity, its direction is
    below 2^-126, in float64 2^-900.

    A scene shares the memory of the trees that are added, which stay as they are: refit() of a tree changes no scene,
    and refit() of a scene changes no tree. Copies of a scene share their geometries; the first change of a copy copies
    its instances. Many threads may query one scene at the same time, also while others change it: a query keeps the
    scene that it began with, and each change is seen whole or not at all. Changes release the GIL if they take long.

    Instances may have names, which place() gives, name_of() finds and instances_named() looks for. Copies and pickles
    keep them; files do not.

    Scenes are copied and pickled with their attributes, like any object. A scene that is loaded or unpickled is ready,
    as after update().

    Parameters
    ----------
    dtype : {numpy.float32, numpy.float64}, optional
        The type of the scene's numbers: vertices of meshes are rounded to it. By default the first geometry decides,
        and meshes with numbers that the type does not hold raise ValueError. Without geometries it is float64.

    Examples
    --------
    >>> import numpy as np, raylanes
    >>> tree = raylanes.Bvh(np.float32([[-1, -1, 0], [1, -1, 0], [0, 1, 0]]), [[0, 1, 2]])
    >>> scene = raylanes.Scene()
    >>> part = scene.add(tree)
    >>> moved = np.eye(4)
    >>> moved[2, 3] = 2
    >>> scene.place(part, [np.eye(4), moved])
    array([0, 1])
    >>> scene.update()
    >>> hits = scene.closest(raylanes.rays([[0, 0, 5], [9, 0, 5]], [0, 0, -1]))
    >>> hits.t, hits.instance[hits.hit]
    (array([ 3., inf], dtype=float32), array([1], dtype=uint32))
    """

    _native_tree, _natives = _native.Scene, {b"raylanes scnd": _native.SceneD}
    _tree = _native.SceneD()  # of all scenes for which neither a geometry nor dtype has decided; it stays empty
    _rounds = False  # whether dtype asked for the rounding of vertices

    def __init__(self, *, dtype=None):
        if dtype is not None:
            self._tree = _native_for(numbers_for(dtype).real)
            self._rounds = True

    @property
    def _numbers(self):
        return DOUBLE_SCENES if isinstance(self._tree, _native.SceneD) else SCENES

    @property
    def dtype(self):
        """dtype: the type of coordinates, t, u and v: float32 or float64."""
        return self._numbers.real

    def add(self, tree, faces=None, *, threads=0):
        """Add a tree, whose memory the scene shares, a mesh, which it copies, or a scene, to be placed as a whole.

        The first geometry decides the type of the scene, if `dtype` did not. In a scene of float32, a mesh has no tree
        of its own until one is needed: instances that stand where they were made are traced as one tree. In a scene of
        float64, its tree is built at once. A scene is added as it is: later changes of it do not change this one. Its
        geometries follow it: geometry i of it is geometry `returned + 1 + i` of this scene. It may place scenes itself,
        to any depth.

        Parameters
        ----------
        tree : Bvh, SphereTree, Scene, array of float of shape (n, 3), or a mesh
            The tree, which may be in any number of scenes; or the vertices of a mesh, as in Bvh. Vertices that the type
            of the scene does not hold raise ValueError, unless the scene was made with `dtype`.
        faces : array of int, shape (m, 3), optional
            The triangles of a mesh, as in Bvh.
        threads : int, default 0
            At most so many threads to check a mesh, or to build its tree of float64; 0: all cores.

        Returns
        -------
        int
            The index of the geometry.

        Raises
        ------
        ValueError
            If the tree has another dtype than the scene, or Bvh refuses the mesh.

        Warns
        -----
        MeshWarning
            As Bvh does, if the tree of a mesh is built at once.

        Examples
        --------
        >>> scene = raylanes.Scene()
        >>> scene.add([[0, 0, 0.1], [1, 0, 0.1], [0, 1, 0.1]], [[0, 1, 2]]), scene.dtype
        (0, dtype('float64'))
        >>> spheres = raylanes.Scene()
        >>> spheres.add(raylanes.SphereTree([[0, 0, 0]], 1)), spheres.dtype
        (0, dtype('float32'))
        """
        if faces is None and isinstance(tree, Scene):
            return self._add_scene(tree)
        if not _is_mesh(tree, faces):
            return self._added(_dtype_of(tree), lambda native: native.add(_part_of(tree, native)))
        given, faces = _checked_mesh(tree, faces)
        return self._added(numbers_for(None, given).real, lambda native: self._add_mesh(native, given, faces, threads))

    def _added(self, dtype, add):
        """The index that add(native scene) returns. If this is the first geometry, the scene becomes one of that type,
        unless add() raises. If several threads add a first geometry, one of them decides."""
        if "_tree" not in self.__dict__:
            native = _native_for(dtype)
            index = add(native)
            if self.__dict__.setdefault("_tree", native) is native:
                return index
        return add(self._tree)

    def _add_mesh(self, native, given, faces, threads):
        if isinstance(native, _native.SceneD):
            return native.add(self._tree_of_mesh(native, given, faces, threads))
        return native.add_mesh(self._vertices(native, given), faces, threads_of(threads))

    def _tree_of_mesh(self, native, given, faces, threads):
        return Bvh(self._vertices(native, given), faces, threads=threads)._tree

    def _vertices(self, native, given):
        """The vertices of a mesh as numbers of a native scene."""
        kept = vertices_of("vertices", given, _dtype_in(native))
        if not self._rounds:
            require_kept("vertices", given, kept, f"the scene has {kept.dtype}: Scene(dtype=numpy.{kept.dtype}) rounds "
                         "them" + (", Scene(dtype=numpy.float64) has float64" if kept.dtype == np.float32 else ""))
        return kept

    def _add_scene(self, scene):
        names, names_within, native = scene._names.copy(), scene._names_within, vars(scene).get("_tree")

        def add(to):
            given = type(to)() if native is None else native  # one without geometries has any type
            if type(given) is not type(to):
                raise ValueError(f"tree: the scene has {_dtype_in(to)}, this Scene has {_dtype_in(given)}; give it a "
                                 f"Scene made with dtype=numpy.{_dtype_in(to)}")
            return to.add_scene(given)

        added = self._added(scene.dtype, add)
        if names or names_within:
            within = {added + 1 + geometry: others for geometry, others in names_within.items()}
            self._names_within = {**self._names_within, **within, added: names}
        return added

    def replace(self, geometry, tree, faces=None, *, threads=0):
        """Replace a geometry by another tree, or a mesh; its instances stay where they are. update() must follow.

        Parameters
        ----------
        geometry : int
            The index of the geometry.
        tree : Bvh, SphereTree, array of float of shape (n, 3), or a mesh
            The tree, or the vertices of a mesh, whose tree is built at once; as in add().
        faces : array of int, shape (m, 3), optional
            The triangles of a mesh.
        threads : int, default 0
            At most so many threads to build the tree of a mesh; 0: all cores.

        Returns
        -------
        None

        Raises
        ------
        IndexError
            If there is no such geometry.
        """
        geometry, native = geometry_index(geometry), self._tree
        if _is_mesh(tree, faces):
            part = self._tree_of_mesh(native, *_checked_mesh(tree, faces), threads)
        else:
            part = _part_of(tree, native)
        native.replace(geometry, part)

    def refit(self, geometry, vertices, faces=None, *, threads=0):
        """Refit a geometry of triangles to a moved mesh, as Bvh.refit() does. update() must follow.

        In a scene of float32, it works in place if nothing else has the geometry's tree and the program has one thread;
        otherwise it makes a tree first. If it raises, the scene is unchanged.

        Parameters
        ----------
        geometry : int
            The index of the geometry.
        vertices : array of float, shape (n, 3), or a mesh
            As in Bvh, of numbers as in add().
        faces : array of int, shape (m, 3)
            As many triangles as the geometry has.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        None

        Raises
        ------
        IndexError
            If there is no such geometry.
        ValueError
            If it is of spheres, or Bvh.refit() would raise it.
        """
        geometry, (given, faces) = geometry_index(geometry), _checked_mesh(vertices, faces)
        self._tree.refit(geometry, self._vertices(self._tree, given), faces, threads_of(threads))

    def set_triangle_masks(self, geometry, masks):
        """Give the triangles of a geometry masks, which hide them from calls with rays. update() must follow.

        A call sees a triangle if its mask and the mask of the call have a bit in common. The scene copies the masks.
        refit() keeps them, replace() takes them away. A scene that has some cannot be saved or pickled.

        Parameters
        ----------
        geometry : int
            The index of the geometry.
        masks : array of int, shape (n,), or None
            One for each triangle; triangles from n on are always there. None takes all masks away.

        Returns
        -------
        None

        Raises
        ------
        IndexError
            If there is no such geometry.
        ValueError
            If it has no triangles.

        Examples
        --------
        >>> scene.set_triangle_masks(0, None)
        >>> scene.update()
        """
        self._tree.set_triangle_masks(geometry_index(geometry), words_of([] if masks is None else masks))

    def update(self, *, threads=0):
        """Make the scene ready for queries after changes, in 0.2 to 0.4 µs for each of hundreds of instances.

        It also builds one tree over the meshes that stand where they were made, if there are new ones; then it takes
        the time of a Bvh of their triangles.

        Parameters
        ----------
        threads : int, default 0
            At most so many threads for that tree; 0: all cores.

        Returns
        -------
        None

        Examples
        --------
        >>> scene.update()
        """
        self._tree.update(threads_of(threads))

    def report(self):
        """Describe how the scene is traced: the common trees of meshes that stand where they were made.

        Returns
        -------
        dict
            common_trees: one for each mask, up to four; none while they are out of use after set_mask().
            common_instances: instances in them. common_triangles: their triangles. common_bytes: their memory, besides
            that of the geometries' trees. mesh_triangles: triangles of all geometries. meshes_without_tree: meshes that
            needed no tree of their own so far.

        Examples
        --------
        >>> scene.report()['common_trees']
        1
        """
        return self._tree.report()

    @property
    def geometry_count(self):
        """int: the number of geometries."""
        return self._tree.geometry_count()

    @property
    def instance_count(self):
        """int: the number of instances."""
        return self._tree.instance_count()

    @property
    def bounds(self):
        """ndarray of self.dtype, shape (2, 3): a box around all instances at the last update(); inf, -inf without one.
        """
        return np.array(self._tree.bounds(), self.dtype)

    @property
    def nbytes(self):
        """int: the bytes of the instances, the tree over them and the common tree, without geometries."""
        return self._tree.nbytes()

    def __repr__(self):
        return (f"<raylanes.{type(self).__name__} of {self.geometry_count} geometries of {self.dtype} in "
                f"{self.instance_count} instances, {self.nbytes} bytes without geometries>")


def _native_for(dtype):
    return (_native.Scene if dtype == np.float32 else _native.SceneD)()


def _dtype_in(native):
    return (DOUBLE_SCENES if isinstance(native, _native.SceneD) else SCENES).real


def _is_mesh(tree, faces):
    return faces is not None or (not isinstance(tree, (Bvh, SphereTree)) and is_mesh(tree))


def _checked_mesh(vertices, faces):
    """The vertices as they are given, and the faces."""
    vertices, faces = parts_of(vertices, faces)
    return numbers("vertices", vertices), faces_of(faces)


def _dtype_of(tree):
    return tree.dtype if isinstance(tree, Bvh) else FLOATS.real


def _part_of(tree, native):
    """The native tree of a geometry, for a native scene."""
    if not isinstance(tree, (Bvh, SphereTree)):
        each = ": call add() for each part" if isinstance(tree, (list, tuple)) else ""
        raise TypeError(f"tree: a Bvh, a SphereTree or a mesh is needed, not {type(tree).__name__}{each}")
    of_scene, of_tree = _dtype_in(native), _dtype_of(tree)
    if of_tree != of_scene:
        instead = (f"give it a Bvh made with dtype=numpy.{of_scene}" if isinstance(tree, Bvh)
                   else "put spheres into a scene made with dtype=numpy.float32")
        raise ValueError(f"tree: the scene has {of_scene}, this {type(tree).__name__} has {of_tree}; {instead}")
    return tree._tree
