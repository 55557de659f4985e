"""A mesh object that an armature deforms, as a character of the library. Its model space is the space of the object."""
import dataclasses

import numpy as np

from .library import sunder_tear

STATIC = '(object)'  # the bone of vertices that no bone moves


class Unsupported(Exception):
    """The object cannot be torn; the text says why and what to do."""


@dataclasses.dataclass
class Rig:
    """A character and how it belongs to the object. Slots of its skin are deforming bones; the last one stands still."""
    character: object
    armature: object          # the object
    bones: list               # names, in the order of the skeleton
    slot_names: list          # per slot: the name of its bone, which its vertex group has too; None: the one that stands still
    vertices: np.ndarray      # per vertex of the character: that of the mesh
    triangle_loops: np.ndarray  # (triangles, 3): loops of the mesh
    triangle_polygon: np.ndarray
    keys: list                # names of the shape keys whose targets the character has, in order

    def pose(self, depsgraph, obj):
        """model_from_bone and morph weights at the present frame."""
        to_object = np.linalg.inv(_to_armature(obj, self.armature))
        pose = self.armature.evaluated_get(depsgraph).pose.bones
        # From the matrices that the modifier uses: they are rounded, and vertices are to be where it puts them.
        matrices = [to_object @ np.array(pose[name].matrix_channel, np.float64) @ _rest(self.armature, name) for name in self.bones[:-1]]
        matrices.append(np.eye(4))
        blocks = obj.evaluated_get(depsgraph).data.shape_keys or obj.data.shape_keys
        return np.array(matrices)[:, :3], [_weight(blocks.key_blocks[name]) for name in self.keys]


def _weight(block):
    return 0.0 if block.mute else block.value


def deforming_modifier(obj):
    """The armature modifier that the library can stand for."""
    if obj is None or obj.type != 'MESH':
        raise Unsupported('the active object is no mesh')
    if obj.mode != 'OBJECT':
        raise Unsupported('the object must be in Object Mode')
    active = [modifier for modifier in obj.modifiers if modifier.show_viewport]
    armatures = [modifier for modifier in active if modifier.type == 'ARMATURE' and modifier.object]
    if len(armatures) != 1:
        raise Unsupported(f"'{obj.name}' has {len(armatures)} armature modifiers; it must have one")
    modifier = armatures[0]
    before = [other.name for other in active[:active.index(modifier)]]
    if before:
        raise Unsupported(f'modifiers come before the armature: {", ".join(before)}; apply them or move them behind it')
    for flag, text in (('use_deform_preserve_volume', 'Preserve Volume is on; turn it off'),
                       ('use_bone_envelopes', 'Bone Envelopes is on; turn it off'),
                       ('use_multi_modifier', 'Multi Modifier is on; turn it off')):
        if getattr(modifier, flag):
            raise Unsupported(f"armature modifier '{modifier.name}': {text}")
    if not modifier.use_vertex_groups or modifier.vertex_group:
        raise Unsupported(f"armature modifier '{modifier.name}': it must use vertex groups, and no group as its mask")
    return modifier


def read_object(obj):
    """The rig of an object. Raises Unsupported."""
    modifier = deforming_modifier(obj)
    armature, mesh = modifier.object, obj.data
    bones = _in_order(armature.data.bones)
    curved = [bone.name for bone in bones if bone.bbone_segments > 1]
    if curved:
        raise Unsupported(f'bones bend: {", ".join(curved[:3])}; set their B-Bone segments to 1')
    mesh.calc_loop_triangles()
    triangles = mesh.loop_triangles
    loops = _read(triangles, 'loops', 3, np.int32)
    if not len(loops):
        raise Unsupported(f"'{obj.name}' has no faces")
    vertex_of_loop = _read(mesh.loops, 'vertex_index', 1, np.int32).ravel()
    vertices, corners = np.unique(vertex_of_loop[loops], return_inverse=True)
    to_armature = _to_armature(obj, armature)
    slots = [bone.name for bone in bones if bone.use_deform]
    first, slot, weight = _influences(obj, vertices, slots)
    inverse_binds = [np.linalg.inv(_rest(armature, name)) @ to_armature for name in slots] + [np.eye(4)]
    positions, targets = _shapes(mesh, vertices)
    names = [bone.name for bone in bones] + [STATIC]
    polygon = _read(triangles, 'polygon_index', 1, np.int32).ravel()
    body = sunder_tear.Mesh(
        name=mesh.name, skin=0, positions=positions, normals=None, tangents=None, uv_sets=[], color_sets=[], attributes={},
        first_influence=first, influence_slot=slot, influence_weight=weight, triangles=corners.reshape(-1, 3),
        triangle_submesh=np.zeros(len(loops)), submeshes=[(mesh.name, 0)], morph_targets=targets)
    skin = ([names.index(name) for name in slots] + [len(bones)], np.array(inverse_binds)[:, :3])
    character = sunder_tear.Character.from_arrays(_skeleton(bones, to_armature), [skin], [body], name=obj.name)
    return Rig(character, armature, names, slots + [None], vertices, loops, polygon, list(targets))


def _rest(armature, name):
    return np.array(armature.data.bones[name].matrix_local, np.float64)


def _to_armature(obj, armature):
    """From the space of the object to that of the armature. In double: Blender's matrices are of floats."""
    return np.linalg.inv(np.array(armature.matrix_world, np.float64)) @ np.array(obj.matrix_world, np.float64)


def _read(collection, attribute, width, dtype):
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, width)


def _in_order(bones):
    """Parents before their children."""
    ordered = [bone for bone in bones if bone.parent is None]
    for bone in ordered:
        ordered.extend(bone.children)
    return ordered


def _skeleton(bones, to_armature):
    from mathutils import Matrix
    number = {bone.name: i for i, bone in enumerate(bones)}
    to_object = Matrix(np.linalg.inv(to_armature))
    skeleton = []
    for bone in bones:
        parent = bone.parent
        rest = parent.matrix_local.inverted() @ bone.matrix_local if parent else to_object @ bone.matrix_local
        translation, rotation, scale = rest.decompose()
        skeleton.append(sunder_tear.Bone(bone.name, number[parent.name] if parent else None,
                                         (tuple(translation), (rotation.x, rotation.y, rotation.z, rotation.w), tuple(scale))))
    skeleton.append(sunder_tear.Bone(STATIC, None, ((0, 0, 0), (0, 0, 0, 1), (1, 1, 1))))
    return skeleton


def _influences(obj, vertices, slots):
    """Weights as the armature modifier uses them: those of deforming bones, divided by their sum; without any, the vertex stands still."""
    slot_of_group = {obj.vertex_groups[name].index: i for i, name in enumerate(slots) if name in obj.vertex_groups}
    first, slot, weight = [0], [], []
    for vertex in vertices:
        rows = [(group.weight, slot_of_group[group.group]) for group in obj.data.vertices[int(vertex)].groups
                if group.weight > 0 and group.group in slot_of_group]
        total = sum(row[0] for row in rows)
        if total <= 1e-4:  # as the modifier does
            rows, total = [(1.0, len(slots))], 1.0
        for value, index in sorted(rows, key=lambda row: -row[0]):
            slot.append(index)
            weight.append(value / total)
        first.append(len(slot))
    weight = np.array(weight, np.float32)
    is_seen = weight > 0  # a weight that a division took below the least float
    kept = np.concatenate([[0], np.cumsum(is_seen)])
    return kept[np.array(first)], np.array(slot)[is_seen], weight[is_seen]


def _shapes(mesh, vertices):
    """Positions of the basis, and the displacements of the shape keys that may act."""
    if mesh.shape_keys is None:
        return _read(mesh.vertices, 'co', 3, np.float32)[vertices], {}
    keys = mesh.shape_keys
    if not keys.use_relative:
        raise Unsupported('the shape keys are absolute; only relative ones are supported')
    place_of = {block.name: _read(block.data, 'co', 3, np.float32) for block in keys.key_blocks}
    targets = {}
    for block in keys.key_blocks:
        if block == keys.reference_key:
            continue
        deltas = place_of[block.name] - place_of[block.relative_key.name]
        if block.vertex_group:
            raise Unsupported(f"shape key '{block.name}' is limited to a vertex group; apply that first")
        targets[block.name] = deltas[vertices]
    return place_of[keys.reference_key.name][vertices], targets
