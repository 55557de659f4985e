"""A hundred worlds in which a blade follows a wanted wound: prints steps per second, and how near the wounds come to their targets.

wound_environment.py MODEL.glb [WORLDS] [STEPS]
"""
import sys
import time

import numpy as np

import sunder_tear
from sunder_tear.environment import TARGET_PLACES


def follow(environment, observations):
    """A policy: the tip goes to a little below the first target place that is not met, and presses when it is near."""
    targets = observations[:, 10:10 + 3 * TARGET_PLACES].reshape(-1, TARGET_PLACES, 3)
    met = observations[:, -TARGET_PLACES:] > 0
    wanted = targets[np.arange(len(targets)), met.argmin(axis=1)] + 0.02 * observations[:, 3:6]
    actions = np.zeros((len(targets), 7))
    actions[:, :3] = wanted / (environment.speed * environment.frame)
    actions[:, 6] = np.where(np.linalg.norm(wanted, axis=1) < 0.06, 1, -1)
    return actions


def main():
    worlds, steps = (int(argument) for argument in (sys.argv[2:] + ['100', '90'][len(sys.argv) - 2:]))
    character = sunder_tear.Character.load(sys.argv[1])
    environment = sunder_tear.WoundEnvironment(character, worlds, clip=0 if character.clips else None, steps=steps)
    observations, _ = environment.reset(seed=1)
    begin, total = time.perf_counter(), np.zeros(worlds)
    for _ in range(steps):
        observations, rewards, terminated, truncated, infos = environment.step(follow(environment, observations))
        total += rewards
    seconds = time.perf_counter() - begin
    print(f'{worlds * steps / seconds:.0f} steps per second: {worlds} worlds x {steps} steps in {seconds:.2f} s')
    distance = np.median(infos['distance'])
    print(f'mean distance between target and wound: {environment.reach} -> {distance:.4f} sizes of the character (median)')


if __name__ == '__main__':
    main()
