"""Scenes of trees that are placed any number of times."""

import numpy as np

from . import _native
from ._arrays import count_of, faces_of, numbers, require_kept, unsigned, vertices_of
from ._meshes import is_mesh, parts_of
from ._places import Places
from ._scalars import count, flag, threads_of
from ._scene_points import ScenePoints
from ._scene_queries import EVERY_BIT, SceneQueries
from ._stored import Stored
from ._traces import words_of
from .sphere_tree import SphereTree
from .tree import Bvh


class Scene(SceneQueries, ScenePoints, Places, Stored):
    """Geometries, and instances that place them: trees of triangles and of spheres, each in any number of places.

    Geometries and instances are numbered from 0, in the order in which they are added. Call update() after any change
    but set_mask(), before the next query: a query of a changed scene raises RuntimeError. Without instances, nothing is
    hit.

    A scene has float32. A ray is moved to the space of an instance by the inverse of its transform, in float64, and
    rounded once to float32. The tree then decides as it does alone; t is the same in both spaces. Hits are ordered by
    t, then instance, then primitive. By the test "exact", and of spheres, their bytes do not depend on ISA path, mode
    or number of threads.

    An instance is never hit if its mask has no bit in common with the mask of the call; if its geometry is empty; if
    its transform is not finite, or singular; or if it reaches beyond the largest float32. A ray misses an instance if
    its origin or direction is not finite there, or, unless the transform is the identity, its direction is below
    2^-126.

    A scene shares the memory of the trees that are added, which stay as they are: refit() of a tree changes no scene,
    and refit() of a scene changes no tree. Copies of a scene share their geometries; the first change of a copy copies
    its instances. Many threads may query one scene at the same time, also while others change it: a query keeps the
    scene that it began with, and each change is seen whole or not at all. Changes release the GIL if they take long.

    Instances may have names, which place() gives, name_of() finds and instances_named() looks for. Copies and pickles
    keep them; files do not.

    Scenes are copied and pickled with their attributes, like any object. A scene that is loaded or unpickled is ready,
    as after update().

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

    _native_tree = _native.Scene

    def __init__(self):
        self._tree = _native.Scene()

    def add(self, tree, faces=None, *, threads=0):
        """Add a tree, whose memory the scene shares, a mesh, which it copies, or a scene, to be placed as a whole.

        A mesh has no tree of its own until one is needed: instances that stand where they were made are traced as one
        tree. A scene is added as it is: later changes of it do not change this one. Its geometries follow it: geometry
        i of it is geometry `returned + 1 + i` of this scene. It may place scenes itself, to any depth.

        Parameters
        ----------
        tree : Bvh of float32, SphereTree, Scene, array of float of shape (n, 3), or a mesh
            The tree, which may be in any number of scenes; or the vertices of a mesh, as in Bvh. Numbers that float32
            does not hold raise ValueError.
        faces : array of int, shape (m, 3), optional
            The triangles of a mesh, as in Bvh.
        threads : int, default 0
            At most so many threads to check a mesh; 0: all cores. update() builds trees.

        Returns
        -------
        int
            The index of the geometry.

        Raises
        ------
        ValueError
            If the tree is a Bvh of float64, or Bvh refuses the mesh.

        Examples
        --------
        >>> scene = raylanes.Scene()
        >>> scene.add(raylanes.SphereTree([[0, 0, 0]], 1))
        0
        >>> scene.add([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        1
        """
        if faces is None and isinstance(tree, Scene):
            names, names_within = tree._names.copy(), tree._names_within
            added = self._tree.add_scene(tree._tree)
            if names or names_within:
                within = {added + 1 + geometry: others for geometry, others in names_within.items()}
                self._names_within = {**self._names_within, **within, added: names}
            return added
        if not _is_mesh(tree, faces):
            return self._tree.add(_part_of(tree))
        return self._tree.add_mesh(*_mesh_of_floats(tree, faces), threads_of(threads))

    def replace(self, geometry, tree, faces=None, *, threads=0):
        """Replace a geometry by another tree, or a mesh; its instances stay where they are. update() must follow.

        Parameters
        ----------
        geometry : int
            The index of the geometry.
        tree : Bvh of float32, SphereTree, array of float of shape (n, 3), or a mesh
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
        geometry = _index("geometry", geometry)
        if _is_mesh(tree, faces):
            tree = Bvh(*_mesh_of_floats(tree, faces), threads=threads)
        self._tree.replace(geometry, _part_of(tree))

    def refit(self, geometry, vertices, faces=None, *, threads=0):
        """Refit a geometry of triangles to a moved mesh, as Bvh.refit() does. update() must follow.

        It works in place if nothing else has the geometry's tree and the program has one thread; otherwise it makes a
        tree first. If it raises, the scene is unchanged.

        Parameters
        ----------
        geometry : int
            The index of the geometry.
        vertices : array of float, shape (n, 3), or a mesh
            As in Bvh; numbers that float32 does not hold raise ValueError.
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
        self._tree.refit(_index("geometry", geometry), *_mesh_of_floats(vertices, faces), threads_of(threads))

    def place(self, geometry, transform=None, *, mask=EVERY_BIT, name=None):
        """Place a geometry once or many times. update() must follow.

        If it is a scene, its instance j becomes instance `returned + 1 + j` of this scene. Its transform is the product
        of both, rounded to float32, and its mask has the bits of both. Hits name these instances; levels_of() tells
        their way, and name_of() the names that they have in their own scene.

        Parameters
        ----------
        geometry : int
            The index of the geometry.
        transform : array of float, shape (..., 3, 4) or (..., 4, 4), optional
            From the space of the geometry to that of the scene: x' = transform[..., 0, :] @ [x, y, z, 1], and so on.
            The fourth row, if there is one, must be 0, 0, 0, 1. Numbers are rounded to float32. Default: the identity.
        mask : int or array of int, default 2^32 - 1
            Bits of the instance, or of each instance; an instance with mask 0 is never hit.
        name : str or array of str, optional
            The name of the instance, or of each instance: name_of(hits.instance) returns the names of what is hit.

        Returns
        -------
        int or ndarray of int64, shape (...)
            The index of the instance, or of each instance: they are numbered in order, each before
            the parts of its scene.

        Raises
        ------
        IndexError
            If there is no such geometry.

        Examples
        --------
        >>> scene.place(0, [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]], mask=0b10)
        1
        """
        rows, shape = _transforms(np.eye(4)[:3] if transform is None else transform)
        masks, names = unsigned("mask", mask), _texts("name", "" if name is None else name)
        whole = _common(_common(shape, masks.shape), names.shape)
        geometry, total = _index("geometry", geometry), count_of(whole)
        first, step = self._tree.place(geometry, _spread(rows, shape, whole), _flat(masks, whole))
        placed = range(first, first + step * total, step)
        if name is not None or self._names or self._names_within:
            self._give_names(placed, _flat(names, whole).tolist(), self._names_within.get(geometry, {}))
        return first if whole == () else np.array(placed, np.int64).reshape(whole)

    def move(self, instance, transform):
        """Give instances other transforms. update() must follow.

        All instances of a placed scene move with the one that places it.

        Parameters
        ----------
        instance : int or array of int
            The instances.
        transform : array of float, shape (..., 3, 4) or (..., 4, 4)
            One transform, or one for each instance, as in place().

        Returns
        -------
        None

        Raises
        ------
        IndexError
            If there is no such instance; then none has moved.
        ValueError
            If an instance belongs to a scene that another one places; then none has moved.

        Examples
        --------
        >>> scene.move(0, np.diag([2, 2, 2, 1]))
        """
        rows, shape = _transforms(transform)
        instances = unsigned("instance", instance)
        whole = _common(shape, instances.shape)
        self._tree.move(_flat(instances, whole), _spread(rows, shape, whole))

    def set_mask(self, instance, mask):
        """Give instances other masks, at once: update() is not needed.

        Parameters
        ----------
        instance : int or array of int
            The instances.
        mask : int or array of int
            One mask, or one for each instance, as in place().

        Returns
        -------
        None

        Raises
        ------
        IndexError
            If there is no such instance; then no mask has changed.

        Examples
        --------
        >>> scene.set_mask(0, 0b101)
        """
        instances, masks = unsigned("instance", instance), unsigned("mask", mask)
        whole = _common(instances.shape, masks.shape)
        self._tree.set_mask(_flat(instances, whole), _flat(masks, whole))

    def set_moving(self, instance, moving=True):
        """Say that instances will move, or change otherwise, so that they are traced by themselves.

        Meshes that stand where they were made are traced as one tree, which update() builds: see docs/scenes.md. An
        instance that changes leaves that tree by itself.

        Parameters
        ----------
        instance : int or array of int
            The instances.
        moving : bool, default True
            False: they no longer move, and may be in the common tree again.

        Returns
        -------
        None

        Raises
        ------
        IndexError
            If there is no such instance; then nothing has changed.

        Examples
        --------
        >>> scene.set_moving(0)
        """
        instances = unsigned("instance", instance)
        self._tree.set_moving(_flat(instances, instances.shape), flag("moving", moving))

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
        self._tree.set_triangle_masks(_index("geometry", geometry), words_of([] if masks is None else masks))

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
        """ndarray of float32, shape (2, 3): a box around all instances at the last update(); inf, -inf without one."""
        return np.array(self._tree.bounds(), np.float32)

    @property
    def nbytes(self):
        """int: the bytes of the instances, the tree over them and the common tree, without geometries."""
        return self._tree.nbytes()

    def __repr__(self):
        return (f"<raylanes.{type(self).__name__} of {self.geometry_count} geometries in {self.instance_count} "
                f"instances, {self.nbytes} bytes without geometries>")


def _is_mesh(tree, faces):
    return faces is not None or (not isinstance(tree, (Bvh, SphereTree)) and is_mesh(tree))


def _mesh_of_floats(vertices, faces):
    """The vertices, of float32, and the faces of a mesh."""
    vertices, faces = parts_of(vertices, faces)
    faces, given = faces_of(faces), numbers("vertices", vertices)
    rows = vertices_of("vertices", given, np.float32)
    require_kept("vertices", given, rows, "a scene has float32: give it vertices of float32")
    return rows, faces


def _part_of(tree):
    """The native tree of a geometry."""
    if not isinstance(tree, (Bvh, SphereTree)):
        each = ": call add() for each part" if isinstance(tree, (list, tuple)) else ""
        raise TypeError(f"tree: a Bvh, a SphereTree or a mesh is needed, not {type(tree).__name__}{each}")
    if isinstance(tree._tree, _native.BvhD):
        raise ValueError("tree: a scene has float32, this Bvh has float64; give it a Bvh made with dtype=numpy.float32")
    return tree._tree


def _texts(name, values):
    array = np.asarray(values)
    if array.dtype.kind != "U" and array.shape != (0,):
        raise TypeError(f"{name}: strings are needed, not {array.dtype}")
    return array


def _index(name, value):
    return count(name, value, 0xFFFFFFFF)


def _transforms(transform):
    """(rows of twelve numbers, shape without the last two axes)."""
    array = numbers("transform", transform)
    if array.ndim < 2 or array.shape[-2:] not in ((3, 4), (4, 4)):
        raise ValueError(f"transform: the shape must be (..., 3, 4) or (..., 4, 4), it is {array.shape}")
    if array.shape[-2] == 4 and not (array[..., 3, :] == (0, 0, 0, 1)).all():
        raise ValueError("transform: the fourth row must be 0, 0, 0, 1")
    rows = np.ascontiguousarray(array[..., :3, :].astype(np.float32, copy=False)).reshape(-1, 12)
    return rows, array.shape[:-2]


def _common(shape, other):
    return shape if shape == other else np.broadcast_shapes(shape, other)


def _spread(rows, shape, whole):
    """The rows of an array of that shape, broadcast to another one."""
    if shape == whole:
        return rows
    return np.ascontiguousarray(np.broadcast_to(rows.reshape(*shape, 12), (*whole, 12))).reshape(-1, 12)


def _flat(array, whole):
    return np.ascontiguousarray(array if array.shape == whole else np.broadcast_to(array, whole)).reshape(-1)
