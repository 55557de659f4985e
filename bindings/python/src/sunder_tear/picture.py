"""Small pictures of meshes, which notebooks show: flat faces in an orthographic view, by numpy alone."""
from __future__ import annotations

import struct
import zlib

import numpy as np

SIZE = 320            # pixels a side
_SAMPLES = 2          # per pixel and axis
_FRAGMENTS = 1 << 21  # at once
_SKIN, _FLESH, _LIP = (0.72, 0.74, 0.78), (0.62, 0.10, 0.09), (0.86, 0.32, 0.26)
_FILLINGS = {'wall', 'cap', 'Wound'}
_VIEW = np.array([0.45, 0.25, 0.86])   # from the middle of the model to the eye: from the front, a little from its left and above
_LIGHT = np.array([0.2, 0.6, 0.77])


def colours_of(mesh) -> np.ndarray:
    """One per triangle of a Mesh: walls and caps are of flesh, and what lies beside one side of a lip is red."""
    colours = np.tile(np.array(_SKIN), (len(mesh.triangles), 1))
    if '_TEARSIDE' in mesh.attributes:
        colours[(mesh.attributes['_TEARSIDE'].ravel()[mesh.triangles] != 0).any(axis=1)] = _LIP
    filled = [i for i, (name, _) in enumerate(mesh.submeshes) if name in _FILLINGS]
    colours[np.isin(mesh.triangle_submesh, filled)] = _FLESH
    return colours


def _fragments(corners, width):
    """Pixels (x, y) whose centres lie in triangles, (m, 3, 3) in pixels and depth: triangle, pixel, depth. By sizes of bounding boxes."""
    low = np.floor(corners[:, :, :2].min(axis=1)).astype(int).clip(0, width - 1)
    extent = np.ceil(corners[:, :, :2].max(axis=1)).astype(int).clip(1, width) - low
    steps = np.maximum(extent.max(axis=1), 1)
    side = 1
    while side < 2 * width:
        of_size = np.flatnonzero((steps <= side) & (steps > side // 2))
        for some in np.array_split(of_size, max(1, len(of_size) * side * side // _FRAGMENTS + 1)):
            y, x = np.divmod(np.arange(side * side), side)
            at = low[some][:, None, :] + np.stack([x, y], axis=1)
            a, b, c = (corners[some][:, None, k, :] for k in range(3))

            def cross(p, q, r):
                return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])
            centre = at + 0.5
            parts = np.stack([cross(b, c, centre), cross(c, a, centre), cross(a, b, centre)])
            total = parts.sum(axis=0)
            with np.errstate(divide='ignore', invalid='ignore'):
                parts = parts / total
                depth = parts[0] * a[..., 2] + parts[1] * b[..., 2] + parts[2] * c[..., 2]
            inside = (parts >= 0).all(axis=0) & (at < width).all(axis=2)
            yield some[np.nonzero(inside)[0]], at[inside][:, 1] * width + at[inside][:, 0], depth[inside]
        side *= 2


def draw(surfaces, size: int = SIZE) -> np.ndarray:
    """An image, (size, size, 4) of bytes, transparent where nothing is. surfaces: (positions (n, 3), triangles (m, 3), colours (m, 3))."""
    corners = [np.asarray(positions, float)[triangles] for positions, triangles, _ in surfaces]
    corners = np.concatenate(corners) if corners else np.zeros((0, 3, 3))
    colours = np.concatenate([np.asarray(of) for _, _, of in surfaces]) if surfaces else np.zeros((0, 3))
    seen = np.isfinite(corners).all(axis=(1, 2))
    corners, colours = corners[seen], colours[seen]
    width = size * _SAMPLES
    image = np.zeros((width * width, 4))
    if len(corners):
        eye = _VIEW / np.linalg.norm(_VIEW)
        right = np.cross([0, 1, 0], eye)
        right /= np.linalg.norm(right)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        with np.errstate(divide='ignore', invalid='ignore'):
            normals = np.nan_to_num(normals / np.linalg.norm(normals, axis=1, keepdims=True))
        shade = 0.35 + 0.65 * np.abs(normals @ _LIGHT)
        view = corners @ np.stack([right, -np.cross(eye, right), eye], axis=1)
        low, high = view.min(axis=(0, 1)), view.max(axis=(0, 1))
        scale = 0.94 * width / max((high - low)[:2].max(), 1e-30)
        view[:, :, :2] = (view[:, :, :2] - (low + high)[:2] / 2) * scale + width / 2
        triangle, pixel, depth = (np.concatenate(of) for of in zip(*_fragments(view, width)))
        order = np.argsort(depth, kind='stable')  # the nearest comes last, and stays
        image[pixel[order], :3] = (colours * shade[:, None])[triangle[order]]
        image[pixel, 3] = 1
    image = image.reshape(size, _SAMPLES, size, _SAMPLES, 4).mean(axis=(1, 3))
    image[..., :3] /= np.maximum(image[..., 3:], 1e-9)
    return (255 * image.clip(0, 1) + 0.5).astype(np.uint8)


def png(image: np.ndarray) -> bytes:
    """An image, (height, width, 4) of bytes, as a PNG file."""
    height, width, _ = image.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), image.reshape(height, -1)], axis=1)  # each begins with its filter: none

    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack('>I', len(content)) + kind + content + struct.pack('>I', zlib.crc32(kind + content))
    header = struct.pack('>IIBBBBB', width, height, 8, 6, 0, 0, 0)
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', zlib.compress(rows.tobytes())) + chunk(b'IEND', b'')
