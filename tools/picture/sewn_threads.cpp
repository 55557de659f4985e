#include "tools/picture/sewn_threads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>

namespace sunder::tools {
namespace {

constexpr float kReach = 0.9f, kRadius = 0.13f;  ///< Of a stitch, in thicknesses.
constexpr std::size_t kThreadSides = ThreadTube::kSides;

/// Where the ends of threads are, and which way the surface lies from there.
class ThreadEnds {
 public:
  ThreadEnds(const TornModel& torn, std::span<const DeformedMesh> open) : torn_(torn), open_(open) {
    for (const SutureThread& thread : threads_of(torn))
      for (const std::uint32_t point : {thread.left, thread.right}) fans_[point];
    for (std::uint32_t m = 0; m < open.size(); ++m) add_fans(m);
  }

  struct End {
    Vec3f place, normal;
    Vec3f inward;  ///< Across the lip; of unit length, or 0.
  };
  /// Nothing where the point has no face any more, or its mesh no normals.
  [[nodiscard]] std::optional<End> at(std::uint32_t point) const {
    const MeshVertex at = vertex_at(torn_, point);
    if (at.mesh == kNone || open_[at.mesh].normals.empty()) return std::nullopt;
    End end{open_[at.mesh].positions[at.vertex], open_[at.mesh].normals[at.vertex], Vec3f::Zero()};
    const std::vector<Corner>& others = fans_.at(point);
    Vec3f sum = Vec3f::Zero();
    std::vector<Vec3f> along_lip;  // Only these are in one face of the fan.
    for (const Corner& other : others) {
      sum += other.place - end.place;
      if (std::ranges::count(others, other.point, &Corner::point) == 1)
        along_lip.push_back(other.place);
    }
    end.inward = sum - sum.dot(end.normal) * end.normal;
    if (along_lip.size() == 2) {
      const Vec3f across = end.normal.cross(along_lip[0] - along_lip[1]);
      end.inward = across.dot(end.inward) < 0 ? Vec3f(-across) : across;
    }
    end.inward.normalize();
    return end;
  }

 private:
  void add_fans(std::uint32_t m) {
    const std::vector<Triangle>& triangles = torn_.character().meshes[m].triangles;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (std::uint32_t c = 0; c < 3 && !is_retired(triangles[t]); ++c) {
        const auto fan = fans_.find(torn_.point_at(m, t, c));
        if (fan == fans_.end()) continue;
        for (const std::uint32_t k : {(c + 1) % 3, (c + 2) % 3})
          fan->second.push_back({torn_.point_at(m, t, k), open_[m].positions[triangles[t][k]]});
      }
  }

  const TornModel& torn_;
  std::span<const DeformedMesh> open_;
  struct Corner {
    std::uint32_t point;
    Vec3f place;
  };
  /// Per point: the other two corners of each face there, across seams.
  std::map<std::uint32_t, std::vector<Corner>> fans_;
};

/// Rings around a line.
void add_tube(const std::vector<Vec3f>& line, const Vec3f& normal, float radius, ThreadTube& tube) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3f along = line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0];
    const Vec3f side = along.cross(normal).normalized(), up = side.cross(along).normalized();
    for (std::size_t k = 0; k < kThreadSides; ++k) {
      const auto angle =
          static_cast<float>(2 * std::numbers::pi * static_cast<double>(k) / kThreadSides);
      tube.normals.emplace_back(std::cos(angle) * side + std::sin(angle) * up);
      tube.places.emplace_back(line[i] + radius * tube.normals.back());
    }
  }
}

}  // namespace

std::vector<Triangle> ThreadTube::triangles() const {
  std::vector<Triangle> triangles;
  const auto sides = static_cast<std::uint32_t>(kSides);
  for (std::uint32_t ring = 0; ring + sides < places.size(); ring += sides)
    for (std::uint32_t k = 0; k < sides; ++k) {
      const std::uint32_t here = ring + k, next = ring + (k + 1) % sides;
      triangles.push_back({here, here + sides, next});
      triangles.push_back({next, here + sides, next + sides});
    }
  if (places.empty()) return triangles;
  const auto last = static_cast<std::uint32_t>(places.size()) - sides;
  for (std::uint32_t k = 1; k + 1 < sides; ++k) {  // both ends are closed
    triangles.push_back({0, k, k + 1});
    triangles.push_back({last, last + k + 1, last + k});
  }
  return triangles;
}

std::vector<ThreadTube> thread_tubes(const TornModel& torn, std::span<const DeformedMesh> posed,
                                     std::span<const ThreadLoad> loads, double thickness) {
  const std::span<const SutureThread> threads = threads_of(torn);
  std::vector<ThreadTube> tubes;
  if (threads.empty()) return tubes;
  const auto reach = kReach * static_cast<float>(thickness),
             radius = kRadius * static_cast<float>(thickness);
  const ThreadEnds ends(torn, posed);
  for (std::size_t i = 0; i < threads.size(); ++i) {
    ThreadTube& tube = tubes.emplace_back(ThreadTube{threads[i].left, threads[i].right, {}, {}});
    if (i < loads.size() && loads[i].is_broken) continue;
    const auto left = ends.at(threads[i].left), right = ends.at(threads[i].right);
    if (!left || !right) continue;
    const Vec3f normal = (left->normal + right->normal).normalized();
    Vec3f across = left->inward - right->inward;
    across = (across - across.dot(normal) * normal).normalized();
    if (!(normal.norm() > 0.5f && across.norm() > 0.5f)) continue;
    const Vec3f in_left = left->place + reach * across, in_right = right->place - reach * across;
    const Vec3f lift = radius * normal;
    add_tube({in_left - lift, in_left + lift, left->place + lift, right->place + lift,
              in_right + lift, in_right - lift},
             normal, radius, tube);
  }
  return tubes;
}

void add_threads(std::span<const ThreadTube> threads, RenderScene& scene) {
  if (threads.empty()) return;
  scene.materials.emplace_back().factor = kThreadColor;
  for (const ThreadTube& tube : threads)
    for (const Triangle& corners : tube.triangles()) {
      RenderTriangle triangle;
      triangle.material = static_cast<std::uint32_t>(scene.materials.size() - 1);
      for (std::size_t c = 0; c < 3; ++c) {
        triangle.corners[c] = tube.places[corners[c]];
        triangle.normals[c] = tube.normals[corners[c]];
        triangle.uvs[c] = Vec2f::Zero();
        triangle.tints[c].setOnes();
      }
      scene.triangles.push_back(triangle);
    }
}

}  // namespace sunder::tools
