#include "tear/filling/flat_triangles.h"

#include <algorithm>
#include <map>
#include <memory_resource>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"

namespace sunder::tear {
namespace {

/// In bind space.
Eigen::Vector3d place(Index point, const CapVertices& of, const SurfaceEditor& editor) {
  return editor.births.position(of.mesh, of.vertices[point]).cast<double>();
}

/// The triangles of a cap, found by their edges.
class TriangulatedCap {
 public:
  TriangulatedCap(std::span<FlatTriangle> triangles, const CapVertices& vertices, const CapRim& rim,
                  const SurfaceEditor& editor)
      : triangles_(triangles),
        vertices_(vertices),
        rim_(rim),
        editor_(editor),
        triangle_at_(&editor.scratch()) {
    for (std::size_t t = 0; t < triangles.size(); ++t) enter(t);
  }

  [[nodiscard]] bool is_flat(const FlatTriangle& t) const {
    return height_of(t) <= kStoredCoordinates * at(t[0]).cwiseAbs().maxCoeff();
  }
  /// Flips the longest edge of a triangle where that helps.
  void turn(std::size_t t) {
    const FlatTriangle flat = triangles_[t];
    const std::size_t k = longest_edge(flat);
    const Index a = flat[k], b = flat[(k + 1) % 3], c = flat[(k + 2) % 3];
    const auto across = triangle_at_.find({b, a});
    if (across == triangle_at_.end()) return;
    const std::size_t other = across->second;
    const FlatTriangle& of_other = triangles_[other];
    const Index d = of_other[0] != a && of_other[0] != b   ? of_other[0]
                    : of_other[1] != a && of_other[1] != b ? of_other[1]
                                                           : of_other[2];
    if (triangle_at_.count({c, d}) != 0 || triangle_at_.count({d, c}) != 0) return;
    if (std::max(c, d) < rim_.size() && rim_.is_joined(c, d, editor_.surface())) return;
    if (!(std::min(height_of({a, d, c}), height_of({d, b, c})) > height_of(flat))) return;
    triangle_at_.erase({a, b});
    triangle_at_.erase({b, a});
    triangles_[t] = {a, d, c};
    triangles_[other] = {d, b, c};
    enter(t);
    enter(other);
  }

 private:
  [[nodiscard]] Eigen::Vector3d at(Index point) const { return place(point, vertices_, editor_); }
  [[nodiscard]] double height_of(const FlatTriangle& t) const {
    const double longest =
        std::max({norm(at(t[1]) - at(t[0])), norm(at(t[2]) - at(t[1])), norm(at(t[0]) - at(t[2]))});
    return longest > 0 ? norm((at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]))) / longest : 0.0;
  }
  [[nodiscard]] std::size_t longest_edge(const FlatTriangle& of) const {
    const auto length = [&](std::size_t k) { return norm(at(of[(k + 1) % 3]) - at(of[k])); };
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (length(k) > length(longest)) longest = k;
    return longest;
  }
  void enter(std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k)
      triangle_at_[{triangles_[t][k], triangles_[t][(k + 1) % 3]}] = t;
  }

  std::span<FlatTriangle> triangles_;
  const CapVertices& vertices_;
  const CapRim& rim_;
  const SurfaceEditor& editor_;
  std::pmr::map<std::array<Index, 2>, std::size_t> triangle_at_;  ///< By directed edge.
};

bool have_area(std::span<const FlatTriangle> triangles, const CapVertices& of,
               const SurfaceEditor& editor) {
  return std::all_of(triangles.begin(), triangles.end(), [&](const FlatTriangle& t) {
    const Eigen::Vector3d a = place(t[0], of, editor), ab = place(t[1], of, editor) - a,
                          ac = place(t[2], of, editor) - a;
    return squared_norm(ab.cross(ac)) > 0;
  });
}

}  // namespace

bool has_flat_triangles(std::span<const FlatTriangle> triangles, const CapVertices& of,
                        const SurfaceEditor& editor) {
  return std::any_of(triangles.begin(), triangles.end(), [&](const FlatTriangle& t) {
    const Eigen::Vector3d a = place(t[0], of, editor);
    const Eigen::Vector3d ab = place(t[1], of, editor) - a, ac = place(t[2], of, editor) - a,
                          bc = ac - ab;
    const double longest = std::max({squared_norm(ab), squared_norm(bc), squared_norm(ac)});
    const double height = kStoredCoordinates * a.cwiseAbs().maxCoeff();
    return !(squared_norm(ab.cross(ac)) > height * height * longest);
  });
}

bool turn_flat_triangles(std::span<FlatTriangle> triangles, const CapVertices& of,
                         const CapRim& rim, const SurfaceEditor& editor) {
  TriangulatedCap cap(triangles, of, rim, editor);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (cap.is_flat(triangles[t])) cap.turn(t);
  return have_area(triangles, of, editor);
}

}  // namespace sunder::tear
