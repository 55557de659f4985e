// The pieces that operations name are the connected components that a plain flood fill over all
// faces finds, after any sequence of operations, undo, redo and compact.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;
using Face = std::array<std::uint32_t, 2>;  ///< Mesh and triangle.

int count_of_cases(int usual) { return test::stressed(usual, 20); }

/// The connected components of a model, by the points that faces share.
class Components {
 public:
  explicit Components(const TornModel& model) : parent_(model.point_count()) {
    for (std::uint32_t i = 0; i < parent_.size(); ++i) parent_[i] = i;
    const auto& meshes = model.character().meshes;
    for (std::uint32_t m = 0; m < meshes.size(); ++m)
      for (std::uint32_t t = 0; t < meshes[m].triangle_count(); ++t) {
        const std::uint32_t a = model.point_at(m, t, 0), b = model.point_at(m, t, 1),
                            c = model.point_at(m, t, 2);
        if (a == b || b == c || c == a) continue;
        point_of_face_[{m, t}] = a;
        join(a, b);
        join(b, c);
      }
  }

  /// kNone for a face that is not live.
  [[nodiscard]] std::uint32_t of(const Face& face) const {
    const auto found = point_of_face_.find(face);
    return found == point_of_face_.end() ? kNone : root(found->second);
  }
  [[nodiscard]] std::map<std::uint32_t, std::set<Face>> faces() const {
    std::map<std::uint32_t, std::set<Face>> faces;
    for (const auto& [face, point] : point_of_face_) faces[root(point)].insert(face);
    return faces;
  }

 private:
  [[nodiscard]] std::uint32_t root(std::uint32_t i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  std::vector<std::uint32_t> parent_;
  std::map<Face, std::uint32_t> point_of_face_;
};

double bind_area(const TornModel& model, const std::set<Face>& faces) {
  double area = 0;
  for (const auto& [m, t] : faces) {
    const Mesh& mesh = model.character().meshes[m];
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3d at = mesh.positions[a].cast<double>();
    area += 0.5 * Vec3d(mesh.positions[b].cast<double>() - at)
                      .cross(Vec3d(mesh.positions[c].cast<double>() - at))
                      .norm();
  }
  return area;
}

/// The parts of each former component that now has several. A part of new faces alone belongs to
/// the component of the source triangles that they are parts of, if that is one.
class Separated {
 public:
  Separated(const Components& before, const std::map<Face, std::uint32_t>& former_of_source,
            const TornModel& model) {
    for (auto& [root, faces] : Components(model).faces()) {
      std::set<std::uint32_t> former;
      for (const Face& face : faces)
        if (before.of(face) != kNone) former.insert(before.of(face));
      if (former.empty())
        for (const auto& [m, t] : faces) {
          const auto found = former_of_source.find({m, model.source_triangle(m, t)});
          former.insert(found == former_of_source.end() ? kNone : found->second);
        }
      // A cap may join what was apart.
      is_clear = is_clear && former.size() == 1 && *former.begin() != kNone;
      parts[*former.begin()].push_back(std::move(faces));
    }
    std::erase_if(parts, [](const auto& of) { return of.second.size() < 2; });
  }

  std::map<std::uint32_t, std::vector<std::set<Face>>> parts;
  bool is_clear = true;
};

/// Per source triangle the component of its parts; kNone if they are in several.
std::map<Face, std::uint32_t> components_of_sources(const Components& components,
                                                    const TornModel& model) {
  std::map<Face, std::uint32_t> result;
  for (const auto& [root, faces] : components.faces())
    for (const auto& [m, t] : faces) {
      const auto [known, is_new] = result.try_emplace({m, model.source_triangle(m, t)}, root);
      if (known->second != root) known->second = kNone;
    }
  return result;
}

/// @return the number of separated components.
std::size_t expect_named(const Separated& expected, const TearReport& report, bool names_bodies,
                         const TornModel& model) {
  std::set<std::size_t> named;  // indices of parts
  std::size_t wanted = 0;
  std::vector<const std::set<Face>*> parts;
  std::vector<std::uint32_t> former;
  for (const auto& [component, of] : expected.parts) {
    wanted += of.size() - (names_bodies ? 0 : 1);
    for (const auto& faces : of) {
      parts.push_back(&faces);
      former.push_back(component);
    }
  }
  EXPECT_EQ(report.pieces.size(), wanted);
  std::map<std::uint32_t, std::uint32_t> former_of;  // by TornPiece::component
  std::map<std::uint32_t, double> body_area, largest;
  for (const TornPiece& piece : report.pieces) {
    const auto found = std::find_if(parts.begin(), parts.end(), [&](const auto* faces) {
      return faces->count({piece.mesh, piece.triangle}) == 1;
    });
    if (found == parts.end()) {
      ADD_FAILURE() << "triangle " << piece.triangle << " names no separated component";
      continue;
    }
    const auto i = static_cast<std::size_t>(found - parts.begin());
    EXPECT_TRUE(named.insert(i).second) << "named twice";
    if (piece.triangle_count != kNone) {
      EXPECT_EQ(piece.triangle_count, (*found)->size());
    }
    EXPECT_EQ(former_of.try_emplace(piece.component, former[i]).first->second, former[i]);
    const double area = bind_area(model, **found);
    largest[former[i]] = std::max(largest[former[i]], area);
    if (piece.is_body) {
      EXPECT_TRUE(body_area.try_emplace(former[i], area).second) << "two bodies";
    }
    const auto described = model.describe_piece(piece);
    if (!described) {
      ADD_FAILURE() << described.error().text();
      continue;
    }
    std::set<Face> faces;
    for (const auto& of_mesh : described->meshes)
      for (const std::uint32_t t : of_mesh.triangles) faces.insert({of_mesh.mesh, t});
    EXPECT_TRUE(faces == **found);
  }
  EXPECT_EQ(body_area.size(), names_bodies ? largest.size() : 0);
  for (const auto& [component, area] : body_area) EXPECT_GE(area, largest[component] * (1 - 1e-5));
  return named.size();
}

PlaneCut random_cut(const Character& character, const ModelPose& pose, Random& random) {
  const auto positions = test::posed_positions(
      character, random.index(static_cast<std::uint32_t>(character.meshes.size())), pose);
  PlaneCut cut;
  if (!positions.empty())
    cut.point = positions[random.index(static_cast<std::uint32_t>(positions.size()))];
  // Some planes pass exactly through points and along edges.
  cut.normal = random.index(4) == 0 ? Vec3d(random.index(2), 1, 0) : random.direction();
  cut.caps = random.index(3) == 0;
  if (random.index(4) == 0) {
    const Vec3d x = Vec3d(cut.normal.unitOrthogonal()), y = Vec3d(cut.normal.cross(x));
    const double size = random.uniform(0.1, 1.5);
    for (int k = 0; k < 4; ++k)
      cut.bounds.push_back(cut.point + size * ((k < 2 ? 1 : -1) * x + (k % 3 == 0 ? 1 : -1) * y));
  }
  return cut;
}

/// Through the whole model: a soup may have no face to aim at.
Stroke stroke_through(const Character& character, const ModelPose& pose, Random& random) {
  const double size = test::posed_diagonal(character, pose);
  const auto place = [&] {
    const auto& positions = test::posed_positions(character, 0, pose);
    return positions[random.index(static_cast<std::uint32_t>(positions.size()))];
  };
  const Vec3d through = size * random.direction(), first = place(), last = place();
  Stroke stroke;
  for (int i = 0; i < 3; ++i) {
    const Vec3d at = first + 0.5 * i * (last - first);
    stroke.push_back({at + through, at - through});
  }
  return stroke;
}

Result<TearReport> random_operation(TornModel& model, const ModelPose& pose, Random& random,
                                    bool is_soup, bool& is_cut) {
  const Character& character = model.character();
  const double size = test::posed_diagonal(character, pose);
  const auto aim = [&](double length, std::uint32_t segments) {
    return is_soup ? stroke_through(character, pose, random)
                   : test::random_stroke(character, pose, random, length, segments);
  };
  is_cut = random.index(2) == 0;
  if (is_cut) return model.cut(pose, random_cut(character, pose, random));
  if (random.index(3) == 0) {
    const Blade blade = aim(0.1, 1)[0];
    const Vec3d along = blade.tip - blade.base;
    return model.drill(
        pose, {Vec3d(blade.base - along), along, 0.08 * size, size, 0.0, random.index(2) == 0});
  }
  TearOptions options;
  if (random.index(2) == 0) options.width = 0.02 * size;
  if (random.index(2) == 0) options.layers = Layers::all;
  return model.tear(pose, aim(1.5, 5), options);
}

/// @return the number of pieces.
std::size_t operate_at_random(const Character& character, std::uint64_t seed,
                              bool is_soup = false) {
  Random random(seed);
  TornModel model = make_model(character);
  std::size_t pieces = 0;
  for (int i = 0; i < 10 && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const std::uint32_t choice = random.index(10);
    if (choice == 0 && model.undo_count() > 0) {
      EXPECT_TRUE(model.undo());
    } else if (choice == 1 && model.redo_count() > 0) {
      EXPECT_TRUE(model.redo());
    } else if (choice == 2 && random.index(3) == 0) {
      EXPECT_TRUE(model.compact());
    } else {
      const ModelPose pose = random.index(2) == 0 ? *bind_pose(character)
                                                  : test::random_pose(character, random, 0.4, 1.0);
      const Components before(model);
      const auto former_of_source = components_of_sources(before, model);
      bool is_cut = false;
      const auto report = random_operation(model, pose, random, is_soup, is_cut);
      if (!report) continue;  // A degenerate character may leave no way to aim.
      const Separated expected(before, former_of_source, model);
      if (expected.is_clear) pieces += expect_named(expected, *report, is_cut, model);
    }
  }
  return pieces;
}

TEST(Pieces, of_a_tube_are_its_components) {
  std::size_t pieces = 0;
  for (int seed = 0; seed < count_of_cases(60) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    pieces += operate_at_random(
        test::make_tube(6 + random.index(12), 8 + random.index(12), 1 + random.index(5)),
        static_cast<std::uint64_t>(seed));
  }
  EXPECT_GT(pieces, 100u);
}

TEST(Pieces, of_two_meshes_that_share_points_are_their_components) {
  std::size_t pieces = 0;
  for (int seed = 0; seed < count_of_cases(30) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    pieces += operate_at_random(test::make_two_tubes(8, 12), static_cast<std::uint64_t>(seed));
  }
  EXPECT_GT(pieces, 50u);
}

TEST(Pieces, of_a_sheet_and_a_ball_are_their_components) {
  std::size_t pieces = 0;
  for (int seed = 0; seed < count_of_cases(20) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    pieces += operate_at_random(seed % 2 == 0 ? test::make_sheet(24) : test::make_bumpy_ball(1500),
                                static_cast<std::uint64_t>(seed));
  }
  EXPECT_GT(pieces, 20u);
}

/// A stroke that winds around the middle of a unit sheet, once or more, and crosses itself.
Stroke ring_stroke(Random& random) {
  const double turns = random.uniform(1.05, 2), shrink = random.index(2) == 0 ? 0 : 0.5,
               waver = random.index(3) == 0 ? 0.97 : 1;
  const std::uint32_t blades = 20 + random.index(60);
  Stroke stroke;
  for (std::uint32_t i = 0; i <= blades; ++i) {
    const double t = static_cast<double>(i) / blades, angle = 2 * std::numbers::pi * turns * t;
    const double radius = 0.3 * (1 - shrink * t) * (i % 2 == 0 ? 1 : waver);
    stroke.push_back(test::down_at(0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle)));
  }
  return stroke;
}

TEST(Pieces, of_strokes_whose_walls_grow_are_their_components) {
  std::size_t pieces = 0;
  for (int seed = 0; seed < count_of_cases(24) && !HasFailure(); ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    TornModel model = make_model(test::make_sheet(12));
    const ModelPose pose = *bind_pose(model.source());
    const Stroke stroke = ring_stroke(random);
    TearOptions options;
    options.width = seed % 3 == 0 ? 0.01 : 0;
    options.wall_depth = random.uniform(0.002, 0.04);
    auto tear = TearStroke::create(model, pose, stroke[0], options);
    ASSERT_TRUE(tear);
    const Components untorn(model);
    const auto untorn_of_source = components_of_sources(untorn, model);
    for (std::size_t i = 1; i < stroke.size() && !HasFailure(); ++i) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", blade " << i);
      const Components before(model);
      const auto former_of_source = components_of_sources(before, model);
      const auto report = tear->extend(pose, stroke[i]);
      ASSERT_TRUE(report);
      const Separated expected(before, former_of_source, model);
      if (expected.is_clear) pieces += expect_named(expected, *report, false, model);
    }
    SCOPED_TRACE(seed);
    const auto report = tear->end();
    ASSERT_TRUE(report);
    const Separated expected(untorn, untorn_of_source, model);
    if (expected.is_clear) pieces += expect_named(expected, *report, false, model);
  }
  EXPECT_GT(pieces, 10u);
}

TEST(Pieces, of_soups_are_their_components) {
  for (int seed = 0; seed < count_of_cases(200) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    operate_at_random(test::make_soup(random), static_cast<std::uint64_t>(seed), true);
  }
}

TEST(Pieces, the_body_is_the_largest_of_its_component) {
  const Character tube = test::make_tube(20, 16, 3);
  TornModel model = make_model(tube);
  PlaneCut cut;
  cut.point = {0, 2.5, 0};
  cut.normal = {0, 1, 0};
  const auto report = model.cut(*bind_pose(tube), cut);
  ASSERT_TRUE(report) << report.error().text();
  ASSERT_EQ(report->pieces.size(), 2u);
  for (const TornPiece& piece : report->pieces) {
    const auto described = model.describe_piece(piece);
    ASSERT_TRUE(described) << described.error().text();
    EXPECT_EQ(piece.is_body, described->centroid_posed.y() < 2.5);
    EXPECT_EQ(piece.component, report->pieces[0].component);
  }
}

TEST(Pieces, more_than_sixteen_are_named) {
  const Character tube = test::make_tube(40, 8, 3);
  TornModel model = make_model(tube);
  for (int i = 1; i < 20; ++i) {
    PlaneCut cut;
    cut.point = {0, 0.15 * i, 0};
    cut.normal = {0, 1, 0};
    ASSERT_TRUE(model.cut(*bind_pose(tube), cut));
  }
  PlaneCut along;
  along.normal = {1, 0.001, 0.002};
  const auto report = model.cut(*bind_pose(tube), along);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->pieces.size(), 40u);
  std::set<std::uint32_t> components;
  std::size_t bodies = 0;
  for (const TornPiece& piece : report->pieces) {
    components.insert(piece.component);
    bodies += piece.is_body ? 1 : 0;
    EXPECT_TRUE(model.describe_piece(piece));
  }
  EXPECT_EQ(components.size(), 20u);
  EXPECT_EQ(bodies, 20u);
}

TEST(Pieces, an_unknown_piece_is_refused) {
  const Character tube = test::make_tube(4, 8, 2);
  TornModel model = make_model(tube);
  EXPECT_EQ(model.describe_piece({0, 0}).error().code(), StatusCode::not_found);
  EXPECT_EQ(model.describe_piece({1, 0}).error().code(), StatusCode::index_out_of_range);
  EXPECT_EQ(model.describe_piece({0, 100000}).error().code(), StatusCode::index_out_of_range);
}

}  // namespace
}  // namespace sunder
