#include "tools/picture/enclosing_faces.h"

#include <array>
#include <limits>

#include "tools/render/triangle_tree.h"

namespace sunder::tools {
namespace {

/// Rays begin this share of the size of all behind the triangle.
constexpr float kBegin = 1e-4f;
/// Of the five rays per triangle, one straight inwards and four at 45 degrees to it.
constexpr int kMostThatEscape = 2;

Vec3f doubled_area(const TriangleTree::Corners& of) { return (of[1] - of[0]).cross(of[2] - of[0]); }

std::array<Vec3f, 5> directions(const Vec3f& inwards) {
  const Vec3f side = inwards.unitOrthogonal(), other = inwards.cross(side);
  return {inwards, Vec3f(inwards + side), Vec3f(inwards - side), Vec3f(inwards + other),
          Vec3f(inwards - other)};
}

bool encloses(const TriangleTree& tree, const std::vector<TriangleTree::Corners>& all,
              const TriangleTree::Corners& of, float size) {
  const Vec3f normal = doubled_area(of);
  if (!(normal.norm() > 0)) return false;
  const Vec3f inwards = -normal.normalized();
  const Vec3f from = (of[0] + of[1] + of[2]) / 3.0f + kBegin * size * inwards;
  int escaped = 0;
  for (const Vec3f& way : directions(inwards)) {
    const TriangleTree::Hit hit = tree.first_hit(from, way, 2 * size);
    if (hit.triangle == kNone || doubled_area(all[hit.triangle]).dot(way) <= 0) ++escaped;
  }
  return escaped <= kMostThatEscape;
}

}  // namespace

std::vector<std::vector<bool>> enclosing_faces(const Character& character,
                                               const std::vector<DeformedMesh>& posed) {
  std::vector<TriangleTree::Corners> corners;
  Vec3f least = Vec3f::Constant(std::numeric_limits<float>::max()), greatest = -least;
  const auto for_each = [&](auto visit) {
    for (std::size_t m = 0; m < posed.size(); ++m)
      for (std::size_t t = 0; t < character.meshes[m].triangles.size(); ++t)
        if (const Triangle& triangle = character.meshes[m].triangles[t]; !is_retired(triangle))
          visit(m, t, triangle);
  };
  for_each([&](std::size_t m, std::size_t, const Triangle& triangle) {
    TriangleTree::Corners& added = corners.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      added[k] = posed[m].positions[triangle[k]];
      least = least.cwiseMin(added[k]);
      greatest = greatest.cwiseMax(added[k]);
    }
  });
  const TriangleTree tree(corners);
  const float size = (greatest - least).norm();
  std::vector<std::vector<bool>> enclosing;
  for (std::size_t m = 0; m < posed.size(); ++m)
    enclosing.emplace_back(character.meshes[m].triangles.size());
  std::size_t i = 0;
  for_each([&](std::size_t m, std::size_t t, const Triangle&) {
    enclosing[m][t] = encloses(tree, corners, corners[i++], size);
  });
  return enclosing;
}

}  // namespace sunder::tools
