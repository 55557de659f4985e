#include "tools/picture/recipe_rigs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "tools/demo/surface_nets.h"

namespace sunder::tools {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kColumns = 150, kRows = 100;  ///< Cells of sheets.

/// A character of one mesh that follows one bone.
Character rig_of(Mesh mesh) {
  Character character;
  character.name = mesh.name;
  character.skeleton.bones.push_back({"Root", kNone, {}});
  character.skins = {{mesh.name, {0}, {Affine3f::Identity()}}};
  mesh.submeshes = {{mesh.name, kNone}};
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  const std::array<Influence, 1> held = {{{0, 1.0f}}};
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) mesh.weights.append(held);
  character.meshes.push_back(std::move(mesh));
  return character;
}

/// @param color_at  linear RGBA.
Mesh make_grid(const char* name, const std::function<Vec4f(const Vec2d&)>& color_at) {
  Mesh mesh;
  mesh.name = name;
  mesh.color_sets.emplace_back();
  for (std::uint32_t j = 0; j <= kRows; ++j)
    for (std::uint32_t i = 0; i <= kColumns; ++i) {
      const Vec2d at(kSheetSize.x() * (i / double{kColumns} - 0.5),
                     kSheetSize.y() * (j / double{kRows} - 0.5));
      mesh.positions.emplace_back(static_cast<float>(at.x()), static_cast<float>(at.y()), 0.0f);
      mesh.normals.push_back(Vec3f::UnitZ());
      mesh.color_sets[0].push_back(color_at(at));
    }
  for (std::uint32_t j = 0; j < kRows; ++j)
    for (std::uint32_t i = 0; i < kColumns; ++i) {
      const std::uint32_t a = j * (kColumns + 1) + i, b = a + 1, c = a + kColumns + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// The place of a point of the sheet in the triangles of make_grid().
TissuePlace place_on_grid(const Vec2d& at) {
  const double x = (at.x() / kSheetSize.x() + 0.5) * kColumns,
               y = (at.y() / kSheetSize.y() + 0.5) * kRows;
  const auto i = std::min(kColumns - 1, static_cast<std::uint32_t>(std::max(x, 0.0)));
  const auto j = std::min(kRows - 1, static_cast<std::uint32_t>(std::max(y, 0.0)));
  const double u = std::clamp(x - i, 0.0, 1.0), v = std::clamp(y - j, 0.0, 1.0);
  const std::uint32_t cell = 2 * (j * kColumns + i);
  if (u >= v) return {0, cell, {1 - u, u - v, v}};
  return {0, cell + 1, {1 - v, u, v - u}};
}

/// The row of holes, from below to above.
Vec2d hole_at(double share) {
  return {0.02 * std::sin(2 * kPi * share), kSheetSize.y() * (share - 0.5)};
}

Mesh mesh_of(const char* name, const std::function<double(const Vec3d&)>& field,
             const PointSurface& surface, const Vec4f& color) {
  Mesh mesh;
  mesh.name = name;
  for (const Vec3d& at : surface.positions) {
    mesh.positions.push_back(at.cast<float>());
    mesh.normals.push_back(field_normal(field, at).cast<float>().normalized());
  }
  mesh.color_sets.emplace_back(mesh.positions.size(), color);
  mesh.triangles = surface.triangles;
  return mesh;
}

double distance_to_capsule(const Vec3d& at, const Vec3d& from, const Vec3d& to, double radius) {
  const Vec3d along = to - from;
  const double share = std::clamp((at - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (at - from - share * along).norm() - radius;
}

/// Four fingers and a thumb on a palm that goes on below y = 0.
double glove_field(const Vec3d& at) {
  constexpr std::array<std::array<double, 3>, 4> kFingers = {
      {{-0.0315, -0.040, 0.170},
       {-0.0105, -0.013, 0.187},
       {0.0105, 0.014, 0.182},
       {0.0315, 0.041, 0.155}}};  // x at the knuckles and at the tip, y at the tip
  constexpr double kFinger = 0.0088;
  const auto melt = [](double a, double b, double width) {
    const double h = std::max(0.0, 1 - std::abs(a - b) / width);
    return std::min(a, b) - 0.25 * h * h * width;
  };
  double field = 1;
  for (const std::array<double, 3>& finger : kFingers)
    field = melt(field,
                 distance_to_capsule(at, {finger[0], 0.09, 0}, {finger[1], finger[2], 0}, kFinger),
                 0.004);
  const double thumb = distance_to_capsule(at, {-0.025, 0.05, 0.002}, {-0.075, 0.115, 0.008}, 0.01);
  field = melt(field, thumb, 0.02);
  // The palm, and the wrist below it, are flattened.
  const Vec3d flat(at.x(), at.y(), 2.0 * at.z());
  const double palm = distance_to_capsule({0.8 * flat.x(), flat.y(), flat.z()}, {0, 0.055, 0},
                                          {0, 0.085, 0}, 0.032);
  const double wrist = distance_to_capsule({flat.x(), flat.y(), 0.75 * flat.z()}, {0, -0.04, 0},
                                           {0, 0.05, 0}, 0.028);
  return melt(melt(field, 0.7 * palm, 0.012), wrist, 0.02);
}

}  // namespace

PerforatedPaper make_perforated_paper() {
  constexpr int kHoles = 18, kPlaces = 90;
  constexpr double kHole = 0.0028;
  PerforatedPaper paper;
  paper.character = rig_of(make_grid("Paper", [](const Vec2d& at) {
    double nearest = 1;
    for (int i = 0; i < kHoles; ++i)
      nearest = std::min(nearest, (at - hole_at((i + 0.5) / kHoles)).norm());
    const auto light = static_cast<float>(std::clamp(nearest / kHole - 0.5, 0.08, 0.82));
    return Vec4f(light, light, light, 1);
  }));
  for (int i = 0; i <= kPlaces; ++i)
    paper.holes.push_back(place_on_grid(hole_at(i / double{kPlaces})));
  return paper;
}

Character make_seamed_cloth() {
  constexpr double kHalfWidth = 0.007, kStitch = 0.012;
  return rig_of(make_grid("Cloth", [](const Vec2d& at) {
    const double beside = std::abs(at.y() - 0.01 * std::sin(2 * kPi * at.x() / kSheetSize.x()));
    const double seam = std::clamp(2 - beside / kHalfWidth, 0.0, 1.0);
    // Two rows of stitches, beside the line along which the parts meet.
    const bool is_stitch = std::abs(beside - 0.6 * kHalfWidth) < 0.0017 &&
                           std::fmod(at.x() + 1, kStitch) < 0.6 * kStitch;
    if (is_stitch) return Vec4f(0.85f, 0.75f, 0.45f, static_cast<float>(seam));
    return Vec4f(0.06f, 0.12f, 0.32f, static_cast<float>(seam));
  }));
}

Character make_orange() {
  const auto field = [](const Vec3d& at) { return at.norm() - kOrangeRadius; };
  const Vec3d corner = Vec3d::Constant(1.1 * kOrangeRadius);
  return rig_of(mesh_of("Peel", field, surface_nets(field, -corner, corner, 0.0016),
                        {0.85f, 0.24f, 0.02f, 1}));
}

Character make_glove() {
  const PointSurface closed =
      surface_nets(glove_field, {-0.11, -0.08, -0.06}, {0.08, 0.22, 0.06}, 0.0025);
  PointSurface open;
  std::vector<std::uint32_t> kept(closed.positions.size(), kNone);
  for (const Triangle& triangle : closed.triangles) {
    if (std::ranges::any_of(triangle, [&](auto v) { return closed.positions[v].y() < 0; }))
      continue;
    Triangle points = {};
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t& point = kept[triangle[i]];
      if (point == kNone) {
        point = static_cast<std::uint32_t>(open.positions.size());
        open.positions.push_back(closed.positions[triangle[i]]);
      }
      points[i] = point;
    }
    open.triangles.push_back(points);
  }
  Mesh mesh = mesh_of("Glove", glove_field, open, {0.42f, 0.52f, 0.68f, 1});
  CustomAttribute thickness = {"_THICKNESS", 1, true, {}};
  for (const Vec3f& at : mesh.positions)
    thickness.values.push_back(1 + std::clamp(2 - at.y() / 0.02f, 0.0f, 1.0f));
  mesh.custom_attributes.push_back(std::move(thickness));
  return rig_of(std::move(mesh));
}

}  // namespace sunder::tools
