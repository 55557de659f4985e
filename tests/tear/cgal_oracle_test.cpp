// Compares cuts, gaps and bores with CGAL's corefinement of the posed surface, an independent
// method with exact predicates. Built if CGAL is found (scripts/setup oracle).
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh/IO/OFF.h>
#include <CGAL/convex_hull_3.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "support/oracles/clip_oracle.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Judge = CGAL::Surface_mesh<Point>;
using test::make_model;
using test::Random;
using testing::IsEmpty;

/// Largest rounding of a position by CGAL or Sunder, as a fraction of the model's diagonal; for
/// areas, of its square.
constexpr double kRounding = 1e-9;

int count_of_cases(int usual) { return test::stressed(usual, 20); }

Point to_judge(const Vec3d& p) { return {p.x(), p.y(), p.z()}; }
Vec3d from_judge(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// The surface of an untorn model in a pose.
Judge posed_surface(const TornModel& model, const ModelPose& pose) {
  Judge surface;
  std::vector<Judge::Vertex_index> vertex_of_point(model.point_count());
  for (std::uint32_t m = 0; m < model.source().meshes.size(); ++m) {
    const Mesh& mesh = model.source().meshes[m];
    const auto positions = test::posed_positions(model.source(), m, pose);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      std::array<Judge::Vertex_index, 3> corners;
      for (std::uint32_t k = 0; k < 3; ++k) {
        Judge::Vertex_index& vertex = vertex_of_point[model.point_at(m, t, k)];
        if (vertex == Judge::null_vertex())
          vertex = surface.add_vertex(to_judge(positions[mesh.triangles[t][k]]));
        corners[k] = vertex;
      }
      EXPECT_NE(surface.add_face(corners[0], corners[1], corners[2]), Judge::null_face());
    }
  }
  return surface;
}

/// The rest of a surface that CGAL has split.
struct Parts {
  std::vector<double> areas;   ///< Of each part.
  std::vector<Vec3d> middles;  ///< Of the largest face of each part.
  std::vector<Vec3d> section;  ///< Points on borders.
  double border_length = 0;
};

Parts parts_of(const Judge& surface) {
  Parts parts;
  Judge& mutable_surface = const_cast<Judge&>(surface);
  const auto part_of =
      mutable_surface.add_property_map<Judge::Face_index, std::size_t>("f:part", 0).first;
  const std::size_t count = processing::connected_components(surface, part_of);
  parts.areas.resize(count, 0);
  parts.middles.resize(count, Vec3d::Zero());
  std::vector<double> largest(count, -1);
  for (const auto face : surface.faces()) {
    std::array<Vec3d, 3> corners;
    std::size_t k = 0;
    for (const auto vertex : vertices_around_face(surface.halfedge(face), surface))
      corners[k++] = from_judge(surface.point(vertex));
    const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    const std::size_t part = part_of[face];
    parts.areas[part] += area;
    if (area <= largest[part]) continue;
    largest[part] = area;
    parts.middles[part] = (corners[0] + corners[1] + corners[2]) / 3;
  }
  for (const auto halfedge : surface.halfedges())
    if (surface.is_border(halfedge)) {
      const Vec3d to = from_judge(surface.point(surface.target(halfedge)));
      parts.border_length += (to - from_judge(surface.point(surface.source(halfedge)))).norm();
      parts.section.push_back(to);
    }
  return parts;
}

/// Each place once: both lips have it, and a line through a vertex crosses all its edges at places
/// closer than `distance`.
std::vector<Vec3d> distinct(const std::vector<Vec3d>& places, double distance) {
  std::vector<Vec3d> kept;
  for (const Vec3d& place : places)
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const Vec3d& other) { return (place - other).norm() <= distance; }))
      kept.push_back(place);
  return kept;
}

double distance_to(const std::vector<Vec3d>& places, const Vec3d& place) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3d& other : places) least = std::min(least, (other - place).norm());
  return least;
}

/// Positions of the points that a call opened, on the posed source: by their births, so that
/// interpolation of weights does not matter.
std::vector<Vec3d> opened_places(const TornModel& model, const ModelPose& pose,
                                 const ChangeRecord& change) {
  std::map<std::uint32_t, Vec3d> place_of_point;
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m) {
    const Mesh &torn = model.character().meshes[m], &source = model.source().meshes[m];
    const auto posed = test::posed_positions(model.source(), m, pose);
    for (std::uint32_t t = 0; t < torn.triangle_count(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = torn.triangles[t][k];
        Vec3d place = Vec3d::Zero();
        if (vertex < source.vertex_count()) {
          place = posed[vertex];
        } else {
          const Birth birth = model.birth(m, vertex);
          for (std::size_t i = 0; i < 3; ++i)
            place += birth.barycentric[i] * posed[source.triangles[birth.triangle][i]];
        }
        place_of_point[model.point_at(m, t, k)] = place;
      }
  }
  std::vector<Vec3d> places;
  for (const LipPair& pair : change.lips) places.push_back(place_of_point.at(pair.left));
  return places;
}

std::vector<double> sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

/// A body and a place on it, in a pose in which it does not intersect itself.
struct Subject {
  Character character;
  ModelPose pose;
};

Subject random_tube(Random& random) {
  for (;;) {
    const std::uint32_t rings = 4 + random.index(16), sides = 5 + random.index(20),
                        bones = 2 + random.index(3);
    Subject subject{test::make_tube(rings, sides, bones), {}};
    subject.pose = test::random_pose(subject.character, random, 0.5, 1.2);
    if (!processing::does_self_intersect(
            posed_surface(make_model(subject.character), subject.pose)))
      return subject;
  }
}

/// The Stanford bunny on two bones, or nothing if it is absent.
Character make_bunny() {
  Judge bunny;
  const auto file = test::shared_models() / "static" / "bunny_3485.off";
  if (test::shared_models().empty() || !CGAL::IO::read_OFF(file.string(), bunny)) return {};
  Character character = test::make_sheet(1, 0.2f);  // for its bones
  Mesh& mesh = character.meshes[0];
  mesh = {};
  mesh.name = "bunny";
  mesh.submeshes.push_back({"fur", kNone});
  for (const auto vertex : bunny.vertices()) {
    mesh.positions.push_back(from_judge(bunny.point(vertex)).cast<float>());
    const float along = std::clamp(5 * (mesh.positions.back().x() + 0.1f), 0.01f, 0.99f);
    mesh.weights.append(std::vector<Influence>{{0, 1.0f - along}, {1, along}});
  }
  for (const auto face : bunny.faces()) {
    Triangle& triangle = mesh.triangles.emplace_back();
    std::size_t k = 0;
    for (const auto vertex : vertices_around_face(bunny.halfedge(face), bunny))
      triangle[k++] = vertex.idx();
  }
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  return character;
}

PlaneCut random_cut(const Subject& subject, Random& random) {
  const auto positions = test::posed_positions(subject.character, 0, subject.pose);
  const auto count = static_cast<std::uint32_t>(positions.size());
  PlaneCut cut;
  cut.normal = random.direction();
  const double share = random.uniform(0.1, 0.9);
  cut.point = share * positions[random.index(count)];
  cut.point += (1 - share) * positions[random.index(count)];
  return cut;
}

/// One triangle that reaches beyond the body: two would add points where their common side crosses
/// faces.
Judge sheet_of(const PlaneCut& cut, double diagonal) {
  const Vec3d normal = cut.normal.normalized(), right = normal.unitOrthogonal(),
              up = normal.cross(right);
  Judge sheet;
  const auto corner = [&](double x, double y) {
    return sheet.add_vertex(to_judge(cut.point + diagonal * (x * right + y * up)));
  };
  const auto a = corner(-4, -2), b = corner(4, -2), c = corner(0, 4);
  sheet.add_face(a, b, c);
  return sheet;
}

int compared_cuts = 0;

/// Cuts a closed body with Sunder and with CGAL.
void compare_cut(const Subject& subject, const PlaneCut& cut, double snap = 0) {
  TornModel model = make_model(subject.character);
  const double diagonal = test::posed_diagonal(subject.character, subject.pose);
  Judge surface = posed_surface(model, subject.pose);
  ASSERT_TRUE(CGAL::is_closed(surface));
  Judge sheet = sheet_of(cut, diagonal);
  processing::split(surface, sheet);
  const Parts parts = parts_of(surface);

  ChangeRecord change;
  const auto report = model.cut(subject.pose, cut, &change);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->blocked, 0u);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
  // A corner that the plane cuts off by less than rounding does not count as a piece.
  if (*std::min_element(parts.areas.begin(), parts.areas.end()) <
      std::max(snap, kRounding * diagonal) * diagonal)
    return;
  const std::size_t components = count_topology(model.character())->components;
  // A bridge that is not wider than the rounding may or may not connect two parts.
  if (snap == 0) {
    EXPECT_EQ(components, parts.areas.size());
  }
  EXPECT_NEAR(report->length_posed, 0.5 * parts.border_length,
              (snap + kRounding * diagonal) * static_cast<double>(1 + change.lips.size()));
  EXPECT_EQ(report->runs > 0, parts.border_length > 0);
  std::vector<double> areas;
  for (const TornPiece& piece : report->pieces)
    areas.push_back(model.describe_piece(piece)->area_posed);
  if (parts.areas.size() > 1 && components == parts.areas.size()) {
    EXPECT_THAT(sorted(areas),
                testing::Pointwise(testing::DoubleNear((snap + kRounding * diagonal) * diagonal),
                                   sorted(parts.areas)));
  }
  const double near = snap + 1e-12 * diagonal;
  const std::vector<Vec3d> opened = opened_places(model, subject.pose, change),
                           section = distinct(parts.section, near);
  EXPECT_EQ(distinct(opened, near).size(), section.size());
  if (snap == 0) {
    EXPECT_EQ(opened.size(), section.size()) << "each place opens once";
  }
  for (const Vec3d& place : opened)
    EXPECT_LE(distance_to(section, place), snap + kRounding * diagonal);
  ++compared_cuts;
}

TEST(CgalOracle, agrees_about_cuts_of_tubes) {
  Random random(1);
  compared_cuts = 0;
  for (int i = 0; i < count_of_cases(60) && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const Subject subject = random_tube(random);
    compare_cut(subject, random_cut(subject, random));
  }
  EXPECT_GT(compared_cuts, count_of_cases(50));
}

TEST(CgalOracle, agrees_about_cuts_of_the_bunny) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  Random random(2);
  Subject subject{make_bunny(), {}};
  ASSERT_FALSE(subject.character.meshes.empty());
  for (int i = 0; i < count_of_cases(8) && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    subject.pose = i % 2 == 0 ? test::random_pose(subject.character, random, 0, 1)
                              : test::random_pose(subject.character, random, 0.3, 1.1);
    compare_cut(subject, random_cut(subject, random));
  }
}

/// Through vertices, exactly and very close to them: a point that would be stored as the end of its
/// edge is that end.
TEST(CgalOracle, agrees_about_cuts_through_vertices) {
  Random random(3);
  compared_cuts = 0;
  for (int i = 0; i < count_of_cases(60) && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const Subject subject = random_tube(random);
    const auto positions = test::posed_positions(subject.character, 0, subject.pose);
    PlaneCut cut = random_cut(subject, random);
    cut.point = positions[random.index(static_cast<std::uint32_t>(positions.size()))];
    const double diagonal = test::posed_diagonal(subject.character, subject.pose);
    const double beside = std::array{0.0, 1e-14, 1e-12, 1e-5}[random.index(4)];
    cut.point += (random.index(2) == 0 ? 1 : -1) * beside * diagonal * cut.normal;
    compare_cut(subject, cut, 2e-7 * diagonal);
  }
  EXPECT_GT(compared_cuts, count_of_cases(20));
}

/// The surface split by a convex body: its part inside, and the number of parts outside.
struct Removal {
  double area_inside = 0;
  std::size_t parts_outside = 0;
};

Removal remove_body(Judge surface, const std::vector<Vec3d>& corners,
                    const test::ConvexCell& cell) {
  std::vector<Point> points;
  for (const Vec3d& corner : corners) points.push_back(to_judge(corner));
  Judge body;
  CGAL::convex_hull_3(points.begin(), points.end(), body);
  processing::split(surface, body);
  const Parts parts = parts_of(surface);
  Removal removal;
  for (std::size_t part = 0; part < parts.areas.size(); ++part) {
    const bool is_inside = std::all_of(cell.begin(), cell.end(), [&](const test::HalfSpace& side) {
      return side.normal.dot(parts.middles[part]) <= side.offset;
    });
    if (is_inside)
      removal.area_inside += parts.areas[part];
    else
      ++removal.parts_outside;
  }
  return removal;
}

/// The half-spaces of the sides of a convex hull.
test::ConvexCell cell_around(const std::vector<Vec3d>& corners) {
  std::vector<Point> points;
  for (const Vec3d& corner : corners) points.push_back(to_judge(corner));
  Judge body;
  CGAL::convex_hull_3(points.begin(), points.end(), body);
  test::ConvexCell cell;
  for (const auto face : body.faces()) {
    std::array<Vec3d, 3> at;
    std::size_t k = 0;
    for (const auto vertex : vertices_around_face(body.halfedge(face), body))
      at[k++] = from_judge(body.point(vertex));
    const Vec3d normal = (at[1] - at[0]).cross(at[2] - at[0]).normalized();
    cell.push_back({normal, normal.dot(at[0])});
  }
  return cell;
}

void compare_gap(const Subject& subject, Random& random) {
  TornModel model = make_model(subject.character);
  const double diagonal = test::posed_diagonal(subject.character, subject.pose);
  const Stroke around =
      test::random_stroke(subject.character, subject.pose, random, random.uniform(0.02, 0.6), 1);
  const Vec3d motion = around[1].base - around[0].base,
              blade = random.uniform(1, 8) * (around[0].tip - around[0].base);
  const Stroke stroke = {{around[0].base, around[0].base + blade},
                         {around[0].base + motion, around[0].base + motion + blade}};
  TearOptions options;
  options.width = random.uniform(0.005, 0.1) * diagonal;
  options.layers = Layers::all;
  const Vec3d half = 0.5 * options.width * motion.cross(blade).normalized();
  std::vector<Vec3d> corners;
  for (const Blade& at : stroke)
    for (const Vec3d& end : {at.base, at.tip})
      corners.insert(corners.end(), {end - half, end + half});
  const Removal expected =
      remove_body(posed_surface(model, subject.pose), corners, cell_around(corners));

  const auto report = model.tear(subject.pose, stroke, options);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->blocked, 0u);
  EXPECT_NEAR(report->area_removed_posed, expected.area_inside, kRounding * diagonal * diagonal);
  EXPECT_EQ(count_topology(model.character())->components, expected.parts_outside);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
}

TEST(CgalOracle, agrees_about_gaps_of_tubes) {
  Random random(4);
  for (int i = 0; i < count_of_cases(60) && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    compare_gap(random_tube(random), random);
  }
}

TEST(CgalOracle, agrees_about_gaps_of_the_bunny) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  Random random(5);
  Subject subject{make_bunny(), {}};
  for (int i = 0; i < count_of_cases(8) && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    subject.pose = test::random_pose(subject.character, random, 0.2, 1.1);
    compare_gap(subject, random);
  }
}

/// A bore is only guaranteed to be within the tolerance of the circle, so it lies between two
/// prisms.
void compare_bore(const Subject& subject, Random& random) {
  TornModel model = make_model(subject.character);
  const double diagonal = test::posed_diagonal(subject.character, subject.pose);
  const Blade along = test::random_stroke(subject.character, subject.pose, random, 0.1, 1)[0];
  Bore bore;
  bore.origin = along.base;
  bore.direction = along.tip - along.base;
  bore.depth = random.uniform(0.5, 10) * bore.direction.norm();
  bore.radius = random.uniform(0.01, 0.2) * diagonal;
  bore.chord_tolerance = 1e-4 * bore.radius;
  const Vec3d axis = bore.direction.normalized(), right = axis.unitOrthogonal(),
              up = axis.cross(right);
  const auto removal_by = [&](double radius) {
    constexpr int kSides = 200;
    std::vector<Vec3d> corners;
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSides;
      const Vec3d corner = bore.origin + radius * (std::cos(angle) * right + std::sin(angle) * up);
      corners.insert(corners.end(), {corner, corner + bore.depth * axis});
    }
    return remove_body(posed_surface(model, subject.pose), corners, cell_around(corners));
  };
  const Removal inner = removal_by((1 - 1e-4) * bore.radius);
  const Removal outer = removal_by(bore.radius / std::cos(std::numbers::pi / 200));

  const auto report = model.drill(subject.pose, bore);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->blocked, 0u);
  EXPECT_GE(report->area_removed_posed, inner.area_inside - kRounding * diagonal * diagonal);
  EXPECT_LE(report->area_removed_posed, outer.area_inside + kRounding * diagonal * diagonal);
  if (inner.parts_outside == outer.parts_outside) {
    EXPECT_EQ(count_topology(model.character())->components, inner.parts_outside);
  }
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
}

TEST(CgalOracle, agrees_about_bores_of_tubes) {
  Random random(6);
  for (int i = 0; i < count_of_cases(30) && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    compare_bore(random_tube(random), random);
  }
}

}  // namespace
}  // namespace sunder
