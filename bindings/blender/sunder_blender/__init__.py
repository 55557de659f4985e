"""Sunder for Blender: tears, cuts and drills meshes that an armature deforms, in the pose of the present frame."""
import bpy

from .operators import CLASSES

bl_info = {
    'name': 'Sunder', 'author': 'The Sunder authors', 'version': (0, 1, 0), 'blender': (3, 4, 0), 'category': 'Mesh',
    'location': '3D Viewport > Sidebar > Sunder', 'description': 'Tears rigged meshes in the pose in which they stand'}


def register():
    for of in CLASSES:
        bpy.utils.register_class(of)


def unregister():
    for of in reversed(CLASSES):
        bpy.utils.unregister_class(of)
