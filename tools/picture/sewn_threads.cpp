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
constexpr std::size_t kThreadSides = 6;
/// Silk, linear RGB.
const Vec4f kThreadColor(0.012f, 0.012f, 0.016f, 1.0f);

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

void add_tube(const std::vector<Vec3f>& line, const Vec3f& normal, float radius,
              std::uint32_t material, RenderScene& scene) {
  std::vector<std::array<Vec3f, kThreadSides>> rings, facings;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3f along = line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0];
    const Vec3f side = along.cross(normal).normalized(), up = side.cross(along).normalized();
    std::array<Vec3f, kThreadSides> ring, facing;
    for (std::size_t k = 0; k < kThreadSides; ++k) {
      const auto angle =
          static_cast<float>(2 * std::numbers::pi * static_cast<double>(k) / kThreadSides);
      facing[k] = std::cos(angle) * side + std::sin(angle) * up;
      ring[k] = line[i] + radius * facing[k];
    }
    rings.push_back(ring);
    facings.push_back(facing);
  }
  const auto add = [&](std::array<std::array<std::size_t, 2>, 3> corners) {
    RenderTriangle triangle;
    triangle.material = material;
    for (std::size_t c = 0; c < 3; ++c) {
      triangle.corners[c] = rings[corners[c][0]][corners[c][1]];
      triangle.normals[c] = facings[corners[c][0]][corners[c][1]];
      triangle.uvs[c] = Vec2f::Zero();
      triangle.tints[c].setOnes();
    }
    scene.triangles.push_back(triangle);
  };
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    for (std::size_t k = 0; k < kThreadSides; ++k) {
      const std::size_t next = (k + 1) % kThreadSides;
      add({{{i, k}, {i + 1, k}, {i, next}}});
      add({{{i, next}, {i + 1, k}, {i + 1, next}}});
    }
}

}  // namespace

void add_threads(const TornModel& torn, std::span<const DeformedMesh> open,
                 std::span<const ThreadLoad> loads, double thickness, RenderScene& scene) {
  const std::span<const SutureThread> threads = threads_of(torn);
  if (threads.empty()) return;
  const auto reach = kReach * static_cast<float>(thickness),
             radius = kRadius * static_cast<float>(thickness);
  const ThreadEnds ends(torn, open);
  scene.materials.emplace_back().factor = kThreadColor;
  const auto material = static_cast<std::uint32_t>(scene.materials.size() - 1);
  for (std::size_t i = 0; i < threads.size(); ++i) {
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
             normal, radius, material, scene);
  }
}

}  // namespace sunder::tools
