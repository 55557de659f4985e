#include <sunder/bodies/convex_hulls.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "tear/bodies/hull_of_points.h"
#include "tear/bodies/internal/posed_surface.h"
#include "tear/bodies/parts.h"
#include "tear/bodies/qhull.h"

namespace sunder {
namespace {

Status check_options(const HullOptions& options) {
  if (!bodies::has_qhull())
    return Status::failure(StatusCode::unsupported_feature, kNone,
                           "convex hulls need Qhull; build with SUNDER_QHULL");
  if (options.maximum_points < 4 || options.maximum_points > 65535)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "hulls of at most %u points; it must be 4 to 65535",
                           options.maximum_points);
  if (options.maximum_hulls == 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "at most 0 hulls; it must be 1 or more");
  return {};
}

Status check_points(std::span<const Vec3d> points) {
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      return Status::failure(StatusCode::non_finite_value, i, "point %u is not finite", i);
  return {};
}

}  // namespace

bool has_convex_hulls() { return bodies::has_qhull(); }

Result<ConvexHull> convex_hull(std::span<const Vec3d> points, std::uint32_t maximum_points) {
  HullOptions options;
  options.maximum_points = maximum_points;
  if (Status status = check_options(options); !status) return status;
  if (points.empty())
    return Status::failure(StatusCode::empty_input, kNone, "a hull needs at least one point");
  if (Status status = check_points(points); !status) return status;
  return or_out_of_memory(
      [&]() -> Result<ConvexHull> { return bodies::hull_of_points(points, maximum_points); });
}

Result<std::vector<ConvexHull>> convex_hulls(std::span<const Vec3d> positions,
                                             std::span<const Triangle> triangles,
                                             std::span<const std::uint32_t> part_of_triangle,
                                             const HullOptions& options) {
  if (Status status = check_options(options); !status) return status;
  if (part_of_triangle.size() != triangles.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "there are parts of %zu triangles, and %zu triangles",
                           part_of_triangle.size(), triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (const std::uint32_t vertex : triangles[t])
      if (vertex >= positions.size())
        return Status::failure(StatusCode::index_out_of_range, t,
                               "triangle %u has vertex %u; there are %zu", t, vertex,
                               positions.size());
  if (Status status = check_points(positions); !status) return status;
  return or_out_of_memory([&]() -> Result<std::vector<ConvexHull>> {
    std::vector<ConvexHull> hulls;
    for (const bodies::Part& part :
         bodies::join_parts(positions, triangles, part_of_triangle, options.maximum_hulls)) {
      std::vector<Vec3d> points;
      for (const std::uint32_t vertex : part.vertices) points.push_back(positions[vertex]);
      hulls.push_back(bodies::hull_of_points(points, options.maximum_points));
      hulls.back().part = part.number;
    }
    if (hulls.empty())
      return Status::failure(StatusCode::empty_input, kNone,
                             "hulls need a surface; there is no triangle");
    return hulls;
  });
}

Result<std::vector<ConvexHull>> convex_hulls(const Character& character, const ModelPose& pose,
                                             const HullOptions& options) {
  if (Status status = check_options(options); !status) return status;
  return or_out_of_memory([&]() -> Result<std::vector<ConvexHull>> {
    const Result<bodies::PosedSurface> surface = bodies::pose_surface(character, pose);
    if (!surface) return surface.error();
    return convex_hulls(surface->positions, surface->triangles, surface->bones, options);
  });
}

std::uint32_t main_bone(const Triangle& triangle, const SkinWeights& weights, const Skin& skin) {
  // As MainBones does for many triangles, but without memory.
  const auto sum_of = [&](std::uint32_t slot) {
    float sum = 0;
    for (const std::uint32_t vertex : triangle)
      for (const Influence& of : weights.of(vertex))
        if (of.slot == slot) sum += of.weight;
    return sum;
  };
  Influence most{kNone, 0.0f};
  for (const std::uint32_t vertex : triangle)
    for (const Influence& influence : weights.of(vertex)) {
      const float sum = sum_of(influence.slot);
      if (sum > most.weight || (sum == most.weight && influence.slot < most.slot))
        most = {influence.slot, sum};
    }
  return skin.bones[most.slot];
}

}  // namespace sunder
