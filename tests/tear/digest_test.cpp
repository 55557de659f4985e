// The digest depends on all bits of a model.

#include <sunder/tear/torn_model.h>

#include <bit>

#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::make_model;

/// Makes the smallest change of a float.
void flip_last_bit(float& value) {
  value = std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) ^ 1u);
}

TEST(Digest, of_equal_models_is_equal) {
  const Character tube = test::make_tube(12, 16, 3);
  TornModel one = make_model(tube), other = make_model(tube);
  EXPECT_EQ(one.digest(), other.digest());
  test::Random random(1);
  for (int i = 0; i < 5; ++i) {
    const Operation operation = test::random_operation(one, random);
    ASSERT_TRUE(test::play(one, operation));
    ASSERT_TRUE(test::play(other, operation));
    EXPECT_EQ(one.digest(), other.digest());
  }
  EXPECT_NE(one.digest(), make_model(tube).digest());
}

TEST(Digest, differs_after_one_bit) {
  const Character tube = test::make_tube(6, 8, 2);
  const std::uint64_t digest = make_model(tube).digest();
  const auto expect_another = [&](const char* what, const auto& change) {
    Character changed = tube;
    change(changed.meshes[0]);
    EXPECT_NE(make_model(changed).digest(), digest) << what;
  };
  expect_another("position", [](Mesh& mesh) { flip_last_bit(mesh.positions.back().z()); });
  expect_another("normal", [](Mesh& mesh) { flip_last_bit(mesh.normals.front().x()); });
  expect_another("texture coordinate", [](Mesh& mesh) { flip_last_bit(mesh.uv_sets[0][5].y()); });
  expect_another("morph displacement",
                 [](Mesh& mesh) { flip_last_bit(mesh.morph_targets[0].position_deltas[7].y()); });
  expect_another("weight", [](Mesh& mesh) { flip_last_bit(mesh.weights.influences[3].weight); });
  expect_another("winding",
                 [](Mesh& mesh) { std::swap(mesh.triangles[0][1], mesh.triangles[0][2]); });
}

TEST(Digest, is_restored_by_undo_and_redo) {
  test::Random random(2);
  TornModel model = make_model(test::make_tube(12, 16, 3));
  std::vector<std::uint64_t> digests = {model.digest()};
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
    if (model.undo_count() == digests.size()) digests.push_back(model.digest());
  }
  ASSERT_GT(digests.size(), 2u);
  for (std::size_t at = digests.size() - 1; at > 0; --at) {
    EXPECT_EQ(model.digest(), digests[at]);
    ASSERT_TRUE(model.undo());
  }
  EXPECT_EQ(model.digest(), digests.front());
  for (std::size_t at = 1; at < digests.size(); ++at) {
    ASSERT_TRUE(model.redo());
    EXPECT_EQ(model.digest(), digests[at]);
  }
}

/// The same bits from every compiler, at every optimisation level. Only a number that all builds
/// must reproduce can test this. It changes only when the results of operations change on purpose.
TEST(Digest, of_a_fixed_history_is_the_same_in_every_build) {
  TornModel model = make_model(test::make_tube(12, 16, 3));
  ModelPose pose{{model.source().skeleton.bones.size(), Affine3d::Identity()},
                 model.source().rest_morph_weights};
  for (std::size_t bone = 0; bone < pose.model_from_bone.size(); ++bone)
    pose.model_from_bone[bone].matrix() << 1, 0.125 * static_cast<double>(bone), 0, 0.25, 0, 0.875,
        0.0625, 0.5, -0.03125, 0, 1, 0;
  const auto positions = test::posed_positions(model.source(), 0, pose);
  const Vec3d middle = 0.5 * (positions[20] + positions[60]);
  const auto blade = [&](double along, double up) -> Blade {
    const Vec3d at = middle + Vec3d(along, up, 0);
    return {at + Vec3d(0, 0, 2), at - Vec3d(0, 0, 0.1)};
  };
  const Stroke stroke = {blade(-0.3, -0.2), blade(0, 0.05), blade(0.3, 0.3)};
  const std::vector<Operation> operations = {
      TearOperation{pose, stroke, {}, {}},
      TearOperation{
          pose, {blade(0.1, -0.4), blade(-0.1, 0.6)}, {}, {0.0625, Layers::nearest, 0.03125}},
      DrillOperation{pose, {middle + Vec3d(0.05, 0.5, 3), Vec3d(0, 0, -1), 0.125, 6, 0.001, true}},
      CutOperation{pose, {middle, Vec3d(0.25, 1, 0.5), {}, true}},
      UndoOperation{2},
      RedoOperation{2},
      TearOperation{pose, stroke, {}, {0.03125, Layers::all, 0}}};
  for (const Operation& operation : operations) {
    const auto report = apply_operation(model, operation);
    ASSERT_TRUE(report) << report.error().text();
  }
  ASSERT_EQ(model.undo_count(), 5u) << "every operation tore something";
  EXPECT_EQ(model.digest(), 12827145988900124586u);
}

}  // namespace
}  // namespace sunder
