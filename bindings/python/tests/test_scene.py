"""Strokes over frames, tissue, pieces, snapshots, and what misuse does."""
import gc
import os

import numpy as np
import pytest

import sunder_tear
from conftest import diagonal, random_blades


@pytest.fixture
def soft(tube):
    scene = sunder_tear.Scene(threads=1)
    asset = sunder_tear.Asset(tube, soft=True, materials=[sunder_tear.material('skin')], tension=50.0, has_normals=1)
    instance = scene.spawn(asset)
    instance.prepare_to_tear()
    scene.update()
    return scene, instance


def axis_of(positions):
    """The longest direction of a model, and its middle."""
    return int(np.argmax(np.ptp(positions, axis=0))), (positions.max(0) + positions.min(0)) / 2


def cut_in_the_middle(scene, instance, **options):
    axis, middle = axis_of(instance.posed().positions)
    command = instance.cut(middle, np.eye(3)[axis], **options)
    scene.update()
    return command.result


def test_a_result_waits_for_an_update(tube):
    scene = sunder_tear.Scene()
    command = scene.spawn(tube).undo()
    assert not command.is_done
    with pytest.raises(sunder_tear.SunderError, match='not applied yet'):
        command.result
    scene.update()
    with pytest.raises(sunder_tear.SunderError):
        command.result  # there is nothing to undo
    assert command.is_done


def test_a_stroke_over_frames_tears_while_the_clip_plays(tube):
    scene = sunder_tear.Scene()
    instance = scene.spawn(sunder_tear.Asset(tube))
    if tube.clips:
        instance.play(0)
    scene.update()
    blades = random_blades(instance.posed().positions, np.random.default_rng(3), 8)
    commands = [instance.begin_stroke(blades[0])]
    scene.update(1 / 90)
    for blade in blades[1:]:
        commands.append(instance.extend_stroke(blade, 1 / 90))
        scene.update(1 / 90)
    commands.append(instance.end_stroke())
    scene.update(1 / 90)
    assert all(command.is_done for command in commands)
    added = len(instance.mesh().positions) - len(tube.meshes[0].positions)
    assert commands[-1].result.vertices_added == added > 0  # of the whole stroke
    assert sum(command.result.vertices_added for command in commands[:-1]) == added
    assert instance.digest != 0


def test_a_weld_closes_a_wound(tube):
    scene = sunder_tear.Scene()
    instance = scene.spawn(tube)
    scene.update()
    torn = instance.tear(random_blades(instance.posed().positions, np.random.default_rng(3), 8))
    scene.update()
    open_digest = instance.digest
    bad = instance.weld([[0, float('nan'), 0]])
    scene.update()
    with pytest.raises(sunder_tear.SunderError):
        bad.result
    with pytest.raises(ValueError):
        instance.weld(np.zeros((0, 3)))
    sewn = instance.suture(spacing=0.05, strength=10)
    scene.update()
    assert sewn.result.runs > 0 and '"suture"' in instance.log and instance.digest != open_digest
    threads = instance.threads
    assert len(threads) >= sewn.result.runs and not any(thread.is_broken for thread in threads)
    for thread in threads:  # both ends are at one place
        places = [instance.mesh(mesh).positions[vertex] for mesh, vertex in (thread.left, thread.right)]
        assert thread.left != thread.right and np.allclose(*places, atol=1e-6)
    instance.undo()
    bad = instance.suture(spacing=-1)
    scene.update()
    with pytest.raises(sunder_tear.SunderError, match='spacing is -1 m'):
        bad.result
    assert instance.digest == open_digest
    welded = instance.weld()
    scene.update()
    assert welded.result.runs > 0 and welded.result.blocked == 0
    assert welded.result.length == pytest.approx(torn.result.length, rel=0.02)
    assert '"weld"' in instance.log and instance.digest != open_digest
    instance.undo()
    scene.update()
    assert instance.digest == open_digest


def test_tissue_gapes_and_comes_to_rest(soft):
    scene, instance = soft
    before = instance.posed().positions
    instance.tear(random_blades(before, np.random.default_rng(1)))
    scene.update(1 / 60)
    assert instance.is_awake and instance.particle_count > 0
    for _ in range(2000):
        scene.update(1 / 60)
        if not instance.is_awake:
            break
    assert not instance.is_awake
    after = instance.posed().positions
    moved = np.linalg.norm(after[:len(before)] - before, axis=1).max()
    assert 0 < moved < 0.5 * diagonal(before)


def test_a_held_point_follows(soft):
    scene, instance = soft
    posed = instance.posed()
    vertex = int(posed.triangles[0, 0])
    start = posed.positions[vertex].astype(np.float64)
    place = start + 0.02 * diagonal(posed.positions)
    hold = instance.hold(instance.point_at(0, vertex), place)
    for _ in range(300):
        scene.update(1 / 60)
    pulled = instance.posed().positions[vertex]
    assert np.linalg.norm(pulled - place) < np.linalg.norm(start - place)
    instance.release_hold(hold)
    for _ in range(1000):
        scene.update(1 / 60)
    assert np.linalg.norm(instance.posed().positions[vertex] - start) < 1e-3 * diagonal(posed.positions)


def test_pulled_tissue_gives_way_where_it_is_weak(tube):
    scene = sunder_tear.Scene(threads=1)
    weak = sunder_tear.material('skin', strength=1.02)
    instance = scene.spawn(sunder_tear.Asset(tube, soft=True, materials=[weak]))
    instance.prepare_to_tear()
    scene.update()
    whole = instance.digest
    posed = instance.posed()
    vertex = int(posed.triangles[len(posed.triangles) // 2, 0])
    middle = posed.positions.mean(axis=0).astype(np.float64)
    place = middle + 2 * (posed.positions[vertex] - middle)
    instance.hold(instance.point_at(0, vertex), place, stiffness=1e5)
    tears = 0
    for _ in range(60):
        scene.update(1 / 60)
        found = instance.tear_overstretched(length=1.0)
        assert found.greatest_stretch >= 1 and found.has_torn == (found.length > 0)
        tears += found.has_torn
    assert tears > 0
    for _ in range(tears):
        instance.undo()
    scene.update()
    assert instance.digest == whole
    with pytest.raises(sunder_tear.SunderError, match='length'):
        instance.tear_overstretched(length=-1)


def test_a_ray_meets_the_drawn_surface(soft):
    _, instance = soft
    posed = instance.posed()
    middle = posed.positions[posed.triangles[5]].mean(axis=0).astype(np.float64)
    hit = instance.find_nearest(middle)
    corners = posed.positions[instance.mesh().triangles[hit.triangle]].astype(np.float64)
    assert np.allclose(np.array(hit.barycentric) @ corners, hit.place, atol=1e-6)
    along = instance.cast_ray(middle + np.array(hit.normal), -np.array(hit.normal))
    assert along is not None and along.distance <= 1 + 1e-6
    assert instance.cast_ray(1e3 * np.ones(3), np.ones(3)) is None
    reach = np.array(hit.normal) * diagonal(posed.positions)
    contacts = instance.find_blade_contacts([middle + reach, middle - reach])
    assert contacts and [contact.distance for contact in contacts] == sorted(contact.distance for contact in contacts)


def test_pieces_have_mass_and_move_on(soft):
    scene, instance = soft
    assert cut_in_the_middle(scene, instance).separated_pieces == 1
    axis, middle = axis_of(instance.posed().positions)
    above = middle + 0.2 * diagonal(instance.posed().positions) * np.eye(3)[axis]
    command = instance.detach(above, density=1000.0)
    scene.update()
    piece = command.result.piece
    assert piece.mass == pytest.approx(1000.0 * piece.volume) and piece.volume > 0
    assert np.linalg.eigvalsh(piece.inertia).min() > 0
    part = piece.character
    mesh, vertices = piece.source_vertices(0)
    assert len(vertices) == len(part.meshes[0].positions) and vertices.max() < len(instance.mesh(mesh).positions)
    scene.spawn(part)
    scene.update()
    try:
        hulls = piece.hulls(4, 32)
    except sunder_tear.SunderError as error:
        assert error.name == 'unsupported_feature'
    else:
        assert 1 <= len(hulls) <= 4 and all(len(hull.points) <= 32 for hull in hulls)
        assert sum(hull.volume for hull in hulls) > 0.9 * piece.volume


def test_a_restored_scene_goes_on_with_the_same_bits(soft):
    scene, instance = soft
    instance.tear(random_blades(instance.posed().positions, np.random.default_rng(2)))
    scene.update(1 / 60)
    snapshot = scene.save()
    ends = []
    for _ in range(2):
        for _ in range(20):
            scene.update(1 / 60)
        ends.append(instance.posed().positions)
        scene.restore(snapshot, [instance.asset])
    assert np.array_equal(*ends)


def test_damaged_bytes_are_refused(soft):
    scene, instance = soft
    snapshot = bytearray(scene.save())
    snapshot[len(snapshot) // 2] ^= 1
    with pytest.raises(sunder_tear.SunderError) as caught:
        scene.restore(bytes(snapshot), [instance.asset])
    assert caught.value.name == 'malformed_file'
    scene.update()
    for model in (b'', b'glTF', b'\0' * 100, instance.save()[:1000]):
        with pytest.raises(sunder_tear.SunderError):
            sunder_tear.Character.load(model)
    with pytest.raises(sunder_tear.SunderError) as caught:
        instance.apply_log('{"sunder_operations": 1, "operations": [{"op": "tearr"}]}')
    assert '/operations/0' in caught.value.text


def test_what_is_no_regular_file_is_refused(tmp_path):
    """A link among models could lead to a device without an end, or to a pipe that nobody writes."""
    (tmp_path / 'device.glb').symlink_to('/dev/zero')
    os.mkfifo(tmp_path / 'pipe.glb')
    with open(tmp_path / 'large.glb', 'wb') as file:
        file.truncate(3 << 30)
    (tmp_path / 'folder.glb').mkdir()
    for name, error in (('device', 'file_unreadable'), ('pipe', 'file_unreadable'), ('folder', 'file_unreadable'),
                        ('large', 'limit_exceeded')):
        with pytest.raises(sunder_tear.SunderError) as raised:
            sunder_tear.Character.load(tmp_path / f'{name}.glb')
        assert raised.value.name == error
    with pytest.raises(FileNotFoundError):
        sunder_tear.Character.load(tmp_path / 'none.glb')


def test_borrowed_arrays_hold_the_scene(tube):
    scene = sunder_tear.Scene()
    instance = scene.spawn(tube)
    scene.update()
    with instance.borrow() as posed:
        with pytest.raises(ValueError):
            posed.positions[0] = 0
        for change in (scene.update, instance.undo, instance.stop, lambda: scene.spawn(tube), lambda: instance.apply_log('{}')):
            with pytest.raises(sunder_tear.StaleView):
                change()
    scene.update()


def test_misuse_raises(tube):
    scene = sunder_tear.Scene()
    instance = scene.spawn(tube)
    for wrong in ([], [[0, 0, 0]], [[[0, 0], [1, 1]]], [[[0, 0, 0, 0]] * 2]):
        with pytest.raises(ValueError):
            instance.tear(wrong)
    with pytest.raises(ValueError, match='layers'):
        instance.tear([[[0, 0, 0], [0, 0, 1]]] * 2, layers='some')
    with pytest.raises(TypeError, match='widht.*width'):
        instance.tear([[[0, 0, 0], [0, 0, 1]]] * 2, widht=1)
    with pytest.raises(sunder_tear.SunderError) as caught:
        tube.find_bone('no such bone')
    assert caught.value.name == 'not_found'
    with pytest.raises(sunder_tear.SunderError):
        instance.mesh(99)
    instance.destroy()
    with pytest.raises(sunder_tear.SunderError):
        instance.stop()
    gone = instance.undo()
    scene.update()
    with pytest.raises(sunder_tear.SunderError):
        gone.result
    command = scene.spawn(tube).tear([[[0, 0, np.nan], [0, 0, 1]]] * 2)
    scene.update()
    with pytest.raises(sunder_tear.SunderError) as caught:
        command.result
    assert caught.value.name == 'non_finite_value' and caught.value.index == 0


def test_arrays_outlive_their_objects(tube):
    scene = sunder_tear.Scene()
    instance = scene.spawn(tube)
    scene.update()
    posed, mesh, bones = instance.posed(), instance.mesh(), tube.bones
    total = float(posed.positions.sum()) + float(mesh.influence_weight.sum())
    del scene, instance
    gc.collect()
    sunder_tear.Scene().spawn(tube)
    assert float(posed.positions.sum()) + float(mesh.influence_weight.sum()) == total
    assert bones[0].parent is None
