// Skinned models mapped onto other skeletons.

#include <sunder/binding/binding.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "binding/binding_rigs.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::Random;
using testing::HasSubstr;

Affine3d random_place(Random& random) {
  Affine3d place = Affine3d::Identity();
  place.linear() = random.uniform(0.2, 5) *
                   Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d(random.direction()))
                       .toRotationMatrix();
  place.translation() = random.uniform(0, 4) * random.direction();
  return place;
}

/// The rig's skeleton with other names, for maps.
Character renamed(Character rig) {
  for (Bone& bone : rig.skeleton.bones) bone.name = "robot_" + bone.name;
  return rig;
}

std::vector<BonePair> pairs_of(const Character& model) {
  std::vector<BonePair> pairs;
  for (const Bone& bone : model.skeleton.bones) pairs.push_back({bone.name, "robot_" + bone.name});
  return pairs;
}

MappedBinding mapped_to(const Character& model, const Character& rig,
                        const std::vector<BonePair>& pairs, const MappingOptions& options = {}) {
  auto bound = bind_by_mapping(model, rig, pairs, options);
  EXPECT_TRUE(bound) << bound.error().text();
  if (!bound) return {};
  const Status status = validate_character(bound->character);
  EXPECT_TRUE(status) << status.text();
  return std::move(*bound);
}

double largest_distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

TEST(BindByMapping, the_own_skeleton_gives_the_same_surface_in_every_pose) {
  const Character tube = test::make_tube(12, 8, 4);
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    MappingOptions options;
    options.place.rig_from_bone = bind_pose(tube)->model_from_bone;
    const MappedBinding bound = mapped_to(tube, renamed(tube), pairs_of(tube), options);
    EXPECT_EQ(bound.mapped_bones, 4u);
    EXPECT_NEAR(bound.farthest_distance, 0, 1e-6);
    EXPECT_LE(bound.largest_shape_error, 1e-6);
    EXPECT_EQ(bound.clips_left_out, 1u);
    const ModelPose pose = test::random_pose(tube, random);
    EXPECT_LE(largest_distance(test::posed_positions(bound.character, 0, pose),
                               test::posed_positions(tube, 0, pose)),
              1e-5);
  }
}

TEST(BindByMapping, weights_keep_their_bits_and_meshes_all_else) {
  const Character tube = test::make_tube(12, 8, 4);
  const MappedBinding bound = mapped_to(tube, renamed(tube), pairs_of(tube));
  const Mesh &before = tube.meshes[0], &after = bound.character.meshes[0];
  EXPECT_EQ(before.positions, after.positions);
  EXPECT_EQ(before.morph_targets, after.morph_targets);
  EXPECT_EQ(before.triangles, after.triangles);
  const Skin& skin = bound.character.skins[after.skin];
  for (Index v = 0; v < before.vertex_count(); ++v) {
    ASSERT_EQ(before.weights.of(v).size(), after.weights.of(v).size());
    for (const Influence& influence : before.weights.of(v)) {
      const auto same = std::ranges::find_if(after.weights.of(v), [&](const Influence& other) {
        return skin.bones[other.slot] == tube.skins[0].bones[influence.slot];
      });
      ASSERT_NE(same, after.weights.of(v).end());
      EXPECT_EQ(same->weight, influence.weight);
    }
  }
  EXPECT_EQ(bound.character.clips.size(), 1u);
  EXPECT_EQ(bound.character.skeleton.bones[0].name, "robot_bone0");
}

TEST(BindByMapping, keeps_the_shape_where_it_is_placed_in_every_pose_of_the_binding) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Character model = i % 2 == 0 ? test::make_tube(6, 5, 3) : test::make_two_tubes(6, 5);
    const Character rig = renamed(test::make_tube(3, 3, 5));
    MappingOptions options;
    options.place.rig_from_model = random_place(random);
    ModelPose pose = test::random_pose(rig, random, 1.5, 1.5);
    options.place.rig_from_bone = pose.model_from_bone;
    std::vector<BonePair> pairs;
    for (const Bone& bone : model.skeleton.bones)
      pairs.push_back({bone.name, rig.skeleton.bones[random.index(5)].name});
    const MappedBinding bound = mapped_to(model, rig, pairs, options);
    EXPECT_LE(bound.largest_shape_error, 1e-5);
    pose.morph_weights = model.rest_morph_weights;
    for (Index m = 0; m < model.meshes.size(); ++m) {
      std::vector<Vec3d> placed = test::posed_positions(model, m, *bind_pose(model));
      for (Vec3d& position : placed) position = options.place.rig_from_model * position;
      EXPECT_LE(largest_distance(test::posed_positions(bound.character, m, pose), placed), 1e-4);
    }
  }
}

TEST(BindByMapping, several_bones_hand_their_weight_to_one) {
  const Character tube = test::make_tube(12, 8, 4);
  const Character rig = test::make_bare_chain(2);
  const MappedBinding bound = mapped_to(
      tube, rig, {{"bone0", "link0"}, {"bone1", "link0"}, {"bone2", "link1"}, {"bone3", "link1"}});
  const Mesh& mesh = bound.character.meshes[0];
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    double of_upper = 0, mapped = 0;
    for (const Influence& influence : tube.meshes[0].weights.of(v))
      if (influence.slot >= 2) of_upper += static_cast<double>(influence.weight);
    for (const Influence& influence : mesh.weights.of(v))
      if (bound.character.skins[0].bones[influence.slot] == 1)
        mapped += static_cast<double>(influence.weight);
    EXPECT_NEAR(mapped, of_upper, 1e-6);
  }
}

TEST(BindByMapping, the_nearest_mapped_ancestor_takes_the_weight_of_others_and_says_so) {
  const Character tube = test::make_tube(12, 8, 4);
  const Character rig = test::make_bare_chain(2);
  const std::vector<BonePair> pairs = {{"bone0", "link0"}, {"bone2", "link1"}};
  const MappedBinding bound = mapped_to(tube, rig, pairs);
  EXPECT_EQ(bound.mapped_bones, 2u);
  const std::vector<BonePair> expected = {{"bone1", "link0"}, {"bone3", "link1"}};
  EXPECT_EQ(bound.taken_by_ancestor, expected);

  MappingOptions strict;
  strict.refuse_unmapped = true;
  const auto refused = bind_by_mapping(tube, rig, pairs, strict);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code(), StatusCode::not_found);
  EXPECT_EQ(refused.error().index(), 1u);
  EXPECT_THAT(std::string(refused.error().text()), HasSubstr("'bone1'"));

  const auto rootless = bind_by_mapping(tube, rig, std::vector<BonePair>{{"bone2", "link1"}});
  ASSERT_FALSE(rootless);
  EXPECT_THAT(std::string(rootless.error().text()), HasSubstr("'bone0'"));
}

TEST(BindByMapping, equal_names_need_no_pair_and_pairs_come_first) {
  const Character tube = test::make_tube(12, 8, 3);
  const MappedBinding alike = mapped_to(tube, tube, {});
  EXPECT_EQ(alike.mapped_bones, 3u);
  EXPECT_TRUE(alike.taken_by_ancestor.empty());
  const MappedBinding moved = mapped_to(tube, tube, {{"bone2", "bone1"}});
  EXPECT_EQ(moved.character.skins[0].bones, (std::vector<Index>{0, 1}));
  EXPECT_EQ(moved.farthest_pair, (BonePair{"bone2", "bone1"}));
  EXPECT_NEAR(moved.farthest_distance, 1, 1e-6);
}

TEST(BindByMapping, wrong_maps_and_places_are_refused_with_their_cause) {
  const Character tube = test::make_tube(4, 4, 2);
  const auto error = [&](const std::vector<BonePair>& pairs, const MappingOptions& options = {}) {
    const auto bound = bind_by_mapping(tube, tube, pairs, options);
    EXPECT_FALSE(bound);
    return std::string(bound.error().text());
  };
  EXPECT_THAT(error({{"Bone1", "bone1"}}), HasSubstr("did you mean 'bone1'"));
  EXPECT_THAT(error({{"bone1", "bome1"}}), HasSubstr("of the rig is named 'bome1'"));
  EXPECT_THAT(error({{"bone1", "bone1"}, {"bone1", "bone0"}}), HasSubstr("mapped twice"));
  MappingOptions options;
  options.place.rig_from_model.linear().setZero();
  EXPECT_THAT(error({}, options), HasSubstr("no inverse"));
  options = {};
  options.place.rig_from_model.translation().x() = std::nan("");
  EXPECT_THAT(error({}, options), HasSubstr("no inverse"));
  options = {};
  options.place.rig_from_bone.resize(1, Affine3d::Identity());
  EXPECT_THAT(error({}, options), HasSubstr("has 1 bones, the rig has 2"));
  options.place.rig_from_bone.resize(2, Affine3d::Identity());
  options.place.rig_from_bone[1].linear().col(0).setZero();
  EXPECT_THAT(error({}, options), HasSubstr("'bone1' has no inverse"));
  EXPECT_FALSE(bind_by_mapping(Character(), tube, {}));
  EXPECT_FALSE(bind_by_mapping(tube, Character(), {}));
}

TEST(BindByMapping, bones_that_move_nothing_are_named) {
  Character tube = test::make_tube(4, 4, 2);
  Bone end;
  end.name = "end";
  end.parent = 1;
  tube.skeleton.bones.push_back(end);
  EXPECT_EQ(mapped_to(tube, tube, {{"end", "bone1"}}).unused, std::vector<std::string>{"end"});
}

TEST(FitPlace, finds_the_place_from_which_the_joints_came) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Character model = test::make_tube(3, 3, 6);
    const Character rig = renamed(model);
    // Bent alike, so that the joints are not on a line.
    const ModelPose bent = test::random_pose(model, random, 1.0, 1.0);
    Character bent_model = model;
    for (std::size_t bone = 0; bone < 6; ++bone)
      bent_model.skins[0].bone_from_bind[bone] =
          Affine3f(bent.model_from_bone[bone].inverse().cast<float>());
    const Affine3d place = random_place(random);
    BindingPlace pose;
    for (const Affine3d& matrix : bent.model_from_bone)
      pose.rig_from_bone.push_back(place * matrix);
    const auto fitted = fit_place(bent_model, rig, pairs_of(model), pose);
    ASSERT_TRUE(fitted) << fitted.error().text();
    EXPECT_LE((fitted->matrix() - place.matrix()).norm(), 1e-4 * place.matrix().norm());
  }
}

TEST(FitPlace, joints_on_a_line_fix_no_place) {
  const Character tube = test::make_tube(3, 3, 4);
  const auto fitted = fit_place(tube, tube, {});
  ASSERT_FALSE(fitted);
  EXPECT_THAT(std::string(fitted.error().text()), HasSubstr("not on a line"));
}

}  // namespace
}  // namespace sunder
