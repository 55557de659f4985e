"""The wounds in the texture, while a scene plays."""
import numpy as np
import pytest

import sunder_tear
from conftest import random_blades


def test_rectangles_make_the_whole_texture(tube):
    scene = sunder_tear.Scene(threads=1)
    instance = scene.spawn(tube)
    scene.update()
    with pytest.raises(sunder_tear.SunderError):
        instance.wound_mask()
    instance.begin_wound_mask(width=128, height=64, reach=0.1)
    texture = instance.wound_mask().distances
    assert texture.shape == (64, 128) and (texture == np.float32(0.1)).all(), 'nothing is torn'
    random = np.random.default_rng(4)
    for _ in range(12):
        instance.tear(random_blades(instance.posed().positions, random), width=0.01)
        scene.update(1 / 60)
        mask = instance.wound_mask()
        texture[mask.changed] = mask.distances[mask.changed]
        np.testing.assert_array_equal(texture, mask.distances)
    assert (texture < 0).any() and (texture > 0).any()
    assert instance.wound_mask().distances[instance.wound_mask().changed].size == 0
