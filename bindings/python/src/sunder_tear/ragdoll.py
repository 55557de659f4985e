"""Characters as rigid bodies and joints of a physics engine."""
from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import Optional

import numpy as np

from .abi import abi
from .arrays import copy, doubles, matrices, numbers, pointer_to
from .hull import Hull

_SHAPES = ('sphere', 'capsule', 'box')
_KINDS = ('hinge', 'cone')


@dataclass(frozen=True)
class BoneLimit:
    """How far a bone turns from its rest, radians. A hinge turns about its axis alone; in a cone the axis swings by at most `cone`, and
    the bone twists about it from `lower` to `upper`. axis: (3,), in the bone's own frame."""
    bone: int
    kind: str
    axis: np.ndarray
    lower: float = 0.0
    upper: float = 0.0
    cone: float = 0.0


@dataclass(frozen=True)
class Body:
    """A rigid body and its joint to the body above, whose index is `parent`. Frames are (3, 4): a rotation and a translation; x of the
    joint's is the axis of the limit. shape: sphere (radius), capsule along y (radius, half length) or box (half sizes), at `place`
    turned by `rotation` (x y z w) in the frame of the body."""
    bone: int
    parent: Optional[int]
    mass: float
    moments: np.ndarray
    model_from_body: np.ndarray
    parent_from_joint: np.ndarray
    body_from_joint: np.ndarray
    shape: str
    size: np.ndarray
    place: np.ndarray
    rotation: np.ndarray
    limit: BoneLimit


def _flat(frames, count) -> np.ndarray:
    return np.ascontiguousarray(doubles(frames, count, 3, 4).transpose(0, 2, 1))


class Ragdoll:
    """The bodies of a character; made by Character.ragdoll()."""

    def __init__(self, character, model_from_bone, limits=(), morph_weights=None, **options):
        flat = _flat(model_from_bone, -1)
        raw = abi.new('ragdoll_options', **options)
        given = (abi.type('bone_limit') * len(limits))()
        for to, limit in zip(given, limits):
            if limit.kind not in _KINDS:
                raise ValueError(f'a limit is a hinge or a cone, not {limit.kind!r}')
            to.bone, to.kind, to.axis = limit.bone, _KINDS.index(limit.kind), tuple(map(float, limit.axis))
            to.lower, to.upper, to.cone = limit.lower, limit.upper, limit.cone
        if limits:
            raw.limit_count, raw.limits = len(limits), given
        morph = None if morph_weights is None else numbers(morph_weights, np.float32, character._data.morph_weight_count)
        self._bone_count = len(flat)
        self._handle = abi.output('create_ragdoll', character._handle, pointer_to(flat), len(flat),
                                  None if morph is None else pointer_to(morph, ctypes.c_float), ctypes.byref(raw))
        pointer, count = ctypes.POINTER(abi.type('ragdoll_body'))(), ctypes.c_uint32()
        abi.call('get_ragdoll_bodies', self._handle, ctypes.byref(pointer), ctypes.byref(count))
        self.bodies = [self._body(pointer[i]) for i in range(count.value)]  #: parents before children

    def __del__(self):
        if getattr(self, '_handle', 0):
            abi.plain('destroy_ragdoll', self._handle)

    @staticmethod
    def _body(raw) -> Body:
        limit = BoneLimit(raw.limit.bone, _KINDS[raw.limit.kind], np.array(raw.limit.axis), raw.limit.lower, raw.limit.upper, raw.limit.cone)
        frames = [matrices(np.array(frame))[0] for frame in (raw.model_from_body, raw.parent_from_joint, raw.body_from_joint)]
        return Body(raw.bone, None if raw.parent == abi.constant('NONE') else raw.parent, raw.mass, np.array(raw.moments), *frames,
                    _SHAPES[raw.shape.shape], np.array(raw.shape.size), np.array(raw.shape.place), np.array(raw.shape.rotation), limit)

    def place(self, model_from_bone) -> np.ndarray:
        """Where a pose puts the bodies: (bodies, 3, 4)."""
        flat, to = _flat(model_from_bone, -1), np.empty(12 * len(self.bodies))
        abi.call('place_bodies', self._handle, pointer_to(flat), len(flat), pointer_to(to))
        return matrices(to)

    def turns(self, model_from_body) -> np.ndarray:
        """How bodies in these places turn their joints: quaternions x y z w, (bodies, 4); of a pose of a clip, targets of motors."""
        flat, to = _flat(model_from_body, -1), np.empty((len(self.bodies), 4))
        abi.call('get_joint_turns', self._handle, pointer_to(flat), len(flat), pointer_to(to))
        return to

    def pose(self, model_from_body) -> np.ndarray:
        """The pose in which bodies in these places hold the bones, for Instance.set_pose(): (bones, 3, 4)."""
        flat, to = _flat(model_from_body, -1), np.empty(12 * self._bone_count)
        abi.call('pose_of_bodies', self._handle, pointer_to(flat), len(flat), pointer_to(to))
        return matrices(to)

    def hulls(self, most_points: int = 64) -> list:
        """The convex hull of each body's part of the surface, in its frame. Raises SunderError without Qhull."""
        pointer, count = ctypes.POINTER(abi.type('hull'))(), ctypes.c_uint32()
        abi.call('get_ragdoll_hulls', self._handle, most_points, ctypes.byref(pointer), ctypes.byref(count))
        return [Hull.copied(pointer[i]) for i in range(count.value)]
