"""Tests of the Blender add-on, run in Blender without a window:

blender -b --factory-startup --python-exit-code 1 --python addon_test.py -- ADD_ON.zip MODEL.glb ...

The models, and those of ../shared if it is there, are torn, cut and drilled in the middle of a clip; then Blender's armature
modifier and the library must pose them alike, in ten frames, and what the tear did not meet must have kept all that it has.
"""
import pathlib
import sys
import tempfile
import traceback
import zipfile

ADD_ON, *MODELS = sys.argv[sys.argv.index('--') + 1:]
MODELS += sorted(map(str, (pathlib.Path(__file__).resolve().parents[4] / 'shared/models/rigged').glob('*.glb')))
FOLDER = tempfile.TemporaryDirectory()
zipfile.ZipFile(ADD_ON).extractall(FOLDER.name)
sys.path.insert(0, FOLDER.name)

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from mathutils import Matrix, Vector  # noqa: E402

import sunder_blender  # noqa: E402
from sunder_blender.library import sunder_tear  # noqa: E402
from sunder_blender.read_object import read_object  # noqa: E402

np.bool = bool  # Debian's importer of glTF uses a name that Debian's numpy has no more


def load(model):
    """An empty scene with one model; its object with the most faces that an armature deforms."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=model)
    bodies = [obj for obj in bpy.context.scene.objects if obj.type == 'MESH' and any(m.type == 'ARMATURE' for m in obj.modifiers)]
    body = max(bodies, key=lambda obj: len(obj.data.polygons))
    bpy.ops.object.select_all(action='DESELECT')
    bpy.context.view_layer.objects.active = body
    body.select_set(True)
    bpy.context.scene.frame_set(7)
    return body


def read(collection, attribute, width=1, dtype=np.float32):
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, width)


def evaluated(body):
    """Positions as Blender poses them, in the space of the object."""
    mesh = body.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return read(mesh.vertices, 'co', 3)


def size_of(body):
    return float(np.linalg.norm(np.ptp(evaluated(body), axis=0)))


def posed_by_library(body):
    """The same by the library, of the mesh as it is now."""
    rig = read_object(body)
    scene = sunder_tear.Scene(threads=1)
    instance = scene.spawn(rig.character)
    instance.set_pose(*rig.pose(bpy.context.evaluated_depsgraph_get(), body))
    scene.update()
    return rig.vertices, instance.posed(0).positions


def expect_poses_alike(body):
    """In ten frames, within 1e-5 of the size, and what Blender rounds: its modifier adds floats of the size of bind positions."""
    size = size_of(body)
    tolerance = 1e-5 + 16 * 2 ** -24 * float(np.abs(read(body.data.vertices, 'co', 3)).max()) / size
    for frame in range(0, 40, 4):
        bpy.context.scene.frame_set(frame)
        vertices, posed = posed_by_library(body)
        worst = np.abs(evaluated(body)[vertices] - posed).max()
        assert worst <= tolerance * size, f'frame {frame}: {worst / size:.2e} of the size apart'
    bpy.context.scene.frame_set(7)


def annotate(body, count=9):
    """A stroke over the surface, in the middle of what is seen from the front, in the pose of the frame."""
    places = evaluated(body) @ np.array(body.matrix_world.to_3x3()).T + np.array(body.matrix_world.translation)
    low, high = places.min(axis=0), places.max(axis=0)
    middle = places[np.abs(places - (low + high) / 2).sum(axis=1).argmin()]
    reach = float(0.08 * np.linalg.norm(high - low))
    data = bpy.data.grease_pencils.new('Annotations')
    bpy.context.scene.grease_pencil = data
    stroke = data.layers.new('Blade').frames.new(7).strokes.new()
    stroke.points.add(count)
    tree = body.evaluated_get(bpy.context.evaluated_depsgraph_get())
    for point, step in zip(stroke.points, np.linspace(-1, 1, count)):
        wanted = Vector(middle + reach * step * np.array([0.3, 0, 1]))
        _, near, _, _ = tree.closest_point_on_mesh(body.matrix_world.inverted() @ wanted)
        point.co = body.matrix_world @ near
    bpy.context.scene.frame_set(7)
    return reach


def place_of_annotation():
    """The middle of the annotation, in world space."""
    return Vector(bpy.context.scene.grease_pencil.layers[0].frames[0].strokes[0].points[4].co)


def snapshot(body):
    """What a face has, by the positions of its corners: materials, flags, UV maps, colours; and what edges and vertices have."""
    mesh = body.data
    co, loops = read(mesh.vertices, 'co', 3), read(mesh.loops, 'vertex_index', 1, np.int32).ravel()
    uvs = [read(layer.data, 'uv', 2) for layer in mesh.uv_layers]
    colors = [read(layer.data, 'color', 4) for layer in mesh.color_attributes if layer.domain == 'CORNER']
    faces = {}
    for polygon in mesh.polygons:
        span = slice(polygon.loop_start, polygon.loop_start + polygon.loop_total)
        corners = loops[span]
        key = tuple(map(tuple, co[corners]))
        faces.setdefault(key, []).append((polygon.material_index, polygon.use_smooth, [uv[span].tolist() for uv in uvs],
                                          [color[span].tolist() for color in colors], [weights(body, v) for v in corners],
                                          [[block.data[v].co[:] for v in corners] for block in shape_blocks(body)]))
    return faces


def shape_blocks(body):
    return body.data.shape_keys.key_blocks if body.data.shape_keys else []


def weights(body, vertex):
    return sorted((group.group, round(group.weight, 6)) for group in body.data.vertices[vertex].groups)


def area(body):
    """Of the mesh and, per UV map, of its image."""
    mesh = body.data
    mesh.calc_loop_triangles()
    loops = read(mesh.loop_triangles, 'loops', 3, np.int32)
    corners = read(mesh.vertices, 'co', 3)[read(mesh.loops, 'vertex_index', 1, np.int32).ravel()[loops]].astype(float)
    areas = [np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2]
    for layer in mesh.uv_layers:
        at = read(layer.data, 'uv', 2)[loops].astype(float)
        a, b = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
        areas.append(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2)
    return np.array(areas)


def expect_kept(before, after, least_share=0.5):
    """Faces that stand where they stood have what they had."""
    common = before.keys() & after.keys()
    assert len(common) >= least_share * len(before), f'{len(common)} of {len(before)} faces stayed'
    for key in common:
        assert before[key] == after[key], (key, before[key], after[key])


def border_edges(body):
    count = {}
    for polygon in body.data.polygons:
        for edge in polygon.edge_keys:
            count[edge] = count.get(edge, 0) + 1
    return sum(n == 1 for n in count.values()), sum(n > 2 for n in count.values())


def test_poses_of_the_source(model):
    expect_poses_alike(load(model))


def test_tear(model):
    body = load(model)
    reach = annotate(body)
    before, areas, (border, crowded) = snapshot(body), area(body), border_edges(body)
    count = len(body.data.vertices)
    assert bpy.ops.object.sunder_tear(depth=0.2 * reach) == {'FINISHED'}
    assert len(body.data.vertices) > count
    body.data.validate(verbose=True)
    assert len(body.data.vertices) > count, 'the mesh is valid as it is'
    np.testing.assert_allclose(area(body), areas, rtol=1e-4, atol=1e-9)
    expect_kept(before, snapshot(body))
    after_border, after_crowded = border_edges(body)
    assert after_border > border and after_crowded == crowded
    expect_poses_alike(body)


def linear(places, *axes):
    """Numbers that vary linearly over space, so that interpolation anywhere on a face gives them again."""
    return np.asarray(places, np.float64) @ np.array(axes, np.float64).T


UV, COLOUR, STIFF, KEY = [(1, 0, 0.5), (0, 0.5, 1)], [(0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1), (0.05, 0.05, 0)], [(0.3, 0.2, 0.1)], \
    [(0.1, 0, 0.02), (0, 0.1, 0), (0.03, 0, 0.1)]


def decorate(body):
    """Gives a mesh all that one can have, as linear functions of the position, and makes every edge a seam."""
    mesh = body.data
    co = read(mesh.vertices, 'co', 3).astype(float)
    co /= np.abs(co).max()
    corners = co[read(mesh.loops, 'vertex_index', 1, np.int32).ravel()]
    mesh.uv_layers.new(name='linear').data.foreach_set('uv', linear(corners, *UV).ravel())
    mesh.color_attributes.new('colour', 'FLOAT_COLOR', 'CORNER').data.foreach_set('color', linear(corners, *COLOUR).ravel())
    mesh.attributes.new('stiff', 'FLOAT', 'POINT').data.foreach_set('value', linear(co, *STIFF).ravel())
    group = body.vertex_groups.new(name='painted')
    for vertex, weight in enumerate(0.5 + 0.2 * co[:, 2]):
        group.add([vertex], weight, 'REPLACE')
    if mesh.shape_keys is None:
        body.shape_key_add(name='Basis')
    size = np.abs(read(mesh.vertices, 'co', 3)).max()
    key = body.shape_key_add(name='linear')
    key.data.foreach_set('co', (size * (co + linear(co, *KEY))).ravel())
    key.value = 0.3
    mesh.edges.foreach_set('use_seam', [True] * len(mesh.edges))
    return size


def seam_length(mesh):
    return sum((mesh.vertices[edge.vertices[0]].co - mesh.vertices[edge.vertices[1]].co).length for edge in mesh.edges if edge.use_seam)


def corner_normals(mesh):
    """Place and normal of each corner."""
    mesh.calc_normals_split()
    places = read(mesh.vertices, 'co', 3)[read(mesh.loops, 'vertex_index', 1, np.int32).ravel()]
    return zip(map(tuple, places.tolist()), map(tuple, read(mesh.loops, 'normal', 3).tolist()))


def test_all_that_a_mesh_has_is_carried(model):
    body = load(model)
    size = decorate(body)
    reach = annotate(body)
    old = {}
    for place, normal in corner_normals(body.data):
        old.setdefault(place, set()).add(normal)
    has_normals, seams = body.data.has_custom_normals, seam_length(body.data)
    count = len(body.data.vertices)
    assert bpy.ops.object.sunder_tear(depth=0.2 * reach) == {'FINISHED'}
    mesh = body.data
    assert len(mesh.vertices) > count
    co = read(mesh.vertices, 'co', 3).astype(float) / size
    corners = co[read(mesh.loops, 'vertex_index', 1, np.int32).ravel()]
    close = {'rtol': 0, 'atol': 2e-6}
    np.testing.assert_allclose(read(mesh.uv_layers['linear'].data, 'uv', 2), linear(corners, *UV), **close)
    np.testing.assert_allclose(read(mesh.color_attributes['colour'].data, 'color', 4), linear(corners, *COLOUR), **close)
    np.testing.assert_allclose(read(mesh.attributes['stiff'].data, 'value'), linear(co, *STIFF), **close)
    key = mesh.shape_keys.key_blocks['linear']
    np.testing.assert_allclose(read(key.data, 'co', 3) / size, co + linear(co, *KEY), **close)
    group = body.vertex_groups['painted'].index
    painted = [next(entry.weight for entry in vertex.groups if entry.group == group) for vertex in mesh.vertices]
    np.testing.assert_allclose(painted, 0.5 + 0.2 * co[:, 2], **close)
    assert abs(seam_length(mesh) - seams) < 1e-4 * seams, f'{seam_length(mesh)} m of seams, {seams} before'
    assert mesh.has_custom_normals == has_normals
    if has_normals:  # Blender does not hold all of them, even if the same are set again in a mesh that nothing changed
        turned = [place for place, normal in corner_normals(mesh)
                  if place in old and max(Vector(normal).dot(Vector(other)) for other in old[place]) < 0.999]
        assert len(turned) <= 0.005 * len(mesh.loops), f'{len(turned)} normals turned, at {turned[:3]}'
    expect_poses_alike(body)


def test_undo_and_redo(model):
    name = load(model).name
    reach = annotate(bpy.data.objects[name])
    count = len(bpy.data.objects[name].data.vertices)
    bpy.ops.ed.undo_push(message='before')
    assert bpy.ops.object.sunder_tear(depth=0.2 * reach) == {'FINISHED'}
    bpy.ops.ed.undo_push(message='after')
    torn = len(bpy.data.objects[name].data.vertices)
    bpy.ops.ed.undo()
    assert len(bpy.data.objects[name].data.vertices) == count < torn
    bpy.ops.ed.redo()
    assert len(bpy.data.objects[name].data.vertices) == torn


def test_walls_have_a_material_of_their_own(model):
    body = load(model)
    reach = annotate(body)
    slots = len(body.data.materials)
    assert bpy.ops.object.sunder_tear(depth=0.2 * reach, width=0.05 * reach, wall_depth=0.1 * reach) == {'FINISHED'}
    assert [material.name for material in body.data.materials][slots:] == ['Wound']
    assert sum(polygon.material_index == slots for polygon in body.data.polygons) > 4
    expect_poses_alike(body)


def test_cut_by_the_cursor(model):
    body = load(model)
    annotate(body)
    bpy.context.scene.cursor.matrix = Matrix.Translation(place_of_annotation())
    before = snapshot(body)
    assert bpy.ops.object.sunder_cut(caps=True) == {'FINISHED'}
    expect_kept(before, snapshot(body), 0.3)
    expect_poses_alike(body)


def test_cut_across_a_bone(model):
    bones = [bone.name for bone in read_object(load(model)).armature.data.bones]
    for name in bones[:12]:
        body = load(model)
        before = snapshot(body)
        if bpy.ops.object.sunder_cut(bone=name, share=0.5) == {'FINISHED'}:
            expect_kept(before, snapshot(body), 0.3)
            return expect_poses_alike(body)
    raise AssertionError('no bone was cut')


def test_drill_at_the_cursor(model):
    body = load(model)
    reach = annotate(body)
    point = place_of_annotation()
    local = body.matrix_world.inverted() @ point
    _, _, normal, _ = body.evaluated_get(bpy.context.evaluated_depsgraph_get()).closest_point_on_mesh(local)
    out = (body.matrix_world.to_3x3() @ normal).normalized()
    turn = out.to_track_quat('Z', 'Y').to_matrix().to_4x4()
    bpy.context.scene.cursor.matrix = Matrix.Translation(point + 0.3 * reach * out) @ turn
    before = snapshot(body)
    assert bpy.ops.object.sunder_drill(radius=0.15 * reach, depth=0.6 * reach) == {'FINISHED'}
    expect_kept(before, snapshot(body))
    expect_poses_alike(body)


def expect_refused(text, operator=None, **options):
    try:
        result = (operator or bpy.ops.object.sunder_cut)(**options)
    except RuntimeError as error:  # how Blender hands on a report of an error
        assert text in str(error), str(error)
        return
    raise AssertionError(f'{result}; expected a refusal with {text!r}')


def test_refusals_change_nothing(model):
    body = load(model)
    modifier = next(modifier for modifier in body.modifiers if modifier.type == 'ARMATURE')
    before = snapshot(body)
    expect_refused('no visible stroke', bpy.ops.object.sunder_tear)
    expect_refused("has no bone 'nobody'", bone='nobody')
    modifier.use_deform_preserve_volume = True
    expect_refused('Preserve Volume')
    modifier.use_deform_preserve_volume = False
    mirror = body.modifiers.new('Twin', 'MIRROR')
    bpy.ops.object.modifier_move_to_index(modifier='Twin', index=0)
    expect_refused('Twin')
    body.modifiers.remove(mirror)
    modifier.show_viewport = False
    expect_refused('0 armature modifiers')
    modifier.show_viewport = True
    bpy.context.scene.cursor.location = (1e4, 1e4, 1e4)
    assert bpy.ops.object.sunder_cut() == {'CANCELLED'}, 'nothing is met'
    assert snapshot(body) == before
    assert not [material for material in body.data.materials if material and material.name == 'Wound']


def main():
    sunder_blender.register()
    tests = [(name, test) for name, test in globals().items() if name.startswith('test_')]
    failures = 0
    for model in MODELS:
        for name, test in tests:
            try:
                test(model)
                print(f'ok      {name}({pathlib.Path(model).name})', flush=True)
            except Exception:
                failures += 1
                print(f'FAILED  {name}({pathlib.Path(model).name})', flush=True)
                traceback.print_exc()
    print(f'{failures} of {len(tests) * len(MODELS)} tests failed')
    if failures:
        raise SystemExit(1)


main()
