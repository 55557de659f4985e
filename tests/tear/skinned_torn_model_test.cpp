// A SkinnedMesh that follows a torn model by its changes has the bits of a new one.

#include <sunder/skinning/skinned_mesh.h>
#include <sunder/tear/torn_model.h>

#include <memory>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/models/posed_arrays.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

/// A mesh's buffers with additional room.
struct Runtime {
  explicit Runtime(const Character& character)
      : made(std::move(
            *SkinnedMesh::create(source_of(character.meshes[0]), character.skins[0].bones.size()))),
        palette(*BonePalette::create(character.skins[0].bones.size(),
                                     character.rest_morph_weights.size())),
        positions(20000),
        normals(20000),
        buffer(
            {character.meshes[0].vertex_count(), {positions[0].data()}, {normals[0].data()}, {}}) {}

  void frame(const Character& character, const ModelPose& pose) {
    ASSERT_TRUE(palette.set(character.skins[0], pose));
    ASSERT_TRUE(made.deform(palette, buffer));
  }
  void follow(const Character& character, std::uint32_t first_changed) {
    ASSERT_TRUE(made.update(source_of(character.meshes[0]), first_changed));
    buffer.set_vertex_count(made.vertex_count());
  }
  void expect_as_made_anew(const Character& character) const {
    const Mesh& mesh = character.meshes[0];
    const auto anew = SkinnedMesh::create(source_of(mesh), character.skins[0].bones.size());
    ASSERT_TRUE(anew);
    test::PosedArrays expected(mesh);
    PosedBuffer to_expected(expected.target());
    ASSERT_TRUE(anew->deform(palette, to_expected));
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      ASSERT_EQ(std::memcmp(positions[v].data(), expected.position(v).data(), 12), 0)
          << "vertex " << v;
      ASSERT_EQ(std::memcmp(normals[v].data(), expected.normal(v).data(), 12), 0) << "vertex " << v;
    }
  }

  SkinnedMesh made;
  BonePalette palette;
  std::vector<Vec3f> positions, normals;
  PosedBuffer buffer;
};

TEST(SkinnedTornModel, follows_tears_undo_and_redo_and_lips_stay_closed) {
  for (int seed = 1; seed <= 10; ++seed) {
    test::Random random(static_cast<std::uint64_t>(seed));
    const auto source = std::make_shared<const Character>(test::make_tube(20, 24, 6));
    auto model = TornModel::create(source);
    ASSERT_TRUE(model);
    Runtime runtime(*source);
    runtime.frame(*source, test::random_pose(*source, random));
    for (int step = 0; step < 12; ++step) {
      ChangeRecord change;
      const ModelPose pose = test::random_pose(*source, random);
      if (step % 5 == 3)
        (void)model->undo(&change);
      else if (step % 5 == 4)
        (void)model->redo(&change);
      else
        (void)model->tear(pose, test::random_stroke(model->character(), pose, random), {}, &change);
      for (const MeshChange& of_mesh : change.meshes)
        runtime.follow(model->character(), of_mesh.first_vertex);
      runtime.frame(model->character(), test::random_pose(*source, random));
      runtime.expect_as_made_anew(model->character());
      // Vertices that are one point of the bind surface with the same weights stay together in the
      // pose, bit for bit.
      for (const MeshChange& of_mesh : change.meshes) {
        const Mesh& mesh = model->character().meshes[0];
        for (std::uint32_t v = of_mesh.first_vertex; v < mesh.vertex_count(); ++v)
          for (std::uint32_t w = v + 1; w < mesh.vertex_count(); ++w) {
            const auto of_v = mesh.weights.of(v), of_w = mesh.weights.of(w);
            if (mesh.positions[v] != mesh.positions[w] ||
                !std::equal(of_v.begin(), of_v.end(), of_w.begin(), of_w.end()))
              continue;
            bool same_morph = true;
            for (const MorphTarget& target : mesh.morph_targets)
              same_morph = same_morph && target.position_deltas[v] == target.position_deltas[w];
            if (same_morph) {
              ASSERT_EQ(runtime.positions[v], runtime.positions[w]) << v << " and " << w;
            }
          }
      }
    }
  }
}

TEST(SkinnedTornModel, frames_and_updates_with_room_do_not_allocate) {
  test::Random random(1);
  const auto source = std::make_shared<const Character>(test::make_tube(20, 24, 6));
  auto model = TornModel::create(source);
  ASSERT_TRUE(model);
  Runtime runtime(*source);
  ASSERT_TRUE(runtime.made.reserve(4000, 8));
  std::vector<ModelPose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back(test::random_pose(*source, random));
  runtime.frame(*source, poses[0]);
  runtime.frame(*source, poses[1]);  // the first that writes only changed vertices
  for (int i = 0; i < 10; ++i) {
    ChangeRecord change;
    (void)model->tear(poses[0], test::random_stroke(model->character(), poses[0], random), {},
                      &change);
    const std::uint64_t before = test::allocation_count();
    for (const MeshChange& of_mesh : change.meshes)
      runtime.follow(model->character(), of_mesh.first_vertex);
    if (i > 0) {
      EXPECT_EQ(test::allocation_count(), before) << "update";
    }
    runtime.frame(model->character(), poses[0]);  // the buffer may grow to the larger mesh
    const std::uint64_t before_frames = test::allocation_count();
    for (const ModelPose& pose : poses) runtime.frame(model->character(), pose);
    EXPECT_EQ(test::allocation_count(), before_frames) << "frames";
  }
}

}  // namespace
}  // namespace sunder
