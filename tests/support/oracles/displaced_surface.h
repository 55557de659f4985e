#pragma once

#include <sunder/particles/soft_body.h>

namespace sunder::test {

/// How well the normals and tangents of a displaced mesh fit its displaced faces.
struct DisplacedSurface {
  /// 99th percentile and maximum, over the vertices of faces, of the angle between a vertex's
  /// normal and the mean normal of its faces by area, beyond the same angle at rest. Degrees.
  double normal_p99 = 0, normal_worst = 0;
  double tangent_dot = 0;  ///< Largest |n . t| of unit normals and tangents.
  /// Largest angle between faces that share two vertices, beyond that at rest. Degrees.
  double jump = 0;
};

/// Adds tangents to a mesh without them: unit vectors across its normals.
void add_tangents(Mesh& mesh);

/// Displaces mesh 0 of a model by a body, and measures the result. Vertices that nothing displaces
/// do not count.
/// @param model  with normals and tangents; its first skin moves the mesh.
/// @param from_tips  normals nearer to a tip of a tear do not count, metres.
DisplacedSurface measure_displaced(const TornModel& model, const ModelPose& pose, ParticleSet& set,
                                   SoftBody& body, double from_tips = 0);

}  // namespace sunder::test
