import pathlib

import numpy as np
import pytest

import sunder_tear

RIGS = pathlib.Path(__file__).resolve().parents[3] / 'tests/data/rigged'
SHARED = pathlib.Path(__file__).resolve().parents[4] / 'shared/models/rigged'


def model_files():
    """The rigs of the repository, and the shared ones where they are."""
    return sorted(RIGS.glob('*.glb')) + [file for file in sorted(SHARED.glob('*.glb')) if file.stat().st_size < 3e6]


@pytest.fixture(params=model_files(), ids=lambda file: file.stem)
def character(request):
    try:
        return sunder_tear.Character.load(request.param)
    except sunder_tear.SunderError as error:
        if error.name == 'unsupported_feature':
            pytest.skip(str(error))
        raise


@pytest.fixture
def tube():
    return sunder_tear.Character.load(RIGS / 'tube.glb')


def posed_by_numpy(character, mesh, model_from_bone):
    """Linear blend skinning in double, from the definition. Meshes without morph targets."""
    bones, bone_from_bind = character.skins[mesh.skin]
    bind = np.concatenate([bone_from_bind.astype(np.float64), np.tile([[[0.0, 0, 0, 1]]], (len(bones), 1, 1))], axis=1)
    slots = model_from_bone[bones] @ bind
    points = np.concatenate([mesh.positions.astype(np.float64), np.ones((len(mesh.positions), 1))], axis=1)
    return np.einsum('vs,sij,vj->vi', mesh.weights(len(bones)).astype(np.float64), slots, points)


def diagonal(positions):
    return float(np.linalg.norm(np.ptp(positions, axis=0)))


def random_blades(positions, random, count=6):
    """A stroke across a surface: from a vertex on, along a random direction, from outside to well inside."""
    size = diagonal(positions)
    start = positions[random.integers(len(positions))]
    along, across = random.normal(size=(2, 3))
    along /= np.linalg.norm(along)
    across -= along * (across @ along)
    across /= np.linalg.norm(across)
    steps = np.linspace(-0.2, 0.2, count)[:, None]
    places = start + size * steps * along
    return np.stack([places + 0.4 * size * across, places - 0.4 * size * across], axis=1)


def live(triangles):
    """Those that were not removed."""
    return triangles[(triangles[:, 0] != triangles[:, 1]) | (triangles[:, 0] != triangles[:, 2])]


def area(positions, triangles):
    a, b, c = (positions[live(triangles)[:, i]].astype(np.float64) for i in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
