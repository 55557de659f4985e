"""Sunder for Python: rigged characters that are torn while they move. docs/python.md of the project has examples."""
from .character import Asset, Bone, Character, Clip, Mesh, Note, material
from .environment import WoundEnvironment
from .errors import StaleView, SunderError
from .haptics import blade_force
from .hull import Hull
from .piece import Piece
from .ragdoll import Body, BoneLimit, Ragdoll
from .scene import Command, Contact, ForceTearing, Instance, Layer, Origins, PosedMesh, Result, Scene, Thread, WoundMask
from .torn import Torn, tear
from .transfer import Transfer, transfer
from .validation import Finding, Report, validate

__all__ = [
    'Asset', 'Body', 'Bone', 'BoneLimit', 'Character', 'Clip', 'Command', 'Contact', 'Finding', 'ForceTearing', 'Hull', 'Instance', 'Layer',
    'Mesh', 'Note', 'Origins', 'Piece', 'PosedMesh', 'Ragdoll', 'Report', 'Result', 'Scene', 'StaleView', 'SunderError', 'Thread', 'Torn', 'Transfer',
    'WoundEnvironment', 'WoundMask', 'blade_force', 'material', 'tear', 'transfer', 'validate']
