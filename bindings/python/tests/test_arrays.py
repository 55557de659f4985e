"""Characters made of arrays, and the origins of what operations made."""
import dataclasses

import numpy as np
import pytest

import sunder_tear
from conftest import diagonal, live, random_blades


def rebuilt(character):
    return sunder_tear.Character.from_arrays(character.bones, character.skins, character.meshes, character.rest_morph_weights, 'copy')


def torn(character):
    """An instance torn by the first random stroke that meets its largest mesh, and the number of the mesh."""
    scene = sunder_tear.Scene(threads=1)
    instance = scene.spawn(sunder_tear.Asset(character))
    scene.update()
    mesh = max(range(character.mesh_count), key=lambda i: len(character.meshes[i].triangles))
    count = len(character.meshes[mesh].positions)
    for seed in range(20):
        instance.tear(random_blades(instance.posed(mesh).positions, np.random.default_rng(seed)), layers='all')
        scene.update()
        if len(instance.mesh(mesh).positions) > count:
            return instance, mesh
    raise AssertionError('no stroke met the mesh')


def test_arrays_make_the_same_character(character):
    copy = rebuilt(character)
    assert copy.bones == character.bones
    for before, after in zip(character.meshes, copy.meshes):
        for field in dataclasses.fields(before):
            a, b = getattr(before, field.name), getattr(after, field.name)
            if isinstance(a, np.ndarray):
                np.testing.assert_array_equal(a, b, field.name)
            elif field.name not in ('attributes', 'morph_targets', 'uv_sets', 'color_sets'):
                assert a == b, field.name
            else:
                assert len(a) == len(b), field.name
                for x, y in zip(*((v.values() if isinstance(v, dict) else v) for v in (a, b))):
                    np.testing.assert_array_equal(x, y, field.name)
    assert torn(character)[0].digest == torn(copy)[0].digest


def test_origins_carry_what_a_program_keeps_per_vertex(character):
    instance, mesh = torn(character)
    source, result, origins = character.meshes[mesh], instance.mesh(mesh), instance.origins(mesh)
    own = source.positions.astype(np.float64) @ [2.0, -1.0, 0.5]
    assert (origins.vertex_triangle >= 0).all(), 'no walls, no caps'
    corners = source.triangles[origins.vertex_triangle]
    carried = (own[corners] * origins.vertex_barycentric).sum(axis=1)
    wanted = result.positions[len(own):].astype(np.float64) @ [2.0, -1.0, 0.5]
    assert np.abs(carried - wanted).max() < 1e-5 * diagonal(source.positions)


def test_triangles_that_share_two_points_share_an_edge(character):
    instance, mesh = torn(character)
    result, origins = instance.mesh(mesh), instance.origins(mesh)
    is_live = (result.triangles[:, 0] != result.triangles[:, 1]) | (result.triangles[:, 0] != result.triangles[:, 2])
    assert ((origins.points >= 0).all(axis=1) == is_live).all()
    points, corners = origins.points[is_live].ravel(), live(result.triangles).ravel()
    places = np.full((points.max() + 1, 3), np.nan)
    places[points] = result.positions[corners]
    np.testing.assert_array_equal(places[points], result.positions[corners])
    assert (origins.triangle[is_live] >= 0).all()


def test_wrong_arrays_are_refused(tube):
    mesh = tube.meshes[0]

    def make(**changes):
        return sunder_tear.Character.from_arrays(tube.bones, tube.skins, [dataclasses.replace(mesh, **changes)])

    with pytest.raises(ValueError):
        make(positions=mesh.positions[:, :2])
    with pytest.raises(ValueError):
        make(influence_weight=mesh.influence_weight[1:])
    with pytest.raises(sunder_tear.SunderError):
        make(triangles=mesh.triangles + len(mesh.positions))
    with pytest.raises(sunder_tear.SunderError):
        make(influence_weight=mesh.influence_weight * 2)
    with pytest.raises(sunder_tear.SunderError):
        sunder_tear.Scene().spawn(tube).origins()
