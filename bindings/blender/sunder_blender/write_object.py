"""Brings a torn character back into the mesh of its object. Only the faces that the tear met change; the others, and their UV maps,
colours, edges and shape keys, stay as they are."""
import bmesh
import numpy as np
from mathutils import Vector

_NORMAL = 'sunder_normal'  # carries custom normals through the change
_BLENDED = ('float', 'float_vector', 'float_color', 'color', 'shape')  # kinds of layers


def write_object(obj, rig, instance, fill_material=None):
    """Changes the mesh of the object. fill_material: index of the material slot of walls and caps. Returns the numbers of vertices
    added, of faces that changed, and of new vertices that a part of their weight would hold in place, which Blender cannot express."""
    normals = _custom_normals(obj.data)
    change = _Change(obj, rig, instance)
    mesh = bmesh.new()
    try:
        mesh.from_mesh(obj.data)
        if normals is not None:
            _keep_normals(mesh, normals)
        change.apply(mesh, fill_material)
        mesh.to_mesh(obj.data)
    finally:
        mesh.free()
    if normals is not None:
        _restore_normals(obj.data)
    obj.data.update()
    return change.vertices_added, change.faces_changed, change.held


class _Change:
    """What differs between the source and the torn mesh."""

    def __init__(self, obj, rig, instance):
        self.obj, self.rig = obj, rig
        self.torn, self.origins = instance.mesh(0), instance.origins(0)
        self.source = rig.character.meshes[0]
        self.count = len(self.source.positions)
        self.vertices_added = self.faces_changed = self.held = 0
        before, after = self.source.triangles, self.torn.triangles
        is_same = (before == after[:len(before)]).all(axis=1)
        self.polygons = np.unique(rig.triangle_polygon[~is_same])
        is_of_polygon = np.isin(rig.triangle_polygon, self.polygons)
        is_live = (after[:, 0] != after[:, 1]) | (after[:, 0] != after[:, 2])
        origin = self.origins.triangle
        is_new = np.where(origin >= 0, is_of_polygon[np.maximum(origin, 0)], True)
        self.triangles = np.flatnonzero(is_live & is_new)

    def apply(self, mesh, fill_material):
        self.deform = mesh.verts.layers.deform.verify()  # a new layer makes older references to elements invalid
        mesh.faces.ensure_lookup_table()
        self.mesh, self.keys = mesh, mesh.verts.layers.shape
        self.old = list(mesh.verts)
        self.layers = {kind: _layers(getattr(mesh, kind).layers) for kind in ('verts', 'loops')}
        self.source_faces = {int(polygon): mesh.faces[int(polygon)] for polygon in self.polygons}
        self.source_edges = {edge for face in self.source_faces.values() for edge in face.edges}
        self.vertex_of_point = self._old_points()  # one of those that stand there
        self.vertex_of_birth = {}
        self.support = {}  # of new vertices: the vertices of the source between which they were born
        # The surface first: walls and caps join its vertices.
        self.triangles = self.triangles[np.argsort(self.origins.triangle[self.triangles] < 0, kind='stable')]
        corners = [self._corners(t) for t in self.triangles]
        faces = [self._face(of, t, fill_material) for of, t in zip(corners, self.triangles)]
        self._copy_edges([face for face in faces if face])
        self._remove()
        self.faces_changed = len(self.source_faces)

    def _old_points(self):
        """Per point of the torn surface: the vertex of the mesh that stands there already."""
        points, corners = self.origins.points.ravel(), self.torn.triangles.ravel()
        is_old = (points >= 0) & (corners < self.count)
        return {int(p): self.old[int(self.rig.vertices[c])] for p, c in zip(points[is_old], corners[is_old])}

    def _corners(self, triangle):
        vertices = []
        for vertex, point in zip(self.torn.triangles[triangle], self.origins.points[triangle]):
            if vertex < self.count:
                vertices.append(self.old[int(self.rig.vertices[vertex])])
                continue
            vertices.append(self._new_vertex(int(vertex), int(point)))
        return vertices

    def _new_vertex(self, vertex, point):
        """Where the mesh has two vertices at one place, as importers make them at seams, the tear makes two on the edges between
        such: one for each pair of parents. The rim of a wall or cap, which has no parents, belongs to either."""
        parents = self._parents(vertex)
        if not parents:
            if point not in self.vertex_of_point:
                self.vertex_of_point[point] = self._vertex(vertex, parents)
            return self.vertex_of_point[point]
        key = (point, frozenset(parent.index for parent, _ in parents))
        if key not in self.vertex_of_birth:
            self.vertex_of_birth[key] = self._vertex(vertex, parents)
            self.vertex_of_point.setdefault(point, self.vertex_of_birth[key])
        return self.vertex_of_birth[key]

    # Vertices

    def _vertex(self, vertex, parents):
        place = Vector(self.torn.positions[vertex].tolist())
        made = self.mesh.verts.new(place)
        self.vertices_added += 1
        self.support[made] = frozenset(parent.index for parent, _ in parents)
        if parents:
            made.copy_from(max(parents, key=lambda parent: parent[1])[0])
            made.co = place
            _blend(self.layers['verts'], made, parents)
        else:  # inside of a wall or cap
            for name in self.rig.keys:
                made[self.keys[name]] = place + Vector(self.torn.morph_targets[name][vertex].tolist())
        if self.obj.data.shape_keys is not None:
            made[self.keys[self.obj.data.shape_keys.reference_key.name]] = place
        self._give_weights(made, vertex, parents)
        return made

    def _give_weights(self, made, vertex, parents):
        """Bones as the library says, other groups between those of the parents."""
        groups, weights = self.obj.vertex_groups, made[self.deform]
        bones = {groups[name].index for name in self.rig.slot_names if name and name in groups}
        weights.clear()
        for parent, share in parents:
            for group, weight in parent[self.deform].items():
                if group not in bones:
                    weights[group] = weights.get(group, 0.0) + share * weight
        first = self.torn.first_influence
        for i in range(first[vertex], first[vertex + 1]):
            name = self.rig.slot_names[self.torn.influence_slot[i]]
            if name is None:
                self.held += 1
            elif name in groups:
                weights[groups[name].index] = float(self.torn.influence_weight[i])

    def _birth(self, vertex):
        """The triangle of the source in which a vertex that operations made was born, and its place there."""
        return int(self.origins.vertex_triangle[vertex - self.count]), self.origins.vertex_barycentric[vertex - self.count]

    def _parents(self, vertex):
        triangle, shares = self._birth(vertex)
        if triangle < 0:
            return []
        corners = self.rig.vertices[self.source.triangles[triangle]]
        return [(self.old[int(corner)], float(share)) for corner, share in zip(corners, shares) if share > 0]

    # Faces

    def _face(self, vertices, triangle, fill_material):
        """None for a face that Blender cannot hold: of less than three vertices, or a second one of the same three."""
        if len(set(vertices)) < 3 or self.mesh.faces.get(vertices) is not None:
            return None
        origin = int(self.origins.triangle[triangle])
        face = self.mesh.faces.new(vertices)
        if origin < 0:
            face.smooth = True
            face.material_index = fill_material or 0
            return face
        source = self.source_faces[int(self.rig.triangle_polygon[origin])]
        face.copy_from(source)
        face.smooth, face.material_index = source.smooth, source.material_index
        loop_of = {loop.vert.index: loop for loop in source.loops}
        for loop, vertex in zip(face.loops, self.torn.triangles[triangle]):
            parents = self._loop_parents(int(vertex), loop_of)
            loop.copy_from(max(parents, key=lambda parent: parent[1])[0])
            if len(parents) > 1:
                _blend(self.layers['loops'], loop, parents)
        return face

    def _loop_parents(self, vertex, loop_of):
        """Corners of the face around a vertex, with their shares. A vertex on an edge may have been born in the face beside it."""
        if vertex < self.count:
            return [(loop_of[int(self.rig.vertices[vertex])], 1.0)]
        return [(loop_of[parent.index], share) for parent, share in self._parents(vertex)]

    # Edges

    def _copy_edges(self, faces):
        """Parts of an edge are as it was: a seam, sharp, creased."""
        edge_of = {frozenset(vert.index for vert in edge.verts): edge for edge in self.source_edges}

        def support(vert):
            return self.support.get(vert) or frozenset([vert.index])

        for edge in {edge for face in faces for edge in face.edges} - self.source_edges:
            source = edge_of.get(support(edge.verts[0]) | support(edge.verts[1]))
            if source is not None:
                edge.copy_from(source)
                edge.seam, edge.smooth = source.seam, source.smooth

    def _remove(self):
        """Removes the faces that were replaced, and edges and vertices that no face has any more."""
        vertices = {vert for face in self.source_faces.values() for vert in face.verts}
        for face in self.source_faces.values():
            self.mesh.faces.remove(face)
        for edge in self.source_edges:
            if edge.is_valid and not edge.link_faces:
                self.mesh.edges.remove(edge)
        for vert in vertices:
            if vert.is_valid and not vert.link_edges:
                self.mesh.verts.remove(vert)


def _layers(layers):
    """(kind, layer) of all that vertices or corners carry, without weights."""
    return [(kind, layer) for kind in ('uv', *_BLENDED) if hasattr(layers, kind) for layer in getattr(layers, kind).values()]


def _blend(layers, element, parents):
    """Values between those of the parents; what cannot be blended was copied."""
    for kind, layer in layers:
        if kind == 'uv':
            element[layer].uv = sum((share * parent[layer].uv for parent, share in parents), Vector((0, 0)))
        elif kind in _BLENDED:
            values = [share * parent[layer] for parent, share in parents]
            element[layer] = sum(values[1:], values[0])


# Custom normals: a mesh stores them relative to its faces, so they are carried as vectors.

def _custom_normals(mesh):
    if not mesh.has_custom_normals:
        return None
    if hasattr(mesh, 'calc_normals_split'):  # until Blender 4.0
        mesh.calc_normals_split()
        normals = np.empty(3 * len(mesh.loops), np.float32)
        mesh.loops.foreach_get('normal', normals)
    else:
        normals = np.empty(3 * len(mesh.loops), np.float32)
        mesh.corner_normals.foreach_get('vector', normals)
    return normals.reshape(-1, 3)


def _keep_normals(mesh, normals):
    layer = mesh.loops.layers.float_vector.new(_NORMAL)
    for face in mesh.faces:
        for loop in face.loops:
            loop[layer] = Vector(normals[loop.index].tolist())


def _restore_normals(mesh):
    attribute = mesh.attributes[_NORMAL]
    normals = np.empty(3 * len(mesh.loops), np.float32)
    attribute.data.foreach_get('vector', normals)
    mesh.attributes.remove(attribute)
    mesh.normals_split_custom_set(normals.reshape(-1, 3).tolist())  # of zero length: as the face has it
