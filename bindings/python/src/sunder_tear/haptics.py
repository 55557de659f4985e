"""What a hand feels that holds the blade."""
import ctypes

import numpy as np

from .abi import abi
from .arrays import doubles, pointer_to


def blade_force(length_torn: float, depth: float, motion, **tissue: float) -> np.ndarray:
    """The force on a blade in newtons, (3,), which opposes its motion. length_torn: `Result.length` of the frame; depth: of the tip
    below the surface; motion: of the tip since the last frame, (3,), metres. tissue: toughness (J/m^2), thickness (m), friction
    (N/m), greatest (N)."""
    raw = abi.new('cutting_resistance', **tissue)
    force = np.zeros(3)
    abi.call('blade_force', ctypes.byref(raw), length_torn, depth, pointer_to(doubles(motion, 3)), pointer_to(force))
    return force
