// `sunder transfer` from the outside: exit codes, words, JSON, and what it leaves on disk.

#include <sunder/skinning/pose.h>
#include <sunder/validation/transfer.h>

#include <algorithm>

#include "support/machine/gltf_validator.h"
#include "support/models/rigs.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

/// The cactus as one rigid model: no bone moves it.
Character sunk_cactus() {
  Character character = tools::make_cactus();
  Bone node;
  node.name = "Plant";
  node.rest.translation = {0, 0.5f, 0};
  character.skeleton.bones = {node};
  character.skins = {{"Plant", {0}, {Affine3f::Identity()}}};
  character.clips.clear();
  const std::vector<Influence> all = {{0, 1.0f}};
  for (Mesh& mesh : character.meshes) {
    mesh.skin = 0;
    mesh.weights = {};
    for (Vec3f& position : mesh.positions) {
      position.y() -= 0.5f;
      mesh.weights.append(all);
    }
  }
  return character;
}

class TransferCommand : public CommandSuite {
 protected:
  static void SetUpTestSuite() {
    CommandSuite::SetUpTestSuite();
    ASSERT_TRUE(save_glb(source(), tools::make_cactus()));
    ASSERT_TRUE(save_glb(stiff(), sunk_cactus()));
  }
  static std::string source() { return path("source.glb"); }
  static std::string stiff() { return path("stiff.glb"); }
  static Character load(const std::string& name) {
    const auto loaded = load_character(path(name));
    EXPECT_TRUE(loaded) << loaded.error().text();
    return loaded ? *loaded->character : Character();
  }
};

TEST_F(TransferCommand, a_stiff_model_gets_skeleton_and_skin_and_keeps_its_look) {
  const CommandResult result = run_sunder(
      {"transfer", source(), stiff(), "-o", path("skinned.glb"), "--report", path("r.json")});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  EXPECT_THAT(result.out, HasSubstr("coincident"));
  EXPECT_THAT(result.out, HasSubstr("SUNDER_T_SKELETON"));
  EXPECT_THAT(result.err, IsEmpty());
  const json report = read_json("r.json");
  EXPECT_EQ(report["sunder_transfer"], 1);
  EXPECT_EQ(report["matched_share"], 1.0);
  EXPECT_EQ(report["findings"][0]["code"], "SUNDER_T_SKELETON");

  const Character skinned = load("skinned.glb"), truth = load("source.glb"),
                  before = load("stiff.glb");
  ASSERT_EQ(skinned.meshes.size(), truth.meshes.size());
  for (Index m = 0; m < skinned.meshes.size(); ++m) {
    const Mesh& mesh = skinned.meshes[m];
    const auto same = std::ranges::find(truth.meshes, mesh.vertex_count(), &Mesh::vertex_count);
    ASSERT_NE(same, truth.meshes.end());
    const Mesh& of_truth = *same;
    EXPECT_EQ(mesh.positions, before.meshes[m].positions);
    EXPECT_EQ(mesh.uv_sets, before.meshes[m].uv_sets);
    const auto name_of = [](const Character& character, const Mesh& of, const Influence& i) {
      return character.skeleton.bones[character.skins[of.skin].bones[i.slot]].name;
    };
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      for (const Influence& expected : of_truth.weights.of(v)) {
        const auto found =
            std::ranges::find_if(mesh.weights.of(v), [&](const Influence& influence) {
              return name_of(skinned, mesh, influence) == name_of(truth, of_truth, expected);
            });
        ASSERT_NE(found, mesh.weights.of(v).end());
        EXPECT_NEAR(found->weight, expected.weight, 1e-6);
      }
  }
  if (!test::has_gltf_validator()) return;
  const auto verdict = test::validate_glb(path("skinned.glb"));
  EXPECT_EQ(verdict.errors, 0) << verdict.output;
}

TEST_F(TransferCommand, a_skinned_target_keeps_its_document) {
  ASSERT_EQ(run_sunder({"transfer", source(), source(), "-o", path("same.glb"), "--influences", "2",
                        "--weights-as", "u8"})
                .exit_code,
            0);
  const Character same = load("same.glb"), before = load("source.glb");
  EXPECT_EQ(same.skeleton, before.skeleton);
  EXPECT_EQ(same.skins, before.skins);
  EXPECT_EQ(same.clips, before.clips);
  for (const Mesh& mesh : same.meshes)
    for (Index v = 0; v < mesh.vertex_count(); ++v) EXPECT_LE(mesh.weights.of(v).size(), 2u);
}

TEST_F(TransferCommand, the_clips_of_the_source_are_offered_and_written_on_request) {
  const CommandResult without =
      run_sunder({"transfer", source(), stiff(), "-o", path("without.glb")});
  ASSERT_EQ(without.exit_code, 0) << without.err;
  EXPECT_THAT(without.out, HasSubstr("the source has 1 clips"));
  EXPECT_THAT(without.out, HasSubstr("--clips writes them too"));
  EXPECT_TRUE(load("without.glb").clips.empty());
  const CommandResult with =
      run_sunder({"transfer", source(), stiff(), "--clips", "-o", path("with.glb")});
  ASSERT_EQ(with.exit_code, 0) << with.err;
  const Character moving = load("with.glb"), truth = load("source.glb");
  ASSERT_EQ(moving.clips.size(), truth.clips.size());
  EXPECT_EQ(moving.clips[0].name, truth.clips[0].name);
  // Every vertex goes where the source's goes.
  for (const double time : {0.0, 0.7, 1.4}) {
    ModelPose pose = *make_pose(moving, ClipPose{0u, time}),
              of_truth = *make_pose(truth, ClipPose{0u, time});
    // Morph targets are the target's own.
    pose.morph_weights = moving.rest_morph_weights;
    of_truth.morph_weights = truth.rest_morph_weights;
    for (Index m = 0; m < moving.meshes.size(); ++m) {
      const auto same =
          std::ranges::find(truth.meshes, moving.meshes[m].vertex_count(), &Mesh::vertex_count);
      ASSERT_NE(same, truth.meshes.end());
      const auto found = test::posed_positions(moving, m, pose);
      const auto expected =
          test::posed_positions(truth, static_cast<Index>(same - truth.meshes.begin()), of_truth);
      for (std::size_t v = 0; v < found.size(); ++v)
        ASSERT_LT((found[v] - expected[v]).norm(), 1e-4) << time << " " << m << " " << v;
    }
  }
}

TEST_F(TransferCommand, few_matches_ask_for_unit_and_place) {
  Character far = sunk_cactus();
  for (Mesh& mesh : far.meshes)
    for (Vec3f& position : mesh.positions) position *= 0.01f;
  ASSERT_TRUE(save_glb(path("small.glb"), far));
  const CommandResult small =
      run_sunder({"transfer", source(), path("small.glb"), "-o", path("no.glb")});
  EXPECT_THAT(small.err, HasSubstr("are both in the same unit"));
  EXPECT_THAT(small.err, HasSubstr("times as large"));
  Character beside = sunk_cactus();
  for (Mesh& mesh : beside.meshes)
    for (Vec3f& position : mesh.positions) position.x() += 0.35f;
  ASSERT_TRUE(save_glb(path("beside.glb"), beside));
  const CommandResult moved = run_sunder({"transfer", source(), path("beside.glb"), "-o",
                                          path("beside_skinned.glb"), "--distance", "0.5%"});
  EXPECT_THAT(moved.err, HasSubstr("do both stand in the same place"));
  EXPECT_THAT(moved.err, HasSubstr("the source spans"));
}

TEST_F(TransferCommand, an_unknown_bone_comes_with_the_nearest_names) {
  const CommandResult result =
      run_sunder({"transfer", source(), stiff(), "--dry-run", "--bones", "Trnk2"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("did you mean 'Trunk2'"));
}

TEST_F(TransferCommand, a_dry_run_writes_nothing) {
  const CommandResult result = run_sunder({"transfer", source(), stiff(), "--dry-run"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("vertices"));
  EXPECT_EQ(run_sunder({"transfer", source(), stiff()}).exit_code, 2);
  EXPECT_EQ(
      run_sunder({"transfer", source(), stiff(), "--dry-run", "-o", path("no.glb")}).exit_code, 2);
  EXPECT_FALSE(exists("no.glb"));
}

TEST_F(TransferCommand, inputs_are_never_overwritten) {
  const auto before = test::read_bytes(stiff());
  for (const std::string& output : {stiff(), source()}) {
    const CommandResult result = run_sunder({"transfer", source(), stiff(), "-o", output});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("would overwrite"));
  }
  EXPECT_EQ(run_sunder({"transfer", source(), stiff(), "-o", path("no.glb"), "--report", stiff()})
                .exit_code,
            2);
  EXPECT_EQ(test::read_bytes(stiff()), before);
  EXPECT_FALSE(exists("no.glb"));
}

TEST_F(TransferCommand, nothing_matched_is_said_and_exits_with_2) {
  Character far = sunk_cactus();
  far.skeleton.bones[0].rest.translation.x() = 40;
  ASSERT_TRUE(save_glb(path("far.glb"), far));
  const CommandResult result =
      run_sunder({"transfer", source(), path("far.glb"), "-o", path("no.glb")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("no vertex of the target matches"));
  EXPECT_FALSE(exists("no.glb"));
}

TEST_F(TransferCommand, masks_and_names_come_from_files) {
  const std::string pairs = write("pairs.json", R"({"Plant": "nobody"})");
  const CommandResult unknown =
      run_sunder({"transfer", source(), stiff(), "-o", path("no.glb"), "--bone-names", pairs});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("nobody"));
  const std::string vertices = write("vertices.json", R"({"Cactus": [0, 1, 2]})");
  ASSERT_EQ(run_sunder({"transfer", source(), source(), "-o", path("three.glb"), "--vertices",
                        vertices, "--report", path("three.json")})
                .exit_code,
            0);
  const json report = read_json("three.json");
  EXPECT_EQ(report["coincident"], 3);
  EXPECT_EQ(report["locked"], report["vertices"].get<int>() - 3);
  EXPECT_EQ(run_sunder({"transfer", source(), stiff(), "-o", path("no.glb"), "--vertices",
                        write("bad.json", R"({"Nobody": [0]})")})
                .exit_code,
            2);
  EXPECT_EQ(run_sunder({"transfer", source(), stiff(), "-o", path("no.glb"), "--lock", "_NONE"})
                .exit_code,
            2);
  EXPECT_FALSE(exists("no.glb"));
}

}  // namespace
}  // namespace sunder::command_test
