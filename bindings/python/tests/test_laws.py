"""What must hold after any tear, computed with numpy from what the package gives."""
import numpy as np
import pytest

import sunder_tear
from conftest import area, diagonal, live, posed_by_numpy, random_blades


def torn_instances(character, seeds=4, **options):
    """Instances torn in a pose of a clip, those that a stroke met: at least one."""
    torn = 0
    for seed in range(seeds):
        random = np.random.default_rng(seed)
        scene = sunder_tear.Scene(threads=1)
        instance = scene.spawn(sunder_tear.Asset(character, has_normals=1))
        if character.clips:
            instance.play(int(random.integers(len(character.clips))), time=float(random.uniform(0, 0.5)))
        scene.update()
        meshes = [mesh for mesh in range(character.mesh_count) if len(character.meshes[mesh].triangles)]
        posed = instance.posed(int(random.choice(meshes)))
        command = instance.tear(random_blades(posed.positions, random), layers='all', **options)
        scene.update()
        if command.result.runs:
            torn += 1
            yield scene, instance
    assert torn > 0


def test_rows_of_weights_are_whole(character):
    for _, instance in torn_instances(character):
        for i in range(character.mesh_count):
            mesh = instance.mesh(i)
            slots = len(character.skins[mesh.skin][0])
            sums = np.add.reduceat(mesh.influence_weight.astype(np.float64), mesh.first_influence[:-1].astype(np.int64))
            assert np.abs(sums - 1).max() < 1e-6
            assert mesh.influence_weight.min() > 0
            assert mesh.influence_slot.max() < slots


def test_posed_vertices_are_those_of_their_definition(character):
    if any(mesh.morph_targets for mesh in character.meshes):
        pytest.skip('the oracle has no morph targets')
    for scene, instance in torn_instances(character, seeds=2):
        for step in (0.0, 0.13, 0.4):
            scene.update(step)
            for i in range(character.mesh_count):
                posed, mesh = instance.posed(i), instance.mesh(i)
                wanted = posed_by_numpy(character, mesh, instance.pose)
                used = np.unique(live(mesh.triangles))  # others are posed with what they belonged to
                assert np.abs(posed.positions[used] - wanted[used]).max(initial=0) < 1e-5 * diagonal(wanted)


def test_a_tear_without_a_width_keeps_the_area(character):
    for _, instance in torn_instances(character):
        for i in range(character.mesh_count):
            before, after = character.meshes[i], instance.mesh(i)
            assert area(after.positions, after.triangles) == pytest.approx(area(before.positions, before.triangles), rel=1e-5, abs=1e-12)


def test_old_vertices_stay(character):
    for _, instance in torn_instances(character, width=0.01 * diagonal(character.meshes[0].positions)):
        for i in range(character.mesh_count):
            before, after = character.meshes[i], instance.mesh(i)
            assert np.array_equal(after.positions[:len(before.positions)], before.positions)
            for one, other in zip(after.uv_sets, before.uv_sets):
                assert np.array_equal(one[:len(other)], other)


def test_undo_gives_the_source_and_redo_the_tear(character):
    for scene, instance in torn_instances(character, seeds=2):
        torn = instance.digest
        instance.undo()
        scene.update()
        for i in range(character.mesh_count):
            before, after = character.meshes[i], instance.mesh(i)
            assert np.array_equal(live(after.triangles), live(before.triangles))
        instance.redo()
        scene.update()
        assert instance.digest == torn != 0


def test_a_log_makes_the_same_model_again(character):
    for _, instance in torn_instances(character, seeds=3):
        other = sunder_tear.Scene().spawn(character)
        assert other.apply_log(instance.log) == 1
        assert other.digest == instance.digest
        for i in range(character.mesh_count):
            assert np.array_equal(other.mesh(i).positions, instance.mesh(i).positions)
            assert np.array_equal(other.mesh(i).influence_weight, instance.mesh(i).influence_weight)


def test_a_saved_file_is_the_torn_model(character):
    for _, instance in torn_instances(character, seeds=1):
        again = sunder_tear.Character.load(instance.save(influences=None))
        assert [clip.name for clip in again.clips] == [clip.name for clip in character.clips]
        total = sum(area(mesh.positions, mesh.triangles) for mesh in again.meshes)
        wanted = sum(area(instance.mesh(i).positions, instance.mesh(i).triangles) for i in range(character.mesh_count))
        assert total == pytest.approx(wanted, rel=1e-4)


def test_one_call_tears_as_a_scene_does(character):
    random = np.random.default_rng(5)
    pose = character.pose()
    blades = random_blades(character.meshes[0].positions, random)
    torn = sunder_tear.tear(character, blades, layers='all')
    scene = sunder_tear.Scene()
    instance = scene.spawn(character)
    instance.set_pose(pose)
    instance.tear(blades, layers='all')
    scene.update()
    assert torn.log == instance.log
    assert torn.glb == instance.save()
