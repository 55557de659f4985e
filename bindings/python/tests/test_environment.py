"""Worlds in which a blade makes a wound."""
import pathlib
import sys

import numpy as np
import pytest

import sunder_tear

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / 'samples'))
from wound_environment import follow  # noqa: E402


def play(environment, seed, steps):
    observations, _ = environment.reset(seed)
    total = np.zeros(environment.num_envs)
    for _ in range(steps):
        observations, rewards, terminated, truncated, infos = environment.step(follow(environment, observations))
        total += rewards
    return observations, total, terminated, truncated, infos


def test_a_policy_that_follows_the_target_makes_the_wound(tube):
    environment = sunder_tear.WoundEnvironment(tube, 12, clip=0, steps=90)
    observations, total, terminated, truncated, infos = play(environment, 5, 90)
    assert observations.shape == (12, *environment.observation_shape) and observations.dtype == np.float32
    assert np.isfinite(observations).all() and truncated.all()
    np.testing.assert_allclose(total, environment.reach - infos['distance'])
    assert np.median(total) > 0.6 * environment.reach, total
    assert all(world.instance.digest for world in environment._worlds if world.distance < environment.reach)


def test_the_same_seed_gives_the_same_bits_with_any_number_of_threads(tube):
    results = []
    for threads in (1, 2, 1):
        environment = sunder_tear.WoundEnvironment(tube, 8, clip=0, threads=threads)
        observations, total, *_ = play(environment, 3, 60)
        results.append((environment.digests, observations.tobytes(), total.tobytes()))
    assert results[0] == results[1] == results[2]
    assert any(results[0][0])
    environment = sunder_tear.WoundEnvironment(tube, 8, clip=0)
    play(environment, 4, 60)
    assert environment.digests != results[0][0], 'another seed, another world'


def test_random_actions_leave_no_error(tube):
    environment = sunder_tear.WoundEnvironment(tube, 20, clip=0)
    environment.reset(1)
    random = np.random.default_rng(2)
    for _ in range(80):
        observations, rewards, *_ = environment.step(random.uniform(-1, 1, (20, 7)))
        assert np.isfinite(observations).all() and np.isfinite(rewards).all()


def test_wrong_actions_are_refused(tube):
    environment = sunder_tear.WoundEnvironment(tube, 2)
    environment.reset()
    before = environment.digests
    for actions in (np.zeros((2, 6)), np.zeros((1, 7)), np.full((2, 7), np.nan)):
        with pytest.raises(ValueError):
            environment.step(actions)
    assert environment.digests == before
    with pytest.raises(ValueError):
        sunder_tear.WoundEnvironment(tube, 0)
