"""Convex hulls."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from .abi import abi
from .arrays import copy


@dataclass(frozen=True)
class Hull:
    """A convex part, in the frame of a piece or body: points (n, 3), triangles (m, 3), and the bone whose part it is."""
    points: np.ndarray
    triangles: np.ndarray
    volume: float
    bone: Optional[int]

    @staticmethod
    def copied(raw) -> Hull:
        bone = None if raw.bone == abi.constant('NONE') else raw.bone
        return Hull(copy(raw.points, raw.point_count, 3), copy(raw.triangles, raw.triangle_count, 3), raw.volume, bone)
