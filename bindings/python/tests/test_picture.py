"""Pictures for notebooks: PNGs that say what stands where, compared with a plain loop over triangles."""
import struct
import zlib

import numpy as np
import pytest


import sunder_tear
from sunder_tear import picture


def pixels_of(png):
    """The pixels of a PNG as png() writes it, checked against the format."""
    assert png[:8] == b'\x89PNG\r\n\x1a\n'
    chunks, at = {}, 8
    while at < len(png):
        size, kind = struct.unpack('>I4s', png[at:at + 8])
        content = png[at + 8:at + 8 + size]
        assert struct.unpack('>I', png[at + 8 + size:at + 12 + size])[0] == zlib.crc32(kind + content)
        chunks[kind] = content
        at += 12 + size
    width, height, depth, colour = struct.unpack('>IIBB', chunks[b'IHDR'][:10])
    assert (depth, colour) == (8, 6) and b'IEND' in chunks
    rows = np.frombuffer(zlib.decompress(chunks[b'IDAT']), np.uint8).reshape(height, 1 + 4 * width)
    assert (rows[:, 0] == 0).all()
    return rows[:, 1:].reshape(height, width, 4)


def drawn_by_a_loop(positions, triangles, colours, size):
    """The same picture, triangle by triangle over all samples."""
    eye = picture._VIEW / np.linalg.norm(picture._VIEW)
    right = np.cross([0, 1, 0], eye)
    right /= np.linalg.norm(right)
    view = positions[triangles] @ np.stack([right, -np.cross(eye, right), eye], axis=1)
    low, high = view.min(axis=(0, 1)), view.max(axis=(0, 1))
    width = 2 * size
    view[:, :, :2] = (view[:, :, :2] - (low + high)[:2] / 2) * (0.94 * width / (high - low)[:2].max()) + width / 2
    centres = np.stack(np.meshgrid(np.arange(width) + 0.5, np.arange(width) + 0.5), axis=2)
    image, depths = np.zeros((width, width, 4)), np.full((width, width), -np.inf)
    for corners, triangle, colour in zip(view, triangles, colours):
        edges = np.stack([corners[1, :2] - corners[0, :2], corners[2, :2] - corners[0, :2]], axis=1)
        if abs(np.linalg.det(edges)) < 1e-12:
            continue
        b, c = np.moveaxis((centres - corners[0, :2]) @ np.linalg.inv(edges).T, 2, 0)
        depth = corners[0, 2] * (1 - b - c) + corners[1, 2] * b + corners[2, 2] * c
        seen = (b >= 0) & (c >= 0) & (b + c <= 1) & (depth > depths)
        normal = np.cross(*(positions[triangle[k]] - positions[triangle[0]] for k in (1, 2)))
        shade = 0.35 + 0.65 * abs(normal @ picture._LIGHT) / np.linalg.norm(normal)
        depths[seen] = depth[seen]
        image[seen] = [*(colour * shade), 1]
    image = image.reshape(size, 2, size, 2, 4).mean(axis=(1, 3))
    image[..., :3] /= np.maximum(image[..., 3:], 1e-9)
    return 255 * image


@pytest.mark.parametrize('seed', range(6))
def test_pictures_are_those_of_a_loop(seed):
    random = np.random.default_rng(seed)
    count = int(random.integers(1, 60))
    sizes = random.choice([0.02, 0.3, 2.0], (count, 1, 1))
    positions = (random.uniform(-1, 1, (count, 1, 3)) + sizes * random.normal(size=(count, 3, 3))).reshape(-1, 3)
    triangles, colours = np.arange(3 * count).reshape(-1, 3), random.uniform(size=(count, 3))
    found = picture.draw([(positions, triangles, colours)], size=48).astype(float)
    difference = np.abs(found - drawn_by_a_loop(positions, triangles, colours, 48)).max(axis=2)
    assert (difference > 1).mean() < 0.002  # samples on an edge may fall to either side


def test_every_model_has_a_picture(character):
    pixels = pixels_of(character._repr_png_())
    assert pixels.shape == (picture.SIZE, picture.SIZE, 4)
    assert 0.02 < (pixels[..., 3] > 0).mean() < 0.95
    assert len(pixels_of(character.meshes[0]._repr_png_())) == picture.SIZE


def test_a_tear_shows(tube):
    blades = np.array([[[-2, 1 + t, 3], [-2, 1 + t, -3]] for t in (0, 0.3)], float) + np.array([[[0, 0, 0]], [[4, 0, 0]]])
    torn = sunder_tear.tear(tube, blades, wall_depth=0.05, width=0.1)
    assert torn.result.faces_crossed > 0

    def red(png):
        pixels = pixels_of(png).astype(int)
        return ((pixels[..., 0] > pixels[..., 2] + 40) & (pixels[..., 3] > 0)).sum()
    assert red(tube._repr_png_()) == 0
    assert red(torn._repr_png_()) > 50
    instance = sunder_tear.Scene(threads=1).spawn(tube)
    instance.scene.update()
    assert red(instance._repr_png_()) == 0


def test_nothing_and_broken_faces_are_drawn_as_nothing():
    assert (picture.draw([]) == 0).all()
    positions = np.array([[0, 0, 0], [1, 0, 0], [np.nan, 1, 0]])
    assert (picture.draw([(positions, np.array([[0, 1, 2], [0, 0, 0]]), np.ones((2, 3)))]) == 0).all()


