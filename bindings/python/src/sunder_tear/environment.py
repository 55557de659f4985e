"""Many worlds in which a blade learns to make a wound: an environment for reinforcement learning."""
from __future__ import annotations

from typing import Optional, Union

import numpy as np

from .character import Asset, Character
from .errors import SunderError
from .scene import Scene

TARGET_PLACES = 12  # along the wanted wound
_AHEAD = 0.05  # of the size: how far the base of the blade is behind its tip


class WoundEnvironment:
    """Worlds with one character each, of which all take a step in one call. The interface is that of Gymnasium's vector environments,
    which is not needed: `reset`, `step`, `num_envs`, shapes of one world in `observation_shape` and `action_shape`.

    In each world a random line on the surface is the wanted wound. An action, 7 numbers from -1 to 1, moves the tip of the blade (3: of
    at most `speed` sizes of the character per second), turns its direction (3: added, then of unit length) and presses the blade (1:
    above 0). While it is pressed the blade tears what it crosses, and the character moves on by its clip. An observation has the tip
    (3), the direction (3), whether the blade is pressed (1), the way from the tip to the nearest place of the surface (3), the posed
    target relative to the tip (3 for each of TARGET_PLACES), and of each target place whether the wound has come to it (1 each).
    Lengths are in sizes of the character, float32. The reward of a step is what it took off the mean distance between the target and
    the wound, in sizes of the character; before the first tear that distance is `reach`, which is also its greatest value.

    The same seed and actions give the same bits, with any number of threads, on every machine.
    """

    def __init__(self, character: Character, worlds: int = 1, *, clip: Union[str, int, None] = None, steps: int = 120,
                 frame: float = 1 / 60, speed: float = 0.5, reach: float = 0.2, threads: int = 0, mesh: Optional[int] = None):
        if worlds < 1 or steps < 1:
            raise ValueError(f'worlds is {worlds} and steps is {steps}; both must be at least 1')
        meshes = character.meshes
        self.mesh = max(range(len(meshes)), key=lambda i: len(meshes[i].triangles)) if mesh is None else mesh
        self._source = meshes[self.mesh]
        self._asset, self._clip, self._threads = Asset(character), clip, threads
        self._size = float(np.linalg.norm(np.ptp(self._source.positions, axis=0)))
        self.num_envs, self.steps, self.frame, self.speed, self.reach = worlds, steps, frame, speed, reach
        self.action_shape, self.observation_shape = (7,), (10 + 4 * TARGET_PLACES,)
        self.near = 0.02  # a target place that a wound comes so near to, in sizes, is met

    def reset(self, seed: int = 0):
        """New worlds with new targets. Returns observations, (worlds, …), and an empty dict."""
        self._scene = Scene(threads=self._threads)
        self._worlds = [_World(self, np.random.default_rng([seed, i])) for i in range(self.num_envs)]
        self._scene.update()
        for world in self._worlds:
            world.place_blade()
        self._step = 0
        return self._observe(), {}

    def step(self, actions):
        """One frame of all worlds. actions: (worlds, 7). Returns observations, rewards, terminated (the whole target is met), truncated
        (`steps` are over), and a dict with `faces_crossed` and the `distance` of each world."""
        actions = np.clip(np.asarray(actions, np.float64), -1, 1)
        if actions.shape != (self.num_envs, 7):
            raise ValueError(f'actions are of shape {actions.shape}; ({self.num_envs}, 7) is needed')
        if not np.isfinite(actions).all():
            raise ValueError('an action is not finite')
        for world, action in zip(self._worlds, actions):
            world.act(action)
        self._scene.update(self.frame)
        self._step += 1
        rewards = np.array([world.reward() for world in self._worlds])
        terminated = np.array([bool(world.met.all()) for world in self._worlds])
        truncated = np.full(self.num_envs, self._step >= self.steps)
        infos = {'faces_crossed': np.array([world.crossed for world in self._worlds]),
                 'distance': np.array([world.distance for world in self._worlds])}
        return self._observe(), rewards, terminated, truncated, infos

    @property
    def digests(self) -> list:
        """Of the torn model of each world: equal for the same seed and actions."""
        return [world.instance.digest for world in self._worlds]

    def _observe(self):
        return np.stack([world.observe() for world in self._worlds])


class _World:
    def __init__(self, of: WoundEnvironment, random):
        self.of, self.random = of, random
        self.instance = of._scene.spawn(of._asset)
        if of._clip is not None:
            self.instance.play(of._clip, time=float(random.uniform(0, 1)))
        self.triangles, self.shares = _line_on_surface(of._source, random, 0.15 * of._size)
        self.bind = self._places(of._source.positions.astype(np.float64))
        self.wound, self.known = np.zeros((0, 3)), len(of._source.positions)
        self.distance, self.met = of.reach, np.zeros(TARGET_PLACES, bool)
        self.is_pressed = self.is_in_stroke = False
        self.command, self.crossed = None, 0
        self.instance.prepare_to_tear()

    def _places(self, positions):
        return (positions[self.of._source.triangles[self.triangles]] * self.shares[:, :, None]).sum(axis=1)

    def _target(self):
        """Where the target is in the pose of the frame."""
        with self.instance.borrow(self.of.mesh) as posed:
            return self._places(np.asarray(posed.positions[:len(self.of._source.positions)], np.float64))

    def place_blade(self):
        """Above the beginning of the target, turned to it."""
        nearest = self.instance.find_nearest(self._target()[0])
        self.direction = -np.asarray(nearest.normal)
        self.tip = np.asarray(nearest.place) - 0.1 * self.of._size * self.direction

    def act(self, action):
        of = self.of
        self.tip = self.tip + of.speed * of.frame * of._size * action[:3]
        turned = self.direction + 0.2 * action[3:6]
        length = np.linalg.norm(turned)
        if length > 1e-6:
            self.direction = turned / length
        blade = np.stack([self.tip - _AHEAD * of._size * self.direction, self.tip])
        self.is_pressed = bool(action[6] > 0)
        self.command = None
        if self.is_pressed and self.is_in_stroke:
            self.command = self.instance.extend_stroke(blade, of.frame)
        elif self.is_pressed:
            self.command = self.instance.begin_stroke(blade)
            self.is_in_stroke = True
        elif self.is_in_stroke:
            self._end()

    def _end(self):
        self.command = self.instance.end_stroke()
        self.is_in_stroke = False

    def reward(self):
        """What the frame took off the distance between the target and the wound."""
        self.crossed = 0
        if self.command is not None:
            try:
                self.crossed = self.command.result.faces_crossed
            except SunderError:  # the blade moved or turned too far for one stroke: the next frame begins another one
                self._end()
        if not self.crossed:
            return 0.0
        positions = self.instance.mesh(self.of.mesh).positions
        self.wound = positions[self.known:].astype(np.float64)
        if not len(self.wound):
            return 0.0
        apart = np.linalg.norm(self.bind[:, None] - self.wound[None], axis=2).min(axis=1) / self.of._size
        self.met |= apart < self.of.near
        distance = float(np.minimum(apart, self.of.reach).mean())
        gained, self.distance = self.distance - distance, distance
        return gained

    def observe(self):
        size = self.of._size
        nearest = self.instance.find_nearest(self.tip)
        way = (np.asarray(nearest.place) - self.tip) / size if nearest else np.zeros(3)
        target = (self._target() - self.tip) / size
        return np.concatenate([self.tip / size, self.direction, [self.is_pressed], way, target.ravel(), self.met]).astype(np.float32)


def _line_on_surface(mesh, random, length):
    """Places along a plane section of the surface in bind space, from a random vertex on: triangles, and shares of their corners."""
    positions = mesh.positions.astype(np.float64)
    triangles = np.flatnonzero((mesh.triangles[:, 0] != mesh.triangles[:, 1]) & (mesh.triangles[:, 0] != mesh.triangles[:, 2]))
    corners = positions[mesh.triangles[triangles]]
    middles = corners.mean(axis=1)
    start = middles[random.integers(len(middles))]
    along = random.normal(size=3)
    along /= np.linalg.norm(along)
    wanted = start + np.linspace(0, length, TARGET_PLACES)[:, None] * along
    nearest = np.array([np.linalg.norm(middles - place, axis=1).argmin() for place in wanted])  # of the triangle: its middle
    return triangles[nearest], np.full((TARGET_PLACES, 3), 1 / 3)
