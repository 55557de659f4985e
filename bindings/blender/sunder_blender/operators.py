"""The operators of the add-on."""
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty
from mathutils import Vector

from .library import sunder_tear
from .read_object import Unsupported, deforming_modifier, read_object
from .strokes import blades_along, drawn_strokes, mean_scale
from .write_object import write_object

WOUND = 'Wound'
FLESH = (0.34, 0.036, 0.028, 1.0)


class _Operator(bpy.types.Operator):
    """Applies operations of the library to the active object, in the pose of the present frame."""
    bl_options = {'REGISTER', 'UNDO'}

    @classmethod
    def poll(cls, context):
        return context.active_object is not None and context.active_object.type == 'MESH' and context.mode == 'OBJECT'

    def execute(self, context):
        obj, depsgraph = context.active_object, context.evaluated_depsgraph_get()
        try:
            rig = read_object(obj)
            scene = sunder_tear.Scene(threads=1)
            instance = scene.spawn(sunder_tear.Asset(rig.character, poses_vertices=0))
            instance.set_pose(*rig.pose(depsgraph, obj))
            fill = self._fill_slot(obj)
            commands = self.submit(context, obj, depsgraph, instance, fill)
            scene.update()
            results = [command.result for command in commands]
        except (Unsupported, sunder_tear.SunderError) as error:
            self.report({'ERROR'}, str(error))
            return {'CANCELLED'}
        missed = sum(result.runs == 0 and result.caps == 0 and result.vertices_added == 0 for result in results)
        if missed == len(results):
            self.report({'WARNING'}, f'nothing of \'{obj.name}\' was met')
            return {'CANCELLED'}
        added, changed, held = write_object(obj, rig, instance, fill)
        if fill == len(obj.data.materials):
            obj.data.materials.append(_wound_material())
        pieces = sum(result.separated_pieces for result in results)
        self.report({'INFO'}, f'{added} vertices added, {changed} faces changed, {pieces} pieces' +
                    (f'; {missed} of {len(results)} strokes met nothing' if missed else '') +
                    (f'; {held} new vertices lie beside some that no bone moves, and follow their bones fully' if held else ''))
        return {'FINISHED'}

    def _fill_slot(self, obj):
        """The slot of the wound's material, which is one more than there are if it must be made; None without fillings."""
        if not self.has_fillings():
            return None
        names = [material.name if material else '' for material in obj.data.materials]
        return next((i for i, name in enumerate(names) if name == WOUND or name.startswith(WOUND + '.')), len(names))


def _wound_material():
    known = bpy.data.materials.get(WOUND)
    if known is not None:
        return known
    material = bpy.data.materials.new(WOUND)
    material.use_nodes = True
    material.diffuse_color = FLESH
    for node in material.node_tree.nodes:
        if node.type == 'BSDF_PRINCIPLED':
            node.inputs['Base Color'].default_value = FLESH
            node.inputs['Roughness'].default_value = 0.4
    return material


def _local(obj, length):
    """A length of the world in the units of the object."""
    scale = mean_scale(obj)
    return length / scale if scale > 0 else length


class SUNDER_OT_tear(_Operator):
    """Tear the active mesh along annotations or grease pencil strokes, in the pose of the present frame"""
    bl_idname = 'object.sunder_tear'
    bl_label = 'Tear along Strokes'

    source: EnumProperty(name='Strokes', items=[('ANNOTATION', 'Annotations', 'Of the scene'),
                                                ('GREASE_PENCIL', 'Grease Pencil', 'Of the first visible grease pencil object')])
    direction: EnumProperty(name='Direction', items=[('SURFACE', 'Surface', 'At right angles to the surface'),
                                                     ('VIEW', 'View', 'Along the line of sight')])
    depth: FloatProperty(name='Depth', description='How far the blade reaches below the stroke', subtype='DISTANCE',
                         default=0.05, min=1e-6)
    width: FloatProperty(name='Width', description='Of the band of surface that is removed; 0: the lips touch', subtype='DISTANCE',
                         default=0.0, min=0.0)
    wall_depth: FloatProperty(name='Walls', description='Depth of the walls below the lips; 0: none', subtype='DISTANCE',
                              default=0.0, min=0.0)
    all_layers: BoolProperty(name='All Layers', description='Tear all surfaces that the blade crosses, not the first one alone')

    def has_fillings(self):
        return self.wall_depth > 0

    def submit(self, context, obj, depsgraph, instance, fill):
        strokes = drawn_strokes(context, self.source)
        if not strokes:
            raise Unsupported('there is no visible stroke; draw an annotation on the mesh, or choose Grease Pencil')
        towards_eye = self._towards_eye(context) if self.direction == 'VIEW' else None
        options = {'width': _local(obj, self.width), 'layers': 'all' if self.all_layers else 'nearest'}
        if fill is not None:
            options.update(wall_depth=_local(obj, self.wall_depth), wall_material=fill)
        return [instance.tear(blades_along(obj, depsgraph, stroke, _local(obj, self.depth), towards_eye), **options) for stroke in strokes]

    @staticmethod
    def _towards_eye(context):
        if context.region_data is None:
            raise Unsupported('the direction View needs a 3D viewport')
        return context.region_data.view_rotation @ Vector((0, 0, 1))


class SUNDER_OT_cut(_Operator):
    """Cut the active mesh by the plane of the 3D cursor, or through a bone, in the pose of the present frame"""
    bl_idname = 'object.sunder_cut'
    bl_label = 'Cut by Plane'

    bone: bpy.props.StringProperty(name='Bone', description='Cut across this bone, and nothing but what it and its children move; '
                                                            'empty: by the plane of the 3D cursor')
    share: FloatProperty(name='Share', description='Where on the bone: 0 at its head, 1 at its tail', default=0.5, min=0.0, max=1.0)
    caps: BoolProperty(name='Caps', description='Close the section', default=True)

    def has_fillings(self):
        return self.caps

    def submit(self, context, obj, depsgraph, instance, fill):
        armature = deforming_modifier(obj).object
        if self.bone:
            bone = armature.evaluated_get(depsgraph).pose.bones.get(self.bone)
            if bone is None:
                raise Unsupported(f"'{armature.name}' has no bone '{self.bone}'")
            to_world = armature.matrix_world
            point, normal = to_world @ bone.head.lerp(bone.tail, self.share), to_world.to_3x3() @ (bone.tail - bone.head)
        else:
            cursor = context.scene.cursor.matrix
            point, normal = cursor.translation, cursor.to_3x3() @ Vector((0, 0, 1))
        local = obj.matrix_world.to_3x3().transposed() @ normal
        if local.length == 0:
            raise Unsupported('the plane has no direction: the bone is a point')
        options = {} if fill is None else {'cap_material': fill}
        return [instance.cut(obj.matrix_world.inverted() @ point, local.normalized(), bone=self.bone or None, caps=self.caps, **options)]


class SUNDER_OT_drill(_Operator):
    """Bore a round hole from the 3D cursor along its negative Z axis, in the pose of the present frame"""
    bl_idname = 'object.sunder_drill'
    bl_label = 'Drill at Cursor'

    radius: FloatProperty(name='Radius', subtype='DISTANCE', default=0.02, min=1e-6)
    depth: FloatProperty(name='Depth', subtype='DISTANCE', default=0.1, min=1e-6)
    wall: BoolProperty(name='Wall', description='Line the hole', default=True)

    def has_fillings(self):
        return self.wall

    def submit(self, context, obj, depsgraph, instance, fill):
        cursor = obj.matrix_world.inverted() @ context.scene.cursor.matrix
        direction = (cursor.to_3x3() @ Vector((0, 0, -1))).normalized()
        options = {} if fill is None else {'wall_material': fill}
        return [instance.drill(cursor.translation, direction, _local(obj, self.radius), _local(obj, self.depth), wall=self.wall, **options)]


class SUNDER_PT_panel(bpy.types.Panel):
    bl_label = 'Sunder'
    bl_idname = 'SUNDER_PT_panel'
    bl_space_type = 'VIEW_3D'
    bl_region_type = 'UI'
    bl_category = 'Sunder'

    def draw(self, context):
        for operator in (SUNDER_OT_tear, SUNDER_OT_cut, SUNDER_OT_drill):
            self.layout.operator(operator.bl_idname)


CLASSES = (SUNDER_OT_tear, SUNDER_OT_cut, SUNDER_OT_drill, SUNDER_PT_panel)
