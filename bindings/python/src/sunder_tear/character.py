"""Rigged models: meshes, skins, a skeleton and clips."""
from __future__ import annotations

import ctypes
import os
import stat
from dataclasses import dataclass, field
from typing import Optional, Union

import numpy as np

from .abi import abi
from .arrays import copy, matrices, numbers, pointer_to
from .character_arrays import CharacterStructs
from .errors import SunderError
from .picture import colours_of, draw, png

_INTERPOLATIONS = ('linear', 'step', 'cubic')
_TARGETS = ('translation', 'rotation', 'scale', 'morph_weights')
_NOTES = ('information', 'repaired', 'dropped', 'warning')


@dataclass(frozen=True)
class Mesh:
    """A mesh in bind space, copied. n vertices, m triangles.

    positions, normals: (n, 3) or None; tangents: (n, 4) or None; uv_sets: each (n, 2); color_sets: each (n, 4), linear;
    triangles: (m, 3), of which one whose corners are the same vertex was removed; triangle_submesh: (m,).
    The influences of vertex v are first_influence[v] to first_influence[v + 1] of influence_slot and influence_weight;
    a slot is an index in the bones of the mesh's skin.
    """
    name: str
    skin: int
    positions: np.ndarray
    normals: Optional[np.ndarray]
    tangents: Optional[np.ndarray]
    uv_sets: list
    color_sets: list
    attributes: dict
    first_influence: np.ndarray
    influence_slot: np.ndarray
    influence_weight: np.ndarray
    triangles: np.ndarray
    triangle_submesh: np.ndarray
    submeshes: list = field(default_factory=list)
    morph_targets: dict = field(default_factory=dict)
    labels: set = field(default_factory=set)  #: names of attributes that are copied from a vertex, not interpolated

    def weights(self, slot_count: int) -> np.ndarray:
        """Weights as a dense array, (n, slot_count)."""
        dense = np.zeros((len(self.positions), slot_count), np.float32)
        rows = np.repeat(np.arange(len(self.positions)), np.diff(self.first_influence))
        dense[rows, self.influence_slot] = self.influence_weight
        return dense

    def _repr_png_(self) -> bytes:
        """The mesh in bind space, as notebooks show it."""
        return png(draw([(self.positions, self.triangles, colours_of(self))]))


def mesh_of(raw) -> Mesh:
    """A copy of a sunder_mesh."""
    n, m = raw.vertex_count, raw.triangle_count
    first = copy(raw.first_influence, n + 1)
    count = int(first[-1]) if n else 0
    pairs = ctypes.cast(raw.influences, ctypes.POINTER(ctypes.c_uint32))
    words = copy(pairs, count, 2) if count else np.zeros((0, 2), np.uint32)
    return Mesh(
        name=(raw.name or b'').decode(), skin=raw.skin, positions=copy(raw.positions, n, 3), normals=copy(raw.normals, n, 3),
        tangents=copy(raw.tangents, n, 4), uv_sets=[copy(raw.uv_sets[i], n, 2) for i in range(raw.uv_set_count)],
        color_sets=[copy(raw.color_sets[i], n, 4) for i in range(raw.color_set_count)],
        attributes={raw.attributes[i].name.decode(): copy(raw.attributes[i].values, n, raw.attributes[i].components)
                    for i in range(raw.attribute_count)},
        first_influence=first, influence_slot=words[:, 0].copy(), influence_weight=words[:, 1].copy().view(np.float32),
        triangles=copy(raw.triangles, m, 3), triangle_submesh=copy(raw.triangle_submesh, m),
        submeshes=[((raw.submeshes[i].name or b'').decode(), raw.submeshes[i].material) for i in range(raw.submesh_count)],
        morph_targets={(raw.morph_targets[i].name or str(i).encode()).decode(): copy(raw.morph_targets[i].position_deltas, n, 3)
                       for i in range(raw.morph_target_count)},
        labels={raw.attributes[i].name.decode() for i in range(raw.attribute_count) if raw.attributes[i].is_label})


@dataclass(frozen=True)
class Bone:
    """A bone: its parent is an earlier bone, or None; rest: translation (3), rotation x y z w, scale (3)."""
    name: str
    parent: Optional[int]
    rest: tuple


@dataclass(frozen=True)
class Clip:
    name: str
    duration: float  #: seconds
    channels: list  #: dicts: target, index, interpolation, times, values


@dataclass(frozen=True)
class Note:
    """What loading repaired, dropped or tells."""
    kind: str
    place: str
    text: str
    count: int


def _read_file(path, most_bytes: int) -> bytes:
    """The bytes of a regular file. A name among models may lead to a device or a pipe, which would not end."""
    # Without O_NONBLOCK, to open a pipe waits for a writer.
    descriptor = os.open(path, os.O_RDONLY | getattr(os, 'O_NONBLOCK', 0) | getattr(os, 'O_BINARY', 0))
    status = os.fstat(descriptor)
    if not stat.S_ISREG(status.st_mode):
        os.close(descriptor)
        raise SunderError(abi.constant('FILE_UNREADABLE'), 'file_unreadable', f'{path}: not a regular file')
    with open(descriptor, 'rb') as file:
        if status.st_size > most_bytes:
            raise SunderError(abi.constant('LIMIT_EXCEEDED'), 'limit_exceeded', f'{path}: {status.st_size} bytes exceed {most_bytes}')
        return file.read(status.st_size)


class Character:
    """A rigged model. Immutable; made by load() or from_arrays()."""

    def __init__(self, handle: int):
        self._handle = handle
        self._data = abi.new('character_data')
        abi.call('get_character', handle, ctypes.byref(self._data))

    def __del__(self):
        if getattr(self, '_handle', 0):
            abi.plain('destroy_character', self._handle)

    @staticmethod
    def load(model: Union[str, os.PathLike, bytes], strict: bool = False) -> Character:
        """Reads a GLB or glTF from a file or from bytes. Other files to which it refers are not read: use GLB.

        strict: raises SunderError for what would otherwise be repaired or dropped (`notes`).
        """
        options = abi.new('load_options', is_strict=int(strict))
        if isinstance(model, (bytes, bytearray, memoryview)):
            model = bytes(model)
        else:
            model = _read_file(model, options.maximum_bytes)
        return Character(abi.output('load_glb', model, len(model), ctypes.byref(options)))

    @staticmethod
    def from_arrays(bones: list, skins: list, meshes: list, rest_morph_weights=None, name: str = '') -> Character:
        """A character of one's own arrays, which are copied: as `bones`, `skins` and `meshes` of another give them.
        rest_morph_weights: of the targets of all meshes, one mesh after the other; None: zeros. Raises ValueError for arrays of another
        shape, SunderError for what is no valid model (an index out of range, weights that do not sum to one)."""
        structs = CharacterStructs(name, bones, skins, meshes, rest_morph_weights)
        return Character(abi.output('create_character', ctypes.byref(structs.data)))

    def with_attribute(self, name: str, values, mesh: int = 0) -> Character:
        """A copy in which a mesh has an attribute of one number per vertex, in place of one of that name, which begins with "_".
        Files of it have it too."""
        values = numbers(values, np.float32, -1)
        return Character(abi.output('add_attribute', self._handle, mesh, name.encode(), pointer_to(values, ctypes.c_float), len(values)))

    @property
    def name(self) -> str:
        return (self._data.name or b'').decode()

    @property
    def bones(self) -> list:
        result = []
        for i in range(self._data.bone_count):
            bone = self._data.bones[i]
            parent = None if bone.parent == abi.constant('NONE') else bone.parent
            result.append(Bone(bone.name.decode(), parent, (tuple(bone.rest.translation), tuple(bone.rest.rotation), tuple(bone.rest.scale))))
        return result

    @property
    def rest_morph_weights(self) -> np.ndarray:
        """Of the targets of all meshes."""
        return copy(self._data.rest_morph_weights, self._data.morph_weight_count) if self._data.morph_weight_count else np.zeros(0, np.float32)

    @property
    def meshes(self) -> list:
        return [mesh_of(self._data.meshes[i]) for i in range(self._data.mesh_count)]

    @property
    def mesh_count(self) -> int:
        return self._data.mesh_count

    @property
    def skins(self) -> list:
        """Per skin: the bone of each slot, and the inverse bind matrices, (slots, 3, 4)."""
        result = []
        for i in range(self._data.skin_count):
            skin = self._data.skins[i]
            bind = copy(skin.bone_from_bind, skin.slot_count, 12)
            result.append((copy(skin.bones, skin.slot_count), matrices(bind)))
        return result

    @property
    def clips(self) -> list:
        result = []
        for i in range(self._data.clip_count):
            clip = self._data.clips[i]
            channels = []
            for j in range(clip.channel_count):
                channel = clip.channels[j]
                cubic = channel.interpolation == abi.constant('INTERPOLATE_CUBIC')
                shape = (channel.key_count, 3, channel.width) if cubic else (channel.key_count, channel.width)
                channels.append({
                    'target': _TARGETS[channel.target], 'index': channel.index, 'interpolation': _INTERPOLATIONS[channel.interpolation],
                    'times': copy(channel.times, channel.key_count), 'values': copy(channel.values, *shape)})
            result.append(Clip((clip.name or b'').decode(), clip.duration, channels))
        return result

    @property
    def notes(self) -> list:
        notes, count = ctypes.POINTER(abi.type('note'))(), ctypes.c_uint32()
        abi.call('get_notes', self._handle, ctypes.byref(notes), ctypes.byref(count))
        return [Note(_NOTES[notes[i].kind], notes[i].place.decode(), notes[i].text.decode(), notes[i].count) for i in range(count.value)]

    def find_bone(self, name: str) -> int:
        return abi.output('find_bone', self._handle, name.encode())

    def find_clip(self, name: str) -> int:
        return abi.output('find_clip', self._handle, name.encode())

    def pose(self, clip: Union[str, int, None] = None, seconds: float = 0.0) -> np.ndarray:
        """model_from_bone of each bone in a clip at a time, or at rest: (bones, 3, 4)."""
        count = self._data.bone_count
        transforms = None
        if clip is not None:
            transforms = (abi.type('transform') * count)()
            abi.call('sample_clip', self._handle, self.clip_index(clip), seconds, transforms, None)
        flat = np.empty(12 * count)
        abi.call('compute_matrices', self._handle, transforms, flat.ctypes.data_as(ctypes.POINTER(ctypes.c_double)))
        return matrices(flat)

    def ragdoll(self, model_from_bone=None, **options):
        """Rigid bodies and joints for a physics engine, in a pose, (bones, 3, 4), by default that of rest. options: maximum_bodies,
        least_share, density, limits (a list of BoneLimit), morph_weights, and the other fields of sunder_ragdoll_options."""
        from .ragdoll import Ragdoll
        return Ragdoll(self, self.pose() if model_from_bone is None else model_from_bone, **options)

    def clip_index(self, clip: Union[str, int]) -> int:
        return self.find_clip(clip) if isinstance(clip, str) else clip

    def _repr_png_(self) -> bytes:
        """The character at rest, as notebooks show it."""
        from .scene import Scene
        instance = Scene(threads=1).spawn(self)
        instance.scene.update()
        return instance._repr_png_()

    def save(self, influences: Optional[int] = 0) -> bytes:
        """A GLB. influences: most per vertex, 4 or 8; 0: as many as the source has; None: all."""
        options = abi.new('save_options', maximum_influences=abi.constant('NONE') if influences is None else influences)
        return abi.take_bytes(abi.output('save_glb', self._handle, ctypes.byref(options)))


def material(name: str, **fields: float):
    """A preset of tissue ("skin", "fat", "muscle", "liver", "rubber", "foam", "cloth", "jelly") with other fields than its own."""
    found = abi.new('material')
    abi.call('find_material', name.encode(), ctypes.byref(found))
    for key, value in fields.items():
        if key not in dict(found._fields_):
            raise TypeError(f'a material has no field {key!r}; it has {", ".join(name for name, _ in found._fields_[2:])}')
        setattr(found, key, value)
    return found


_FIELDS = ('strength', 'toughness', 'stiffness', 'tension', 'thickness')


def _fields(fields, kept):
    made = (abi.type('tissue_field') * len(fields))()
    for raw, (key, values) in zip(made, fields.items()):
        mesh, name = key if isinstance(key, tuple) else (0, key)
        if name not in _FIELDS:
            raise ValueError(f'{name!r} is no field of tissue; there are {", ".join(_FIELDS)}')
        kept.append(numbers(values, np.float32, -1))
        raw.struct_size, raw.mesh, raw.field = ctypes.sizeof(raw), mesh, abi.constant(f'FIELD_{name.upper()}')
        raw.value_count, raw.values = len(kept[-1]), pointer_to(kept[-1], ctypes.c_float)
    return made


def _perforations(perforations, kept):
    made = (abi.type('perforation') * len(perforations))()
    for raw, (places, strength) in zip(made, perforations):
        kept.append((abi.type('surface_place') * len(places))())
        for place, (mesh, triangle, barycentric) in zip(kept[-1], places):
            place.mesh, place.triangle = mesh, triangle
            place.barycentric[:] = barycentric
        raw.struct_size, raw.place_count, raw.places = ctypes.sizeof(raw), len(places), kept[-1]
        raw.strength = strength
    return made


class Asset:
    """What instances of one character share. O(size of the character).

    soft: with tissue, of `materials` (of material(); the first is that of all particles). fields: factors per vertex of a mesh
    where the tissue differs, {'toughness': values} of mesh 0 or {(mesh, 'toughness'): values}, of strength, toughness, stiffness,
    tension, thickness. perforations: lines along which it is weaker, (places, strength); a place is (mesh, triangle,
    barycentric). Other options are fields of sunder_asset_options: has_normals, has_tangents, skinning, gravity, tension,
    particle_range, ...
    """

    def __init__(self, character: Character, *, soft: bool = False, materials=(), fields=None, perforations=(), **options):
        values = (abi.type('material') * len(materials))(*materials)
        raw = abi.new('asset_options', is_soft=int(soft), **options)
        if materials:
            raw.material_count, raw.materials = len(materials), values
        kept = []  # what the structs point to, until the call returns
        if fields:
            raw.field_count, raw.fields = len(fields), _fields(fields, kept)
        if perforations:
            raw.perforation_count, raw.perforations = len(perforations), _perforations(perforations, kept)
        self.character = character
        self._handle = abi.output('create_asset', character._handle, ctypes.byref(raw))

    def __del__(self):
        if getattr(self, '_handle', 0):
            abi.plain('destroy_asset', self._handle)
