"""Fields and perforations of tissue, on a sheet."""
import numpy as np
import pytest

import sunder_tear

CELLS = 30
# Those of sunder_default_material(), on which the perforations of tests/particles/perforation_test.cpp are tried.
PLAIN = dict(return_frequency=3.2, damping_ratio=0.7, membrane_stiffness=4.0, membrane_damping=0.25, areal_density=0.4, range=0.1,
             stretch_limit=0.0, strength=0.0)


@pytest.fixture(scope='module')
def sheet():
    """A square metre in the plane z = 0, of one bone."""
    steps = np.linspace(0, 1, CELLS + 1, dtype=np.float32)
    y, x = np.meshgrid(steps, steps, indexing='ij')
    positions = np.stack([x, y, 0 * x], axis=2).reshape(-1, 3)
    count = len(positions)
    a = (np.arange(CELLS)[:, None] * (CELLS + 1) + np.arange(CELLS)).reshape(-1, 1)
    triangles = np.stack([a + [0, 1, CELLS + 2], a + [0, CELLS + 2, CELLS + 1]], axis=1).reshape(-1, 3).astype(np.uint32)
    mesh = sunder_tear.Mesh(
        name='sheet', skin=0, positions=positions, normals=None, tangents=None, uv_sets=[], color_sets=[], attributes={},
        first_influence=np.arange(count + 1, dtype=np.uint32), influence_slot=np.zeros(count, np.uint32),
        influence_weight=np.ones(count, np.float32), triangles=triangles, triangle_submesh=np.zeros(2 * CELLS * CELLS, np.uint32),
        submeshes=[('cloth', 0)])
    bone = sunder_tear.Bone('root', None, ((0, 0, 0), (0, 0, 0, 1), (1, 1, 1)))
    skin = (np.zeros(1, np.uint32), np.eye(4)[None, :3])
    return sunder_tear.Character.from_arrays([bone], [skin], [mesh], name='sheet')


def place_at(x, y):
    """(mesh, triangle, barycentric) of a place on the sheet."""
    i, j = (min(int(CELLS * along), CELLS - 1) for along in (x, y))
    u, v = CELLS * x - i, CELLS * y - j
    cell = 2 * (j * CELLS + i)
    return (0, cell, (1 - u, u - v, v)) if u >= v else (0, cell + 1, (1 - v, u, v - u))


class Slit:
    """A sheet with a slit along x in its middle, `half` metres to either side, pulled apart by its tension for some frames."""

    def __init__(self, sheet, tension=1.2, material=None, half=0.2, frames=40, **options):
        materials = [material or sunder_tear.material('skin', **PLAIN)]
        self.scene = sunder_tear.Scene(threads=1)
        asset = sunder_tear.Asset(sheet, soft=True, materials=materials, tension=tension, particle_range=0.05, **options)
        self.instance = self.scene.spawn(asset)
        self.instance.prepare_to_tear()
        self.scene.update()
        blades = [[[x, 0.503, 0.1], [x, 0.503, -0.1]] for x in (0.5 - half, 0.5 + half)]
        torn = self.instance.tear(blades)
        for _ in range(frames):
            self.scene.update(1 / 30)
        assert torn.result.runs == 1

    @property
    def moved(self):
        return self.instance.posed().positions.astype(np.float64) - self.instance.mesh().positions

    def run(self, frames):
        """Lets it tear by itself; how often it did."""
        tears = 0
        for _ in range(frames):
            self.scene.update(1 / 30)
            tears += self.instance.tear_overstretched().has_torn
        return tears


def even(sheet, factor):
    return np.full(len(sheet.meshes[0].positions), factor, np.float32)


def test_factors_of_one_change_no_bit(sheet):
    names = ('strength', 'toughness', 'stiffness', 'tension', 'thickness')
    np.testing.assert_array_equal(Slit(sheet).moved, Slit(sheet, fields={name: even(sheet, 1) for name in names}).moved)


def test_even_factors_are_those_of_the_material(sheet):
    factor = float(np.float32(1.7))
    fields = {name: even(sheet, factor) for name in ('stiffness', 'tension', 'thickness')}
    scaled = sunder_tear.material('skin', **{
        **PLAIN, 'areal_density': PLAIN['areal_density'] * factor, 'membrane_damping': PLAIN['membrane_damping'] * factor,
        'membrane_stiffness': PLAIN['membrane_stiffness'] * factor * factor})
    with_fields, with_material = Slit(sheet, fields=fields), Slit(sheet, tension=1.2 * factor, material=scaled)
    assert np.abs(with_fields.moved).max() > 0.005
    np.testing.assert_array_equal(with_fields.moved, with_material.moved)


def test_a_slit_opens_less_where_the_tissue_is_stiff(sheet):
    x = sheet.meshes[0].positions[:, 0]
    stiff_right = Slit(sheet, fields={(0, 'stiffness'): np.where(x > 0.5, 8.0, 1.0)})
    at = stiff_right.instance.mesh().positions
    moved = np.linalg.norm(stiff_right.moved, axis=1)
    left, right = moved[at[:, 0] < 0.45].max(), moved[at[:, 0] > 0.55].max()
    assert 0 < 2 * right < left
    plain = np.linalg.norm(Slit(sheet).moved, axis=1)
    assert right < 0.5 * plain[at[:, 0] > 0.55].max()


def test_tears_run_along_perforations_and_not_without(sheet):
    tough = sunder_tear.material('skin', **PLAIN, toughness=0.1)
    line = [place_at(0.1, 0.503), place_at(0.9, 0.503)]
    assert Slit(sheet, material=tough, half=0.1, frames=3).run(30) == 0  # before it comes to rest
    weak = Slit(sheet, material=tough, half=0.1, frames=3, perforations=[(line, 0.3)])
    assert weak.run(100) > 3
    new = weak.instance.mesh().positions[len(sheet.meshes[0].positions):]
    assert np.abs(new[:, 1] - 0.503).max() < 1e-4
    assert np.ptp(new[:, 0]) == pytest.approx(0.8, abs=1e-4)  # to its ends


@pytest.mark.parametrize('fields, error, text', [
    ({'stiffness': [1, 2]}, 'size_mismatch', "'sheet': the field stiffness has 2 values; the mesh has 961 vertices"),
    ({'strength': np.zeros(961)}, 'invalid_argument', 'vertex 0: the factor of strength is 0'),
    ({'tension': np.full(961, np.nan)}, 'non_finite_value', 'vertex 0: the factor of tension is nan'),
    ({(1, 'stiffness'): np.ones(961)}, 'index_out_of_range', 'mesh'),
])
def test_fields_that_do_not_fit_are_refused(sheet, fields, error, text):
    with pytest.raises(sunder_tear.SunderError, match=text) as caught:
        sunder_tear.Asset(sheet, soft=True, fields=fields)
    assert caught.value.name == error


def test_fields_that_are_none_are_refused(sheet):
    with pytest.raises(ValueError, match="'hardness' is no field of tissue; there are strength, toughness"):
        sunder_tear.Asset(sheet, soft=True, fields={'hardness': np.ones(961)})
    with pytest.raises(ValueError, match='shape'):
        sunder_tear.Asset(sheet, soft=True, fields={'tension': np.ones((31, 31))})


@pytest.mark.parametrize('places, strength, error, text', [
    ([place_at(0.1, 0.5)], 0.5, 'invalid_argument', 'perforation 0 has 1 places'),
    ([], 0.5, 'invalid_argument', 'perforation 0 has 0 places'),
    ([place_at(0.1, 0.5), (0, 10**6, (1, 0, 0))], 0.5, 'index_out_of_range', 'place 1: .*has no triangle 1000000'),
    ([place_at(0.1, 0.5), (0, 0, (1, 1, 0))], 0.5, 'invalid_argument', 'place 1: the barycentrics'),
    ([place_at(0.1, 0.5), place_at(0.9, 0.5)], 2.0, 'invalid_argument', 'strength of perforation 0 is 2'),
])
def test_perforations_that_are_none_are_refused(sheet, places, strength, error, text):
    with pytest.raises(sunder_tear.SunderError, match=text) as caught:
        sunder_tear.Asset(sheet, soft=True, perforations=[(places, strength)])
    assert caught.value.name == error


def test_a_place_has_three_numbers(sheet):
    with pytest.raises(ValueError):
        sunder_tear.Asset(sheet, soft=True, perforations=[([(0, 0, (1, 0)), (0, 1, (1, 0, 0))], 0.5)])


def test_a_painted_field_is_an_attribute_of_files(sheet):
    values = np.linspace(0.5, 2, 961).astype(np.float32)
    painted = sheet.with_attribute('_STIFFNESS', np.ones(961)).with_attribute('_STIFFNESS', values)
    read = sunder_tear.Character.load(painted.save())
    np.testing.assert_array_equal(read.meshes[0].attributes['_STIFFNESS'][:, 0], values)
    again = sunder_tear.Character.load(read.with_attribute('_TENSION', values).save())  # of one that has a file
    assert sorted(again.meshes[0].attributes) == ['_STIFFNESS', '_TENSION']
    assert '_STIFFNESS' not in sheet.meshes[0].attributes


@pytest.mark.parametrize('name, values, mesh, error', [
    ('STIFFNESS', np.ones(961), 0, 'invalid_argument'),
    ('_STIFFNESS', np.ones(960), 0, 'size_mismatch'),
    ('_STIFFNESS', np.full(961, np.inf), 0, 'non_finite_value'),
    ('_STIFFNESS', np.ones(961), 1, 'index_out_of_range'),
])
def test_attributes_that_do_not_fit_are_refused(sheet, name, values, mesh, error):
    with pytest.raises(sunder_tear.SunderError) as caught:
        sheet.with_attribute(name, values, mesh)
    assert caught.value.name == error
