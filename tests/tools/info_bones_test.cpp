// `sunder info --bones`: places, lengths and surfaces against the skinning functions.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "support/models/shared_models.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

class InfoBones : public CactusSuite {
 protected:
  static json info(const std::string& file, const std::string& pose) {
    const CommandResult result = run_sunder({"info", file, "--bones", "--pose", pose, "--json"});
    EXPECT_LE(result.exit_code, 1) << result.err;
    return json::parse(result.out);
  }
};

Vec3d vector(const json& numbers) {
  return {numbers[0].get<double>(), numbers[1].get<double>(), numbers[2].get<double>()};
}

/// The bones' transforms at a time of a clip, computed step by step.
ModelPose sampled(const Character& character, std::size_t clip, double time) {
  Pose pose = *local_rest_pose(character);
  EXPECT_TRUE(sample_clip(character.clips[clip], time, pose));
  ModelPose model_pose;
  EXPECT_TRUE(compute_model_pose(character.skeleton, pose, model_pose));
  return model_pose;
}

/// The positions that each bone moves more than any other does.
std::map<std::uint32_t, std::vector<Vec3d>> surfaces(const Character& character,
                                                     const ModelPose& pose) {
  std::map<std::uint32_t, std::vector<Vec3d>> of_bone;
  for (const Mesh& mesh : character.meshes) {
    const Skin& skin = character.skins[mesh.skin];
    std::vector<Affine3f> palette(skin.bones.size());
    DeformedMesh posed;
    EXPECT_TRUE(compute_palette(skin, pose, palette));
    EXPECT_TRUE(deform_mesh(mesh, palette, pose.morph_weights, posed));
    std::vector<bool> is_used(mesh.vertex_count());
    for (const Triangle& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) is_used[vertex] = true;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      if (!is_used[v]) continue;
      Influence most{0, -1.0f};
      for (const Influence& influence : mesh.weights.of(v))
        if (influence.weight > most.weight) most = influence;
      of_bone[skin.bones[most.slot]].emplace_back(posed.positions[v].cast<double>());
    }
  }
  return of_bone;
}

/// The rounding of the positions that deform_mesh() makes, in floats, on a model of about two
/// metres.
constexpr double kRounding = 1e-6;

void expect_agrees(const json& info, const Character& character, const ModelPose& pose) {
  const json& bones = info["bone_tree"];
  ASSERT_EQ(bones.size(), character.skeleton.bones.size());
  const auto of_bone = surfaces(character, pose);
  for (std::uint32_t i = 0; i < bones.size(); ++i) {
    const json& bone = bones[i];
    const Bone& expected = character.skeleton.bones[i];
    EXPECT_EQ(bone["name"], expected.name);
    EXPECT_EQ(bone["parent"].is_null() ? kNone : bone["parent"].get<std::uint32_t>(),
              expected.parent);
    const Vec3d joint = pose.model_from_bone[i].translation();
    EXPECT_LT((vector(bone["joint"]) - joint).norm(), 1e-9) << expected.name;
    const auto found = of_bone.find(i);
    const std::size_t count = found == of_bone.end() ? 0 : found->second.size();
    EXPECT_EQ(bone["vertices"], count) << expected.name;
    EXPECT_EQ(bone["bounds"].is_null(), count == 0) << expected.name;
    double farthest = 0;
    Vec3d least = Vec3d::Constant(1e300), greatest = Vec3d::Constant(-1e300);
    if (count > 0)
      for (const Vec3d& position : found->second) {
        farthest = std::max(farthest, (position - joint).norm());
        least = least.cwiseMin(position);
        greatest = greatest.cwiseMax(position);
      }
    if (count > 0) {
      EXPECT_LT((vector(bone["bounds"]["min"]) - least).norm(), kRounding) << expected.name;
      EXPECT_LT((vector(bone["bounds"]["max"]) - greatest).norm(), kRounding) << expected.name;
    }
    double length = farthest;
    if (!bone["leads_to"].is_null()) {
      const auto child = bone["leads_to"].get<std::uint32_t>();
      EXPECT_EQ(character.skeleton.bones[child].parent, i);
      length = (pose.model_from_bone[child].translation() - joint).norm();
    }
    EXPECT_NEAR(bone["length"].get<double>(), length, kRounding) << expected.name;
  }
}

TEST_F(InfoBones, places_and_surfaces_are_those_of_the_skinning_functions) {
  const Result<LoadedCharacter> loaded = load_character(model());
  ASSERT_TRUE(loaded);
  const Character& cactus = *loaded->character;
  expect_agrees(info(model(), "rest"), cactus, *rest_pose(cactus));
  expect_agrees(info(model(), "bind"), cactus, *bind_pose(cactus));
  const json swaying = info(model(), "Sway@0.8");
  expect_agrees(swaying, cactus, sampled(cactus, 0, 0.8));
  EXPECT_GT((vector(swaying["bone_tree"][4]["joint"]) -
             vector(info(model(), "rest")["bone_tree"][4]["joint"]))
                .norm(),
            0.01);
}

TEST_F(InfoBones, all_own_models_agree_too) {
  for (const std::filesystem::path& file : test::files_below(test::own_data(), {".glb", ".x"})) {
    const Result<LoadedCharacter> loaded = load_character(file);
    ASSERT_TRUE(loaded) << file;
    SCOPED_TRACE(file.string());
    expect_agrees(info(file.string(), "rest"), *loaded->character, *rest_pose(*loaded->character));
  }
}

TEST_F(InfoBones, a_bone_leads_to_the_branch_that_moves_most) {
  const json bones = info(model(), "rest")["bone_tree"];
  const auto named = [&](const std::string& name) {
    return *std::find_if(bones.begin(), bones.end(),
                         [&](const json& bone) { return bone["name"] == name; });
  };
  const json trunk = named("Trunk2");  // Has the trunk above it, an arm and a bud.
  EXPECT_EQ(bones[trunk["leads_to"].get<std::size_t>()]["name"], "Trunk3");
  EXPECT_NEAR(trunk["length"].get<double>(), 0.35, 1e-6);
  EXPECT_TRUE(named("Left3")["leads_to"].is_null());
  EXPECT_GT(named("Left3")["length"].get<double>(), 0.1);
}

TEST_F(InfoBones, the_table_has_a_line_per_bone_and_straight_columns) {
  const CommandResult result = run_sunder({"info", model(), "--bones", "--pose", "Sway@0.8"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("bones in pose 'Sway' at 0.8 s"));
  std::istringstream lines(result.out.substr(result.out.find("bones in pose")));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  const std::size_t end_of_count = line.find("vertices") + 8;
  std::size_t rows = 0;
  while (std::getline(lines, line)) {
    ++rows;
    EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(line[end_of_count - 1]))) << line;
    EXPECT_EQ(line[end_of_count], ' ') << line;
  }
  EXPECT_EQ(rows, info(model(), "rest")["bone_tree"].size());
  EXPECT_THAT(result.out, HasSubstr("\n    Trunk2"));
  EXPECT_THAT(result.out, HasSubstr("\n        Trunk4"));
}

TEST_F(InfoBones, a_long_chain_leaves_room_for_the_columns) {
  const CommandResult result =
      run_sunder({"info", (test::own_data() / "rigged/many_bones.glb").string(), "--bones"});
  std::istringstream lines(result.out);
  std::size_t widest = 0, rows = 0;
  for (std::string line; std::getline(lines, line); ++rows) widest = std::max(widest, line.size());
  EXPECT_GT(rows, 100u);
  EXPECT_LT(widest, 200u);
  EXPECT_THAT(result.out, HasSubstr(" +1 bone"));
}

TEST_F(InfoBones, info_without_bones_names_clips_materials_and_the_option) {
  const CommandResult result = run_sunder({"info", model()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("--bones"));
  EXPECT_THAT(result.out, HasSubstr("clip 0     'Sway': 2 s"));
  EXPECT_THAT(result.out, HasSubstr("material 0"));
  const json materials = json::parse(run_sunder({"info", model(), "--json"}).out)["materials"];
  std::size_t triangles = 0;
  for (const json& material : materials) triangles += material["triangles"].get<std::size_t>();
  const Result<LoadedCharacter> loaded = load_character(model());
  std::size_t expected = 0;
  for (const Mesh& mesh : loaded->character->meshes) expected += mesh.triangle_count();
  EXPECT_EQ(triangles, expected);
}

TEST_F(InfoBones, morph_targets_are_named) {
  const Character cactus = tools::make_cactus();
  const CommandResult result = run_sunder({"info", model()});
  std::size_t named = 0;
  for (const Mesh& mesh : cactus.meshes)
    for (const MorphTarget& target : mesh.morph_targets) {
      EXPECT_THAT(result.out, HasSubstr("morphs   '" + target.name + "'"));
      ++named;
    }
  EXPECT_GT(named, 0u);
}

TEST_F(InfoBones, a_wrong_pose_is_explained) {
  struct Case {
    const char *pose, *words;
  };
  for (const Case& wrong : {Case{"sway@0.8", "did you mean 'Sway'?"},
                            {"Swya@1", "'Sway'"},
                            {"Sway@-1", "0 or more"},
                            {"Sway@soon", "'soon' is no time"},
                            {"Sway", "CLIP@TIME"},
                            {"@1", "no clip ''"}}) {
    const CommandResult result = run_sunder({"info", model(), "--bones", "--pose", wrong.pose});
    EXPECT_EQ(result.exit_code, 2) << wrong.pose;
    EXPECT_THAT(result.err, HasSubstr(wrong.words));
    EXPECT_THAT(result.out, IsEmpty());
  }
  EXPECT_EQ(run_sunder({"info", model(), "--pose", "rest"}).exit_code, 2) << "needs --bones";
}

TEST_F(InfoBones, a_time_beyond_the_end_is_said_and_holds_the_last_pose) {
  const CommandResult late = run_sunder({"info", model(), "--bones", "--pose", "Sway@7", "--json"});
  EXPECT_EQ(late.exit_code, 0);
  EXPECT_THAT(late.err, HasSubstr("beyond the end of clip 'Sway', which lasts 2 s"));
  EXPECT_EQ(json::parse(late.out)["bone_tree"], info(model(), "Sway@2")["bone_tree"]);
  EXPECT_THAT(run_sunder({"info", model(), "--bones", "--pose", "Sway@2"}).err, IsEmpty());
}

}  // namespace
}  // namespace sunder::command_test
