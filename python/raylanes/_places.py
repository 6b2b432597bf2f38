"""The instances of scenes: where they are, their masks and their names."""

import numpy as np

from ._arrays import count_of, no_part, numbers, unsigned
from ._scalars import count, flag
from ._traces import EVERY_BIT

_instance_dtypes = {np.dtype(real): np.dtype([("geometry", "<u4"), ("mask", "<u4"), ("transform", real, (3, 4))])
                    for real in ("<f4", "<f8")}


class Places:
    """Instances of the native scene `self._tree`, and their names by index."""

    _names: dict[int, str] = {}  # of a scene that has named none
    _names_within: dict[int, dict[int, str]] = {}  # by geometry: those of an added scene

    def place(self, geometry, transform=None, *, mask=EVERY_BIT, name=None):
        """Place a geometry once or many times. update() must follow.

        If it is a scene, its instance j becomes instance `returned + 1 + j` of this scene. Its transform is the product
        of both, rounded to self.dtype, and its mask has the bits of both. Hits name these instances; levels_of() tells
        their way, and name_of() the names that they have in their own scene.

        Parameters
        ----------
        geometry : int
            The index of the geometry.
        transform : array of float, shape (..., 3, 4) or (..., 4, 4), optional
            From the space of the geometry to that of the scene: x' = transform[..., 0, :] @ [x, y, z, 1], and so on.
            The fourth row, if there is one, must be 0, 0, 0, 1. Numbers are rounded to self.dtype. Default:
            the identity.
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
        rows, shape = _transforms(np.eye(4)[:3] if transform is None else transform, self.dtype)
        masks, names = unsigned("mask", mask), _texts("name", "" if name is None else name)
        whole = _common(_common(shape, masks.shape), names.shape)
        geometry, total = geometry_index(geometry), count_of(whole)
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
        rows, shape = _transforms(transform, self.dtype)
        instances = unsigned("instance", instance)
        whole = _common(shape, instances.shape)
        self._tree.move(_flat(instances, whole), _spread(rows, shape, whole))

    def set_mask(self, instance, mask):
        """Give instances other masks. In a scene of float32 they hold at once; in one of float64 update() must follow.

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

    def geometry_of(self, instance):
        """Return the geometry of an instance, or of each of many.

        Parameters
        ----------
        instance : int or array of int, shape (...)
            The instances. IndexError is raised if one does not exist.

        Returns
        -------
        uint32, or ndarray of uint32, shape (...)
            The index of the geometry.

        Examples
        --------
        >>> int(scene.geometry_of(0))
        0
        """
        return self._instances(instance)["geometry"][()]

    def mask_of(self, instance):
        """Return the mask of an instance, or of each of many.

        Parameters
        ----------
        instance : int or array of int, shape (...)
            The instances. IndexError is raised if one does not exist.

        Returns
        -------
        uint32, or ndarray of uint32, shape (...)
            The mask.

        Examples
        --------
        >>> hex(scene.mask_of(0))
        '0xffffffff'
        """
        return self._instances(instance)["mask"][()]

    def transform_of(self, instance):
        """Return the transform of an instance, or of each of many.

        Parameters
        ----------
        instance : int or array of int, shape (...)
            The instances. IndexError is raised if one does not exist.

        Returns
        -------
        ndarray of self.dtype, shape (..., 3, 4)
            The transform, as in place().

        Examples
        --------
        >>> scene.transform_of(0)[0]
        array([1., 0., 0., 0.], dtype=float32)
        """
        return self._instances(instance)["transform"]

    def levels_of(self, instance):
        """Return the way to an instance, or to each of many, through the scenes that it is in.

        Parameters
        ----------
        instance : int or array of int, shape (...)
            The instances, or no_part. IndexError is raised if another one does not exist.

        Returns
        -------
        ndarray of uint32, shape (..., levels, 2)
            An instance and its geometry for each level, from the outermost one in: first of this scene, then of the
            scene that this instance places, by the numbers of that scene, and so on. There are as many levels as the
            deepest instance has, one at least; where an instance has fewer, and for no_part, the rest is no_part.

        Examples
        --------
        >>> scene.levels_of(0)
        array([[0, 0]], dtype=uint32)
        """
        instances = unsigned("instance", instance)
        unique, which = np.unique(instances, return_inverse=True)
        levels, depth = self._tree.levels_of(np.ascontiguousarray(unique))
        return levels.view(np.uint32).reshape(-1, depth, 2)[which.reshape(instances.shape)]

    def name_of(self, instance):
        """Return the name of an instance, or of each of many, such as hits.instance.

        Parameters
        ----------
        instance : int or array of int, shape (...)
            The instances, or no_part. IndexError is raised if another one does not exist.

        Returns
        -------
        str, or ndarray of str, shape (...)
            The name that place() gave; "" for an instance without a name, and for no_part, as misses have it.

        Examples
        --------
        >>> scene.name_of(scene.place(0, name="ball"))
        'ball'
        >>> scene.name_of([0, raylanes.no_part]).tolist()
        ['', '']
        """
        instances = unsigned("instance", instance)
        unique, which = np.unique(instances, return_inverse=True)
        self._instances(unique[unique != no_part])
        names = np.array([self._names.get(index, "") for index in unique.tolist()], np.str_)
        return names[which.reshape(instances.shape)] if instances.shape else str(names[0])

    def instances_named(self, name):
        """Return the instances that have a name.

        Parameters
        ----------
        name : str
            The name. Any number of instances may have it.

        Returns
        -------
        ndarray of int64, shape (n,)
            Their indices, in order.

        Examples
        --------
        >>> scene.place(0, name="ball")
        1
        >>> scene.instances_named("ball")
        array([1])
        """
        return np.array(sorted(index for index, other in self._names.copy().items() if other == name), np.int64)

    def _instances(self, instance):
        instances = unsigned("instance", instance)
        records = np.zeros(instances.shape, _instance_dtypes[self.dtype])
        self._tree.instances(np.ascontiguousarray(instances).reshape(-1), records.reshape(-1))
        return records

    def _give_names(self, placed, names, within):
        """Names of new instances, in order; an empty one is none. `within`: names in the scene that each one places."""
        if "_names" not in self.__dict__:
            self._names = {}
        for index, name in zip(placed, names):
            if name:
                self._names[index] = name
            else:
                self._names.pop(index, None)
            for number, inner in within.items():
                self._names[index + 1 + number] = inner

    def _parts_of_copy(self):
        return {**super()._parts_of_copy(), "_names": self._names.copy()}


def geometry_index(value):
    return count("geometry", value, 0xFFFFFFFF)


def _texts(name, values):
    array = np.asarray(values)
    if array.dtype.kind != "U" and array.shape != (0,):
        raise TypeError(f"{name}: strings are needed, not {array.dtype}")
    return array


def _transforms(transform, dtype):
    """(rows of twelve numbers, shape without the last two axes)."""
    array = numbers("transform", transform)
    if array.ndim < 2 or array.shape[-2:] not in ((3, 4), (4, 4)):
        raise ValueError(f"transform: the shape must be (..., 3, 4) or (..., 4, 4), it is {array.shape}")
    if array.shape[-2] == 4 and not (array[..., 3, :] == (0, 0, 0, 1)).all():
        raise ValueError("transform: the fourth row must be 0, 0, 0, 1")
    rows = np.ascontiguousarray(array[..., :3, :].astype(dtype, copy=False)).reshape(-1, 12)
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
