// Every operation on difficult input: soups, collapsed and mirrored bones, planes in faces, blades
// far smaller and far larger than the surface, tears along, across and into one another.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/say.h"
#include "support/machine/stress.h"
#include "support/models/hard_operations.h"
#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;
using testing::IsEmpty;

int count_of_hard_cases(int usual) { return test::stressed(usual, 40); }

Result<TearReport> tear_blade_by_blade(TornModel& model, const ModelPose& pose,
                                       const Stroke& stroke, const TearOptions& options) {
  auto tearing = TearStroke::create(model, pose, stroke[0], options);
  if (!tearing) return tearing.error();
  for (std::size_t i = 1; i < stroke.size(); ++i)
    if (auto report = tearing->extend(pose, stroke[i]); !report) return report;
  return tearing->end();
}

std::string describe(const Stroke& stroke, const TearOptions& options) {
  std::ostringstream text;
  text.precision(17);
  text << "tear, width " << options.width << ", layers " << static_cast<int>(options.layers)
       << ", wall " << options.wall_depth;
  for (const Blade& blade : stroke)
    text << "\n  " << blade.base.transpose() << " -> " << blade.tip.transpose();
  return text.str();
}

std::string describe(const PlaneCut& cut) {
  std::ostringstream text;
  text.precision(17);
  text << "cut at " << cut.point.transpose() << ", normal " << cut.normal.transpose()
       << (cut.caps ? ", caps" : "");
  for (const Vec3d& corner : cut.bounds) text << "\n  " << corner.transpose();
  return text.str();
}

std::string describe(const Bore& bore) {
  std::ostringstream text;
  text.precision(17);
  text << "bore from " << bore.origin.transpose() << " along " << bore.direction.transpose()
       << ", radius " << bore.radius << ", depth " << bore.depth << ", tolerance "
       << bore.chord_tolerance << (bore.wall ? ", wall" : "");
  return text.str();
}

/// An operation on models of some hundred faces that takes more processor time than this hangs;
/// also under sanitizers and where lines are counted.
constexpr double kSeconds = 20;

class DegenerateSubject {
 public:
  explicit DegenerateSubject(Character character)
      : model(make_model(std::move(character))),
        is_clear_(test::is_clear_of_itself(model.source())),
        begin_(test::state_of(model)) {}

  /// Runs one operation and checks the invariants. Refusals of invalid strokes are accepted.
  template <class Operation>
  void run(const std::string& what, Operation operation) {
    SCOPED_TRACE(what);
    const std::clock_t begin = std::clock();
    ChangeRecord change;
    const Result<TearReport> report = operation(change);
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    EXPECT_LT(seconds, kSeconds);
    if (!report) {
      EXPECT_EQ(report.error().code(), StatusCode::invalid_argument) << report.error().text();
      return;
    }
    done += report->runs > 0 ? 1 : 0;
    EXPECT_THAT(test::broken_laws(model), IsEmpty());
    EXPECT_THAT(test::broken_lips(model, change), IsEmpty());
    if (is_clear_) {
      EXPECT_THAT(test::broken_surface(model), IsEmpty());
    }
    expect_pieces_are_components(*report);
  }

  void undo_everything() {
    while (model.undo_count() > 0) ASSERT_TRUE(model.undo());
    EXPECT_EQ(model.character(), model.source());
    EXPECT_EQ(test::difference(test::state_of(model), begin_), "");
  }

  TornModel model;
  int done = 0;

 private:
  /// Each piece is the whole connected component of any of its triangles. Triangles with a repeated
  /// point are connected to none.
  void expect_pieces_are_components(const TearReport& report) {
    if (report.pieces.empty() || !is_clear_) return;
    using Face = std::array<std::uint32_t, 2>;  // mesh, triangle
    std::map<std::array<std::uint32_t, 2>, std::vector<Face>> faces_of_edge;
    const auto for_each_edge = [&](const Face& face, auto visit) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t a = model.point_at(face[0], face[1], k),
                            b = model.point_at(face[0], face[1], (k + 1) % 3);
        visit(std::array{std::min(a, b), std::max(a, b)});
      }
    };
    const auto has_repeated_point = [&](const Face& face) {
      const std::uint32_t a = model.point_at(face[0], face[1], 0),
                          b = model.point_at(face[0], face[1], 1),
                          c = model.point_at(face[0], face[1], 2);
      return a == b || b == c || c == a;
    };
    for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m)
      for (std::uint32_t t = 0; t < model.character().meshes[m].triangle_count(); ++t)
        if (!has_repeated_point({m, t}))
          for_each_edge({m, t}, [&](const auto& edge) { faces_of_edge[edge].push_back({m, t}); });
    for (const TornPiece& name : report.pieces) {
      const auto described = model.describe_piece(name);
      ASSERT_TRUE(described) << described.error().text();
      const PieceDescription& piece = *described;
      std::set<Face> named, found;
      for (const PieceDescription::Triangles& of_mesh : piece.meshes)
        for (const std::uint32_t t : of_mesh.triangles) named.insert({of_mesh.mesh, t});
      EXPECT_EQ(named.size(), piece.triangle_count);
      EXPECT_EQ(named.count({name.mesh, name.triangle}), 1u);
      if (name.triangle_count != kNone) {
        EXPECT_EQ(named.size(), name.triangle_count);
      }
      if (named.empty()) continue;
      std::vector<Face> open = {*named.begin()};
      found.insert(open.front());
      while (!open.empty()) {
        const Face face = open.back();
        open.pop_back();
        for_each_edge(face, [&](const auto& edge) {
          for (const Face& other : faces_of_edge.at(edge))
            if (found.insert(other).second) open.push_back(other);
        });
      }
      EXPECT_EQ(found, named) << "a piece is not all that hangs together";
    }
  }

  bool is_clear_;
  test::ModelState begin_;
};

void run_hard_operation(DegenerateSubject& subject, const ModelPose& pose, Random& random) {
  const test::Target target = test::target_of(subject.model.character(), pose);
  if (target.faces.empty()) return;
  switch (random.index(4)) {
    case 0: {
      const PlaneCut cut = test::hard_cut(target, random);
      subject.run(describe(cut),
                  [&](ChangeRecord& change) { return subject.model.cut(pose, cut, &change); });
      break;
    }
    case 1: {
      const Bore bore = test::hard_bore(target, random);
      subject.run(describe(bore),
                  [&](ChangeRecord& change) { return subject.model.drill(pose, bore, &change); });
      break;
    }
    default: {
      const Stroke stroke = test::hard_stroke(target, random);
      const TearOptions options = test::hard_options(target, random);
      subject.run(describe(stroke, options), [&](ChangeRecord& change) {
        return subject.model.tear(pose, stroke, options, &change);
      });
    }
  }
}

///
/// @return number of operations that met the surface.
int run_hard_operations(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  DegenerateSubject subject(test::hard_character(random));
  ModelPose pose = test::hard_pose(subject.model.source(), random);
  for (int i = 0; i < 4 && !testing::Test::HasFailure(); ++i) {
    run_hard_operation(subject, pose, random);
    if (random.index(3) == 0) pose = test::hard_pose(subject.model.source(), random);
  }
  subject.undo_everything();
  return subject.done;
}

TEST(Degenerate, operations_on_hard_subjects_in_hard_poses_keep_every_law) {
  int done = 0;
  const int count = count_of_hard_cases(400);
  for (int seed = 0; seed < count; ++seed) {
    done += run_hard_operations(static_cast<std::uint64_t>(seed));
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(done, count);
}

/// Rings of a bore whose points one face connects; caps back to back with a single face, which the
/// next cut crosses.
TEST(Degenerate, walls_and_caps_give_no_edge_a_third_face) {
  for (const std::uint64_t seed : {6367u, 7589u, 9340u, 15940u})
    EXPECT_GT(run_hard_operations(seed), 0);
}

TEST(Degenerate, triangles_with_a_point_twice_are_of_no_piece) {
  for (const std::uint64_t seed : {9558u, 13692u, 15125u}) EXPECT_GT(run_hard_operations(seed), 0);
}

/// Where the surface of a collapsed bone bends away, the plane of two blades leads back behind the
/// first of them.
TEST(Degenerate, a_tear_that_could_go_on_before_its_first_blade_comes_to_an_end) {
  DegenerateSubject subject(test::make_sheet(10));
  ModelPose pose = *bind_pose(subject.model.source());
  pose.model_from_bone[0].linear().setZero();
  const Stroke stroke = {{{0.14436965948727123, 0.24107710487067946, 0.5},
                          {0.14436965948727123, 0.24107710487067946, -0.05}},
                         {{0.14437489273824325, 0.24112420412747801, 0.5},
                          {0.14437489273824325, 0.24112420412747801, -0.3}},
                         {{0.14438012598921526, 0.24117130338427656, 0.5},
                          {0.14438012598921526, 0.24117130338427656, -0.04}},
                         {{0.14438535924018728, 0.24121840264107511, 0.5},
                          {0.14438535924018728, 0.24121840264107511, -0.1}}};
  subject.run(describe(stroke, {}),
              [&](ChangeRecord& change) { return subject.model.tear(pose, stroke, {}, &change); });
  EXPECT_EQ(subject.done, 1);
}

// ---- Tears along, across and into one another, on a sheet.

Stroke stroke_along(const std::vector<Vec2d>& places) {
  Stroke stroke;
  for (const Vec2d& place : places) stroke.push_back(test::down_at(place.x(), place.y()));
  return stroke;
}

Vec2d place_in_sheet(Random& random, std::uint32_t cells) {
  const double x = random.uniform(0.15, 0.85), y = random.uniform(0.15, 0.85);
  if (random.index(2) == 0) return {x, y};
  return {std::round(x * cells) / cells,
          std::round(y * cells) / cells};  // through vertices, along edges
}

TearOptions any_width(Random& random) {
  TearOptions options;
  if (random.index(2) == 0) options.width = test::any_scale(random, 1e-3, 0.05);
  if (random.index(3) == 0) options.layers = Layers::all;
  return options;
}

TEST(Degenerate, tears_meet_older_tears_in_every_way) {
  for (int seed = 0; seed < count_of_hard_cases(600); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const std::uint32_t cells = 1 + random.index(12);
    DegenerateSubject subject(test::make_sheet(cells));
    const ModelPose pose = *bind_pose(subject.model.source());
    const auto tear = [&](const Stroke& stroke, const TearOptions& options) {
      if (random.index(3) == 0)
        subject.run(test::say(describe(stroke, options), " blade by blade"), [&](ChangeRecord&) {
          return tear_blade_by_blade(subject.model, pose, stroke, options);
        });
      else
        subject.run(describe(stroke, options), [&](ChangeRecord& change) {
          return subject.model.tear(pose, stroke, options, &change);
        });
    };
    const Vec2d a = place_in_sheet(random, cells), b = place_in_sheet(random, cells);
    const Vec2d middle = 0.5 * (a + b), across = Vec2d(-(b - a).y(), (b - a).x());
    const Stroke first = stroke_along({a, middle, b});
    tear(first, any_width(random));
    switch (random.index(8)) {
      case 0: tear(first, any_width(random)); break;                         // the same again
      case 1: tear(stroke_along({b, middle, a}), any_width(random)); break;  // and back
      case 2:
        tear(stroke_along({a - 0.3 * (b - a), b + 0.3 * (b - a)}), any_width(random));
        break;  // along it and beyond
      case 3:
        tear(stroke_along({b, b + 0.4 * across}), any_width(random));
        break;  // on from its tip
      case 4:
        tear(stroke_along({b - 0.3 * across, b, b + 0.3 * across}), any_width(random));
        break;  // through its tip
      case 5:
        tear(stroke_along({middle - 0.4 * across, middle + 0.4 * across}), any_width(random));
        break;  // X
      case 6:
        tear(stroke_along({middle - 0.4 * across, middle}), any_width(random));
        break;  // T, into it
      default:
        tear(stroke_along({middle, middle + 0.4 * across}), any_width(random));
        break;  // T, out of it
    }
    const TearOptions options = any_width(random);
    tear(stroke_along({place_in_sheet(random, cells), place_in_sheet(random, cells),
                       place_in_sheet(random, cells)}),
         options);
    subject.undo_everything();
    if (testing::Test::HasFailure()) return;
  }
}

void tear_ring_in_sheet(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  const std::uint32_t cells = 1 + random.index(16), corners = 3 + random.index(12);
  DegenerateSubject subject(test::make_sheet(cells));
  const ModelPose pose = *bind_pose(subject.model.source());
  const double y = random.uniform(0.4, 0.6),
               x = random.uniform(0.4, 0.6);  // evaluated in this order by every compiler
  const Vec2d center(x, y);
  const double radius = random.uniform(0.1, 0.35), begin = random.uniform(0, 6),
               turn = random.index(2) == 0 ? 1 : -1;
  std::vector<Vec2d> places;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = begin + turn * 2 * std::numbers::pi * i / corners;
    places.push_back(center + radius * Vec2d(std::cos(angle), std::sin(angle)));
  }
  places.push_back(places.front());
  TearOptions options;
  if (random.index(2) == 0) options.width = random.uniform(0.01, 0.1) * radius;
  const Stroke stroke = stroke_along(places);
  TearReport report;
  const bool at_once = random.index(2) == 0;
  subject.run(describe(stroke, options), [&](ChangeRecord& change) {
    auto result = at_once ? subject.model.tear(pose, stroke, options, &change)
                          : tear_blade_by_blade(subject.model, pose, stroke, options);
    if (result) report = *result;
    return result;
  });
  const double area = 0.5 * corners * radius * radius * std::sin(2 * std::numbers::pi / corners);
  EXPECT_EQ(count_topology(subject.model.character())->components, 2u);
  ASSERT_EQ(report.pieces.size(), 1u) << describe(stroke, options);
  // The larger part is the rest, even if it is the flap.
  const auto piece = subject.model.describe_piece(report.pieces[0]);
  ASSERT_TRUE(piece) << piece.error().text();
  const double free = piece->area_posed, rest = 1 - report.area_removed_posed - free;
  const double perimeter = 2 * corners * radius * std::sin(std::numbers::pi / corners);
  const double rim = 0.5 * options.width * perimeter;
  // On edges created by tears, points snap by up to 3 % of the faces' longest side, so some of them
  // are displaced to either side.
  const double snapped = 0.2 * 0.03 * std::numbers::sqrt2 / cells * perimeter;
  EXPECT_LE(std::min(std::abs(free - area), std::abs(rest - area)), 1.1 * rim + snapped)
      << describe(stroke, options);
  subject.undo_everything();
}

TEST(Degenerate, a_ring_separates_the_piece_inside) {
  for (int seed = 0; seed < count_of_hard_cases(300) && !testing::Test::HasFailure(); ++seed)
    tear_ring_in_sheet(static_cast<std::uint64_t>(seed));
}

/// The gap crosses a sliver of an older gap's rim where it is as narrow as positions are stored.
TEST(Degenerate, a_ring_sets_free_what_is_in_it) { tear_ring_in_sheet(7659); }

/// The path back snaps next to the place where it began.
TEST(Degenerate, a_ring_meets_its_begin) {
  for (const std::uint64_t seed : {394u, 2484u, 4306u, 5099u, 5137u, 6481u})
    tear_ring_in_sheet(seed);
}

void tear_ring_around_tube(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  const std::uint32_t rings = 3 + random.index(12), sides = 3 + random.index(14),
                      blades = 5 + random.index(20);
  DegenerateSubject subject(test::make_tube(rings, sides, 3));
  const ModelPose pose = *bind_pose(subject.model.source());
  const double height =
      random.index(2) == 0 ? random.uniform(0.5, 2.5) : 3.0 * (1 + random.index(rings - 1)) / rings;
  const double begin = random.index(2) == 0 ? 0.0 : random.uniform(0, 6);
  Stroke stroke;
  for (std::uint32_t i = 0; i < blades; ++i) {
    const double angle = begin + 2 * std::numbers::pi * i / blades;
    const Vec3d out(std::cos(angle), 0, std::sin(angle));
    stroke.push_back({2 * out + height * Vec3d::UnitY(), 0.05 * out + height * Vec3d::UnitY()});
  }
  stroke.push_back(stroke.front());
  TearOptions options;
  if (random.index(2) == 0) options.width = random.uniform(0.01, 0.1);
  TearReport report;
  subject.run(describe(stroke, options), [&](ChangeRecord& change) {
    auto result = subject.model.tear(pose, stroke, options, &change);
    if (result) report = *result;
    return result;
  });
  EXPECT_EQ(count_topology(subject.model.character())->components, 2u) << describe(stroke, options);
  EXPECT_EQ(report.pieces.size(), 1u) << describe(stroke, options);
  subject.undo_everything();
}

TEST(Degenerate, a_ring_around_a_tube_divides_it) {
  for (int seed = 0; seed < count_of_hard_cases(100) && !testing::Test::HasFailure(); ++seed)
    tear_ring_around_tube(static_cast<std::uint64_t>(seed));
}

/// The middle of the gap runs along an edge, closer to it than stored coordinates can resolve, or
/// meets edges there at a small angle.
TEST(Degenerate, a_gap_along_an_edge_is_not_blocked) {
  for (const std::uint64_t seed : {932u, 1714u, 1983u, 2170u, 4049u, 8188u, 9529u, 10878u})
    tear_ring_around_tube(seed);
}

/// The second of two blades at an edge of the tube sees the face from which the tear comes
/// obliquely from behind.
TEST(Degenerate, a_gap_goes_across_faces_that_turn_away_from_the_blade) {
  for (const std::uint64_t seed : {779u, 3858u, 7523u}) tear_ring_around_tube(seed);
}

/// Two meshes with skins of their own under one blade.
TEST(Degenerate, strokes_over_two_meshes_tear_both) {
  int both = 0;
  for (int seed = 0; seed < count_of_hard_cases(100); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const std::uint32_t rings = 2 + random.index(8), sides = 3 + random.index(10);
    DegenerateSubject subject(test::make_two_tubes(rings, sides));
    const ModelPose pose = test::random_pose(subject.model.source(), random, 0.2, 1.1);
    const auto lower = test::posed_positions(subject.model.source(), 0, pose),
               upper = test::posed_positions(subject.model.source(), 1, pose);
    const auto middle_of = [](const std::vector<Vec3d>& places) {
      Vec3d sum = Vec3d::Zero();
      for (const Vec3d& place : places) sum += place;
      return Vec3d(sum / static_cast<double>(places.size()));
    };
    const Vec3d from = middle_of(lower), to = middle_of(upper),
                out = 3 * (to - from).unitOrthogonal();
    const Stroke stroke = {
        {from + out, from}, {0.5 * (from + to) + out, 0.5 * (from + to)}, {to + out, to}};
    const TearOptions options = any_width(random);
    ChangeRecord of_stroke;
    subject.run(describe(stroke, options), [&](ChangeRecord& change) {
      auto result = subject.model.tear(pose, stroke, options, &change);
      of_stroke = change;
      return result;
    });
    both += of_stroke.meshes.size() == 2 ? 1 : 0;
    run_hard_operation(subject, pose, random);
    subject.undo_everything();
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(both, count_of_hard_cases(90));
}

}  // namespace
}  // namespace sunder
