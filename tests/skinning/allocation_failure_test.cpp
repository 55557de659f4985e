// Where memory runs out, a call of skinning says so, and what it was to change is as before.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/skinning/skinned_mesh.h>

#include <gtest/gtest.h>

#include "support/machine/starve.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::starve;

constexpr auto nothing = [](const auto&, const Status&) {};

/// A posed tube. Its mesh was made of the first vertices; the rest is appended by update().
struct Scene {
  explicit Scene(std::uint32_t first_vertices = kNone) {
    const Mesh& mesh = character.meshes[0];
    whole = source_of(mesh);
    source = whole;
    source.vertex_count = std::min(first_vertices, whole.vertex_count);
    first = mesh.weights;
    first.first.resize(source.vertex_count + 1);
    first.influences.resize(first.first.back());
    source.weights = &first;
    for (const MorphTarget& target : mesh.morph_targets) {
      MorphTarget& some = morph_targets.emplace_back(target);
      for (auto* deltas : {&some.position_deltas, &some.normal_deltas, &some.tangent_deltas})
        deltas->resize(std::min<std::size_t>(deltas->size(), source.vertex_count));
    }
    source.morph_targets = morph_targets;
    skinned.emplace(*SkinnedMesh::create(source, character.skins[0].bones.size()));
    set_vertex_count(source.vertex_count);
    test::Random random(5);
    EXPECT_TRUE(palette.set(character.skins[0], test::random_pose(character, random)));
  }

  void set_vertex_count(std::uint32_t count) {
    positions.assign(count, Vec3f::Zero());
    VertexTarget target;
    target.vertex_count = count;
    target.positions.data = positions[0].data();
    buffer.set_target(target);
  }
  /// The posed positions, all written anew.
  std::vector<Vec3f> posed() {
    set_vertex_count(skinned->vertex_count());
    EXPECT_TRUE(skinned->deform(palette, buffer));
    return positions;
  }

  Character character = test::make_tube(20, 24, 5);
  SkinWeights first;
  std::vector<MorphTarget> morph_targets;
  VertexSource whole, source;
  std::optional<SkinnedMesh> skinned;
  BonePalette palette =
      *BonePalette::create(character.skins[0].bones.size(), character.rest_morph_weights.size());
  std::vector<Vec3f> positions;
  PosedBuffer buffer{VertexTarget()};
};

TEST(AllocationFailure, create_says_so) {
  const auto scene = [] { return std::make_unique<Scene>(); };
  starve(
      scene, [](Scene& of) { return SkinnedMesh::create(of.whole, 5); }, nothing);
  starve(
      scene, [](Scene&) { return BonePalette::create(5, 1, SkinningMethod::dual_quaternion); },
      nothing);
}

TEST(AllocationFailure, update_leaves_the_mesh_as_it_was) {
  Scene fed(100);
  const std::vector<Vec3f> before = fed.posed();
  ASSERT_TRUE(fed.skinned->update(fed.whole, 100));
  const std::vector<Vec3f> after = fed.posed();
  starve([] { return std::make_unique<Scene>(100); },
         [](Scene& of) { return of.skinned->update(of.whole, 100); },
         [&](Scene& of, const Status& status) {
           if (!status) {
             ASSERT_EQ(of.posed(), before);
             ASSERT_TRUE(of.skinned->update(of.whole, 100));
           }
           ASSERT_EQ(of.posed(), after);
         });
}

TEST(AllocationFailure, reserve_says_so) {
  starve([] { return std::make_unique<Scene>(100); },
         [](Scene& of) { return of.skinned->reserve(1000, 8); },
         [](Scene& of, const Status&) {
           EXPECT_TRUE(of.skinned->update(of.whole, 100));
           EXPECT_EQ(of.posed(), Scene().posed());
         });
}

TEST(AllocationFailure, deform_writes_nothing_and_later_all) {
  const std::vector<Vec3f> expected = Scene().posed();
  starve([] { return std::make_unique<Scene>(); },
         [](Scene& of) { return of.skinned->deform(of.palette, of.buffer); },
         [&](Scene& of, const Status& status) {
           if (!status) {
             ASSERT_EQ(of.positions, std::vector<Vec3f>(of.positions.size(), Vec3f::Zero()));
             ASSERT_TRUE(of.buffer.dirty_vertices().empty());
             ASSERT_TRUE(of.skinned->deform(of.palette, of.buffer));
           }
           ASSERT_EQ(of.positions, expected);
         });
}

TEST(AllocationFailure, deform_mesh_writes_nothing) {
  struct Deformed : Scene {
    DeformedMesh out;
  };
  const std::vector<Affine3f> matrices(5, Affine3f::Identity());
  const std::vector<float> morph_weights = {0.5f};
  starve([] { return std::make_unique<Deformed>(); },
         [&](Deformed& of) {
           return deform_mesh(of.character.meshes[0], matrices, morph_weights, of.out);
         },
         [](Deformed& of, const Status& status) {
           EXPECT_EQ(of.out.positions.empty(), !status);
           EXPECT_EQ(of.out.normals.empty(), !status);
         });
}

TEST(AllocationFailure, orders_are_refused) {
  const auto scene = [] { return std::make_unique<Scene>(); };
  starve(
      scene, [](Scene& of) { return order_for_skinning(of.character.meshes[0]); }, nothing);
  const Mesh before = Scene().character.meshes[0];
  std::vector<std::uint32_t> order(before.vertex_count());
  for (std::uint32_t v = 0; v < order.size(); ++v)
    order[v] = static_cast<std::uint32_t>(order.size()) - 1 - v;
  starve(
      scene, [&](Scene& of) { return reorder_vertices(of.character.meshes[0], order); },
      [&](Scene& of, const Status& status) {
        EXPECT_EQ(of.character.meshes[0] == before, !status);
      });
}

TEST(AllocationFailure, poses_are_refused) {
  const auto scene = [] { return std::make_unique<Scene>(); };
  starve(
      scene, [](Scene& of) { return local_rest_pose(of.character); }, nothing);
  starve(
      scene, [](Scene& of) { return rest_pose(of.character); }, nothing);
  starve(
      scene, [](Scene& of) { return bind_pose(of.character); }, nothing);
  for (const PoseSpec& spec : {PoseSpec(RestPose{}), PoseSpec(BindPose{}), PoseSpec(ClipPose{0u}),
                               PoseSpec(*rest_pose(Scene().character))})
    starve(
        scene, [&](Scene& of) { return make_pose(of.character, spec); }, nothing);
  const Pose local = *local_rest_pose(Scene().character);
  struct Posed : Scene {
    ModelPose pose;
  };
  starve([] { return std::make_unique<Posed>(); },
         [&](Posed& of) { return compute_model_pose(of.character.skeleton, local, of.pose); },
         [](Posed& of, const Status& status) {
           EXPECT_EQ(of.pose.model_from_bone.empty(), !status);
           EXPECT_EQ(of.pose.morph_weights.empty(), !status);
         });
}

TEST(AllocationFailure, sets_of_poses_are_refused) {
  const auto character = std::make_shared<const Character>(test::make_tube(6, 8, 4));
  PoseSetSpec spec;
  spec.range_of_motion = true;
  spec.poses = {BindPose{}, RestPose{}};
  const auto made = [] { return std::make_unique<ModelPose>(); };
  starve(
      made, [&](ModelPose&) { return PoseSet::create(character, spec); }, nothing);
  const auto set = PoseSet::create(character, spec);
  ASSERT_TRUE(set);
  for (std::size_t i = 0; i < set->size(PoseSet::Role::fit); i += 7)
    starve(
        made, [&](ModelPose& pose) { return set->compute(PoseSet::Role::fit, i, pose); },
        [](ModelPose& pose, const Status& status) {
          EXPECT_EQ(pose.model_from_bone.empty(), !status);
        });
}

}  // namespace
}  // namespace sunder
