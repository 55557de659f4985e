// Gaps and bores across cracks of a source: what they leave of both sides of a crack stays closed
// in bind space.
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/say.h"
#include "support/machine/stress.h"
#include "support/models/cracked_bodies.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::Random;
using testing::IsEmpty;

using Place = std::array<float, 3>;
using Ends = std::array<Place, 2>;  ///< Of an edge of the source, ascending.

/// An oracle: the parts of the edges of a source of one mesh, welded by position, that remain on
/// either side. Where both sides remain, the same edges must be on them.
class EdgeParts {
 public:
  explicit EdgeParts(const TornModel& model)
      : model_(model), torn_(model.character().meshes[0]), source_(model.source().meshes[0]) {
    for (std::uint32_t t = 0; t < torn_.triangle_count(); ++t) {
      const std::uint32_t origin = model.source_triangle(0, t);
      if (!is_retired(torn_.triangles[t]) && origin < source_.triangle_count()) add(t, origin);
    }
  }

  [[nodiscard]] std::vector<std::string> opened() const {
    std::vector<std::string> open;
    for (const auto& [ends, parts] : parts_) {
      std::vector<Part> single;
      for (const Part& part : parts)
        if (std::none_of(parts.begin(), parts.end(), [&](const Part& other) {
              return other.origin != part.origin && other.places == part.places;
            }))
          single.push_back(part);
      for (const Part& a : single)
        for (const Part& b : single)
          if (a.origin < b.origin &&
              std::min(a.end, b.end) - std::max(a.begin, b.begin) > kLeastOverlap)
            open.push_back(test::say("origins ", a.origin, ", ", b.origin, ": ", a.begin, "-",
                                     a.end, " beside ", b.begin, "-", b.end));
    }
    return open;
  }

 private:
  /// Of an edge: stored places are no nearer to one another.
  static constexpr double kLeastOverlap = 1e-5;

  struct Part {
    std::uint32_t origin;
    double begin, end;            ///< Along the edge, from its lesser end.
    std::array<Place, 2> places;  ///< Of these, by stored positions.
  };

  static Place place_of(const Mesh& mesh, std::uint32_t vertex) {
    const Vec3f& at = mesh.positions[vertex];
    return {at.x() + 0.0f, at.y() + 0.0f, at.z() + 0.0f};
  }

  /// The place of a vertex along edge k of a triangle of the source; none if it is elsewhere.
  [[nodiscard]] std::optional<double> place_along(std::uint32_t vertex, std::uint32_t origin,
                                                  std::size_t k) const {
    const Triangle& in = source_.triangles[origin];
    std::array<double, 3> place = {0, 0, 0};
    const auto add = [&](std::uint32_t parent, double part) {
      place[static_cast<std::size_t>(std::find(in.begin(), in.end(), parent) - in.begin())] += part;
    };
    if (vertex < source_.vertex_count()) {
      add(vertex, 1);
    } else {
      const Birth birth = model_.birth(0, vertex);
      for (std::size_t i = 0; i < 3; ++i)
        if (birth.barycentric[i] > 0)
          add(source_.triangles[birth.triangle][i], birth.barycentric[i]);
    }
    if (place[(k + 2) % 3] != 0) return std::nullopt;
    return place[(k + 1) % 3];
  }

  void add(std::uint32_t triangle, std::uint32_t origin) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Place from = place_of(source_, source_.triangles[origin][k]),
                  to = place_of(source_, source_.triangles[origin][(k + 1) % 3]);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = torn_.triangles[triangle][i],
                            b = torn_.triangles[triangle][(i + 1) % 3];
        const auto at_a = place_along(a, origin, k), at_b = place_along(b, origin, k);
        if (!at_a || !at_b) continue;
        Part part{origin, *at_a, *at_b, {place_of(torn_, a), place_of(torn_, b)}};
        if (to < from) part = {origin, 1 - *at_b, 1 - *at_a, {part.places[1], part.places[0]}};
        parts_[{std::min(from, to), std::max(from, to)}].push_back(part);
      }
    }
  }

  const TornModel& model_;
  const Mesh &torn_, &source_;
  std::map<Ends, std::vector<Part>> parts_;
};

DrillOperation random_bore(const TornModel& model, const ModelPose& pose, Random& random) {
  const Blade along = test::random_stroke(model.source(), pose, random, 0.1, 1)[0];
  const double length = (along.tip - along.base).norm();
  DrillOperation drill;
  drill.pose = pose;
  drill.bore.origin = along.base;
  drill.bore.direction = along.tip - along.base;
  drill.bore.depth = random.uniform(0.8, 4) * length;
  drill.bore.radius = random.uniform(0.005, 0.15) * test::posed_diagonal(model.source(), pose);
  drill.bore.wall = random.index(3) == 0;
  return drill;
}

/// A bore, a gap, or now and then an operation that only opens.
Operation some_operation(const TornModel& model, Random& random) {
  const double angle = random.index(3) == 0 ? 0.0 : 0.5;  // at bind the sides coincide
  const ModelPose pose = test::random_pose(model.source(), random, angle);
  if (random.index(2) == 0) return random_bore(model, pose, random);
  TearOperation tear;
  tear.pose = pose;
  tear.stroke = test::random_stroke(model.source(), pose, random, random.uniform(0.05, 0.6),
                                    1 + random.index(5));
  if (random.index(5) > 0)
    tear.options.width = random.uniform(0.002, 0.1) * test::posed_diagonal(model.source(), pose);
  if (random.index(3) == 0) tear.options.layers = Layers::all;
  if (random.index(4) == 0)
    tear.options.wall_depth =
        random.uniform(0.002, 0.05) * test::posed_diagonal(model.source(), pose);
  return tear;
}

TEST(GapsAcrossCracks, leave_closed_what_they_leave) {
  int removed = 0, blocked = 0, operations = 0;
  for (int seed = 0; seed < test::stressed(150, 40) && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    TornModel model = test::make_model(random.index(2) == 0 ? test::cracked_body(random)
                                                            : test::coarsely_weighted_body(random));
    const std::uint64_t before = model.digest();
    for (int i = 0; i < 3 && !testing::Test::HasFailure(); ++i) {
      SCOPED_TRACE(i);
      const Operation operation = some_operation(model, random);
      ChangeRecord change;
      const auto report = test::play(model, operation, &change);
      ASSERT_TRUE(report) << report.error().text();
      ++operations;
      removed += report->area_removed_posed > 0 ? 1 : 0;
      EXPECT_THAT(test::broken_laws(model), IsEmpty());
      EXPECT_THAT(test::broken_lips(model, change), IsEmpty());
      if (report->blocked > 0) {
        ++blocked;
        break;
      }
      EXPECT_THAT(EdgeParts(model).opened(), IsEmpty());
    }
    while (model.undo_count() > 0) ASSERT_TRUE(model.undo());
    EXPECT_EQ(model.digest(), before);
  }
  EXPECT_GT(removed, test::stressed(250, 40));
  EXPECT_LT(blocked, operations / 20);
}

/// A crack whose sides are together does not end a gap of the nearest layer beside the path. Where
/// the path itself takes another way at a fold, or ends at a crack, the areas are not compared.
TEST(GapsAcrossCracks, are_as_wide_as_without_them) {
  int compared = 0, different = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(200, 20)); ++seed) {
    SCOPED_TRACE(seed);
    Random of_whole(seed), of_cracked(seed), random(seed + 77'777);
    TornModel whole = test::make_model(test::closed_body(of_whole)),
              cracked = test::make_model(test::coarsely_weighted_body(of_cracked));
    const ModelPose pose = *bind_pose(whole.source());
    const Stroke stroke = test::random_stroke(whole.source(), pose, random,
                                              random.uniform(0.05, 0.6), 1 + random.index(5));
    TearOptions options;
    options.width = random.uniform(0.002, 0.1) * test::posed_diagonal(whole.source(), pose);
    const auto expected = whole.tear(pose, stroke, options),
               report = cracked.tear(pose, stroke, options);
    ASSERT_TRUE(expected && report);
    if (std::abs(report->length_posed - expected->length_posed) > 1e-6 * expected->length_posed ||
        report->blocked > 0)
      continue;
    ++compared;
    different += std::abs(report->area_removed_posed - expected->area_removed_posed) >
                         1e-3 * expected->area_removed_posed
                     ? 1
                     : 0;
  }
  EXPECT_GT(compared, test::stressed(150, 20));
  EXPECT_LE(different, compared / 300);
}

}  // namespace
}  // namespace sunder
