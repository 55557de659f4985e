"""Scenes: instances that play, are torn, and move on."""
from __future__ import annotations

import contextlib
import ctypes
from dataclasses import dataclass
from typing import Iterator, Optional, Union

import numpy as np

from .abi import abi
from .arrays import copy, doubles, matrices, numbers, pointer_to, view
from .character import Asset, Character, Mesh, mesh_of
from .errors import StaleView, SunderError
from .picture import colours_of, draw, png
from .piece import Piece

_LAYERS = {'nearest': 'LAYERS_NEAREST', 'all': 'LAYERS_ALL'}
_POLICIES = {'barycentric': 'WEIGHTS_BARYCENTRIC', 'pose_exact': 'WEIGHTS_POSE_EXACT', 'refit': 'WEIGHTS_REFIT',
             'exact': 'WEIGHTS_EXACT', 'model': 'WEIGHTS_OF_MODEL'}
_CHANNELS = {'age': 'WOUND_AGE', 'depth': 'WOUND_DEPTH', 'stretch': 'WOUND_STRETCH'}
_MOTIONS = {'frozen': 'PIECE_FROZEN', 'animated': 'PIECE_ANIMATED', 'vanishes': 'PIECE_VANISHES'}
_MODES = {'loop': 'PLAY_LOOP', 'ping_pong': 'PLAY_PING_PONG', 'once': 'PLAY_ONCE'}
_KINDS = {'whole': 'LAYER_WHOLE', 'animated': 'LAYER_ANIMATED', 'additive': 'LAYER_ADDITIVE'}


def _choice(names, value, what):
    if value not in names:
        raise ValueError(f'{what} {value!r} is none of {", ".join(names)}')
    return abi.constant(names[value])


def _with_policy(options):
    if 'weight_policy' in options:
        options['weight_policy'] = _choice(_POLICIES, options['weight_policy'], 'weight_policy')
    return options


@dataclass(frozen=True)
class Result:
    """What an operation did. `runs` of torn surface: 0 if the blade missed. `advises_background`: it took long; use
    in_background for one like it."""
    runs: int
    segments_missed: int
    faces_crossed: int
    vertices_added: int
    triangles_added: int
    triangles_retired: int
    blocked: int
    caps: int
    open_sections: int
    separated_pieces: int
    length: float
    area_removed: float
    piece: Optional[Piece]
    advises_background: bool


class Command:
    """An operation that was submitted. The next update applies it, or a later one in the background."""

    def __init__(self):
        self._result = None
        self._error = None

    @property
    def is_done(self) -> bool:
        return self._result is not None or self._error is not None

    @property
    def result(self) -> Result:
        """Raises SunderError if the operation failed, which changed nothing, or if no update has applied it yet."""
        if self._error is not None:
            raise self._error
        if self._result is None:
            raise SunderError(abi.constant('NOT_FOUND'), 'not_found', 'the operation was not applied yet: call Scene.update()')
        return self._result


class Layer:
    """A clip that an instance plays."""

    def __init__(self, instance: Instance, handle: int):
        self._instance, self._handle = instance, handle

    def _call(self, name, *arguments):
        self._instance._call(name, self._handle, *arguments)

    def seek(self, seconds: float) -> None:
        self._call('seek_layer', seconds)

    def set_speed(self, speed: float) -> None:
        self._call('set_layer_speed', speed)

    def fade(self, weight: float, seconds: float) -> None:
        self._call('fade_layer', weight, seconds)

    def stop(self, fade_out: float = 0.0) -> None:
        self._call('stop_layer', fade_out)

    @property
    def time(self) -> float:
        return self._state().time

    @property
    def is_over(self) -> bool:
        return bool(self._state().is_over)

    def _state(self):
        state = abi.new('layer_state')
        self._call('get_layer', ctypes.byref(state))
        return state


@dataclass(frozen=True)
class PosedMesh:
    """A mesh as it is drawn: positions and normals (n, 3), tangents (n, 4) or None, in model space, and the triangles that are
    drawn, (m, 3). `epoch` names the state."""
    positions: np.ndarray
    normals: Optional[np.ndarray]
    tangents: Optional[np.ndarray]
    triangles: np.ndarray
    epoch: int


@dataclass(frozen=True)
class Contact:
    """Where a ray or a blade meets the drawn surface; docs/contact.md explains the fields."""
    place: tuple
    normal: tuple
    distance: float
    depth: float
    barycentric: tuple
    mesh: int
    triangle: int
    submesh: int
    material: Optional[int]
    bone: Optional[int]
    enters: bool


def _contact(raw) -> Contact:
    none = abi.constant('NONE')
    return Contact(tuple(raw.place), tuple(raw.normal), raw.distance, raw.depth, tuple(raw.barycentric), raw.mesh, raw.triangle,
                   raw.submesh, None if raw.material == none else raw.material, None if raw.bone == none else raw.bone,
                   bool(raw.enters))


@dataclass(frozen=True)
class ForceTearing:
    """What the tissue bears, and where it gave way. greatest_stretch: around moving tissue whose material has a
    strength; greatest_release: the energy, J/m, that the end of a tear would release by running on; length, place and
    direction: of the tear, if has_torn."""
    has_torn: bool
    is_from_tip: bool
    vertices_added: int
    greatest_stretch: float
    greatest_release: float
    length: float
    place: tuple
    direction: tuple


@dataclass(frozen=True)
class Thread:
    """A thread of a suture. left and right: the mesh and the vertex at which an end holds; None: it holds nothing any
    more. newtons: with which it pulled its lips together in the last update."""
    left: Optional[tuple]
    right: Optional[tuple]
    newtons: float
    is_broken: bool


@dataclass(frozen=True)
class Origins:
    """Where a torn mesh of n vertices, of which the source has s, and m triangles comes from; -1 is none.

    vertex_triangle (n - s,), vertex_barycentric (n - s, 3): of each vertex that operations made, the triangle of the source and its
    place there; -1: inside of a wall or cap. triangle (m,): the triangle of the source that each is a part of; -1: a wall or cap.
    points (m, 3): of the surface, at the corners: triangles that share two points share an edge; -1: the triangle was removed.
    """
    vertex_triangle: np.ndarray
    vertex_barycentric: np.ndarray
    triangle: np.ndarray
    points: np.ndarray


@dataclass(frozen=True)
class WoundMask:
    """distances: (height, width), metres along the surface from the nearest lip, at most the reach; negative where operations removed
    the skin. changed: rows and columns that may have changed since the last call, as two slices. The counts are of texels of stacked
    charts, and of triangles that the texture cannot show."""
    distances: np.ndarray
    changed: tuple
    overlapping_texels: int
    unpainted_triangles: int


class Instance:
    """A character in a scene; made by Scene.spawn(). Operations are submitted, and applied by the next Scene.update() in the pose
    that the instance then has. Places are in model space, in metres."""

    def __init__(self, scene: Scene, asset: Asset, handle: int):
        self.scene, self.asset = scene, asset
        self._handle = handle
        self._mask_widths = {}  # per mesh

    def _call(self, name, *arguments):
        self.scene._change()
        abi.call(name, self.scene._handle, self._handle, *arguments)

    def _output(self, name, *arguments, kind=ctypes.c_uint32):
        return abi.output(name, self.scene._handle, self._handle, *arguments, kind=kind)

    def _submit(self, name, *arguments) -> Command:
        self.scene._change()
        return self.scene._await(abi.output(f'submit_{name}', self.scene._handle, self._handle, *arguments, kind=ctypes.c_uint64))

    def destroy(self) -> None:
        self._call('destroy_instance')

    def prepare_to_tear(self) -> None:
        """Takes now the memory that the first operation would take."""
        self._call('prepare_to_tear')

    # Poses

    def play(self, clip: Union[str, int], *, time: float = 0.0, speed: float = 1.0, mode: str = 'loop', kind: str = 'whole',
             fade_in: float = 0.0, weight: float = 1.0, cross_fade: bool = False) -> Layer:
        """Plays a clip of the character. cross_fade: it fades in over all others and then ends them."""
        options = abi.new('layer_options', time=time, speed=speed, fade_in=fade_in, weight=weight,
                          mode=_choice(_MODES, mode, 'mode'), kind=_choice(_KINDS, kind, 'kind'))
        index = self.asset.character.clip_index(clip)
        self.scene._change()
        return Layer(self, self._output('cross_fade' if cross_fade else 'play', index, ctypes.byref(options), kind=ctypes.c_uint64))

    def stop(self) -> None:
        """Ends all that plays and holds the present pose."""
        self._call('stop')

    def set_pose(self, model_from_bone, morph_weights=None) -> None:
        """The pose of the next update: (bones, 3, 4). Ends what plays."""
        pose = doubles(model_from_bone, -1, 3, 4)
        flat = np.ascontiguousarray(pose.transpose(0, 2, 1))
        morph = None if morph_weights is None else numbers(morph_weights, np.float32, self.asset.character._data.morph_weight_count)
        self._call('set_matrices', pointer_to(flat), len(pose), None if morph is None else pointer_to(morph, ctypes.c_float))

    @property
    def pose(self) -> np.ndarray:
        """model_from_bone of the last update: (bones, 3, 4)."""
        pointer, count = ctypes.POINTER(ctypes.c_double)(), ctypes.c_uint32()
        abi.call('get_pose', self.scene._handle, self._handle, ctypes.byref(pointer), ctypes.byref(count))
        return matrices(copy(pointer, 12 * count.value))

    # Operations

    def tear(self, blades, *, layers: str = 'nearest', in_background: bool = False, **options) -> Command:
        """Tears along positions of a blade, (n, 2, 3): from outside the surface to how deep it reaches. layers: "nearest" or
        "all". Other options: width, wall_depth, lip_roll, wall_material, weight_policy, maximum_influences."""
        stroke = doubles(blades, -1, 2, 3)
        raw = self._tear_options(layers, options)
        return self._submit('tear', stroke.ctypes.data_as(ctypes.POINTER(abi.type('blade'))), len(stroke), ctypes.byref(raw),
                            int(in_background))

    def begin_stroke(self, blade, *, layers: str = 'nearest', **options) -> Command:
        """Begins a stroke over several frames, with one position of a blade, (2, 3)."""
        raw = self._tear_options(layers, options)
        return self._submit('begin_stroke', self._blade(blade), ctypes.byref(raw), None)

    def extend_stroke(self, blade, seconds: float = 0.0) -> Command:
        return self._submit('extend_stroke', self._blade(blade), seconds)

    def end_stroke(self) -> Command:
        return self._submit('end_stroke')

    def cancel_stroke(self) -> Command:
        return self._submit('cancel_stroke')

    def cut(self, point, normal, *, bone: Optional[str] = None, caps: bool = True, bounds=None, sections=None, first_hit=None,
            in_background: bool = False, **options) -> Command:
        """Cuts by a plane. bone: only what its branch moves. bounds: corners of a convex polygon, (n, 3). sections: only those
        nearest to these places, (n, 3). first_hit: an origin and a direction, (2, 3): only the section that this ray meets first.
        Other options: cap_material, weight_policy, maximum_influences."""
        raw = abi.new('cut', point=doubles(point, 3), normal=doubles(normal, 3), has_caps=int(caps), **_with_policy(options))
        kept = []
        for name, values in (('bound', bounds), ('section', sections)):
            if values is not None:
                kept.append(doubles(values, -1, 3))
                setattr(raw, f'{name}s', pointer_to(kept[-1]))
                setattr(raw, f'{name}_count', len(kept[-1]))
        if bone is not None:
            raw.bone = bone.encode()
        if first_hit is not None:
            ray = doubles(first_hit, 2, 3)
            raw.has_first_hit = 1
            raw.ray_origin[:], raw.ray_direction[:] = ray[0], ray[1]
        return self._submit('cut', ctypes.byref(raw), int(in_background))

    def drill(self, origin, direction, radius: float, depth: float, *, wall: bool = True, in_background: bool = False,
              **options) -> Command:
        """Bores a round hole. Other options: chord_tolerance, wall_material, weight_policy, maximum_influences."""
        raw = abi.new('bore', origin=doubles(origin, 3), direction=doubles(direction, 3), radius=radius, depth=depth,
                      has_wall=int(wall), **_with_policy(options))
        return self._submit('drill', ctypes.byref(raw), int(in_background))

    def weld(self, places=None, reach: float = 0.0, *, in_background: bool = False) -> Command:
        """Closes wounds whose lips lie on one another: those of tears without width and of cuts. places: only the wound nearest
        to each of them, (n, 3), and no farther along it than `reach`; 0: to its ends."""
        return self._close('weld', abi.new('weld', reach=reach), places, in_background)

    def suture(self, places=None, reach: float = 0.0, *, spacing: float = 0.01, stiffness: float = 1e4, tension: float = 0.0,
               strength: float = 0.0, in_background: bool = False) -> Command:
        """Ties threads between lips that lie on one another. places, reach: as for weld(). spacing: metres along the wound;
        stiffness: N/m; tension: newtons with which a thread was tied; strength: at which it breaks, 0: never."""
        raw = abi.new('suture', reach=reach, spacing=spacing, stiffness=stiffness, tension=tension, strength=strength)
        return self._close('suture', raw, places, in_background)

    def _close(self, name, raw, places, in_background) -> Command:
        if places is not None:
            kept = doubles(places, -1, 3)
            if len(kept) == 0:
                raise ValueError('places are empty; None means all wounds')
            raw.places, raw.place_count = pointer_to(kept), len(kept)
        return self._submit(name, ctypes.byref(raw), int(in_background))

    def detach(self, point, *, bone: Optional[str] = None, motion: str = 'frozen', density: float = 1000.0, **options) -> Command:
        """Takes off the connected piece nearest to a place; `result.piece` has its mass, inertia and meshes. bone: only triangles
        that this bone moves most. density: kg/m^3."""
        raw = abi.new('detach', point=doubles(point, 3), motion=_choice(_MOTIONS, motion, 'motion'), density=density, **options)
        if bone is not None:
            raw.bone = bone.encode()
        return self._submit('detach', ctypes.byref(raw))

    def undo(self) -> Command:
        return self._submit('undo')

    def redo(self) -> Command:
        return self._submit('redo')

    def apply_log(self, log: Union[str, bytes]) -> int:
        """Applies an operation log at once, in the poses that it names. Returns the number of operations; raises SunderError at the
        first that fails, and those before it stay."""
        self.scene._change()
        text = log.encode() if isinstance(log, str) else bytes(log)
        return self._output('apply_log', text, len(text))

    @property
    def log(self) -> str:
        """The operations that are done and not undone, as a log that makes the same model again, bit for bit."""
        return abi.take_bytes(self._output('get_log')).decode()

    @property
    def digest(self) -> int:
        """A hash of all bits of the torn model: equal on every machine; 0: nothing was torn."""
        return self._output('get_digest', kind=ctypes.c_uint64)

    # Meshes

    def mesh(self, mesh: int = 0) -> Mesh:
        """The torn mesh in bind space, copied, with all attributes and weights."""
        raw = abi.type('mesh')()
        abi.call('get_instance_mesh', self.scene._handle, self._handle, mesh, ctypes.byref(raw))
        return mesh_of(raw)

    def origins(self, mesh: int = 0) -> Origins:
        """Where the vertices and triangles of the torn mesh come from. Needs prepare_to_tear() or an operation before."""
        first = len(self.asset.character.meshes[mesh].positions)
        vertices, triangles = (self._origins(f'{kind}_origin', mesh, start) for kind, start in (('vertex', first), ('triangle', 0)))
        return Origins(vertices['triangle'].astype(np.int32), vertices['barycentric'].copy(), triangles['triangle'].astype(np.int32),
                       triangles['points'].astype(np.int32))

    def _origins(self, kind, mesh, first):
        count = self._output(f'get_{kind}s', mesh, first, None, 0)
        structs = (abi.type(kind) * max(count, 1))()
        self._output(f'get_{kind}s', mesh, first, structs, count)
        return np.ctypeslib.as_array(structs)[:count]

    def posed(self, mesh: int = 0) -> PosedMesh:
        """The mesh as it is drawn, copied."""
        with self.borrow(mesh) as posed:
            arrays = [None if array is None else array.copy() for array in (posed.positions, posed.normals, posed.tangents)]
            return PosedMesh(*arrays, posed.triangles, posed.epoch)

    def _repr_png_(self) -> bytes:
        """The instance as it stands, as notebooks show it."""
        meshes = [self.mesh(m) for m in range(self.asset.character.mesh_count)]
        return png(draw([(self.posed(m).positions, mesh.triangles, colours_of(mesh)) for m, mesh in enumerate(meshes)]))

    @contextlib.contextmanager
    def borrow(self, mesh: int = 0) -> Iterator[PosedMesh]:
        """The same without copies of the vertices, within a `with` block: read-only arrays on the library's memory. The scene cannot
        be changed within the block (StaleView), and the arrays must not be used after it."""
        raw = abi.new('posed_mesh')
        abi.call('get_posed_mesh', self.scene._handle, self._handle, mesh, 0, ctypes.byref(raw))
        n = raw.vertex_count
        self.scene._borrowed += 1
        try:
            triangles = copy(raw.initial_triangles, raw.initial_triangle_count, 3)
            if triangles is None:
                triangles = np.zeros((0, 3), np.uint32)
            drawn = np.zeros(len(triangles), bool)
            for i in range(raw.range_count):
                drawn[raw.ranges[i].first_triangle:raw.ranges[i].first_triangle + raw.ranges[i].triangle_count] = True
            yield PosedMesh(view(raw.positions, n, 3), view(raw.normals, n, 3), view(raw.tangents, n, 4), triangles[drawn], raw.epoch)
        finally:
            self.scene._borrowed -= 1

    def begin_wound_mask(self, mesh: int = 0, **options) -> None:
        """Keeps the wounds of a mesh in its texture from now on. Options: width, height, uv_set, dilation, reach; first_operation and
        operation_count: only the wounds of these operations."""
        raw = abi.new('wound_mask_options', **options)
        self._call('begin_wound_mask', mesh, ctypes.byref(raw))
        self._mask_widths[mesh] = raw.width

    def wound_mask(self, mesh: int = 0) -> WoundMask:
        """The wounds in the texture, copied, and what may have changed since the last call."""
        raw = abi.new('wound_mask')
        self._call('get_wound_mask', mesh, ctypes.byref(raw))
        changed = (slice(raw.top, raw.top + raw.changed_height), slice(raw.left, raw.left + raw.changed_width))
        return WoundMask(copy(raw.distances, raw.height, raw.width), changed, raw.overlapping_texels, raw.unpainted_triangles)

    def wound_channel(self, channel: str, mesh: int = 0) -> np.ndarray:
        """(height, width), copied, of a mesh with a wound mask. 'age': the operations since the one that made the nearest lip, -1
        where none is within reach; 'depth': of the wall below that lip, metres; 'stretch': the largest principal stretch of the
        skin that was drawn, 1 beyond reach."""
        return self._texels('get_wound_channel', mesh, _choice(_CHANNELS, channel, 'channel'))

    def flow_blood(self, mesh: int = 0, **options) -> np.ndarray:
        """Lets blood run down from the lips in the pose of the last update: how much of it is on each texel of the wound mask, 0 to
        1, (height, width). Options: down, length, width, spacing (metres), seed."""
        return self._texels('flow_blood', mesh, ctypes.byref(abi.new('blood_flow_options', **options)))

    def _texels(self, name, mesh, argument):
        texels, count = ctypes.POINTER(ctypes.c_float)(), ctypes.c_uint32()
        abi.call(name, self.scene._handle, self._handle, mesh, argument, ctypes.byref(texels), ctypes.byref(count))
        width = self._mask_widths[mesh]
        return copy(texels, count.value // width, width)

    def save(self, influences: Optional[int] = 0) -> bytes:
        """The torn character as a GLB: the source document with the meshes that were torn."""
        options = abi.new('save_options', maximum_influences=abi.constant('NONE') if influences is None else influences)
        return abi.take_bytes(self._output('save_instance', ctypes.byref(options)))

    # Tissue and contact

    @property
    def particle_count(self) -> int:
        return self._tissue().particle_count

    @property
    def is_awake(self) -> bool:
        return bool(self._tissue().is_awake)

    def _tissue(self):
        info = abi.new('tissue_info')
        abi.call('get_tissue', self.scene._handle, self._handle, ctypes.byref(info))
        return info

    @property
    def threads(self) -> list:
        """The threads of all sutures, in the order in which they were tied."""
        raw, count = ctypes.POINTER(abi.type('suture_thread'))(), ctypes.c_uint32()
        abi.call('get_threads', self.scene._handle, self._handle, ctypes.byref(raw), ctypes.byref(count))
        none = abi.constant('NONE')
        return [Thread(None if raw[i].left_mesh == none else (raw[i].left_mesh, raw[i].left_vertex),
                       None if raw[i].right_mesh == none else (raw[i].right_mesh, raw[i].right_vertex),
                       raw[i].newtons, bool(raw[i].is_broken)) for i in range(count.value)]

    def point_at(self, mesh: int, vertex: int) -> Optional[int]:
        """The point of the surface at a vertex; None: it has none any more."""
        point = self._output('get_point', mesh, vertex)
        return None if point == abi.constant('NONE') else point

    def hold(self, point: int, place, stiffness: float = 0.0) -> int:
        """Pulls a point to a place. Returns the number of the hold."""
        self.scene._change()
        return self._output('hold_point', point, pointer_to(doubles(place, 3)), stiffness, kind=ctypes.c_uint64)

    def move_hold(self, hold: int, place) -> None:
        self._call('move_hold', hold, pointer_to(doubles(place, 3)))

    def release_hold(self, hold: int) -> None:
        self._call('release_hold', hold)

    def push(self, point: int, newton_seconds) -> None:
        """Gives the tissue at a point an impulse."""
        self._call('add_impulse', point, pointer_to(doubles(newton_seconds, 3)))

    def set_gravity(self, gravity) -> None:
        self._call('set_gravity', pointer_to(doubles(gravity, 3)))

    def set_tension(self, newtons_per_metre: float, adds_pose_strain: bool = False) -> None:
        self._call('set_tension', newtons_per_metre, int(adds_pose_strain))

    def tear_overstretched(self, length: float = 0.5, metres: float = float('inf')) -> ForceTearing:
        """Tears at once, at one place at most, where tissue whose material has a strength or a toughness gives way in
        the pose of the last update. length: at most this fraction of the particles' range; metres: at most so long. The
        next update draws the tear; it can be undone."""
        options = abi.new('force_tearing_options', length=length, metres=metres)
        found = abi.new('force_tearing')
        self._call('tear_overstretched', ctypes.byref(options), ctypes.byref(found))
        return ForceTearing(bool(found.has_torn), bool(found.is_from_tip), found.vertices_added, found.greatest_stretch,
                            found.greatest_release, found.length, tuple(found.place), tuple(found.direction))

    def cast_ray(self, origin, direction, length: float = 1e9) -> Optional[Contact]:
        """The first place where a ray meets the surface as it was drawn last."""
        return self._query('cast_ray', pointer_to(doubles(origin, 3)), pointer_to(doubles(direction, 3)), length)

    def find_nearest(self, point, most_distance: float = 1e9) -> Optional[Contact]:
        return self._query('find_nearest', pointer_to(doubles(point, 3)), most_distance)

    def _query(self, name, *arguments):
        contact = abi.type('contact')()
        return _contact(contact) if self._output(name, *arguments, ctypes.byref(contact)) else None

    def find_blade_contacts(self, blade) -> list:
        """All places where a blade, (2, 3), crosses the surface, from base to tip."""
        count = self._output('find_blade_contacts', self._blade(blade), None, 0)
        contacts = (abi.type('contact') * max(count, 1))()
        self._output('find_blade_contacts', self._blade(blade), contacts, count)
        return [_contact(contacts[i]) for i in range(count)]

    def _blade(self, blade):
        raw = abi.type('blade')()
        values = doubles(blade, 2, 3)
        raw.base[:], raw.tip[:] = values[0], values[1]
        return ctypes.byref(raw)

    def _tear_options(self, layers, options):
        return abi.new('tear_options', layers=_choice(_LAYERS, layers, 'layers'), **_with_policy(options))


class Scene:
    """Instances that are updated together. One thread at a time per scene. threads: 0: one per core."""

    def __init__(self, threads: int = 0, **options):
        self._handle = abi.output('create_scene', ctypes.byref(abi.new('scene_options', threads=threads, **options)))
        self._waiting = {}
        self._borrowed = 0

    def __del__(self):
        if getattr(self, '_handle', 0):
            abi.plain('destroy_scene', self._handle)

    def _change(self):
        if self._borrowed:
            raise StaleView('arrays of the scene are borrowed: leave the `with` block first')

    def _await(self, number):
        self._waiting[number] = command = Command()
        return command

    def spawn(self, of: Union[Asset, Character], *, visible: bool = True, **options) -> Instance:
        """An instance in the rest pose. Of a character: of an asset that is made for it. Options: vertices, triangles, operations:
        fixed room."""
        self._change()
        asset = of if isinstance(of, Asset) else Asset(of)
        raw = abi.new('spawn_options', is_visible=int(visible), **options)
        return Instance(self, asset, abi.output('spawn', self._handle, asset._handle, ctypes.byref(raw), kind=ctypes.c_uint64))

    def update(self, seconds: float = 0.0) -> None:
        """Advances by a frame: samples clips, applies operations, steps tissue, poses the vertices that changed."""
        self._change()
        abi.call('update', self._handle, seconds)
        results, count = ctypes.POINTER(abi.type('result'))(), ctypes.c_uint32()
        abi.call('get_results', self._handle, ctypes.byref(results), ctypes.byref(count))
        for i in range(count.value):
            self._keep(results[i])

    def _keep(self, raw):
        command = self._waiting.pop(raw.command, None)
        if command is None:
            return
        if raw.status != 0:
            command._error = SunderError(raw.status, abi.plain('status_name', raw.status).decode(), raw.error.decode('utf-8', 'replace'),
                                         raw.error_index)
            return
        piece = Piece(abi.output('take_piece', self._handle, raw.command)) if raw.has_piece else None
        command._result = Result(raw.runs, raw.segments_missed, raw.faces_crossed, raw.vertices_added, raw.triangles_added, raw.triangles_retired,
                                 raw.blocked, raw.caps, raw.open_sections, raw.separated_pieces, raw.length, raw.area_removed, piece,
                                 bool(raw.advises_background))

    @property
    def stats(self) -> dict:
        """Figures of the last update; times are microseconds."""
        stats = abi.new('frame_stats')
        abi.call('get_frame_stats', self._handle, ctypes.byref(stats))
        return {name: getattr(stats, name) for name, _ in stats._fields_ if name not in ('struct_size', 'reserved')}

    def save(self) -> bytes:
        """The state of all instances, without their assets."""
        return abi.take_bytes(abi.output('save_scene', self._handle))

    def restore(self, snapshot: bytes, assets: list) -> None:
        """Makes the scene one that was saved, with the same instances, of these assets in the order of its own. Commands that were
        not applied are forgotten. The bytes are not trusted."""
        self._change()
        handles = (ctypes.c_uint32 * len(assets))(*(asset._handle for asset in assets))
        abi.call('restore_scene', self._handle, snapshot, len(snapshot), handles, len(assets), None)
        self._waiting.clear()
