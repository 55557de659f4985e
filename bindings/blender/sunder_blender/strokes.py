"""Annotations and grease pencil strokes as positions of a blade."""
import numpy as np
from mathutils import Vector


def drawn_strokes(context, source):
    """Points in world space of the strokes of all visible layers, each (n, 3). source: 'ANNOTATION' or 'GREASE_PENCIL'."""
    if source == 'ANNOTATION':
        data, to_world = context.scene.grease_pencil, None
    else:
        pencils = [obj for obj in context.scene.objects if obj.type in ('GPENCIL', 'GREASEPENCIL') and obj.visible_get()]
        if not pencils:
            return []
        data, to_world = pencils[0].data, pencils[0].matrix_world
    strokes = []
    for layer in data.layers if data else []:
        if getattr(layer, 'annotation_hide', False) or getattr(layer, 'hide', False):
            continue
        frames = [frame for frame in layer.frames if frame.frame_number <= context.scene.frame_current]
        if not frames:
            continue
        frame = max(frames, key=lambda frame: frame.frame_number)
        for stroke in frame.strokes if hasattr(frame, 'strokes') else frame.drawing.strokes:
            points = [Vector(point.co if hasattr(point, 'co') else point.position) for point in stroke.points]
            strokes.append([to_world @ point if to_world else point for point in points])
    return [stroke for stroke in strokes if len(stroke) > 1]


def blades_along(obj, depsgraph, stroke, depth, towards_eye=None):
    """Positions of a blade, (n, 2, 3), in the space of the object, that cross its surface along a stroke.

    depth: how far the tip is below the stroke, in the object's units. towards_eye: in world space; None: at right angles to the
    surface as it is shown.
    """
    to_object = obj.matrix_world.inverted()
    points = [to_object @ point for point in stroke]
    evaluated = obj.evaluated_get(depsgraph)
    size = max(max(obj.dimensions) / max(mean_scale(obj), 1e-30), 1e-30)
    if towards_eye is None:
        directions = []
        for point in points:
            is_found, _, normal, _ = evaluated.closest_point_on_mesh(point)
            directions.append(normal if is_found else Vector((0, 0, 1)))
        directions = _smoothed(directions)
    else:
        directions = [(to_object.to_3x3() @ towards_eye).normalized()] * len(points)
    return np.array([[point + 0.05 * size * out, point - depth * out] for point, out in zip(points, directions)])


def _smoothed(directions):
    """Unit vectors of which neighbours differ by less than 45 degrees: a blade must not turn in a jump."""
    for _ in range(8):
        directions = [sum(directions[max(i - 1, 0):i + 2], Vector()) for i in range(len(directions))]
        directions = [direction.normalized() for direction in directions]
        if all(a.dot(b) > 0.7 for a, b in zip(directions, directions[1:])):
            return directions
    mean = sum(directions, Vector())
    return [mean.normalized() if mean.length > 1e-6 else Vector((0, 0, 1))] * len(directions)


def mean_scale(obj):
    """How many units of the world one unit of the object is."""
    return abs(obj.matrix_world.to_3x3().determinant()) ** (1 / 3)
