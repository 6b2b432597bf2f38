"""The instances of scenes: where they are, their masks and their names."""

import numpy as np

from ._arrays import no_part, unsigned

_instance_dtype = np.dtype([("geometry", "<u4"), ("mask", "<u4"), ("transform", "<f4", (3, 4))])


class Places:
    """Instances of the native scene `self._tree`, and their names by index."""

    _names: dict[int, str] = {}  # of a scene that has named none
    _names_within: dict[int, dict[int, str]] = {}  # by geometry: those of an added scene

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
        ndarray of float32, shape (..., 3, 4)
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
        records = np.zeros(instances.shape, _instance_dtype)
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
