#include "support/oracles/source_cover.h"

#include <algorithm>
#include <array>

#include "support/machine/say.h"
#include "support/models/rigs.h"

namespace sunder::test {
namespace {

using CoverPlace = std::array<double, 3>;

/// One mesh of a model, and the origins of its triangles.
class TornMesh {
 public:
  TornMesh(const TornModel& model, std::uint32_t mesh)
      : model_(model),
        mesh_(mesh),
        torn_(model.character().meshes[mesh]),
        source_(model.source().meshes[mesh]),
        fillings_(model.fillings(mesh)) {}

  [[nodiscard]] const Mesh& torn() const { return torn_; }
  [[nodiscard]] std::size_t origin_count() const {
    return source_.triangle_count() + fillings_.size();
  }
  [[nodiscard]] std::uint32_t origin_of(std::uint32_t triangle) const {
    return model_.source_triangle(mesh_, triangle);
  }
  [[nodiscard]] bool is_filling(std::uint32_t origin) const {
    return origin >= source_.triangle_count();
  }
  /// The vertices of the source keep their indices, so the corners of all origins are vertices of
  /// the torn mesh.
  [[nodiscard]] Triangle vertices_of_origin(std::uint32_t origin) const {
    return is_filling(origin) ? fillings_[origin - source_.triangle_count()]
                              : source_.triangles[origin];
  }

  /// The barycentric position of a vertex in a triangle, or nothing if it does not belong to it.
  [[nodiscard]] std::optional<CoverPlace> place_in(const Triangle& in, std::uint32_t vertex) const {
    CoverPlace place = {0, 0, 0};
    const auto add = [&](std::uint32_t parent, double part) {
      const auto at = std::find(in.begin(), in.end(), parent);
      if (at == in.end()) return false;
      place[static_cast<std::size_t>(at - in.begin())] += part;
      return true;
    };
    if (add(vertex, 1.0)) return place;
    if (vertex < source_.vertex_count()) return std::nullopt;
    const Birth birth = model_.birth(mesh_, vertex);
    if (birth.triangle >= origin_count()) return std::nullopt;
    const Triangle parents = vertices_of_origin(birth.triangle);
    for (std::size_t k = 0; k < 3; ++k)
      if (birth.barycentric[k] > 0 && !add(parents[k], birth.barycentric[k])) return std::nullopt;
    return place;
  }

  /// Twice its area times its normal, in bind space.
  [[nodiscard]] Eigen::Vector3d cross(const Triangle& triangle) const {
    const Eigen::Vector3d a = torn_.positions[triangle[0]].cast<double>();
    return (torn_.positions[triangle[1]].cast<double>() - a)
        .cross(torn_.positions[triangle[2]].cast<double>() - a);
  }

 private:
  const TornModel& model_;
  std::uint32_t mesh_;
  const Mesh& torn_;
  const Mesh& source_;
  std::span<const Triangle> fillings_;
};

/// The fraction of the origin that a triangle with these corners covers; negative if it is
/// inverted.
double area_of(const std::array<CoverPlace, 3>& p) {
  return p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) -
         p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
         p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
}

/// Whether a part has the orientation of its origin. An origin without area has none, unless it was
/// created by tearing.
bool faces_as(const TornMesh& mesh, const Triangle& part, std::uint32_t origin) {
  const Eigen::Vector3d whole = mesh.cross(mesh.vertices_of_origin(origin));
  if (whole.isZero(0)) return !mesh.is_filling(origin);
  return mesh.cross(part).dot(whole) > 0;
}

/// The fraction of its origin that a part covers, and its faults.
double cover_by(const TornMesh& mesh, std::uint32_t triangle, std::uint32_t origin,
                std::vector<std::string>& faults) {
  const Triangle& part = mesh.torn().triangles[triangle];
  const Triangle whole = mesh.vertices_of_origin(origin);
  const bool is_whole = part == whole;
  if ((!is_whole || mesh.is_filling(origin)) && !faces_as(mesh, part, origin))
    faults.push_back(say("triangle ", triangle, " has no area, or turned over, in bind space"));
  if (is_whole) return 1;
  std::array<CoverPlace, 3> places;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto place = mesh.place_in(whole, part[k]);
    if (!place) {
      faults.push_back(
          say("triangle ", triangle, " has a vertex from outside of what it is a part of"));
      return 0;
    }
    places[k] = *place;
  }
  const double area = area_of(places);
  if (!(area > 0))
    faults.push_back(say("triangle ", triangle, " covers ", area, " of what it is a part of"));
  return area;
}

}  // namespace

Cover cover_of(const TornModel& model, std::uint32_t mesh_index) {
  const TornMesh mesh(model, mesh_index);
  Cover cover;
  cover.part.assign(mesh.origin_count(), 0.0);
  cover.has_retired.assign(mesh.origin_count(), false);
  for (std::uint32_t t = 0; t < mesh.torn().triangle_count(); ++t) {
    const std::uint32_t origin = mesh.origin_of(t);
    if (origin >= mesh.origin_count()) {
      cover.faults.push_back(say("triangle ", t, " is a part of nothing"));
      continue;
    }
    const Triangle& triangle = mesh.torn().triangles[t];
    if (is_retired(triangle) && triangle != mesh.vertices_of_origin(origin))
      cover.has_retired[origin] = true;
    else
      cover.part[origin] += cover_by(mesh, t, origin, cover.faults);
  }
  return cover;
}

double removed_area(const TornModel& model, const ModelPose& pose) {
  double removed = 0;
  for (std::uint32_t m = 0; m < model.source().meshes.size(); ++m) {
    const Mesh& source = model.source().meshes[m];
    const std::vector<Vec3d> posed = posed_positions(model.source(), m, pose);
    const Cover cover = cover_of(model, m);
    for (std::uint32_t t = 0; t < source.triangle_count(); ++t) {
      const Vec3d a = posed[source.triangles[t][0]], b = posed[source.triangles[t][1]],
                  c = posed[source.triangles[t][2]];
      removed += 0.5 * (b - a).cross(c - a).norm() * (1 - cover.part[t]);
    }
  }
  return removed;
}

}  // namespace sunder::test
