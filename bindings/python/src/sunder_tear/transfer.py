"""The skin of one character given to another one."""
from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import Optional

import numpy as np

from .abi import abi
from .arrays import numbers
from .character import Character

OUTCOMES = ('coincident', 'matched', 'inpainted', 'nearest', 'locked')


@dataclass(frozen=True)
class Transfer:
    """character: the target with its new weights. outcomes: per vertex of the target, all meshes one after the other, an index in
    OUTCOMES; `counts` has their numbers. matched_share: of the vertices that are not locked. largest_distance: of an accepted match,
    metres."""
    character: Character
    outcomes: np.ndarray
    matched_share: float
    largest_distance: float
    has_adopted_skeleton: bool

    @property
    def counts(self) -> dict:
        return {name: int((self.outcomes == i).sum()) for i, name in enumerate(OUTCOMES)}


def transfer(source: Character, target: Character, *, method: str = 'inpainting', bone_names: Optional[dict] = None, bones=(),
             locked=None, **options) -> Transfer:
    """Gives a target the skin of a source; both stand in their bind poses in the same place. method: "inpainting", or
    "closest_point". bone_names: names of the target's bones and the source's that they stand for. bones: of the source, whose weights
    are transferred; none: all. locked: per vertex of the target, all meshes one after the other: whether it keeps its weights. Other
    options are fields of sunder_transfer_options: distance, angle, flips_normals, isolates_parts, keeps_sides_apart, smoothness,
    smoothing_sweeps, smoothing_strength, maximum_influences, mix. Raises SunderError."""
    methods = ('closest_point', 'inpainting')
    if method not in methods:
        raise ValueError(f'method is {method!r}; it must be one of {methods}')
    raw = abi.new('transfer_options', method=methods.index(method), **options)
    names = [abi.type('bone_names')(of.encode(), to.encode()) for of, to in (bone_names or {}).items()]
    pairs = (abi.type('bone_names') * max(len(names), 1))(*names)
    wanted = (ctypes.c_char_p * max(len(bones), 1))(*(bone.encode() for bone in bones))
    raw.bone_names, raw.bone_name_count, raw.bones, raw.bone_count = pairs, len(names), wanted, len(bones)
    if locked is not None:
        flags = numbers(np.asarray(locked, bool), np.uint8, -1)
        raw.locked, raw.locked_count = flags.ctypes.data_as(ctypes.POINTER(ctypes.c_uint8)), len(flags)
    outcomes = np.empty(sum(mesh.vertex_count for mesh in target._data.meshes[:target.mesh_count]), np.uint8)
    handle, info = ctypes.c_uint32(), abi.new('transfer_info')
    abi.call('transfer', source._handle, target._handle, ctypes.byref(raw), ctypes.byref(handle), ctypes.byref(info),
             outcomes.ctypes.data_as(ctypes.POINTER(ctypes.c_uint8)))
    return Transfer(Character(handle.value), outcomes, info.matched_share, info.largest_distance, bool(info.has_adopted_skeleton))
