"""Parts that came off."""
from __future__ import annotations

import ctypes

import numpy as np

from .abi import abi
from .arrays import copy
from .character import Character
from .hull import Hull

_SOLIDS = ('closed', 'fans', 'shell')


class Piece:
    """A part that came off: mass in kg, volume in m^3, centre of mass in model space, inertia about it, (3, 3), kg m^2."""

    def __init__(self, handle: int):
        self._handle = handle
        info = abi.new('piece_info')
        abi.call('get_piece', handle, ctypes.byref(info))
        self.mass, self.volume, self.area = info.mass, info.volume, info.area
        self.holes = info.holes
        self.solid = _SOLIDS[info.solid]  #: how the volume was found
        self.centre = np.array(info.centre)
        self.inertia = np.array(info.inertia).reshape(3, 3)
        self.model_from_piece = np.array(info.model_from_piece).reshape(4, 3).T
        self._mesh_count = info.mesh_count

    def __del__(self):
        if getattr(self, '_handle', 0):
            abi.plain('destroy_piece', self._handle)

    @property
    def character(self) -> Character:
        """The piece as a character, for an asset of its own."""
        return Character(abi.output('get_piece_character', self._handle))

    def source_vertices(self, mesh: int):
        """The torn mesh of which a mesh of the piece was part, and the vertex there of each of its vertices."""
        torn, pointer, count = ctypes.c_uint32(), ctypes.POINTER(ctypes.c_uint32)(), ctypes.c_uint32()
        abi.call('get_piece_vertices', self._handle, mesh, ctypes.byref(torn), ctypes.byref(pointer), ctypes.byref(count))
        return torn.value, copy(pointer, count.value)

    def hulls(self, most_hulls: int = 8, most_points: int = 64) -> list:
        """Convex hulls for a physics engine. Raises SunderError if the library was built without Qhull."""
        pointer, count = ctypes.POINTER(abi.type('hull'))(), ctypes.c_uint32()
        abi.call('get_piece_hulls', self._handle, most_hulls, most_points, ctypes.byref(pointer), ctypes.byref(count))
        return [Hull.copied(pointer[i]) for i in range(count.value)]
