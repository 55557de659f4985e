#include "tools/picture/sewn_threads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace sunder::tools {
namespace {

constexpr float kReach = 0.9f, kRadius = 0.13f;  ///< Of a stitch, in thicknesses.
constexpr std::size_t kSides = 6;
/// Silk, linear RGB.
const Vec4f kThreadColor(0.012f, 0.012f, 0.016f, 1.0f);

/// Per vertex of a mesh: from it into the surface that it belongs to.
std::vector<Vec3f> inward_directions(const Mesh& mesh, const DeformedMesh& posed) {
  std::vector<Vec3f> sums(posed.positions.size(), Vec3f::Zero());
  for (const Triangle& triangle : mesh.triangles) {
    if (is_retired(triangle)) continue;
    const Vec3f centre = (posed.positions[triangle[0]] + posed.positions[triangle[1]] +
                          posed.positions[triangle[2]]) /
                         3.0f;
    for (const std::uint32_t vertex : triangle) sums[vertex] += centre - posed.positions[vertex];
  }
  return sums;
}

/// An end of a stitch: the lip, and where the thread goes into the skin.
struct StitchEnd {
  Vec3f lip, normal, in_skin;
};

void add_tube(const std::vector<Vec3f>& line, const Vec3f& normal, float radius,
              std::uint32_t material, RenderScene& scene) {
  std::vector<std::array<Vec3f, kSides>> rings, facings;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3f along = line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0];
    const Vec3f side = along.cross(normal).normalized(), up = side.cross(along).normalized();
    std::array<Vec3f, kSides> ring, facing;
    for (std::size_t k = 0; k < kSides; ++k) {
      const auto angle = static_cast<float>(2 * std::numbers::pi * static_cast<double>(k) / kSides);
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
    for (std::size_t k = 0; k < kSides; ++k) {
      const std::size_t next = (k + 1) % kSides;
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
  std::vector<std::vector<Vec3f>> inward(open.size());
  const auto end_at = [&](std::uint32_t point, StitchEnd& end) {
    const MeshVertex at = vertex_at(torn, point);
    if (at.mesh == kNone || open[at.mesh].normals.empty()) return false;
    if (inward[at.mesh].empty())
      inward[at.mesh] = inward_directions(torn.character().meshes[at.mesh], open[at.mesh]);
    end.lip = open[at.mesh].positions[at.vertex];
    end.normal = open[at.mesh].normals[at.vertex];
    const Vec3f direction = inward[at.mesh][at.vertex];
    const Vec3f flat = direction - direction.dot(end.normal) * end.normal;
    if (!(flat.norm() > 0)) return false;
    end.in_skin = end.lip + reach * flat.normalized();
    return true;
  };
  scene.materials.emplace_back().factor = kThreadColor;
  const auto material = static_cast<std::uint32_t>(scene.materials.size() - 1);
  for (std::size_t i = 0; i < threads.size(); ++i) {
    if (i < loads.size() && loads[i].is_broken) continue;
    StitchEnd left, right;
    if (!end_at(threads[i].left, left) || !end_at(threads[i].right, right)) continue;
    const Vec3f normal = (left.normal + right.normal).normalized();
    if (!normal.allFinite()) continue;
    const auto above = [&](const Vec3f& place) { return Vec3f(place + radius * normal); };
    add_tube({left.in_skin - radius * left.normal, above(left.in_skin), above(left.lip),
              above(right.lip), above(right.in_skin), right.in_skin - radius * right.normal},
             normal, radius, material, scene);
  }
}

}  // namespace sunder::tools
