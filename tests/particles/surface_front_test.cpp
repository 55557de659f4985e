// Distances along surfaces on which the shortest paths are known.
#include "particles/front/surface_front.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/surface_distances.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

using test::bind_positions;
using test::down_at;
using test::make_model;
using test::Random;

constexpr float kNever = std::numeric_limits<float>::infinity();

double edge_length_of(const Surface& surface, const std::vector<Vec3f>& positions) {
  double sum = 0;
  for (Index c = 0; c < surface.corner_point.size(); ++c)
    sum += double{
        (positions[surface.corner_point[Surface::next(c)]] - positions[surface.corner_point[c]])
            .norm()};
  return sum / static_cast<double>(surface.corner_point.size());
}

/// Infinite for points that the front does not reach.
std::vector<float> front_distances(const Surface& surface, const std::vector<Vec3f>& positions,
                                   Index source, float limit) {
  SurfaceFront front;
  Rings rings(surface, positions);
  front.begin(surface.point_count(), limit, static_cast<float>(edge_length_of(surface, positions)));
  front.add(source, 0.0f);
  std::vector<float> distances(surface.point_count(), kNever);
  front.run(rings, [&](Index point, float distance, Index) {
    EXPECT_EQ(distances[point], kNever) << "point " << point << " is reached twice";
    EXPECT_LT(distance, limit);
    EXPECT_EQ(front.distance(point), distance);
    distances[point] = distance;
    return true;
  });
  EXPECT_TRUE(front.is_done());
  return distances;
}

/// The largest relative errors against true distances, of points nearer than the limit; farther
/// ones are not reached, except within the error.
struct Errors {
  double below = 0, above = 0;  ///< Relative.
  double sum = 0;
  std::size_t points = 0;

  void compare(const std::vector<float>& distances, const std::vector<double>& truth, double limit,
               double margin = 0.03) {
    for (std::size_t p = 0; p < truth.size(); ++p) {
      if (distances[p] == kNever) {
        EXPECT_GT(truth[p], (1 - margin) * limit) << "point " << p << " is not reached";
        continue;
      }
      if (!(truth[p] > 0)) {
        EXPECT_EQ(distances[p], 0.0f);
        continue;
      }
      ++points;
      sum += std::abs(double{distances[p]} / truth[p] - 1);
      below = std::max(below, 1 - double{distances[p]} / truth[p]);
      above = std::max(above, double{distances[p]} / truth[p] - 1);
    }
  }
};

Index point_nearest(const std::vector<Vec3f>& positions, const Vec3f& place) {
  Index nearest = 0;
  for (Index p = 0; p < positions.size(); ++p)
    if ((positions[p] - place).norm() < (positions[nearest] - place).norm()) nearest = p;
  return nearest;
}

/// A sheet with inner points moved at random.
Character irregular_sheet(std::uint32_t cells, double by, Random& random) {
  Character sheet = test::make_sheet(cells);
  for (Vec3f& position : sheet.meshes[0].positions) {
    const bool is_inside =
        position.x() > 0 && position.x() < 1 && position.y() > 0 && position.y() < 1;
    if (!is_inside) continue;
    position.x() += static_cast<float>(random.uniform(-by, by) / cells);
    position.y() += static_cast<float>(random.uniform(-by, by) / cells);
  }
  return sheet;
}

/// @param allowed  the largest relative error, and of the mean.
void expect_straight(double irregular, double allowed, double allowed_mean) {
  SCOPED_TRACE(irregular);
  Errors errors;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(12, 50)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Character sheet = irregular_sheet(6 + random.index(40), irregular, random);
    const Surface surface = tear::build_surface(sheet);
    const std::vector<Vec3f> positions = bind_positions(sheet, surface);
    const Index source = random.index(surface.point_count());
    const auto limit = static_cast<float>(random.uniform(0.2, 1.5));
    std::vector<double> truth;
    for (const Vec3f& position : positions)
      truth.push_back(double{(position - positions[source]).norm()});
    errors.compare(front_distances(surface, positions, source, limit), truth, double{limit},
                   allowed);
  }
  EXPECT_GT(errors.points, 1000u);
  EXPECT_LT(errors.below, 1e-5);
  EXPECT_LT(errors.above, allowed);
  EXPECT_LT(errors.sum / static_cast<double>(errors.points), allowed_mean);
}

TEST(SurfaceFront, is_straight_on_a_flat_sheet) {
  expect_straight(0.0, 0.01, 0.001);
  expect_straight(0.1, 0.1, 0.002);
  expect_straight(0.2, 0.2,
                  0.005);  // more obtuse faces mean more paths along edges
}

TEST(SurfaceFront, goes_around_the_tip_of_a_slit) {
  for (const std::uint32_t cells : {15u, 31u, 63u}) {
    SCOPED_TRACE(cells);
    TornModel model = make_model(test::make_sheet(cells));
    const double x = 0.5 + 0.3 / cells, y = 0.5 + 0.3 / cells;
    ASSERT_TRUE(model.tear(*bind_pose(model.source()), Stroke{down_at(x, -0.2), down_at(x, y)}));
    const Surface& surface = model.surface();
    const std::vector<Vec3f> positions = bind_positions(model.character(), surface);
    const Index source = point_nearest(positions, {0.3f, 0.3f, 0.0f});
    const Vec3d from = positions[source].cast<double>(), tip(x, y, 0);
    std::vector<double> truth;
    for (Index p = 0; p < positions.size(); ++p) {
      const Vec3d to = positions[p].cast<double>();
      bool is_hidden = to.x() > x + 1e-5;
      if (std::abs(to.x() - x) <= 1e-5 &&
          to.y() < y - 1e-5) {  // on a lip: its face tells which one
        Vec3d centre = Vec3d::Zero();
        const Index t = surface.point_corner[p] / 3;
        for (Index k = 0; k < 3; ++k)
          centre += positions[surface.corner_point[3 * t + k]].cast<double>() / 3;
        is_hidden = centre.x() > x;
      } else if (is_hidden) {
        is_hidden = from.y() + (to.y() - from.y()) * (x - from.x()) / (to.x() - from.x()) < y;
      }
      truth.push_back(is_hidden ? (tip - from).norm() + (to - tip).norm() : (to - from).norm());
    }
    Errors errors;
    errors.compare(front_distances(surface, positions, source, 1.5f), truth, 1.5);
    EXPECT_LT(errors.below, 0.01);
    EXPECT_LT(errors.above, 0.06);  // points behind the tip have no single source to unfold
    EXPECT_LT(errors.sum / static_cast<double>(errors.points), 0.01);
  }
}

TEST(SurfaceFront, is_straight_on_an_unrolled_tube) {
  for (const std::uint32_t sides : {8u, 16u, 40u}) {
    SCOPED_TRACE(sides);
    const Character tube = test::make_tube(2 * sides, sides, 4);
    const Surface surface = tear::build_surface(tube);
    const std::vector<Vec3f> positions = bind_positions(tube, surface);
    const double chord = 2 * 0.5 * std::sin(std::numbers::pi / sides), around = chord * sides;
    const Index source = point_nearest(positions, {0.5f, 2.0f, 0.0f});
    // Unrolled, a side is as wide as its chord.
    const auto unrolled = [&](Index p) {
      const double angle = std::atan2(-double{positions[p].z()}, double{positions[p].x()});
      return std::round(angle / (2 * std::numbers::pi) * sides) * chord;
    };
    std::vector<double> truth;
    const double limit = 0.9;  // no path over the caps is as short
    for (Index p = 0; p < positions.size(); ++p) {
      double beside = std::abs(unrolled(p) - unrolled(source));
      beside = std::min(beside, around - beside);
      truth.push_back(std::hypot(beside, double{positions[p].y() - positions[source].y()}));
    }
    Errors errors;
    errors.compare(front_distances(surface, positions, source, static_cast<float>(limit)), truth,
                   limit);
    EXPECT_LT(errors.below, 1e-3);
    EXPECT_LT(errors.above, 0.01);
  }
}

TEST(SurfaceFront, runs_along_great_circles) {
  double before = 1;
  for (const std::uint32_t points : {300u, 1200u, 4800u}) {
    SCOPED_TRACE(points);
    Character ball = test::make_bumpy_ball(points);
    for (Vec3f& position : ball.meshes[0].positions) position.normalize();
    const Surface surface = tear::build_surface(ball);
    const std::vector<Vec3f> positions = bind_positions(ball, surface);
    Errors errors;
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      Random random(seed);
      const Index source = random.index(surface.point_count());
      std::vector<double> truth;
      for (const Vec3f& position : positions)
        truth.push_back(
            2 * std::asin(std::min(1.0, 0.5 * double{(position - positions[source]).norm()})));
      errors.compare(front_distances(surface, positions, source, 2.5f), truth, 2.5, 0.05);
    }
    const double mean = errors.sum / static_cast<double>(errors.points);
    EXPECT_LT(mean, before);
    before = 0.7 * mean;
    EXPECT_LT(mean, 0.02);
    EXPECT_LT(std::max(errors.below, errors.above), 0.1);  // at single faces that are obtuse
  }
}

TEST(SurfaceFront, lies_between_the_straight_line_and_the_edges) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(30, 50)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Character character = seed % 3 == 0 ? test::make_soup(random)
                          : seed % 3 == 1
                              ? test::make_bumpy_ball(100 + random.index(800))
                              : test::make_two_tubes(5 + random.index(10), 5 + random.index(10));
    const Surface surface = tear::build_surface(character);
    const std::vector<Vec3f> positions = bind_positions(character, surface);
    const Index source = random.index(surface.point_count());
    if (surface.point_corner[source] == kNone) continue;
    const std::vector<double> edges = test::edge_distances(surface, positions, source);
    const std::vector<float> distances = front_distances(surface, positions, source, 1.5f);
    for (Index p = 0; p < positions.size(); ++p) {
      if (distances[p] == kNever) {
        EXPECT_GE(edges[p], 1.5 * (1 - 1e-5)) << "point " << p;
        continue;
      }
      EXPECT_LE(double{distances[p]}, edges[p] * (1 + 1e-5)) << "point " << p;
      EXPECT_GE(double{distances[p]},
                double{(positions[p] - positions[source]).norm()} * (1 - 1e-3))
          << "point " << p;
    }
  }
}

struct Visited {
  Index point, from;
  float distance;
  bool operator==(const Visited&) const = default;
};

TEST(SurfaceFront, continues_after_a_stop_with_the_same_result_by_either_ring) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Character character =
        seed % 2 == 0 ? test::make_tube(12, 10, 3) : test::make_bumpy_ball(400);
    const Surface surface = tear::build_surface(character);
    const std::vector<Vec3f> positions = bind_positions(character, surface);
    Rings rings(surface, positions);
    RingWalk walk(surface, positions);
    SurfaceFront front;  // used again and again
    const Index source = random.index(surface.point_count()),
                other = random.index(surface.point_count());
    const auto run = [&](auto& ring, std::uint32_t stops) {
      std::vector<Visited> visited;
      front.begin(surface.point_count(), 1.2f,
                  static_cast<float>(edge_length_of(surface, positions)));
      front.add(source, 0.0f);
      front.add(other, 0.3f);
      Random when(seed);
      do {
        front.run(ring, [&](Index point, float distance, Index from) {
          visited.push_back({point, from, distance});
          return stops == 0 || when.index(stops) != 0;
        });
      } while (!front.is_done());
      return visited;
    };
    const std::vector<Visited> expected = run(rings, 0);
    EXPECT_GT(expected.size(), 10u);
    for (const std::uint32_t stops : {1u, 2u, 7u}) EXPECT_EQ(run(rings, stops), expected);
    EXPECT_EQ(run(walk, 0), expected);
    EXPECT_EQ(run(walk, 3), expected);
  }
}

TEST(Rings, go_around_every_point) {
  Random random(3);
  for (const Character& character :
       {test::make_sheet(5), test::make_tube(4, 6, 2), test::make_soup(random)}) {
    const Surface surface = tear::build_surface(character);
    const std::vector<Vec3f> positions = bind_positions(character, surface);
    Rings rings(surface, positions);
    RingWalk walk(surface, positions);
    for (Index p = 0; p < surface.point_count(); ++p) {
      const Ring ring = rings(p), walked = walk(p);
      ASSERT_EQ(ring.size(), walked.size());
      for (std::size_t i = 0; i < ring.size(); ++i) {
        ASSERT_EQ(ring.point(i), walked.point(i));
        ASSERT_EQ(ring.length(i), walked.length(i));
        ASSERT_EQ(ring.length(i), (positions[ring.point(i)] - positions[p]).norm());
      }
      if (surface.point_corner[p] == kNone) {
        EXPECT_EQ(ring.size(), 0u);
        continue;
      }
      const std::size_t last = ring.size() - 1;
      EXPECT_TRUE(std::isnan(ring.opposite(last)));
      // each pair of neighbours forms a face with the point, in its orientation
      for (std::size_t i = 0; i < last; ++i) {
        const Index half_edge = surface.find_half_edge(p, ring.point(i));
        ASSERT_NE(half_edge, kNone);
        EXPECT_EQ(surface.corner_point[Surface::previous(half_edge)], ring.point(i + 1));
        EXPECT_EQ(ring.opposite(i), walked.opposite(i));
        EXPECT_EQ(ring.opposite(i),
                  (positions[ring.point(i + 1)] - positions[ring.point(i)]).norm());
      }
      EXPECT_EQ(ring.point(0) == ring.point(last), !surface.is_on_border(p));
    }
  }
}

/// All faces of a block, one after the other; the front computes them at once.
TEST(RingLanes, equal_the_lanes_computed_one_by_one) {
  Random random(5);
  const auto length = [&] { return static_cast<float>(random.uniform(0.2, 2.0)); };
  std::size_t found = 0, nearer = 0;
  for (int n = 0; n < 20000; ++n) {
    std::vector<Known> known(100);
    for (Known& of : known) {
      const std::uint32_t kind = random.index(5);
      of = kind == 0                            ? kUnknown
           : kind == 1                          ? -length()
           : kind == 2 && random.index(10) == 0 ? 0.0f
                                                : 3 * length();
    }
    RingBlock block;
    const std::size_t size = 2 + random.index(kRingLanes - 1);
    for (std::size_t i = 0; i < kRingLanes; ++i) {
      block.points[i] = i < size ? random.index(100) : 0;
      block.lengths[i] = i < size ? length() : kNever;
      block.opposite[i] = i + 1 < size ? length() : std::numeric_limits<float>::quiet_NaN();
    }
    const KnownBlock around = gather(known.data(), block);
    ASSERT_EQ(around.lanes, one_by_one::gather(known.data(), block).lanes);
    const float shortest = shortest_across(around, block);
    ASSERT_EQ(shortest, one_by_one::shortest_across(around, block));
    const unsigned lanes = nearer_lanes(around, block, 1.0f, 2.5f);
    ASSERT_EQ(lanes, one_by_one::nearer_lanes(around, block, 1.0f, 2.5f));
    found += shortest < kNever ? 1 : 0;
    nearer += lanes != 0 ? 1 : 0;
  }
  EXPECT_GT(found, 1000u);
  EXPECT_GT(nearer, 1000u);
}

}  // namespace
}  // namespace sunder::particles
