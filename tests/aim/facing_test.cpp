// The way that a character faces: by names, by places, by feet.
#include <sunder/aim/aim.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <array>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::make_model;

/// A figure of two arms and two legs with toes, whose left is on a side and whose front is another.
Character make_figure(const Vec3f& left, const Vec3f& front) {
  Character character = test::make_tube(24, 16, 3);
  const auto add_bone = [&](const char* name, std::uint32_t parent, const Vec3f& place) {
    Bone bone;
    bone.name = name;
    bone.parent = parent;
    bone.rest.translation = place;
    character.skeleton.bones.push_back(bone);
    return static_cast<std::uint32_t>(character.skeleton.bones.size() - 1);
  };
  for (const float side : {1.0f, -1.0f}) {
    const bool is_left = side > 0;
    add_bone(is_left ? "Arm.L" : "Arm.R", 0, side * left + Vec3f(0, 2, 0));
    const std::uint32_t leg = add_bone(is_left ? "Leg.L" : "Leg.R", 0, 0.4f * side * left);
    add_bone(is_left ? "Toe.L" : "Toe.R", leg, Vec3f(0, -1, 0) + 0.3f * front);
  }
  return character;
}

TEST(Facing, is_told_by_the_names_of_sides_and_by_the_toes) {
  const Vec3f x(1, 0, 0), z(0, 0, 1);
  const auto expect = [](const Character& character, const Vec3d& direction, bool is_certain) {
    const auto facing = find_facing(character);
    ASSERT_TRUE(facing) << facing.error().text();
    EXPECT_NEAR((facing->direction - direction).norm(), 0, 1e-6);
    EXPECT_EQ(facing->is_certain, is_certain);
  };
  expect(make_figure(x, z), Vec3d(0, 0, 1), true);
  expect(make_figure(-x, -z), Vec3d(0, 0, -1), true);
  expect(make_figure(-z, x), Vec3d(1, 0, 0), true);
  expect(make_figure(x, -z), Vec3d(0, 0, 1), false);  // the toes contradict the names
  expect(test::make_tube(24, 16, 3), Vec3d(0, 0, 1), false);
}

/// The figure with a face at each bone, which it moves. The faces of toes lie `ahead` of them by
/// their size.
Character make_figure_of_faces(const Vec3f& left, const Vec3f& front, float ahead) {
  Character character = make_figure(left, front);
  const auto pose = rest_pose(character);
  EXPECT_TRUE(pose);
  Skin skin;
  Mesh mesh;
  for (Index bone = 0; bone < character.skeleton.bones.size(); ++bone) {
    const Affine3f model_from_bone = pose->model_from_bone[bone].cast<float>();
    skin.bones.push_back(bone);
    skin.bone_from_bind.push_back(model_from_bone.inverse());
    const bool is_toe = character.skeleton.bones[bone].name.starts_with("Toe");
    const std::uint32_t first = mesh.vertex_count();
    for (const Vec3f& corner : {Vec3f(2, 0, 0), Vec3f(-1, 0, 1.732f), Vec3f(-1, 0, -1.732f)}) {
      const Vec3f way = 0.05f * corner + (is_toe ? ahead * 0.1f : 0.0f) * front;
      mesh.positions.push_back(model_from_bone.translation() + way);
      mesh.weights.append(std::array{Influence{bone, 1.0f}});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangle_submesh.push_back(0);
  }
  mesh.submeshes.emplace_back();
  character.skins = {skin};
  character.meshes = {mesh};
  character.rest_morph_weights.clear();
  character.clips.clear();
  return character;
}

TEST(Facing, is_told_by_places_and_feet_where_names_tell_nothing) {
  const Vec3f x(1, 0, 0), z(0, 0, 1);
  const auto facing_of = [](Character character, bool has_sides) {
    for (Index bone = 0; bone < character.skeleton.bones.size(); ++bone) {
      std::string& name = character.skeleton.bones[bone].name;
      name = (has_sides ? name + "_" : "bone") +
             std::to_string(bone);  // no two differ in the side alone
    }
    const auto facing = find_facing(character);
    EXPECT_TRUE(facing) << facing.error().text();
    return facing ? *facing : Facing();
  };
  for (const Vec3f& front : {z, Vec3f(-z), x, Vec3f(-x)})
    for (const float side : {1.0f, -1.0f}) {
      const Vec3f left = side * Vec3f(0, 1, 0).cross(front);
      const Facing by_feet = facing_of(make_figure_of_faces(left, front, 1), false);
      EXPECT_TRUE(by_feet.is_certain);
      EXPECT_NEAR((by_feet.direction - front.cast<double>()).norm(), 0, 1e-6);
      EXPECT_FALSE(facing_of(make_figure_of_faces(left, front, 0), false).is_certain);
      // Names that tell sides, but no pairs: they agree with the feet, or not.
      const Facing by_sides = facing_of(make_figure_of_faces(left, front, 1), true);
      EXPECT_EQ(by_sides.is_certain, side > 0);
      EXPECT_NEAR((by_sides.direction - side * front.cast<double>()).norm(), 0, 1e-6);
    }
  Character lame = make_figure_of_faces(x, z, 1);
  for (Bone& bone : lame.skeleton.bones)
    if (bone.name.ends_with(".R")) bone.rest.translation += Vec3f(0.2f, 0.7f, 0.3f);
  EXPECT_FALSE(facing_of(lame, false).is_certain);
}

TEST(Facing, turns_the_side_from_which_a_limb_is_seen) {
  const TornModel model = make_model(test::make_tube(24, 16, 3));
  SlashOperation slash;
  slash.place = {"bone1", 0.5};
  const auto stroke_of = [&](const AimedOperation& aimed) {
    const auto plain = resolve(model, aimed);
    EXPECT_TRUE(plain) << plain.error().text();
    return plain ? std::get<TearOperation>(*plain).stroke : Stroke();
  };
  const auto seen = [&](std::optional<ViewSide> side, const Vec3d& front) {
    slash.from = side ? std::optional<View>(*side) : std::nullopt;
    return stroke_of(*seen_by(model, slash, front));
  };
  const auto as_in_file = [&](ViewSide side) {
    slash.from = side;
    return stroke_of(slash);
  };
  const Vec3d back(0, 0, -1), right(-1, 0, 0);
  EXPECT_EQ(seen(ViewSide::front, Vec3d(0, 0, 1)), as_in_file(ViewSide::front));
  EXPECT_EQ(seen(ViewSide::front, back), as_in_file(ViewSide::back));
  EXPECT_EQ(seen(std::nullopt, back), as_in_file(ViewSide::back));
  EXPECT_EQ(seen(ViewSide::left, back), as_in_file(ViewSide::right));
  EXPECT_EQ(seen(ViewSide::front, right), as_in_file(ViewSide::right));
  EXPECT_EQ(seen(ViewSide::left, right), as_in_file(ViewSide::front));
}

}  // namespace
}  // namespace sunder
