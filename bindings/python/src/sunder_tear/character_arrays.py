"""A character's arrays as the structs of the C library."""
import ctypes

import numpy as np

from .abi import abi
from .arrays import numbers, pointer_to

_FLOATS, _INDICES = ctypes.c_float, ctypes.c_uint32


class CharacterStructs:
    """`data`: a sunder_character_data, valid as long as this object, which keeps what it points to. Raises ValueError for arrays of
    another shape."""

    def __init__(self, name, bones, skins, meshes, rest_morph_weights):
        self._kept = []
        self._targets = 0
        self.data = abi.new('character_data')
        self.data.name = name.encode()
        self._list(self.data, 'bone', 'bones', [self._bone(bone) for bone in bones])
        self._list(self.data, 'skin', 'skins', [self._skin(*skin) for skin in skins])
        self._list(self.data, 'mesh', 'meshes', [self._mesh(mesh) for mesh in meshes])
        rest = np.zeros(self._targets) if rest_morph_weights is None else rest_morph_weights
        self.data.rest_morph_weights = self._floats(rest, self._targets)
        self.data.morph_weight_count = self._targets

    def _list(self, owner, kind, field, values):
        array = self._keep((abi.type(kind) * max(len(values), 1))(*values))
        setattr(owner, field, array)
        setattr(owner, f'{kind}_count', len(values))

    def _keep(self, value):
        self._kept.append(value)
        return value

    def _array(self, values, dtype, kind, *shape):
        """A pointer; null for None."""
        return None if values is None else pointer_to(self._keep(numbers(values, dtype, *shape)), kind)

    def _floats(self, values, *shape):
        return self._array(values, np.float32, _FLOATS, *shape)

    def _indices(self, values, *shape):
        return self._array(values, np.uint32, _INDICES, *shape)

    def _pointers(self, arrays, *shape):
        pointers = [self._floats(array, *shape) for array in arrays]
        return self._keep((ctypes.POINTER(_FLOATS) * max(len(pointers), 1))(*pointers))

    @staticmethod
    def _bone(bone):
        parent = abi.constant('NONE') if bone.parent is None else bone.parent
        translation, rotation, scale = (numbers(part, np.float32, size) for part, size in zip(bone.rest, (3, 4, 3)))
        return abi.type('bone')(name=bone.name.encode(), parent=parent, rest=abi.type('transform')(
            (_FLOATS * 3)(*translation), (_FLOATS * 4)(*rotation), (_FLOATS * 3)(*scale)))

    def _skin(self, bones, bone_from_bind):
        columns = numbers(bone_from_bind, np.float32, len(bones), 3, 4).transpose(0, 2, 1).reshape(-1)
        return abi.type('skin')(bones=self._indices(bones, len(bones)), bone_from_bind=self._floats(columns, 12 * len(bones)),
                                slot_count=len(bones))

    def _mesh(self, mesh):
        n, m = len(mesh.positions), len(mesh.triangles)
        raw = abi.type('mesh')(
            name=mesh.name.encode(), skin=mesh.skin, vertex_count=n, triangle_count=m,
            positions=self._floats(mesh.positions, n, 3), normals=self._floats(mesh.normals, n, 3),
            tangents=self._floats(mesh.tangents, n, 4), uv_sets=self._pointers(mesh.uv_sets, n, 2), uv_set_count=len(mesh.uv_sets),
            color_sets=self._pointers(mesh.color_sets, n, 4), color_set_count=len(mesh.color_sets),
            triangles=self._indices(mesh.triangles, m, 3), triangle_submesh=self._indices(mesh.triangle_submesh, m),
            first_influence=self._indices(mesh.first_influence, n + 1), first_morph_weight=self._targets)
        count = int(mesh.first_influence[-1])
        influences = np.empty((count, 2), np.uint32)
        influences[:, 0] = numbers(mesh.influence_slot, np.uint32, count)
        influences[:, 1] = numbers(mesh.influence_weight, np.float32, count).view(np.uint32)
        raw.influences = ctypes.cast(self._indices(influences, count, 2), ctypes.POINTER(abi.type('influence')))
        self._list(raw, 'attribute', 'attributes', [
            abi.type('attribute')(name=name.encode(), values=self._floats(np.reshape(values, (n, -1)), n, -1),
                                  components=np.reshape(values, (n, -1)).shape[1], is_label=int(name in mesh.labels))
            for name, values in mesh.attributes.items()])
        self._list(raw, 'submesh', 'submeshes', [
            abi.type('submesh')(name=name.encode(), material=material) for name, material in mesh.submeshes])
        self._list(raw, 'morph_target', 'morph_targets', [
            abi.type('morph_target')(name=name.encode(), position_deltas=self._floats(deltas, n, 3))
            for name, deltas in mesh.morph_targets.items()])
        self._targets += len(mesh.morph_targets)
        return raw
