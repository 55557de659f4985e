#include <sunder/tear/torn_weights.h>

#include <algorithm>

#include "core/internal/out_of_memory.h"
#include "tear/model/model_access.h"

namespace sunder {
namespace {

using tear::SurfaceEditor;
using tear::TriangleRef;
using tear::VertexRef;

/// Finds the origins of the vertices of one mesh.
class OriginFinder {
 public:
  OriginFinder(std::uint32_t mesh, const Character& source, const SurfaceEditor& editor)
      : mesh_(mesh), triangle_count_(source.meshes[mesh].triangle_count()), editor_(editor) {}

  [[nodiscard]] VertexOrigin of(std::uint32_t vertex) const {
    VertexOrigin origin = place_of(vertex);
    origin.policy = static_cast<std::uint8_t>(editor_.births.policy(mesh_, vertex));
    if (editor_.births.kept_birth(mesh_, vertex) != kNone)
      origin.is_limited = editor_.character().meshes[mesh_].weights.of(vertex).size() <
                          editor_.births.influences(mesh_, vertex).size();
    return origin;
  }

 private:
  static VertexOrigin without_parents(std::uint32_t vertex) {
    return {{vertex, vertex, vertex}, {1, 0, 0}, VertexOrigin::Values::none};
  }

  [[nodiscard]] VertexOrigin place_of(std::uint32_t vertex) const {
    const Birth& birth = editor_.births.at(mesh_, vertex);
    if (birth.triangle == kNone) return rim_of(vertex);
    const Triangle& parents = editor_.fillings.origin_triangle(mesh_, birth.triangle);
    if (birth.triangle < triangle_count_) return {parents, birth.barycentric};
    for (std::size_t k = 0; k < 3; ++k)  // a corner of a filling is its own parent
      if (birth.barycentric[k] == 1.0 && parents[k] == vertex) return rim_of(vertex);
    return {parents, birth.barycentric};
  }

  /// The origin of a vertex that was made for a wall or cap.
  [[nodiscard]] VertexOrigin rim_of(std::uint32_t vertex) const {
    const VertexRef first = editor_.births.original(mesh_, vertex);
    if (first.mesh != mesh_ || first.vertex == vertex) return without_parents(vertex);
    return {{first.vertex, first.vertex, first.vertex}, {1, 0, 0}, VertexOrigin::Values::motion};
  }

  std::uint32_t mesh_, triangle_count_;
  const SurfaceEditor& editor_;
};

/// Twice the area, relative to that of the origin, of a triangle given by barycentric coordinates.
double share_of(const std::array<std::array<double, 3>, 3>& corners) {
  const auto& [a, b, c] = corners;
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// The triangles of a source mesh of which something was removed: rounding explains no share that
/// is missing beyond this.
constexpr double kNothingRemoved = 1e-9;

std::vector<ReducedTriangle> reduced_triangles(std::uint32_t mesh, const Mesh& source,
                                               const SurfaceEditor& editor) {
  std::vector<double> remaining(source.triangles.size(), 0.0);
  const Mesh& torn = editor.character().meshes[mesh];
  for (std::uint32_t t = 0; t < torn.triangle_count(); ++t) {
    const TriangleRef ref = editor.surface().triangle(editor.origins.surface_triangle(mesh, t));
    if (ref.source_triangle >= remaining.size() || is_retired(torn.triangles[t])) continue;
    std::array<std::array<double, 3>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = editor.births.place_in_origin(ref, torn.triangles[t][k]);
    remaining[ref.source_triangle] += share_of(corners);
  }
  std::vector<ReducedTriangle> reduced;
  for (std::uint32_t t = 0; t < remaining.size(); ++t) {
    const Triangle& corners = source.triangles[t];
    const bool has_area =
        corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0];
    if (has_area && remaining[t] < 1.0 - kNothingRemoved)
      reduced.push_back({t, std::max(remaining[t], 0.0)});
  }
  return reduced;
}

MeshOrigins origins_of(std::uint32_t mesh, const Character& source, const SurfaceEditor& editor) {
  MeshOrigins origins;
  origins.first_vertex = source.meshes[mesh].vertex_count();
  const OriginFinder finder(mesh, source, editor);
  const std::uint32_t end = editor.character().meshes[mesh].vertex_count();
  origins.vertices.reserve(end - origins.first_vertex);
  for (std::uint32_t v = origins.first_vertex; v < end; ++v)
    origins.vertices.push_back(finder.of(v));
  origins.reduced = reduced_triangles(mesh, source.meshes[mesh], editor);
  return origins;
}

}  // namespace

Result<std::vector<MeshOrigins>> vertex_origins(const TornModel& model) {
  return or_out_of_memory([&]() -> Result<std::vector<MeshOrigins>> {
    std::vector<MeshOrigins> origins;
    if (&model.character() == &model.source()) {  // Nothing is torn, so there need be no workspace.
      for (const Mesh& mesh : model.source().meshes)
        origins.push_back({mesh.vertex_count(), {}, {}});
      return origins;
    }
    if (Status status = model.unpack(); !status) return status;
    const SurfaceEditor& editor = tear::ModelAccess::state_of(model).editor;
    for (std::uint32_t mesh = 0; mesh < model.source().meshes.size(); ++mesh)
      origins.push_back(origins_of(mesh, model.source(), editor));
    return origins;
  });
}

}  // namespace sunder
