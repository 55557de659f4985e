// The sides of gaps in a change record, and the record of a repeated operation.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/change_record.h>
#include <sunder/tear/tear_stroke.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/posed_points.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {

using test::down_at;
using test::make_model;
using test::posed_points;
using test::Random;

/// The mean of the centres of a point's faces.
Vec3d middle_of_fan(std::uint32_t point, const TornModel& model,
                    const std::map<std::uint32_t, Vec3d>& places) {
  const tear::Surface& surface = model.surface();
  Vec3d sum = Vec3d::Zero();
  double count = 0;
  surface.for_each_in_fan(surface.point_corner[point], [&](std::uint32_t corner) {
    for (std::uint32_t k = 0; k < 3; ++k)
      sum += places.at(surface.corner_point[corner / 3 * 3 + k]);
    count += 3;
  });
  return sum / count;
}

bool has_face(const TornModel& model, std::uint32_t point) {
  return model.surface().point_corner[point] != kNone;
}

void expect_listed_well(const Rims& rims, const TornModel& model, bool has_wall = false) {
  std::vector<std::uint32_t> all;
  for (const auto* side : {&rims.left, &rims.right}) {
    EXPECT_TRUE(std::ranges::is_sorted(*side));
    all.insert(all.end(), side->begin(), side->end());
  }
  std::ranges::sort(all);
  EXPECT_EQ(std::ranges::adjacent_find(all), all.end()) << "a point twice";
  for (const std::uint32_t point : all) {
    ASSERT_LT(point, model.point_count());
    ASSERT_TRUE(has_face(model, point));
    EXPECT_TRUE(has_wall || model.surface().is_on_border(point));
  }
}

/// A straight segment that a blade sweeps without turning, and its plane.
struct Segment {
  Stroke stroke;
  Vec3d left;

  Segment(const Blade& from, const Vec3d& motion)
      : stroke{from, {from.base + motion, from.tip + motion}} {
    left = motion.cross(from.tip - from.base).normalized();
  }
  [[nodiscard]] double distance(const Vec3d& point) const {
    return left.dot(point - stroke[0].base);
  }
  /// 1 at the blade's tip.
  [[nodiscard]] double depth(const Vec3d& point) const {
    const Vec3d down = stroke[0].tip - stroke[0].base;
    return down.dot(point - stroke[0].base) / down.squaredNorm();
  }
};

Segment random_segment(const Character& character, const ModelPose& pose, Random& random) {
  const Stroke stroke = test::random_stroke(character, pose, random, random.uniform(0.02, 0.5), 1);
  return {stroke[0], stroke[1].base - stroke[0].base};
}

TEST(Rims, are_the_border_at_half_the_width_of_a_segment) {
  int gaps = 0, crossing = 0, within = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const bool is_sheet = random.index(2) == 0;
    const std::uint32_t cells = 2 + random.index(12), sides = 5 + random.index(12);
    TornModel model =
        make_model(is_sheet ? test::make_sheet(cells) : test::make_tube(cells + 2, sides, 3));
    // Where bones turn apart, points of the older tear are off the surface on which the gap is
    // found.
    const bool is_torn_before = random.index(2) == 0;
    const ModelPose pose = is_torn_before ? test::random_pose(model.source(), random, 0.0, 1.0)
                                          : test::random_pose(model.source(), random, 0.6, 1.2);
    const double diagonal = test::posed_diagonal(model.source(), pose);
    TearOptions options;
    options.weights = WeightOptions{WeightPolicy::pose_exact};
    const Segment segment = random_segment(model.source(), pose, random);
    if (is_torn_before) {  // across the segment's middle
      const Vec3d middle =
          segment.stroke[0].base + 0.5 * (segment.stroke[1].base - segment.stroke[0].base);
      const Vec3d down = segment.stroke[0].tip - segment.stroke[0].base,
                  step = 0.1 * diagonal * segment.left;
      ASSERT_TRUE(model.tear(
          pose,
          Stroke{{middle - step, middle - step + down}, {middle + step, middle + step + down}},
          options));
    }
    options.width = random.uniform(0.005, 0.1) * diagonal;
    options.layers = random.index(2) == 0 ? Layers::all : Layers::nearest;
    ChangeRecord change;
    const auto report = model.tear(pose, segment.stroke, options, &change);
    ASSERT_TRUE(report) << report.error().text();
    expect_listed_well(change.rims, model);
    const auto places = posed_points(model, pose);
    const double near = 1e-6 * diagonal;
    for (const std::uint32_t point : change.rims.left)
      EXPECT_NEAR(segment.distance(places.at(point)), 0.5 * options.width, near);
    for (const std::uint32_t point : change.rims.right)
      EXPECT_NEAR(segment.distance(places.at(point)), -0.5 * options.width, near);
    gaps += change.rims.left.empty() || change.rims.right.empty() ? 0 : 1;
    crossing += is_torn_before && report->runs > 0 ? 1 : 0;
    if (is_sheet)
      continue;  // it has a border of its own: at the plane, or so near that a side lies beyond it
    const bool has_depth = std::ranges::none_of(places, [&](const auto& place) {
      return model.surface().is_on_border(place.first) &&
             std::abs(segment.depth(place.second) - 1) < 1e-6;
    });
    if (report->runs > 0 && report->pieces.empty() && has_depth) {
      EXPECT_FALSE(change.rims.left.empty());
      EXPECT_FALSE(change.rims.right.empty());
      ++within;
    }
    for (const auto& [point, at] : places) {
      if (!model.surface().is_on_border(point)) continue;
      const double distance = segment.distance(at);
      if (std::abs(std::abs(distance) - 0.5 * options.width) > near) continue;
      const auto& side = distance > 0 ? change.rims.left : change.rims.right;
      EXPECT_TRUE(std::ranges::binary_search(side, point)) << point;
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(gaps, 200);
  EXPECT_GT(crossing, 100);
  EXPECT_GT(within, 30);
}

/// For the lips of a tear without width: whether the left ones have their faces left of the
/// segment, in the sense of Segment::left.
/// @return +1, -1, or 0 if they are on both sides.
int side_of_left_lips(const ChangeRecord& change, const TornModel& model, const ModelPose& pose,
                      const Segment& segment) {
  const auto places = posed_points(model, pose);
  int left = 0, right = 0;
  for (const LipPair& pair : change.lips) {
    const double of_left = segment.distance(middle_of_fan(pair.left, model, places));
    const double of_right = segment.distance(middle_of_fan(pair.right, model, places));
    ++(of_left > of_right ? left : right);
  }
  return right == 0 ? 1 : left == 0 ? -1 : 0;
}

void expect_sides_of_lips(const Character& character, const ModelPose& pose, const Segment& segment,
                          Layers layers, double width, int expected) {
  TearOptions options;
  options.layers = layers;
  TornModel torn = make_model(character), with_gap = make_model(character);
  ChangeRecord lips, rims;
  ASSERT_TRUE(torn.tear(pose, segment.stroke, options, &lips));
  options.width = width;
  ASSERT_TRUE(with_gap.tear(pose, segment.stroke, options, &rims));
  ASSERT_FALSE(lips.lips.empty());
  EXPECT_TRUE(lips.rims == Rims{});
  EXPECT_TRUE(rims.lips.empty());
  EXPECT_EQ(side_of_left_lips(lips, torn, pose, segment), expected);
  const auto places = posed_points(with_gap, pose);
  ASSERT_FALSE(rims.rims.left.empty());
  ASSERT_FALSE(rims.rims.right.empty());
  for (const std::uint32_t point : rims.rims.left)
    EXPECT_GT(expected * segment.distance(places.at(point)), 0);
  for (const std::uint32_t point : rims.rims.right)
    EXPECT_LT(expected * segment.distance(places.at(point)), 0);
}

TEST(Rims, have_the_sides_of_the_lips_that_the_stroke_makes_without_width) {
  const Character sheet = test::make_sheet(7);
  const ModelPose flat = *bind_pose(sheet);
  const Segment from_above({{0.2, 0.41, 0.5}, {0.2, 0.41, -0.5}}, {0.5, 0.13, 0});
  const Segment from_below({{0.2, 0.41, -0.5}, {0.2, 0.41, 0.5}}, {0.5, 0.13, 0});
  expect_sides_of_lips(sheet, flat, from_above, Layers::nearest, 0.04, 1);
  expect_sides_of_lips(sheet, flat, from_above, Layers::all, 0.04, 1);
  // Seen from outside, the left of such a stroke is the blade's right; a sheet through all layers
  // uses the blade's sides.
  expect_sides_of_lips(sheet, flat, from_below, Layers::nearest, 0.04, -1);
  expect_sides_of_lips(sheet, flat, from_below, Layers::all, 0.04, 1);
  const Character tube = test::make_tube(9, 12, 3);
  const Segment across({{1, 1.13, 0.07}, {-1, 1.13, 0.07}}, {0, 0.5, 0.11});
  expect_sides_of_lips(tube, *bind_pose(tube), across, Layers::nearest, 0.05, 1);
  expect_sides_of_lips(tube, *bind_pose(tube), across, Layers::all, 0.05, 1);
}

/// Walks each border loop that has points of rims: it must follow one side, then the other, with
/// only the ends between them.
/// @return number of such loops.
int count_loops_of_two_sides(const Rims& rims, const TornModel& model) {
  const tear::Surface& surface = model.surface();
  std::map<std::uint32_t, std::uint32_t> next;
  for (std::uint32_t h = 0; h < surface.twin.size(); ++h)
    if (surface.corner_point[h] != kNone && surface.twin[h] == kNone)
      next[surface.corner_point[h]] = surface.corner_point[tear::Surface::next(h)];
  int loops = 0;
  while (!next.empty()) {
    std::string sides;  // a run each: l, r, or - for neither
    const std::uint32_t first = next.begin()->first;
    for (std::uint32_t point = first; next.contains(point);) {
      const char side = std::ranges::binary_search(rims.left, point)    ? 'l'
                        : std::ranges::binary_search(rims.right, point) ? 'r'
                                                                        : '-';
      if (sides.empty() || sides.back() != side) sides.push_back(side);
      const std::uint32_t after = next.at(point);
      next.erase(point);
      point = after;
    }
    if (sides == "-") continue;
    ++loops;
    // An end is the straight edge between two corners, or contains points of the surface's own
    // edges.
    std::erase(sides, '-');
    sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
    if (sides.size() > 1 && sides.front() == sides.back()) sides.pop_back();
    EXPECT_EQ(sides.size(), 2u) << sides;
  }
  return loops;
}

TEST(Rims, of_a_turning_stroke_are_two_runs) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(test::make_sheet(1 + random.index(20)));
    TearOptions options;
    options.width = random.uniform(0.001, 0.02);
    const Stroke stroke = test::turning_stroke(random);
    ChangeRecord change;
    ASSERT_TRUE(model.tear(*bind_pose(model.source()), stroke, options, &change));
    expect_listed_well(change.rims, model);
    EXPECT_EQ(count_loops_of_two_sides(change.rims, model), 1);
    EXPECT_GE(change.rims.left.size(), stroke.size());
    EXPECT_GE(change.rims.right.size(), stroke.size());
    if (HasFailure()) return;
  }
}

TEST(Rims, go_around_a_bevel_on_the_outer_side) {
  for (const double degrees : {-170.0, -120.0, -95.0, -60.0, 60.0, 95.0, 120.0, 170.0}) {
    SCOPED_TRACE(degrees);
    TornModel model = make_model(test::make_sheet(12));
    TearOptions options;
    options.width = 0.04;
    const double turn = degrees / 180.0 * std::numbers::pi;
    const Stroke stroke = {down_at(0.2, 0.5), down_at(0.6, 0.5),
                           down_at(0.6 + 0.3 * std::cos(turn), 0.5 + 0.3 * std::sin(turn))};
    ChangeRecord change;
    const ModelPose pose = *bind_pose(model.source());
    ASSERT_TRUE(model.tear(pose, stroke, options, &change));
    expect_listed_well(change.rims, model);
    EXPECT_EQ(count_loops_of_two_sides(change.rims, model), 1);
    // Points beyond the turn are on the outer side.
    const auto& outer = degrees > 0 ? change.rims.right : change.rims.left;
    const auto& inner = degrees > 0 ? change.rims.left : change.rims.right;
    const auto places = posed_points(model, pose);
    const auto is_beyond = [&](std::uint32_t point) { return places.at(point).x() > 0.6 + 1e-6; };
    EXPECT_GT(std::ranges::count_if(outer, is_beyond), 0);
    if (std::abs(degrees) > 90) {
      EXPECT_EQ(std::ranges::count_if(inner, is_beyond), 0);
    }
  }
}

/// Sides from several records in order, for each point that still has a face at the end.
Rims sum_of(const std::vector<ChangeRecord>& changes, const TornModel& model) {
  std::map<std::uint32_t, bool> is_left;
  for (const ChangeRecord& change : changes) {
    for (const std::uint32_t point : change.rims.left) is_left[point] = true;
    for (const std::uint32_t point : change.rims.right) is_left[point] = false;
  }
  Rims sum;
  for (const auto& [point, left] : is_left)
    if (has_face(model, point)) (left ? sum.left : sum.right).push_back(point);
  return sum;
}

std::vector<LipPair> lips_of(const std::vector<ChangeRecord>& changes) {
  std::vector<LipPair> lips;
  for (const ChangeRecord& change : changes)
    lips.insert(lips.end(), change.lips.begin(), change.lips.end());
  return lips;
}

void expect_told(const ChangeRecord& change, const std::vector<LipPair>& lips, const Rims& rims) {
  EXPECT_TRUE(change.lips == lips)
      << change.lips.size() << " pairs, " << lips.size() << " expected";
  EXPECT_EQ(change.rims.left, rims.left);
  EXPECT_EQ(change.rims.right, rims.right);
}

/// Tears blade by blade. @param other  if given, the pose of every second blade.
std::vector<ChangeRecord> tear_by_calls(TornModel& model, const TearOperation& tear,
                                        const ModelPose* other = nullptr) {
  const auto& pose = std::get<ModelPose>(tear.pose);
  std::vector<ChangeRecord> changes;
  auto stroke = TearStroke::create(model, pose, tear.stroke[0], tear.options);
  EXPECT_TRUE(stroke) << stroke.error().text();
  for (std::size_t i = 1; i < tear.stroke.size(); ++i) {
    const auto report = stroke->extend(other != nullptr && i % 2 == 0 ? *other : pose,
                                       tear.stroke[i], 0.0, &changes.emplace_back());
    EXPECT_TRUE(report) << report.error().text();
    expect_listed_well(changes.back().rims, model, tear.options.wall_depth > 0);
  }
  EXPECT_TRUE(stroke->end(&changes.emplace_back()));
  expect_listed_well(changes.back().rims, model, tear.options.wall_depth > 0);
  return changes;
}

TEST(Rims, of_a_stroke_in_several_calls_are_those_of_the_tear) {
  int told = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel at_once = make_model(test::random_character(random)),
              by_calls = make_model(at_once.source());
    for (int i = 0; i < 2; ++i) {
      const TearOperation tear = test::random_tear(at_once, random, i == 1 || random.index(3) > 0);
      ChangeRecord change;
      ASSERT_TRUE(at_once.tear(std::get<ModelPose>(tear.pose), tear.stroke, tear.options, &change));
      expect_listed_well(change.rims, at_once, tear.options.wall_depth > 0);
      const auto changes = tear_by_calls(by_calls, tear);
      ASSERT_EQ(at_once.digest(), by_calls.digest());
      expect_told(change, lips_of(changes), sum_of(changes, by_calls));
      told += change.rims.left.empty() ? 0 : 1;
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(told, 150);
}

/// The records of an operation when it was done.
struct Said {
  std::vector<LipPair> lips;
  Rims rims;
};

Said play_at_random(TornModel& model, Random& random) {
  if (random.index(3) > 0) {
    std::vector<ChangeRecord> changes(1);
    EXPECT_TRUE(test::play(model, test::random_operation(model, random), changes.data()));
    return {changes[0].lips, changes[0].rims};
  }
  const TearOperation tear = test::random_tear(model, random, random.index(2) == 0);
  const ModelPose other = test::random_pose(model.source(), random, 0.2);
  const auto changes = tear_by_calls(model, tear, random.index(2) == 0 ? &other : nullptr);
  return {lips_of(changes), sum_of(changes, model)};
}

void redo_at_random(TornModel& model, Random& random) {
  std::vector<Said> done, undone;
  ChangeRecord change;
  for (int i = 0; i < 30 && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    switch (random.index(4)) {
      case 0: {
        const std::uint32_t before = model.undo_count();
        const Said said = play_at_random(model, random);
        if (model.undo_count() == before) break;
        done.push_back(said);
        undone.clear();
        break;
      }
      case 1: {
        if (done.empty() || random.index(3) > 0) break;
        WeightsOperation wanted;
        wanted.weights.policy =
            random.index(2) == 0 ? WeightPolicy::pose_exact : WeightPolicy::barycentric;
        wanted.pose = *bind_pose(model.source());
        ASSERT_TRUE(model.reweigh(wanted, &change));
        expect_told(change, {}, {});
        done.emplace_back();
        undone.clear();
        break;
      }
      case 2: {
        if (undone.empty()) break;
        const bool is_asked = random.index(4) > 0;
        ASSERT_TRUE(model.redo(is_asked ? &change : nullptr));
        if (is_asked) expect_told(change, undone.back().lips, undone.back().rims);
        done.push_back(undone.back());
        undone.pop_back();
        break;
      }
      default: {
        for (std::uint32_t count = 1 + random.index(3); count > 0 && !done.empty(); --count) {
          ASSERT_TRUE(model.undo(&change));
          expect_told(change, {}, {});
          undone.push_back(done.back());
          done.pop_back();
        }
        break;
      }
    }
    ASSERT_EQ(model.undo_count(), done.size());
    ASSERT_EQ(model.redo_count(), undone.size());
  }
}

class RandomRedo : public testing::TestWithParam<int> {};

TEST_P(RandomRedo, gives_the_record_of_the_operation) {
  Random random(static_cast<std::uint64_t>(GetParam()));
  TornModel model = make_model(test::random_character(random));
  redo_at_random(model, random);
}

INSTANTIATE_TEST_SUITE_P(seeds, RandomRedo, testing::Range(0, 60));

TEST(Redo, gives_the_record_of_the_operation_in_a_model_of_fixed_capacity) {
  for (std::uint64_t seed = 0; seed < 20 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(test::random_character(random), {50000, 50000, 64});
    redo_at_random(model, random);
  }
}

TEST(Rims, of_a_bore_are_none) {
  TornModel model = make_model(test::make_sheet(6));
  Bore bore;
  bore.origin = {0.45, 0.52, 1};
  bore.radius = 0.2;
  bore.depth = 2;
  ChangeRecord change;
  change.rims.left = {1, 2};
  ASSERT_TRUE(model.drill(*bind_pose(model.source()), bore, &change));
  EXPECT_TRUE(change.rims == Rims{});
}

}  // namespace
}  // namespace sunder
