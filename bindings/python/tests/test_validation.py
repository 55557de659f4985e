"""Skins compared, and the force on a blade."""
import numpy as np
import pytest

import sunder_tear
from conftest import RIGS, diagonal, random_blades


def test_a_torn_model_passes(tube):
    torn = sunder_tear.tear(tube, random_blades(tube.meshes[0].positions, np.random.default_rng(1)), influences=None)
    report = sunder_tear.validate(tube, torn.character, random_poses=16)
    assert report.passes, report.findings
    assert report.sampled <= report.certified * (1 + 1e-6) + 1e-6 * report.diagonal
    assert len(report.vertex_deviation) == sum(len(mesh.positions) for mesh in torn.character.meshes)


def test_another_skin_fails():
    source = sunder_tear.Character.load(RIGS / 'tube.glb')
    target = sunder_tear.Character.load(RIGS / 'tube_weights_u8.glb')
    same = sunder_tear.validate(source, source, random_poses=8)
    other = sunder_tear.validate(source, target, random_poses=8)
    assert same.passes and same.sampled < 1e-6 * diagonal(source.meshes[0].positions)
    assert other.sampled > same.sampled
    assert [finding.severity for finding in other.findings] == sorted(
        (finding.severity for finding in other.findings), key=('error', 'warning', 'note').index)


def test_options_are_checked(tube):
    with pytest.raises(TypeError, match='random_poses'):
        sunder_tear.validate(tube, tube, poses=3)
    with pytest.raises(sunder_tear.SunderError, match='maximum_deviation'):
        sunder_tear.validate(tube, tube, maximum_deviation=-1.0)


def test_a_blade_feels_the_work_that_it_does():
    motion = np.array([0.003, 0.0, -0.001])
    force = sunder_tear.blade_force(0.004, 0.01, motion, toughness=2000.0, thickness=0.002)
    assert force @ motion == pytest.approx(-2000.0 * 0.004 * 0.002)
    assert np.all(sunder_tear.blade_force(0.0, 0.01, [0, 0, 0], toughness=2000.0) == 0)
