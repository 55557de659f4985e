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


def test_channels_tell_of_the_nearest_lip(tube):
    scene = sunder_tear.Scene(threads=1)
    instance = scene.spawn(tube)
    scene.update()
    random = np.random.default_rng(4)
    instance.begin_wound_mask(width=128, height=64, reach=0.1)
    assert (instance.wound_channel('age') == -1).all()
    for depth in (0.0, 0.05):
        instance.tear(random_blades(instance.posed().positions, random), wall_depth=depth)
        scene.update(1 / 60)
    mask, ages = instance.wound_mask().distances, instance.wound_channel('age')
    assert ages.shape == (64, 128) and set(np.unique(ages)) == {-1, 0, 1}
    assert (ages[np.abs(mask) < 0.1] >= 0).all()
    depths = instance.wound_channel('depth')
    assert (depths[ages == 1] == 0).all() and (depths[ages == 0] > 0).any()
    stretches = instance.wound_channel('stretch')
    assert (stretches[mask == np.float32(0.1)] == 1).all() and (stretches > 0).all()
    blood = instance.flow_blood(length=0.3, width=0.02, spacing=0.02, seed=3)
    assert blood.shape == mask.shape and blood.max() > 0 and blood.max() <= 1 and blood.min() == 0
    with pytest.raises(ValueError, match='age'):
        instance.wound_channel('heat')
    # The mask of one operation alone is the part of its age.
    instance.begin_wound_mask(width=128, height=64, reach=0.1, first_operation=1, operation_count=1)
    alone = instance.wound_mask().distances
    np.testing.assert_array_equal(alone[ages == 0], mask[ages == 0])
    assert (alone[ages != 0] >= mask[ages != 0]).all() and (alone[ages == 1] > mask[ages == 1]).any()
