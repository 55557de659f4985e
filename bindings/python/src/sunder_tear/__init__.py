"""Sunder for Python: rigged characters that are torn while they move. docs/python.md of the project has examples."""
from .character import Asset, Bone, Character, Clip, Mesh, Note, material
from .errors import StaleView, SunderError
from .piece import Hull, Piece
from .scene import Command, Contact, Instance, Layer, PosedMesh, Result, Scene
from .torn import Torn, tear

__all__ = [
    'Asset', 'Bone', 'Character', 'Clip', 'Command', 'Contact', 'Hull', 'Instance', 'Layer', 'Mesh', 'Note', 'Piece', 'PosedMesh',
    'Result', 'Scene', 'StaleView', 'SunderError', 'Torn', 'material', 'tear']
