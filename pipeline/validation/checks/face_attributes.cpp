#include "pipeline/validation/checks/face_attributes.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"

namespace sunder::validation {
namespace {

constexpr double kOnSurface = 1e-6;      ///< Of the diagonal.
constexpr double kTouches = 2e-6;        ///< Of the diagonal: faces at a place.
constexpr double kParallel = 0.995;      ///< Cosine between faces that lie in each other.
constexpr double kClearHeight = 1e-5;    ///< Of the diagonal: flatter faces have any direction.
constexpr double kClearDirection = 0.5;  ///< Length of a mean of directions that says something.
/// L1. A policy that moves the bind position of a vertex leaves it with weights that are not those
/// of the place where it then stands, and with the texture coordinates of where it was made.
constexpr double kSameWeights = 1e-3;

/// The corners of a face of the source and a place on it.
struct FacePlace {
  const Mesh& mesh;
  Triangle corners;
  std::array<double, 3> barycentric;

  template <class Value>
  [[nodiscard]] auto mean(const std::vector<Value>& values) const {
    auto sum = (barycentric[0] * values[corners[0]].template cast<double>()).eval();
    for (std::size_t k = 1; k < 3; ++k)
      sum += barycentric[k] * values[corners[k]].template cast<double>();
    return sum;
  }
};

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(norm(a.cross(b)), dot(a, b));
}

/// The mean of the corners' directions; zero where they disagree so much that it says nothing.
template <class Value>
Vec3d direction_at(const FacePlace& place, const std::vector<Value>& directions) {
  const Vec3d mean = place.mean(directions).template head<3>();
  return norm(mean) < kClearDirection ? Vec3d(Vec3d::Zero()) : mean;
}

/// The angle between the direction at a place and another one.
template <class Value>
double direction_difference(const FacePlace& place, const std::vector<Value>& directions,
                            const Value& other) {
  return angle_between(direction_at(place, directions),
                       other.template head<3>().template cast<double>());
}

/// The largest difference of a coordinate of any set that both meshes have.
double uv_difference(const FacePlace& place, const Mesh& mesh, Index vertex) {
  double largest = 0.0;
  const std::size_t sets = std::min(place.mesh.uv_sets.size(), mesh.uv_sets.size());
  for (std::size_t set = 0; set < sets; ++set) {
    const Vec2d mean = place.mean(place.mesh.uv_sets[set]),
                own = mesh.uv_sets[set][vertex].cast<double>();
    largest = std::max(largest, (own - mean).cwiseAbs().maxCoeff());
  }
  return largest;
}

/// The difference between a place on the source and a vertex of a mesh.
double difference_at(FaceAttribute attribute, const FacePlace& place, const Mesh& mesh,
                     Index vertex) {
  switch (attribute) {
    case FaceAttribute::normals:
      return direction_difference(place, place.mesh.normals, mesh.normals[vertex]);
    case FaceAttribute::tangents:
      return direction_difference(place, place.mesh.tangents, mesh.tangents[vertex]);
    case FaceAttribute::uv: return uv_difference(place, mesh, vertex);
  }
  return 0.0;
}

bool has_attribute(FaceAttribute attribute, const Mesh& mesh) {
  switch (attribute) {
    case FaceAttribute::normals: return !mesh.normals.empty();
    case FaceAttribute::tangents: return !mesh.tangents.empty();
    case FaceAttribute::uv: return !mesh.uv_sets.empty();
  }
  return false;
}

/// Twice the area vector of a face.
Vec3d area_of(const BindSurface& surface, Index triangle) {
  const auto& [a, b, c] = surface.triangles[triangle];
  return (surface.positions[b] - surface.positions[a])
      .cross(surface.positions[c] - surface.positions[a]);
}

/// The smallest height of a face.
double height_of(const BindSurface& surface, Index triangle) {
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, norm(surface.positions[surface.triangles[triangle][k]] -
                                     surface.positions[surface.triangles[triangle][(k + 1) % 3]]));
  return longest > 0.0 ? norm(area_of(surface, triangle)) / longest : 0.0;
}

/// The faces around each vertex of a surface, those without an area aside.
void collect_faces(const BindSurface& surface, std::vector<Index>& first,
                   std::vector<Index>& faces) {
  first.assign(std::size_t{surface.vertex_count()} + 1, 0);
  const auto visit = [&](const auto& take) {
    for (Index t = 0; t < surface.triangles.size(); ++t)
      if (surface.has_area[t])
        for (const Index v : surface.triangles[t]) take(v, t);
  };
  visit([&](Index v, Index) { ++first[v + 1]; });
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  faces.resize(first.back());
  std::vector<Index> next(first.begin(), first.end() - 1);
  visit([&](Index v, Index t) { faces[next[v]++] = t; });
}

}  // namespace

/// The part of a difference from a place that its rounding does not explain. Where the difference
/// is not above the threshold, it is returned as it is.
double FaceAttributes::excess(const Query& query, const SurfacePlace& place) const {
  const BindSurface& surface = reader_.source().surface;
  const Index of = surface.mesh_of_triangle(place.triangle);
  const Mesh& source = reader_.source().character.meshes[of];
  if (!has_attribute(query.attribute, source)) return 0.0;
  const FacePlace on_face{source, source.triangles[place.triangle - surface.first_triangle[of]],
                          place.barycentric};
  const double difference = difference_at(
      query.attribute, on_face, reader_.target().character.meshes[query.mesh], query.vertex);
  if (difference <= query.threshold) return difference;
  const double height = height_of(surface, place.triangle);
  if (!(height > 0.0)) return difference;
  double spread = 0.0;  // how much the attribute changes over the face
  for (const Index corner : on_face.corners)
    spread = std::max(spread, difference_at(query.attribute, on_face, source, corner));
  return difference - spread * kTouches * surface.diagonal / height;
}

bool FaceAttributes::is_comparable(FaceAttribute attribute, Index mesh, Index vertex) const {
  const SurfaceMatch& match = reader_.match(mesh, vertex);
  return match.is_accepted && match.distance <= kOnSurface * reader_.source().surface.diagonal &&
         has_attribute(attribute, reader_.target().character.meshes[mesh]) &&
         has_attribute(attribute, reader_.source().character.meshes[match.mesh]);
}

/// Whether each face around a vertex of the target is parallel to one of these of the source, and
/// one of them is not a sliver, such as a triangle of a cap between two points of its rim.
bool FaceAttributes::lies_in(Index vertex, std::span<const SurfacePlace> faces) {
  const BindSurface &source = reader_.source().surface, &target = reader_.target().surface;
  if (first_face_.empty()) collect_faces(target, first_face_, faces_);
  bool has_clear_face = false;
  for (Index i = first_face_[vertex]; i < first_face_[vertex + 1]; ++i) {
    has_clear_face |= height_of(target, faces_[i]) > kClearHeight * target.diagonal;
    const Vec3d own = normalized(area_of(target, faces_[i]));
    const auto is_parallel = [&](const SurfacePlace& place) {
      return dot(own, normalized(area_of(source, place.triangle))) >= kParallel;
    };
    if (std::ranges::none_of(faces, is_parallel)) return false;
  }
  return has_clear_face;
}

double FaceAttributes::difference(FaceAttribute attribute, Index mesh, Index vertex,
                                  double threshold) {
  const Query query{attribute, mesh, vertex, threshold};
  if (!is_comparable(attribute, mesh, vertex)) return 0.0;
  const SurfaceMatch& match = reader_.match(mesh, vertex);
  const BindSurface& source = reader_.source().surface;
  const SurfacePlace matched{source.first_triangle[match.mesh] + match.triangle, match.barycentric};
  double least = excess(query, matched);
  if (least <= threshold) return least;
  if (!search_) search_.emplace(source);
  Vec3d place = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    place += match.barycentric[k] * source.positions[source.triangles[matched.triangle][k]];
  const auto faces = search_->within(place, kTouches * source.diagonal);
  if (!lies_in(reader_.target().surface.first_vertex[mesh] + vertex, faces)) return 0.0;
  for (const SurfacePlace& face : faces) least = std::min(least, excess(query, face));
  if (attribute != FaceAttribute::uv || corner_of(match) < 3) return least;
  reader_.actual(mesh, vertex, actual_);
  reader_.expected(match, match.barycentric, expected_);
  return distance(actual_, expected_) <= kSameWeights ? least : 0.0;
}

}  // namespace sunder::validation
