#include <sunder/skinning/pose.h>
#include <sunder/tear/wound_mask.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/atlas_tube.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/wound_distances.h"

namespace sunder {
namespace {

using test::make_atlas_tube;
using test::make_model;
using test::Random;
using test::texel_size;

WoundMaskOptions options_of(std::uint32_t size, double reach, std::uint32_t dilation = 4) {
  WoundMaskOptions options;
  options.width = options.height = size;
  options.reach = reach;
  options.dilation = dilation;
  return options;
}

WoundMask make_mask(const TornModel& model, const WoundMaskOptions& options) {
  auto mask = WoundMask::create(model, 0, options);
  EXPECT_TRUE(mask) << mask.error().text();
  return std::move(*mask);
}

/// The ball of make_bumpy_ball(), each triangle of which is a chart of its own.
Character make_atlas_ball(std::uint32_t points) {
  Character ball = test::make_bumpy_ball(points);
  Mesh& mesh = ball.meshes[0];
  const Mesh joined = mesh;
  const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(joined.triangle_count())));
  const float cell = 1.0f / static_cast<float>(columns);
  mesh.positions.clear();
  mesh.normals.clear();
  mesh.uv_sets.assign(1, {});
  for (std::uint32_t t = 0; t < joined.triangle_count(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      mesh.triangles[t][k] = 3 * t + k;
      mesh.positions.push_back(joined.positions[joined.triangles[t][k]]);
      if (!joined.normals.empty()) mesh.normals.push_back(joined.normals[joined.triangles[t][k]]);
      mesh.uv_sets[0].push_back(cell *
                                Vec2f(static_cast<float>(t % columns) + (k == 1 ? 0.8f : 0.2f),
                                      static_cast<float>(t / columns) + (k == 2 ? 0.8f : 0.2f)));
    }
  test::rig_along(ball, 3);
  return ball;
}

/// The largest difference from brute force; texels.
double largest_error(const TornModel& model, std::uint32_t size, double reach) {
  const WoundMask mask = make_mask(model, options_of(size, reach));
  const std::vector<double> wanted = test::brute_force_wound(model, 0, size, size, 24);
  double largest = 0;
  std::size_t near_lips = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] < 0) continue;
    near_lips += wanted[i] < reach ? 1 : 0;
    largest = std::max(largest, std::abs(mask.distances()[i] - std::min(wanted[i], reach)));
  }
  EXPECT_GT(near_lips, 0U);
  EXPECT_EQ(mask.notes().overlapping_texels, 0U);
  return largest / texel_size(model.source().meshes[0], size);
}

TEST(WoundMask, agrees_with_brute_force_on_sheets) {
  for (int seed = 0; seed < test::stressed(6, 60); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const Character sheet = test::make_sheet(4 + random.index(12));
    TornModel model = make_model(sheet);
    TearOptions options;
    if (seed % 2 == 1) options.width = random.uniform(0.01, 0.05);
    ASSERT_TRUE(model.tear(*bind_pose(sheet), test::turning_stroke(random), options));
    EXPECT_LT(largest_error(model, 128, 0.2), 1.0);
  }
}

TEST(WoundMask, agrees_with_brute_force_on_closed_bodies) {
  for (int seed = 0; seed < test::stressed(8, 80); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const Character tube = make_atlas_tube(6 + random.index(8), 6 + random.index(8));
    TornModel model = make_model(tube);
    for (int i = 0; i < 3; ++i)
      ASSERT_TRUE(test::play(model, test::random_tear(model, random, i == 1 && seed % 2 == 1)));
    EXPECT_LT(largest_error(model, 128, 0.4), 1.0);
  }
}

TEST(WoundMask, agrees_with_brute_force_around_saddles) {
  for (int seed = 0; seed < test::stressed(4, 40); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    TornModel model = make_model(make_atlas_ball(60 + random.index(100)));
    for (int i = 0; i < 2; ++i)
      ASSERT_TRUE(test::play(model, test::random_tear(model, random, false)));
    EXPECT_LT(largest_error(model, 256, 0.4), 1.0);
  }
}

TEST(WoundMask, is_negative_where_skin_was_removed) {
  const Character sheet = test::make_sheet(8);
  TornModel model = make_model(sheet);
  ASSERT_TRUE(model.tear(*bind_pose(sheet),
                         Stroke{test::down_at(0.21, 0.5), test::down_at(0.79, 0.5)}, {0.1}));
  const WoundMask mask = make_mask(model, options_of(64, 0.2));
  const auto at = [&](std::size_t column, std::size_t row) {
    return mask.distances()[64 * row + column];
  };
  EXPECT_NEAR(at(32, 32), -0.05 + 0.5 / 64, 1e-4);
  EXPECT_NEAR(at(32, 29), -0.05 + 2.5 / 64, 1e-4);
  EXPECT_NEAR(at(32, 40), 8.5 / 64 - 0.05, 1e-4);
  EXPECT_FLOAT_EQ(at(32, 60), 0.2f);
}

TEST(WoundMask, without_operations_is_at_its_reach) {
  const WoundMask mask = make_mask(make_model(test::make_sheet(3)), options_of(16, 0.25));
  for (const float distance : mask.distances()) EXPECT_EQ(distance, 0.25f);
}

TEST(WoundMask, bleeds_over_seams) {
  Random random(3);
  const Character tube = make_atlas_tube(8, 8);
  TornModel model = make_model(tube);
  for (int i = 0; i < 4; ++i)
    ASSERT_TRUE(test::play(model, test::random_tear(model, random, false)));
  constexpr std::uint32_t kSize = 128;
  const WoundMask mask = make_mask(model, options_of(kSize, 0.5)),
                  thin = make_mask(model, options_of(kSize, 0.5, 1));
  const std::vector<double> inside = test::brute_force_wound(model, 0, kSize, kSize, 1);
  const double texel = texel_size(tube.meshes[0], kSize);
  std::size_t bled = 0;
  for (std::uint32_t y = 0; y < kSize; ++y)
    for (std::uint32_t x = 0; x + 1 < kSize; ++x) {
      const std::size_t i = std::size_t{y} * kSize + x;
      if (inside[i] < 0 || inside[i + 1] >= 0) continue;
      ASSERT_TRUE(mask.is_painted(x + 1, y));
      EXPECT_NEAR(mask.distances()[i], mask.distances()[i + 1], 1.01 * texel);
      EXPECT_EQ(mask.distances()[i], thin.distances()[i]);
      if (mask.distances()[i + 1] < 0.5f) ++bled;
    }
  EXPECT_GT(bled, 0U);
}

TEST(WoundMask, borders_of_a_chart_that_fills_the_texture_do_not_wrap_into_it) {
  const Character sheet = test::make_sheet(1);
  TornModel model = make_model(sheet);
  ASSERT_TRUE(
      model.tear(*bind_pose(sheet), Stroke{test::down_at(0.2, 0.5), test::down_at(0.7, 0.5)}));
  const WoundMask mask = make_mask(model, options_of(64, 0.15));
  for (std::uint32_t y = 0; y < 64; ++y)
    for (std::uint32_t x = 0; x < 64; ++x) {
      const double u = (x + 0.5) / 64, v = (y + 0.5) / 64;
      const double wanted = std::hypot(u - std::clamp(u, 0.2, 0.7), v - 0.5);
      const float found = mask.distances()[std::size_t{64} * y + x];
      ASSERT_NEAR(found, std::min(wanted, 0.15), 1e-5) << x << ' ' << y;
      ASSERT_EQ(found, static_cast<float>(mask.distance_at(*mask.place_of(x, y))));
    }
}

TEST(WoundMask, wraps_around_tiles) {
  const auto mask_of = [](float shift_u, float shift_v) {
    Character sheet = test::make_sheet(8);
    for (Vec2f& uv : sheet.meshes[0].uv_sets[0]) uv += Vec2f(shift_u, shift_v);
    TornModel model = make_model(sheet);
    EXPECT_TRUE(
        model.tear(*bind_pose(sheet), Stroke{test::down_at(0.21, 0.4), test::down_at(0.79, 0.6)}));
    const WoundMask mask = make_mask(model, options_of(64, 0.2));
    EXPECT_EQ(mask.notes().overlapping_texels, 0U);
    return std::vector<float>(mask.distances().begin(), mask.distances().end());
  };
  const auto plain = mask_of(0, 0), tile = mask_of(3, -2), half = mask_of(0.5f, 0);
  ASSERT_EQ(plain.size(), tile.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_NEAR(plain[i], tile[i], 1e-6f);
    EXPECT_NEAR(plain[i], half[64 * (i / 64) + (i + 32) % 64], 1e-6f);
  }
}

TEST(WoundMask, tells_the_place_of_each_texel) {
  Random random(5);
  const Character tube = make_atlas_tube(8, 8);
  TornModel model = make_model(tube);
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(test::play(model, test::random_tear(model, random, i == 1)));
  WoundMaskOptions options = options_of(96, 0.4);
  // Another tile, and half the texture.
  options.texture_from_uv << 0.5, 0, 3.25, 0, 0.5, -2.25;
  const WoundMask mask = make_mask(model, options);
  options.uv_set = kNone;
  const WoundMask without = make_mask(model, options);
  EXPECT_TRUE(without.distances().empty());
  std::size_t near_lips = 0;
  for (std::uint32_t y = 0; y < 96; ++y)
    for (std::uint32_t x = 0; x < 96; ++x) {
      const std::optional<SourcePlace> place = mask.place_of(x, y);
      ASSERT_EQ(place.has_value(), mask.is_painted(x, y));
      if (!place) continue;
      const float distance = mask.distances()[std::size_t{96} * y + x];
      near_lips += distance < 0.4f ? 1 : 0;
      EXPECT_EQ(static_cast<float>(mask.distance_at(*place)), distance);
      EXPECT_EQ(static_cast<float>(without.distance_at(*place)), distance);
    }
  EXPECT_GT(near_lips, 0U);
}

TEST(WoundMask, paints_one_submesh_of_several_with_textures_of_their_own) {
  // The two halves of a sheet in the same place of the texture.
  Character sheet = test::make_sheet(8);
  Mesh& mesh = sheet.meshes[0];
  mesh.submeshes.resize(2);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    float left = 1;
    for (const std::uint32_t v : mesh.triangles[t]) left = std::min(left, mesh.positions[v].x());
    mesh.triangle_submesh[t] = left < 0.49f ? 0 : 1;
  }
  for (Vec2f& uv : mesh.uv_sets[0]) uv.x() *= 2;
  TornModel model = make_model(sheet);
  ASSERT_TRUE(
      model.tear(*bind_pose(sheet), Stroke{test::down_at(0.1, 0.5), test::down_at(0.4, 0.5)}));
  WoundMaskOptions options = options_of(32, 0.05);
  EXPECT_FALSE(make_mask(model, options).has_own_texels());
  for (const std::uint32_t submesh : {0U, 1U}) {
    options.submesh = submesh;
    const WoundMask mask = make_mask(model, options);
    EXPECT_EQ(mask.notes().overlapping_texels, 0U);
    EXPECT_TRUE(mask.has_own_texels());
    EXPECT_EQ(std::ranges::any_of(mask.distances(), [](float d) { return d < 0.05f; }),
              submesh == 0);
  }
  options.submesh = 2;
  EXPECT_EQ(WoundMask::create(model, 0, options).error().code(), StatusCode::index_out_of_range);
}

TEST(WoundMask, knows_whether_the_wound_itself_is_in_charts_that_overlap) {
  const auto is_shared = [](double height) {
    Character sheet = test::make_sheet(8);  // Its upper half is mirrored onto itself.
    for (Vec2f& uv : sheet.meshes[0].uv_sets[0])
      if (uv.y() > 0.5f) uv.x() = std::abs(uv.x() - 0.5f);
    TornModel model = make_model(sheet);
    EXPECT_TRUE(model.tear(*bind_pose(sheet),
                           Stroke{test::down_at(0.1, height), test::down_at(0.4, height)}));
    const WoundMask mask = make_mask(model, options_of(64, 0.02));
    EXPECT_GT(mask.notes().overlapping_texels, 0U);
    return !mask.has_own_texels();
  };
  EXPECT_NE(is_shared(0.1), is_shared(0.9));
}

TEST(WoundMask, notes_charts_that_overlap_or_repeat) {
  Character sheet = test::make_sheet(4);
  for (Vec2f& uv : sheet.meshes[0].uv_sets[0]) uv *= 2;
  // Centres on the diagonals of the squares are inside no triangle, but on its border.
  EXPECT_EQ(make_mask(make_model(sheet), options_of(32, 0.1)).notes().overlapping_texels,
            32U * 32U - 64U);
  for (Vec2f& uv : sheet.meshes[0].uv_sets[0]) uv *= 1e30f;
  const WoundMaskNotes notes = make_mask(make_model(sheet), options_of(32, 0.1)).notes();
  EXPECT_EQ(notes.unpainted_triangles, 32U);
  EXPECT_EQ(notes.overlapping_texels, 0U);
}

/// A cut across a sheet that stands upright if `down` is in its plane.
std::vector<float> flow_of(const TornModel& model, const Vec3d& down, std::uint64_t seed = 0) {
  BloodFlowOptions options;
  options.down = down;
  options.length = 0.2;
  options.width = 0.05;
  options.spacing = 0.03;
  options.seed = seed;
  const WoundMask mask = make_mask(model, options_of(64, 0.1));
  const auto flow = mask.flow(model, *bind_pose(model.source()), options);
  EXPECT_TRUE(flow) << flow.error().text();
  return *flow;
}

TEST(WoundMask, blood_runs_down_and_no_farther_than_its_length) {
  const Character sheet = test::make_sheet(8);
  TornModel model = make_model(sheet);
  ASSERT_TRUE(
      model.tear(*bind_pose(sheet), Stroke{test::down_at(0.2, 0.5), test::down_at(0.8, 0.5)}));
  const Vec3d along_v = Vec3d::UnitY();
  for (const double sign : {1.0, -1.0}) {
    const std::vector<float> flow = flow_of(model, sign * along_v);
    std::size_t count = 0;
    double farthest = 0;
    for (std::size_t i = 0; i < flow.size(); ++i) {
      ASSERT_TRUE(flow[i] >= 0 && flow[i] <= 1);
      if (flow[i] == 0) continue;
      ++count;
      const double u = (static_cast<double>(i % 64) + 0.5) / 64,
                   v = (static_cast<double>(i / 64) + 0.5) / 64;
      const double below = sign * (v - 0.5);
      EXPECT_GT(below, -0.03) << "above the cut";
      EXPECT_LT(below, 0.23);
      EXPECT_TRUE(u > 0.2 - 0.15 && u < 0.8 + 0.15);
      farthest = std::max(farthest, below);
    }
    EXPECT_GT(count, 40U);
    EXPECT_GT(farthest, 0.1);
  }
  EXPECT_NE(flow_of(model, along_v), flow_of(model, along_v, 1)) << "the seed changes it";
  for (const float value : flow_of(model, Vec3d::UnitZ()))
    EXPECT_EQ(value, 0) << "the sheet lies flat";
}

TEST(WoundMask, blood_is_that_of_a_mask_that_followed_the_operations) {
  for (int seed = 0; seed < test::stressed(6, 60) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const Character tube = make_atlas_tube(6 + random.index(8), 6 + random.index(8));
    TornModel model = make_model(tube);
    WoundMask mask = make_mask(model, options_of(64, 0.2));
    for (int i = 0; i < 4; ++i) {
      ChangeRecord change;
      ASSERT_TRUE(test::play(model, test::random_tear(model, random, i % 2 == 1), &change));
      ASSERT_TRUE(mask.update(model, change));
    }
    BloodFlowOptions options;
    options.down = Vec3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    options.length = 0.8;
    options.width = 0.05;
    options.spacing = 0.1;
    const auto followed = mask.flow(model, *bind_pose(tube), options),
               whole = make_mask(model, options_of(64, 0.2)).flow(model, *bind_pose(tube), options);
    ASSERT_TRUE(followed && whole);
    EXPECT_EQ(*followed, *whole);
    for (std::size_t i = 0; i < whole->size(); ++i) {
      if (mask.distances()[i] > -0.05f) continue;
      EXPECT_EQ((*whole)[i], 0) << "removed skin";
    }
  }
}

TEST(WoundMask, refuses_bad_flow) {
  const TornModel model = make_model(test::make_sheet(2));
  const WoundMask mask = make_mask(model, options_of(8, 0.1));
  const auto is_refused = [&](const BloodFlowOptions& options) {
    const auto flow = mask.flow(model, *bind_pose(model.source()), options);
    return !flow && flow.error().code() == StatusCode::invalid_argument;
  };
  EXPECT_FALSE(is_refused({}));
  for (double BloodFlowOptions::*const field :
       {&BloodFlowOptions::length, &BloodFlowOptions::width, &BloodFlowOptions::spacing})
    for (const double value : {0.0, -1.0, std::nan(""), 1e300}) {
      BloodFlowOptions bad;
      bad.*field = value;
      EXPECT_TRUE(is_refused(bad));
    }
  BloodFlowOptions bad;
  bad.down = Vec3d::Zero();
  EXPECT_TRUE(is_refused(bad));
}

TEST(WoundMask, refuses_bad_options) {
  const TornModel model = make_model(test::make_sheet(2));
  const auto code_of = [&](std::uint32_t mesh, const WoundMaskOptions& options) {
    const auto mask = WoundMask::create(model, mesh, options);
    return mask ? StatusCode::ok : mask.error().code();
  };
  const WoundMaskOptions good = options_of(8, 0.1);
  EXPECT_EQ(code_of(0, good), StatusCode::ok);
  EXPECT_EQ(code_of(1, good), StatusCode::index_out_of_range);
  WoundMaskOptions bad = good;
  bad.uv_set = 1;
  EXPECT_EQ(code_of(0, bad), StatusCode::not_found);
  for (const std::uint32_t size : {0U, 16385U}) {
    (bad = good).width = size;
    EXPECT_EQ(code_of(0, bad), StatusCode::invalid_argument);
    (bad = good).height = size;
    EXPECT_EQ(code_of(0, bad), StatusCode::invalid_argument);
  }
  for (const std::uint32_t dilation : {0U, 65U}) {
    (bad = good).dilation = dilation;
    EXPECT_EQ(code_of(0, bad), StatusCode::invalid_argument);
  }
  (bad = good).texture_from_uv(0, 2) = std::nan("");
  EXPECT_EQ(code_of(0, bad), StatusCode::invalid_argument);
  for (const double reach : {0.0, -1.0, std::nan(""), 1e300}) {
    (bad = good).reach = reach;
    EXPECT_EQ(code_of(0, bad), StatusCode::invalid_argument);
  }
}

/// Whether two masks have the same bits.
bool are_same(const WoundMask& a, const WoundMask& b) {
  return std::ranges::equal(a.distances(), b.distances(), [](float x, float y) {
    return x == y && std::signbit(x) == std::signbit(y);
  });
}

TEST(WoundMask, follows_operations_and_undo) {
  for (int seed = 0; seed < test::stressed(12, 120) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    TornModel model = make_model(test::random_character(random));
    const WoundMaskOptions options = options_of(96, 0.15);
    WoundMask mask = make_mask(model, options);
    for (int step = 0; step < 12; ++step) {
      SCOPED_TRACE(step);
      const std::vector<float> before(mask.distances().begin(), mask.distances().end());
      ChangeRecord change;
      const std::size_t choice = random.index(4);
      if (choice == 0 && model.undo_count() > 0)
        ASSERT_TRUE(model.undo(&change));
      else if (choice == 1 && model.redo_count() > 0)
        ASSERT_TRUE(model.redo(&change));
      else if (choice == 2 && model.undo_count() > 0)
        ASSERT_TRUE(test::play(model, test::random_weld(model, random), &change));
      else if (!test::play(model, test::random_operation(model, random), &change))
        continue;
      const auto changed = mask.update(model, change);
      ASSERT_TRUE(changed) << changed.error().text();
      ASSERT_TRUE(are_same(mask, make_mask(model, options)));
      for (std::uint32_t i = 0; i < before.size(); ++i) {
        const std::uint32_t x = i % 96 - changed->left, y = i / 96 - changed->top;
        if (x < changed->width && y < changed->height) continue;
        ASSERT_EQ(before[i], mask.distances()[i]) << "outside of the rectangle";
      }
    }
  }
}

TEST(WoundMask, refuses_another_source) {
  TornModel model = make_model(test::make_sheet(4));
  WoundMask mask = make_mask(model, options_of(8, 0.1));
  ChangeRecord change;
  const TornModel other = make_model(test::make_sheet(5));
  const auto changed = mask.update(other, change);
  ASSERT_FALSE(changed);
  EXPECT_EQ(changed.error().code(), StatusCode::invalid_argument);
}

}  // namespace
}  // namespace sunder
