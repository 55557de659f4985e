"""Arrays of the library as numpy arrays, and the other way round."""
import ctypes

import numpy as np


def view(pointer, *shape):
    """A read-only numpy array on memory of the library; None for a null pointer."""
    if not pointer:
        return None
    if 0 in shape:
        return np.zeros(shape, np.dtype(pointer._type_))
    array = np.ctypeslib.as_array(pointer, shape)
    array.flags.writeable = False
    return array


def copy(pointer, *shape):
    """The same, copied."""
    array = view(pointer, *shape)
    return None if array is None else array.copy()


def doubles(values, *shape):
    """Numbers as a contiguous array of float64 of the given shape; -1 is any length. Raises ValueError."""
    return numbers(values, np.float64, *shape)


def numbers(values, dtype, *shape):
    array = np.ascontiguousarray(values, dtype=dtype)
    if array.ndim != len(shape) or any(want not in (-1, have) for want, have in zip(shape, array.shape)):
        raise ValueError(f'an array of shape {array.shape} was given; {tuple("n" if n == -1 else n for n in shape)} is needed')
    return array


def pointer_to(array, kind=ctypes.c_double):
    return array.ctypes.data_as(ctypes.POINTER(kind))


def matrices(flat):
    """12 numbers per transform, column after column, as matrices of 3 rows and 4 columns."""
    return np.ascontiguousarray(flat.reshape(-1, 4, 3).transpose(0, 2, 1))
