// The shape of the walls of lips: normals, texture coordinates, growth, room below, closure.
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::down_at;
using test::make_model;
using test::Random;

/// The triangles of mesh 0 in submeshes of a name, or of other names.
std::vector<Triangle> triangles_of(const Character& character, bool of_walls) {
  const Mesh& mesh = character.meshes[0];
  std::vector<Triangle> found;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if ((mesh.submeshes[mesh.triangle_submesh[t]].name == "wall") == of_walls)
      found.push_back(mesh.triangles[t]);
  return found;
}

std::vector<Triangle> live(std::vector<Triangle> triangles) {
  std::erase_if(triangles, [](const Triangle& t) { return t[0] == t[1] && t[1] == t[2]; });
  return triangles;
}

using Corners = std::array<Vec3d, 3>;
Corners corners_of(const std::vector<Vec3d>& positions, const Triangle& triangle) {
  return {positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]};
}
Vec3d normal_of(const Corners& at) { return Vec3d(at[1] - at[0]).cross(Vec3d(at[2] - at[0])); }

/// Where a segment meets a triangle, as a fraction of its way.
std::optional<double> meet(const Vec3d& from, const Vec3d& to, const Corners& at) {
  const Vec3d way = to - from, ab = at[1] - at[0], ac = at[2] - at[0], h = way.cross(ac);
  const double determinant = ab.dot(h);
  if (std::abs(determinant) < 1e-18) return {};
  const Vec3d offset = from - at[0], q = offset.cross(ab);
  const double u = offset.dot(h) / determinant, v = way.dot(q) / determinant,
               t = ac.dot(q) / determinant;
  if (u < 0 || v < 0 || u + v > 1 || t < 0 || t > 1) return {};
  return t;
}

/// Edges of walls that pass through the surface, except at its lips.
int piercing_edges(const Character& character, const std::vector<Vec3d>& positions) {
  const auto walls = live(triangles_of(character, true)),
             others = live(triangles_of(character, false));
  int count = 0;
  for (const Triangle& wall : walls)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d a = positions[wall[k]], b = positions[wall[(k + 1) % 3]];
      const double size = (b - a).norm();
      for (const Triangle& other : others) {
        const Corners at = corners_of(positions, other);
        const auto place = meet(a, b, at);
        if (!place) continue;
        const Vec3d where = a + *place * (b - a);
        // Lips and what lies beside them: the wall begins there.
        const bool is_begin = *place < 1e-3 || *place > 1 - 1e-3;
        const bool is_lip = std::ranges::any_of(at, [&](const Vec3d& corner) {
          return (corner - a).norm() < 1e-6 || (corner - b).norm() < 1e-6 ||
                 (corner - where).norm() < 1e-3 * size;
        });
        count += is_begin || is_lip ? 0 : 1;
      }
    }
  return count;
}

TEST(WallShape, normals_look_into_the_wound) {
  Random random(5);
  int corners = 0, inward = 0;
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    Character source = i % 2 == 0 ? test::make_sheet(8 + random.index(12))
                                  : test::make_tube(8 + random.index(8), 10 + random.index(8), 3);
    for (const Vec3f& n : source.meshes[0].normals) {
      const Vec3f across = n.unitOrthogonal();
      source.meshes[0].tangents.emplace_back(across.x(), across.y(), across.z(), 1.0f);
    }
    TornModel model = make_model(source);
    const ModelPose pose = *bind_pose(model.source());
    const Stroke stroke =
        test::random_stroke(model.source(), pose, random, random.uniform(0.1, 0.4), 3);
    TearOptions options;
    options.wall_depth = random.uniform(0.01, 0.05);
    if (random.index(2) == 0) options.width = random.uniform(0.005, 0.03);
    ASSERT_TRUE(model.tear(pose, stroke, options));
    const auto positions = test::posed_positions(model.character(), 0, pose);
    const Mesh& mesh = model.character().meshes[0];
    for (const Triangle& wall : live(triangles_of(model.character(), true))) {
      const Vec3d face = normal_of(corners_of(positions, wall)).normalized();
      const bool is_at_lip = std::ranges::any_of(
          wall, [&](std::uint32_t v) { return mesh.uv_sets[0][v].y() == 0.0f; });
      for (const std::uint32_t v : wall) {
        if (!is_at_lip) continue;  // below the bends of a gap, rows may cross out of sight
        ++corners;
        inward += face.dot(mesh.normals[v].cast<double>()) > 0 ? 0 : 1;
        // 1e-5, but for vertices where the wall was torn across, whose directions are interpolated.
        EXPECT_LT(std::abs(mesh.normals[v].dot(mesh.tangents[v].head<3>())), 1e-3f);
      }
    }
  }
  EXPECT_GT(corners, 3000);
  EXPECT_LE(inward, 3) << "rows may be twisted where the rim has a sharp corner";
}

TEST(WallShape, texture_coordinates_go_along_the_wound_and_down_in_units_of_the_depth) {
  TornModel model = make_model(test::make_sheet(20));
  const ModelPose pose = *bind_pose(model.source());
  TearOptions options;
  options.wall_depth = 0.04;
  const Stroke stroke = {down_at(0.21, 0.5), down_at(0.45, 0.55), down_at(0.8, 0.52)};
  ASSERT_TRUE(model.tear(pose, stroke, options));
  const Mesh& mesh = model.character().meshes[0];
  double deepest = 0, lowest = 0, highest = 0;
  for (const Triangle& wall : live(triangles_of(model.character(), true)))
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = wall[k], b = wall[(k + 1) % 3];
      const Vec2f uv = mesh.uv_sets[0][a], step = mesh.uv_sets[0][b] - uv;
      lowest = std::min(lowest, double{uv.x()});
      highest = std::max(highest, double{uv.x()});
      deepest = std::max(deepest, double{uv.y()});
      if (mesh.positions[a].z() == 0 && mesh.positions[b].z() == 0) {
        EXPECT_EQ(uv.y(), 0.0f);  // along the lip
        EXPECT_NEAR(std::abs(step.x()), (mesh.positions[b] - mesh.positions[a]).norm() / 0.04f,
                    1e-4);
      }
    }
  // Both lips count from the tip at which the stroke begins, one of them backwards.
  EXPECT_NEAR(highest, -lowest, 1e-3);
  EXPECT_NEAR(highest, (Vec2d(0.24, 0.05).norm() + Vec2d(0.35, 0.03).norm()) / 0.04, 0.1);
  EXPECT_GT(deepest, 1.0);
  EXPECT_LT(deepest, 1.5);
  // Each vertex of a seam has the texture coordinates of its own lip.
  std::map<std::array<float, 3>, std::vector<float>> at;
  for (const Triangle& wall : live(triangles_of(model.character(), true)))
    for (const std::uint32_t v : wall)
      if (mesh.positions[v].z() < 0)
        at[{mesh.positions[v].x(), mesh.positions[v].y(), mesh.positions[v].z()}].push_back(
            mesh.uv_sets[0][v].x());
  for (const auto& [place, us] : at)
    for (const float u : us) EXPECT_NEAR(std::abs(u), std::abs(us.front()), 1e-3);
}

/// A stroke across a sheet, in pieces.
Stroke straight(int segments) {
  Stroke stroke;
  for (int i = 0; i <= segments; ++i) stroke.push_back(down_at(0.2 + 0.6 * i / segments, 0.503));
  return stroke;
}

TEST(WallShape, grows_while_the_stroke_goes_on) {
  for (const double width : {0.0, 0.03}) {
    SCOPED_TRACE(width);
    TornModel model = make_model(test::make_sheet(24));
    const ModelPose pose = *bind_pose(model.source());
    TearOptions options;
    options.wall_depth = 0.03;
    options.width = width;
    const Stroke stroke = straight(12);
    auto tear = TearStroke::create(model, pose, stroke[0], options);
    ASSERT_TRUE(tear);
    std::size_t before = 0;
    double farthest = 0;
    for (std::size_t i = 1; i < stroke.size(); ++i) {
      ASSERT_TRUE(tear->extend(pose, stroke[i]));
      const auto walls = live(triangles_of(model.character(), true));
      EXPECT_GE(walls.size(), before);
      before = walls.size();
      farthest = 0;
      for (const Triangle& wall : walls)
        farthest = std::max(farthest, double{model.character().meshes[0].positions[wall[0]].x()});
      if (i >= 5) {
        EXPECT_GT(farthest, stroke[i].tip.x() - 0.25) << i;
      }
      EXPECT_LT(farthest, stroke[i].tip.x()) << i;
      ASSERT_THAT(test::broken_laws(model), testing::IsEmpty());
      ASSERT_THAT(test::broken_surface(model), testing::IsEmpty());
    }
    ASSERT_TRUE(tear->end());
    EXPECT_GT(live(triangles_of(model.character(), true)).size(), before);
    std::size_t submeshes = 0;
    for (const Submesh& submesh : model.character().meshes[0].submeshes)
      submeshes += submesh.name == "wall" ? 1 : 0;
    EXPECT_EQ(submeshes, 1u);
    TornModel at_once = make_model(test::make_sheet(24));
    ASSERT_TRUE(at_once.tear(pose, stroke, options));
    EXPECT_EQ(at_once.character(), model.character());
    ASSERT_TRUE(model.undo());
    EXPECT_EQ(model.character(), model.source());
    ASSERT_TRUE(model.redo());
    EXPECT_EQ(at_once.character(), model.character());
  }
}

TEST(WallShape, has_the_material_that_is_named) {
  TornModel model = make_model(test::make_tube(10, 12, 3));
  const ModelPose pose = *bind_pose(model.source());
  TearOptions options;
  options.wall_depth = 0.05;
  options.wall_material = 5;
  const Stroke stroke = {{{-0.2, 1.2, 0.8}, {-0.2, 1.2, 0.2}}, {{0.2, 1.8, 0.8}, {0.2, 1.8, 0.2}}};
  ASSERT_TRUE(model.tear(pose, stroke, options));
  EXPECT_EQ(model.character().meshes[0].submeshes.back().material, 5u);
  PlaneCut cut;
  cut.point = {0, 0.7, 0};
  cut.normal = {0, 1, 0};
  cut.caps = true;
  cut.cap_material = 6;
  ASSERT_TRUE(model.cut(pose, cut));
  EXPECT_EQ(model.character().meshes[0].submeshes.back().name, "cap");
  EXPECT_EQ(model.character().meshes[0].submeshes.back().material, 6u);
  Bore bore{{0, 2.5, 1}, {0, 0, -1}, 0.1, 5};
  bore.wall = true;
  bore.wall_material = 7;
  ASSERT_TRUE(model.drill(pose, bore));
  EXPECT_EQ(model.character().meshes[0].submeshes.back().name, "wall");
  EXPECT_EQ(model.character().meshes[0].submeshes.back().material, 7u);
}

/// Materials of walls chosen per vertex: 3 on the left, the rim's in the middle, 5 on the right.
Character with_wall_materials(Character character) {
  Mesh& mesh = character.meshes[0];
  CustomAttribute materials{"_WALL_MATERIAL", 1, false, {}};
  for (const Vec3f& at : mesh.positions)
    materials.values.push_back(at.x() < -0.1f ? 3.0f : at.x() > 0.1f ? 5.0f : -1.0f);
  mesh.custom_attributes.push_back(std::move(materials));
  return character;
}

/// The least and the greatest x of the walls of a material, in bind space.
std::map<std::uint32_t, std::pair<float, float>> extents_of_walls(const TornModel& model) {
  std::map<std::uint32_t, std::pair<float, float>> extents;
  const Mesh& mesh = model.character().meshes[0];
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Submesh& submesh = mesh.submeshes[mesh.triangle_submesh[t]];
    if (submesh.name != "wall" || mesh.triangles[t][0] == mesh.triangles[t][1]) continue;
    for (const std::uint32_t v : mesh.triangles[t]) {
      const float x = mesh.positions[v].x();
      const auto [at, is_new] = extents.try_emplace(submesh.material, x, x);
      at->second = {std::min(at->second.first, x), std::max(at->second.second, x)};
    }
  }
  return extents;
}

TEST(WallShape, has_the_materials_that_vertices_choose) {
  const Character source = with_wall_materials(test::make_tube(40, 48, 3));
  TornModel model = make_model(source);
  const std::uint32_t of_rim = source.meshes[0].submeshes[0].material;
  const ModelPose pose = *bind_pose(model.source());
  const test::ModelState before = test::state_of(model);
  TearOptions options;
  options.wall_depth = 0.05;
  const Stroke stroke = {{{-0.25, 1.2, 0.8}, {-0.25, 1.2, 0.1}},
                         {{0.25, 1.25, 0.8}, {0.25, 1.25, 0.1}}};
  ASSERT_TRUE(model.tear(pose, stroke, options));
  const auto extents = extents_of_walls(model);
  ASSERT_EQ(extents.size(), 3u);
  // The choice is that of the nearest vertex: half an edge to either side.
  EXPECT_LT(extents.at(3).second, -0.04f);
  EXPECT_GT(extents.at(5).first, 0.04f);
  EXPECT_GT(extents.at(of_rim).first, -0.16f);
  EXPECT_LT(extents.at(of_rim).second, 0.16f);
  EXPECT_THAT(test::broken_laws(model), ::testing::IsEmpty());

  const test::ModelState torn = test::state_of(model);
  ASSERT_TRUE(model.undo());
  EXPECT_EQ(test::difference(test::state_of(model), before), "");
  ASSERT_TRUE(model.redo());
  EXPECT_EQ(test::difference(test::state_of(model), torn), "");

  options.wall_material = 7;  // what an operation names counts for all of its walls
  ASSERT_TRUE(model.undo());
  ASSERT_TRUE(model.tear(pose, stroke, options));
  EXPECT_EQ(extents_of_walls(model).size(), 1u);
  EXPECT_TRUE(extents_of_walls(model).contains(7));
}

TEST(WallShape, materials_of_vertices_are_those_of_strokes_bores_and_random_tears) {
  Random random(46);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    TornModel model = make_model(with_wall_materials(test::make_tube(30, 24, 4)));
    const ModelPose pose = *bind_pose(model.source());
    TearOptions options;
    options.wall_depth = 0.04;
    options.width = i % 2 == 0 ? 0.0 : 0.02;
    const double low = random.uniform(0.3, 1.5);
    const Stroke stroke = {{{-0.3, low, 0.8}, {-0.3, low, 0.1}},
                           {{0.0, low + random.uniform(-0.2, 0.2), 0.8}, {0.0, low, 0.1}},
                           {{0.3, low + random.uniform(-0.2, 0.2), 0.8}, {0.3, low, 0.1}}};
    TornModel by_blades = make_model(model.source());
    ASSERT_TRUE(model.tear(pose, stroke, options));
    auto live = TearStroke::create(by_blades, pose, stroke[0], options);
    ASSERT_TRUE(live);
    for (std::size_t b = 1; b < stroke.size(); ++b) ASSERT_TRUE(live->extend(pose, stroke[b]));
    ASSERT_TRUE(live->end());
    EXPECT_EQ(extents_of_walls(by_blades), extents_of_walls(model));
    Bore bore{{0.1, low, 1}, {0, 0, -1}, 0.1, 5};
    bore.wall = true;
    ASSERT_TRUE(model.drill(pose, bore));
    for (const auto& [material, extent] : extents_of_walls(model))
      EXPECT_TRUE(material == 3 || material == 5 ||
                  material == model.source().meshes[0].submeshes[0].material);
    EXPECT_THAT(test::broken_laws(model), ::testing::IsEmpty());
  }
}

TEST(WallShape, begins_with_a_rim_where_lips_roll_outwards) {
  for (const double width : {0.0, 0.03}) {
    SCOPED_TRACE(width);
    TornModel model = make_model(test::make_sheet(24));
    const ModelPose pose = *bind_pose(model.source());
    TearOptions options;
    options.wall_depth = 0.04;
    options.width = width;
    options.lip_roll = 0.01;
    ASSERT_TRUE(model.tear(pose, straight(4), options));
    EXPECT_THAT(test::broken_laws(model), testing::IsEmpty());
    EXPECT_THAT(test::broken_surface(model), testing::IsEmpty());
    double highest = 0, lowest = 0;
    for (const Triangle& wall : live(triangles_of(model.character(), true)))
      for (const std::uint32_t v : wall) {
        highest = std::max(highest, double{model.character().meshes[0].positions[v].z()});
        lowest = std::min(lowest, double{model.character().meshes[0].positions[v].z()});
      }
    EXPECT_NEAR(highest, 0.6 * options.lip_roll, 1e-6);
    EXPECT_NEAR(lowest, -options.wall_depth, 1e-6);
    ASSERT_TRUE(model.undo());
    EXPECT_EQ(model.character(), model.source());
  }
  TearOptions wrong;
  wrong.lip_roll = -1;
  TornModel model = make_model(test::make_sheet(4));
  EXPECT_FALSE(model.tear(*bind_pose(model.source()), straight(2), wrong));
}

/// Two sheets, one below the other, or one sheet folded over in waves.
Character make_layers(std::uint32_t cells, double distance) {
  Character layers = test::make_sheet(cells), below = test::make_sheet(cells);
  Mesh& mesh = layers.meshes[0];
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t v = 0; v < first; ++v) {
    mesh.positions.push_back(mesh.positions[v] - Vec3f(0, 0, static_cast<float>(distance)));
    mesh.normals.push_back(-mesh.normals[v]);
    mesh.uv_sets[0].push_back(mesh.uv_sets[0][v]);
    const auto of = below.meshes[0].weights.of(v);
    mesh.weights.append({of.begin(), of.end()});
  }
  for (const Triangle& t : below.meshes[0].triangles) {
    mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
    mesh.triangle_submesh.push_back(0);
  }
  return layers;
}

Character make_folded(std::uint32_t cells, double distance) {
  Character folded = test::make_sheet(cells);
  for (Vec3f& p : folded.meshes[0].positions) {
    // Down, back below, and down again: the letter S, standing on its side.
    const double along = 3.0 * p.y(), turn = distance / 2;
    const double at = std::fmod(along, 1.0), row = std::floor(along);
    const bool is_back = static_cast<int>(row) % 2 == 1;
    p.y() = static_cast<float>(0.2 * (is_back ? 1 - at : at));
    p.z() = static_cast<float>(-distance * row - turn * at * at * at);
  }
  return folded;
}

TEST(WallShape, stays_within_thin_shells_and_folded_sheets) {
  Random random(9);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const bool is_folded = i % 2 == 1;
    const double distance = std::pow(10.0, random.uniform(-3, -1));
    TornModel model = make_model(is_folded ? make_folded(30, distance) : make_layers(16, distance));
    const ModelPose pose = *bind_pose(model.source());
    const double y = is_folded ? random.uniform(0.05, 0.15) : random.uniform(0.3, 0.7);
    Stroke stroke;
    for (int k = 0; k < 4; ++k) {
      const double x = 0.2 + 0.18 * k, at = y + random.uniform(-0.03, 0.03);
      stroke.push_back({{x, at, 0.3}, {x, at, -0.3}});
    }
    TearOptions options;
    options.wall_depth = random.uniform(0.02, 0.2);
    if (random.index(3) == 0) options.width = random.uniform(0.002, 0.01);
    if (random.index(3) == 0) options.layers = Layers::all;
    ASSERT_TRUE(model.tear(pose, stroke, options));
    EXPECT_THAT(test::broken_laws(model), testing::IsEmpty());
    const auto positions = test::posed_positions(model.character(), 0, pose);
    EXPECT_EQ(piercing_edges(model.character(), positions), 0)
        << "distance " << distance << ", depth " << options.wall_depth;
  }
}

/// The lips of the straight tear, pulled apart as an ellipse; walls go with their lips.
std::vector<Vec3d> opened(const Character& character, const std::vector<Vec3d>& positions,
                          double gap) {
  std::vector<Vec3d> moved = positions;
  std::vector<int> side(positions.size(), 0);
  for (const Triangle& triangle : live(triangles_of(character, false))) {
    double middle = 0;
    for (const std::uint32_t v : triangle) middle += positions[v].y() / 3;
    for (const std::uint32_t v : triangle) side[v] = middle > 0.503 ? 1 : -1;
  }
  const Mesh& mesh = character.meshes[0];
  for (const Triangle& wall : live(triangles_of(character, true)))
    for (const std::uint32_t v : wall) side[v] = mesh.normals[v].y() < 0 ? 1 : -1;
  for (std::size_t v = 0; v < moved.size(); ++v) {
    const double x = (positions[v].x() - 0.5) / 0.3;
    if (std::abs(x) < 1) moved[v].y() += 0.5 * gap * std::sqrt(1 - x * x) * side[v];
  }
  return moved;
}

TEST(WallShape, closes_below_the_lips_that_gape) {
  TornModel model = make_model(test::make_sheet(40));
  const ModelPose pose = *bind_pose(model.source());
  TearOptions options;
  options.wall_depth = 0.05;
  ASSERT_TRUE(model.tear(pose, straight(1), options));
  const auto rest = test::posed_positions(model.character(), 0, pose);
  const auto walls = live(triangles_of(model.character(), true)),
             skin = live(triangles_of(model.character(), false));
  for (const double gap : {0.01, 0.03, 0.06, 0.09}) {
    SCOPED_TRACE(gap);
    const auto positions = opened(model.character(), rest, gap);
    int looks = 0;
    for (int i = 0; i < 400; ++i) {
      const double x = 0.2 + 0.6 * (i + 0.5) / 400;
      for (const double share : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
        const double at = (x - 0.5) / 0.3;
        const double y = 0.503 + 0.5 * gap * std::sqrt(1 - at * at) * share;
        const Vec3d from(x, y, 1), to(x, y, -1);
        const auto is_met = [&](const Triangle& t) {
          return meet(from, to, corners_of(positions, t)).has_value();
        };
        if (std::ranges::any_of(skin, is_met)) continue;  // the lips are polygons
        ++looks;
        double nearest = 2;
        bool is_front = false;
        for (const Triangle& wall : walls) {
          const Corners corners = corners_of(positions, wall);
          const auto place = meet(from, to, corners);
          if (!place || *place >= nearest) continue;
          nearest = *place;
          is_front = normal_of(corners).z() > 0;
        }
        EXPECT_LT(nearest, 2.0) << x << ", " << share;
        EXPECT_TRUE(is_front) << x << ", " << share;
      }
    }
    EXPECT_GT(looks, 1000);
  }
}

}  // namespace
}  // namespace sunder
