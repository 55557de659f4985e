"""Ragdolls: the laws of docs/ragdoll.md, from outside of C++."""
import numpy as np
import pytest

from sunder_tear import BoneLimit, Scene, SunderError


def applied(frame, point):
    return frame[:, :3] @ point + frame[:, 3]


def test_bodies_hang_together_and_poses_give_places(character):
    pose = character.pose()
    ragdoll = character.ragdoll()
    assert 1 <= len(ragdoll.bodies) <= 16
    places = ragdoll.place(pose)
    for index, body in enumerate(ragdoll.bodies):
        assert body.mass > 0 and (body.moments > 0).all()
        np.testing.assert_allclose(places[index], body.model_from_body, atol=1e-6)
        assert np.linalg.det(body.model_from_body[:, :3]) == pytest.approx(1)
        if body.parent is not None:
            assert body.parent < index
            above = applied(places[body.parent], body.parent_from_joint[:, 3])
            np.testing.assert_allclose(above, applied(places[index], body.body_from_joint[:, 3]), atol=1e-6)
    np.testing.assert_allclose(ragdoll.pose(places), pose, atol=1e-5)
    assert np.linalg.norm(ragdoll.turns(places), axis=1) == pytest.approx(np.ones(len(places)))


def test_a_severed_limb_weighs_what_its_piece_weighs(tube):
    scene = Scene(threads=1)
    limb = scene.spawn(tube)
    scene.update()
    limb.cut((0, 1, 0), (0, 1, 0))
    command = limb.detach((0, 9, 0), motion='animated')
    scene.update()
    piece = command.result.piece
    ragdoll = piece.character.ragdoll(limb.pose)
    assert sum(body.mass for body in ragdoll.bodies) == pytest.approx(piece.mass, rel=1e-5)


def test_given_limits_and_faults(tube):
    bone = tube.ragdoll().bodies[1].bone
    hinge = tube.ragdoll(limits=[BoneLimit(bone, 'hinge', (0, 0, 1), -0.1, 0.2)]).bodies[1].limit
    assert (hinge.kind, hinge.lower, hinge.upper) == ('hinge', -0.1, 0.2)
    with pytest.raises(SunderError):
        tube.ragdoll(maximum_bodies=0)
    with pytest.raises(SunderError):
        tube.ragdoll(tube.pose()[:1])
    with pytest.raises(ValueError):
        tube.ragdoll(limits=[BoneLimit(bone, 'elbow', (0, 0, 1))])
    with pytest.raises(ValueError):
        tube.ragdoll().place(np.zeros((2, 2)))
