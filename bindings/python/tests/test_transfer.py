"""A skin that is given to another character."""
import dataclasses

import numpy as np
import pytest

import sunder_tear


def dense(character):
    return np.concatenate([mesh.weights(len(character.skins[mesh.skin][0])) for mesh in character.meshes])


def with_flat_weights(character):
    """The same meshes, of which each follows its first bone."""
    meshes = []
    for mesh in character.meshes:
        count = len(mesh.positions)
        meshes.append(dataclasses.replace(mesh, first_influence=np.arange(count + 1), influence_slot=np.zeros(count),
                                          influence_weight=np.ones(count)))
    return sunder_tear.Character.from_arrays(character.bones, character.skins, meshes, character.rest_morph_weights)


@pytest.mark.parametrize('method', ['closest_point', 'inpainting'])
def test_a_copy_gets_the_weights_of_its_source(tube, method):
    flat = with_flat_weights(tube)
    assert np.abs(dense(flat) - dense(tube)).max() > 0.5
    moved = sunder_tear.transfer(tube, flat, method=method)
    assert np.abs(dense(moved.character) - dense(tube)).max() < 1e-6
    assert moved.counts['coincident'] == len(moved.outcomes) and moved.matched_share == 1


def test_locked_vertices_keep_theirs(tube):
    flat = with_flat_weights(tube)
    locked = np.arange(len(dense(tube))) % 3 == 0
    moved = sunder_tear.transfer(tube, flat, locked=locked)
    assert moved.counts['locked'] == locked.sum()
    np.testing.assert_array_equal(dense(moved.character)[locked], dense(flat)[locked])
    assert np.abs(dense(moved.character)[~locked] - dense(tube)[~locked]).max() < 1e-6


def test_names_and_refusals(tube):
    renamed = sunder_tear.Character.from_arrays(
        [dataclasses.replace(bone, name='my_' + bone.name) for bone in tube.bones], tube.skins, with_flat_weights(tube).meshes,
        tube.rest_morph_weights)
    moved = sunder_tear.transfer(tube, renamed, bone_names={'my_' + bone.name: bone.name for bone in tube.bones})
    assert not moved.has_adopted_skeleton and [bone.name for bone in moved.character.bones] == ['my_' + bone.name for bone in tube.bones]
    assert np.abs(dense(moved.character) - dense(tube)).max() < 1e-6
    with pytest.raises(ValueError):
        sunder_tear.transfer(tube, tube, method='magic')
    with pytest.raises(TypeError):
        sunder_tear.transfer(tube, tube, glue=1)
    for options in ({'bones': ['nobody']}, {'locked': [True]}, {'mix': 3.0}):
        with pytest.raises(sunder_tear.SunderError):
            sunder_tear.transfer(tube, tube, **options)
