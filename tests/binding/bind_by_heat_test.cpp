// Automatic weights: closed forms, laws over random surfaces and rigs, and hard surfaces.

#include <sunder/binding/binding.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "binding/binding_rigs.h"
#include "support/models/changed_surfaces.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::Random;
using test::weight_of;
using test::without_rig;
using testing::HasSubstr;

HeatBinding bound_to(const Character& model, const Character& rig,
                     const HeatOptions& options = {}) {
  auto bound = bind_by_heat(model, rig, options);
  EXPECT_TRUE(bound) << bound.error().text();
  if (!bound) return {};
  const Status status = validate_character(bound->character);
  EXPECT_TRUE(status) << status.text();
  return std::move(*bound);
}

HeatOptions all_influences() {
  HeatOptions options;
  options.maximum_influences = 0;
  return options;
}

double largest_difference(const Character& a, const Character& b) {
  double largest = 0;
  for (Index m = 0; m < a.meshes.size(); ++m)
    for (Index v = 0; v < a.meshes[m].vertex_count(); ++v)
      largest = std::max(largest, test::weight_distance(a, m, v, b, m, v));
  return largest;
}

/// A tube around the y axis that reaches 0.3 beyond both ends of a length from 0, in rings; without
/// a rig.
Character long_tube(std::uint32_t rings, std::uint32_t sides, float length, float radius) {
  Character tube = without_rig(test::make_tube(rings, sides, 1));
  for (Vec3f& position : tube.meshes[0].positions) {
    position.y() = position.y() * (length + 0.6f) - 0.3f;
    position.x() *= 2 * radius;
    position.z() *= 2 * radius;
  }
  return tube;
}

/// Two bones that halve a length, without meshes.
Character two_halves(float length) {
  Character rig = test::make_bare_chain(2);
  rig.skeleton.bones[1].rest.translation.y() = length / 2;
  return rig;
}

TEST(BindByHeat, on_a_long_tube_the_weights_are_those_of_the_closed_form) {
  // Around a straight bone at distance r heat obeys w'' = (w - p) / r^2, with p = 1 beyond the
  // joint: w = exp(s / r) / 2 before it and 1 - exp(-s / r) / 2 after it.
  constexpr float kLength = 8.0f, kRadius = 0.5f;
  for (const double heat : {0.25, 1.0, 4.0}) {
    HeatOptions options = all_influences();
    options.heat = heat;
    const HeatBinding bound =
        bound_to(long_tube(160, 24, kLength, kRadius), two_halves(kLength), options);
    EXPECT_EQ(bound.heated_points, bound.points);
    const Mesh& mesh = bound.character.meshes[0];
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const double s = static_cast<double>(mesh.positions[v].y() - kLength / 2);
      if (std::abs(s) > 2) continue;  // the caps are near
      const double decay =
          0.5 * std::exp(-std::abs(s) * std::sqrt(heat) / static_cast<double>(kRadius));
      EXPECT_NEAR(weight_of(bound.character, 0, v, "link1"), s < 0 ? decay : 1 - decay, 0.012);
    }
  }
}

TEST(BindByHeat, weights_of_two_bones_are_symmetric_and_rise_along_the_axis) {
  const Character tube = long_tube(21, 12, 3.0f, 0.4f);
  const HeatBinding bound = bound_to(tube, two_halves(3.0f), all_influences());
  const Mesh& mesh = bound.character.meshes[0];
  std::map<float, std::pair<double, double>> range;  // of the upper bone, by height
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f& at = mesh.positions[v];
    const double upper = weight_of(bound.character, 0, v, "link1");
    EXPECT_NEAR(upper + weight_of(bound.character, 0, v, "link0"), 1, 2e-7);
    if (Vec2f(at.x(), at.z()).norm() < 0.3f) continue;  // the centres of the caps
    const auto [entry, is_new] = range.try_emplace(at.y(), upper, upper);
    entry->second.first = std::min(entry->second.first, upper);
    entry->second.second = std::max(entry->second.second, upper);
  }
  double below = -1;
  for (const auto& [height, least_and_most] : range) {
    EXPECT_LE(least_and_most.second - least_and_most.first, 0.01) << height;
    EXPECT_GE(least_and_most.first, below - 1e-6) << height;
    below = least_and_most.second;
    const auto mirrored = range.lower_bound(3.0f - height - 1e-4f);
    ASSERT_NE(mirrored, range.end());
    EXPECT_NEAR(least_and_most.first, 1 - mirrored->second.second, 0.01) << height;
  }
}

/// A rig of one to eight bones at random places inside the unit ball, some of them branching.
Character random_rig(Random& random) {
  Character rig;
  const std::uint32_t count = 1 + random.index(8);
  for (std::uint32_t i = 0; i < count; ++i) {
    Bone bone;
    bone.name = "bone" + std::to_string(i);
    bone.parent = i == 0 ? kNone : random.index(i);
    bone.rest.translation = (random.uniform(0, 0.5) * random.direction()).cast<float>();
    rig.skeleton.bones.push_back(bone);
  }
  return rig;
}

Character mirrored(Character character) {
  for (Bone& bone : character.skeleton.bones) bone.rest.translation.x() *= -1;
  for (Mesh& mesh : character.meshes) {
    for (Vec3f& position : mesh.positions) position.x() *= -1;
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return character;
}

TEST(BindByHeat, a_mirrored_model_on_a_mirrored_rig_gets_the_same_weights) {
  const Character ball = without_rig(test::make_bumpy_ball(400));
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Character rig = random_rig(random);
    const HeatBinding bound = bound_to(ball, rig);
    EXPECT_LE(
        largest_difference(bound.character, bound_to(mirrored(ball), mirrored(rig)).character),
        1e-4);
  }
}

TEST(BindByHeat, unit_place_and_order_do_not_matter) {
  const Character ball = without_rig(test::make_bumpy_ball(300));
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Character rig = random_rig(random);
    const HeatBinding bound = bound_to(ball, rig);
    EXPECT_LE(largest_difference(bound.character, bound_to(ball, rig).character), 0.0);
    Character doubled = rig;  // exact in floating point
    for (Bone& bone : doubled.skeleton.bones) bone.rest.translation *= 2;
    HeatOptions options;
    options.place.rig_from_model.linear() *= 2;
    EXPECT_LE(largest_difference(bound.character, bound_to(ball, doubled, options).character),
              1e-9);
    Character in_hundredths = rig;
    for (Bone& bone : in_hundredths.skeleton.bones) bone.rest.translation *= 100;
    options.place.rig_from_model.linear() *= 50;
    EXPECT_LE(largest_difference(bound.character, bound_to(ball, in_hundredths, options).character),
              1e-3);

    Character shuffled = ball;
    Mesh& mesh = shuffled.meshes[0];
    std::vector<Index> old_from_new(mesh.vertex_count()), new_from_old(mesh.vertex_count());
    std::iota(old_from_new.begin(), old_from_new.end(), 0u);
    for (Index v = mesh.vertex_count(); v-- > 1;)
      std::swap(old_from_new[v], old_from_new[random.index(v + 1)]);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      new_from_old[old_from_new[v]] = v;
      mesh.positions[v] = ball.meshes[0].positions[old_from_new[v]];
    }
    std::ranges::reverse(mesh.triangles);
    for (Triangle& triangle : mesh.triangles)
      triangle = {new_from_old[triangle[1]], new_from_old[triangle[2]], new_from_old[triangle[0]]};
    const HeatBinding again = bound_to(shuffled, rig);
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      EXPECT_EQ(test::weight_distance(again.character, 0, v, bound.character, 0, old_from_new[v]),
                0.0);
  }
}

TEST(BindByHeat, a_finer_surface_gets_nearly_the_same_weights) {
  const Character ball = without_rig(test::make_bumpy_ball(1000));
  const Character fine = test::subdivided(ball);
  Random random(6);
  for (int i = 0; i < 10; ++i) {
    const Character rig = random_rig(random);
    const HeatBinding bound = bound_to(ball, rig, all_influences()),
                      finer = bound_to(fine, rig, all_influences());
    double sum = 0;
    const Index count = ball.meshes[0].vertex_count();
    for (Index v = 0; v < count; ++v)  // the subdivision appends its vertices
      sum += test::weight_distance(bound.character, 0, v, finer.character, 0, v);
    EXPECT_LE(sum / count, 0.05);
  }
}

TEST(BindByHeat, one_place_has_one_set_of_weights_and_lips_of_a_tear_two) {
  Character tube = without_rig(test::make_tube(12, 8, 3));
  const HeatBinding bound = bound_to(tube, test::make_bare_chain(3));
  const Mesh& mesh = bound.character.meshes[0];
  EXPECT_LT(bound.points, mesh.vertex_count());  // a seam, hard edges
  std::map<std::array<float, 3>, Index> first;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f p = mesh.positions[v] + Vec3f::Zero();
    const auto [known, is_new] = first.try_emplace({p.x(), p.y(), p.z()}, v);
    EXPECT_TRUE(std::ranges::equal(mesh.weights.of(v), mesh.weights.of(known->second)));
  }
  EXPECT_EQ(bound.components, 1u);
  // The same tube as two bodies in one place, told apart by their tear side.
  Mesh other = tube.meshes[0];
  tube.meshes[0].custom_attributes.push_back(
      {kTearSideAttribute, 1, false, std::vector<float>(other.vertex_count(), 1.0f)});
  tube.meshes.push_back(other);
  EXPECT_EQ(bound_to(tube, test::make_bare_chain(3)).components, 2u);
  tube.meshes[0].custom_attributes.clear();
  EXPECT_EQ(bound_to(tube, test::make_bare_chain(3)).components, 1u);
}

TEST(BindByHeat, soups_get_valid_weights) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Character soup = test::make_soup(random);
    HeatOptions options;
    options.maximum_influences = random.index(5);
    const HeatBinding bound = bound_to(soup, random_rig(random), options);
    const std::size_t most = options.maximum_influences;
    for (const Mesh& mesh : bound.character.meshes)
      for (Index v = 0; v < mesh.vertex_count() && most > 0; ++v)
        EXPECT_LE(mesh.weights.of(v).size(), most);
  }
}

TEST(BindByHeat, heat_has_no_peak_without_a_source) {
  // Only the ring at the joint sees a bone there: the bones stand far outside but for it.
  const Character tube = long_tube(40, 12, 4.0f, 0.5f);
  Character rig = two_halves(4.0f);
  rig.skeleton.bones[0].rest.translation = {3, 0, 0};  // outside: seen by nothing
  rig.skeleton.bones[1].rest.translation = {-3, 2, 0};
  const HeatBinding bound = bound_to(tube, rig, all_influences());
  EXPECT_LT(bound.heated_points, bound.points);
  const Mesh& mesh = bound.character.meshes[0];
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    for (const Influence& influence : mesh.weights.of(v)) {
      EXPECT_GT(influence.weight, 0.0f);
      EXPECT_LE(influence.weight, 1.0f);
    }
}

TEST(BindByHeat, a_part_that_sees_no_bone_follows_the_nearest) {
  Character model = long_tube(20, 8, 2.0f, 0.3f);
  Mesh button = without_rig(test::make_bumpy_ball(100)).meshes[0];
  for (Vec3f& position : button.positions) position = 0.05f * position + Vec3f(0.5f, 1.7f, 0);
  button.uv_sets.clear();
  model.meshes.push_back(button);
  Mesh lone;
  lone.positions = {{0.2f, 0.1f, 0}};
  lone.weights.append(std::vector<Influence>{{0, 1.0f}});
  model.meshes.push_back(lone);
  const HeatBinding bound = bound_to(model, two_halves(2.0f));
  EXPECT_EQ(bound.components, 2u);
  EXPECT_EQ(bound.components_without_sight, 1u);
  EXPECT_EQ(bound.lone_points, 1u);
  for (Index v = 0; v < button.vertex_count(); ++v)
    EXPECT_EQ(weight_of(bound.character, 1, v, "link1"), 1.0);
  EXPECT_EQ(weight_of(bound.character, 2, 0, "link0"), 1.0);
}

TEST(BindByHeat, a_finger_does_not_get_the_bone_of_its_neighbour) {
  // The gap is so narrow that one side of the right finger is nearer to the bone of the left one,
  // which it does not see.
  Character model;
  Mesh mesh = long_tube(24, 16, 3.0f, 0.5f).meshes[0];
  const Index count = mesh.vertex_count();
  Mesh second = mesh;
  for (Vec3f& position : second.positions) position.x() += 1.05f;
  model = long_tube(24, 16, 3.0f, 0.5f);
  model.meshes = {mesh, second};
  Character rig = test::make_bare_chain(2);
  rig.skeleton.bones.push_back({"right0", kNone, {}});
  rig.skeleton.bones.push_back({"right1", 2, {}});
  rig.skeleton.bones[2].rest.translation = {1.45f, 0, 0};  // not in the middle of its finger
  for (const std::uint32_t tip : {1, 3}) rig.skeleton.bones[tip].rest.translation = {0, 1.5f, 0};
  const HeatBinding bound = bound_to(model, rig);
  EXPECT_LT(bound.heated_points, bound.points);
  const auto right = [&](Index mesh_index, Index v) {
    return weight_of(bound.character, mesh_index, v, "right0") +
           weight_of(bound.character, mesh_index, v, "right1");
  };
  for (Index v = 0; v < count; ++v) {
    EXPECT_EQ(right(0, v), 0.0) << v;
    EXPECT_NEAR(right(1, v), 1.0, 1e-6) << v;
  }
}

TEST(BindByHeat, the_limit_of_influences_makes_no_jump) {
  // Along a fine surface, weights change little between neighbours whatever the limit.
  const Character ball = without_rig(test::make_bumpy_ball(4000));
  Random random(8);
  for (int i = 0; i < 5; ++i) {
    Character rig = test::make_bare_chain(1);
    for (std::uint32_t b = 1; b < 9; ++b) {
      Bone bone{"bone" + std::to_string(b), 0, {}};
      bone.rest.translation = (0.5 * random.direction()).cast<float>();
      rig.skeleton.bones.push_back(bone);
    }
    const auto largest_step = [&](std::uint32_t maximum) {
      HeatOptions options;
      options.maximum_influences = maximum;
      const HeatBinding bound = bound_to(ball, rig, options);
      double largest = 0;
      for (const Triangle& t : bound.character.meshes[0].triangles)
        for (const auto& [a, b] : {std::pair(t[0], t[1]), {t[1], t[2]}, {t[2], t[0]}})
          largest = std::max(largest,
                             test::weight_distance(bound.character, 0, a, bound.character, 0, b));
      return largest;
    };
    EXPECT_LE(largest_step(4), 3 * largest_step(0));
  }
}

TEST(BindByHeat, the_shape_stays_in_the_pose_of_the_binding) {
  Random random(9);
  for (int i = 0; i < 20; ++i) {
    const Character tube = test::make_tube(8, 6, 3);
    const Character rig = test::make_bare_chain(3);
    HeatOptions options;
    ModelPose pose = test::random_pose(rig, random, 0.5, 1.0);
    options.place.rig_from_bone = pose.model_from_bone;
    options.place.rig_from_model.linear() *= random.uniform(0.5, 2);
    options.place.rig_from_model.translation() = random.direction();
    const HeatBinding bound = bound_to(tube, rig, options);
    pose.morph_weights = tube.rest_morph_weights;
    const auto posed = test::posed_positions(bound.character, 0, pose);
    const auto before = test::posed_positions(tube, 0, *bind_pose(tube));
    for (std::size_t v = 0; v < posed.size(); ++v)
      EXPECT_LE((posed[v] - options.place.rig_from_model * before[v]).norm(), 1e-5);
  }
}

TEST(BindByHeat, only_bones_that_may_get_weight_do) {
  const Character tube = test::make_tube(12, 8, 3);
  HeatOptions options;
  options.bones = {"bone0", "bone2"};
  const HeatBinding bound = bound_to(tube, tube, options);
  for (const Skin& skin : bound.character.skins)
    for (const Index bone : skin.bones) EXPECT_NE(bone, 1u);
  // The root of a rig with meshes that it does not move gets none either.
  Character rooted = tube;
  for (Bone& bone : rooted.skeleton.bones) bone.parent = bone.parent == kNone ? 0 : bone.parent + 1;
  rooted.skeleton.bones.insert(rooted.skeleton.bones.begin(), Bone{"root", kNone, {}});
  for (Index& bone : rooted.skins[0].bones) ++bone;
  for (Channel& channel : rooted.clips[0].channels) ++channel.index;
  const HeatBinding of_rooted = bound_to(tube, rooted);
  for (const Skin& skin : of_rooted.character.skins)
    EXPECT_EQ(std::ranges::find(skin.bones, 0u), skin.bones.end());
  EXPECT_TRUE(of_rooted.bones_without_weight.empty());
}

TEST(BindByHeat, wrong_options_are_refused_with_their_cause) {
  const Character tube = test::make_tube(4, 4, 2);
  const auto error = [&](const HeatOptions& options) {
    const auto bound = bind_by_heat(tube, tube, options);
    EXPECT_FALSE(bound);
    return std::string(bound.error().text());
  };
  HeatOptions options;
  options.bones = {"bone7"};
  EXPECT_THAT(error(options), HasSubstr("did you mean"));
  options = {};
  options.heat = 0;
  EXPECT_THAT(error(options), HasSubstr("heat is 0; it must be from"));
  options.heat = std::nan("");
  EXPECT_FALSE(error(options).empty());
  EXPECT_FALSE(bind_by_heat(tube, Character()));
  EXPECT_FALSE(bind_by_heat(Character(), tube));
}

}  // namespace
}  // namespace sunder
