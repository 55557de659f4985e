// `sunder tear --open` from the outside.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "support/machine/gltf_validator.h"
#include "support/models/shared_models.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

using test::rigged_gltf_models;
using test::validate_glb;

class OpenCommand : public CactusSuite {
 protected:
  /// Tears a model; the torn one.
  static LoadedCharacter torn(const std::string& from, const std::string& log,
                              const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"tear", from,       "--ops",    log,
                                          "-o",   path(name), "--report", path(name + ".json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run_sunder(arguments);
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << from << '\n' << result.err;
    auto loaded = load_character(path(name));
    EXPECT_TRUE(loaded.has_value()) << from;
    return loaded ? *loaded : LoadedCharacter();
  }

  /// Posed positions of a mesh.
  static std::vector<Vec3f> posed(const Character& character, std::uint32_t mesh,
                                  const PoseSpec& spec) {
    const Result<ModelPose> pose = make_pose(character, spec);
    if (!pose) return {};
    const Skin& skin = character.skins[character.meshes[mesh].skin];
    std::vector<Affine3f> palette(skin.bones.size());
    EXPECT_TRUE(compute_palette(skin, *pose, palette));
    DeformedMesh out;
    EXPECT_TRUE(deform_mesh(character.meshes[mesh], palette, pose->morph_weights, out));
    return out.positions;
  }

  static std::uint32_t mesh_named(const Character& character, const std::string& name) {
    for (std::uint32_t m = 0; m < character.meshes.size(); ++m)
      if (character.meshes[m].name == name) return m;
    return 0;
  }

  static double farthest(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    EXPECT_EQ(a.size(), b.size());
    double far = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      far = std::max(far, static_cast<double>((a[i] - b[i]).norm()));
    return far;
  }

  static void expect_valid(const std::string& name) {
    if (!test::has_gltf_validator()) return;
    const auto report = validate_glb(path(name));
    EXPECT_EQ(report.errors, 0) << name << report.output;
  }
};

TEST_F(OpenCommand, lips_gape_by_a_morph_target_from_the_moment_of_the_tear) {
  const std::string log = write("one.json", kOneTear);
  const LoadedCharacter closed = torn(model(), log, "closed.glb", {});
  const LoadedCharacter open = torn(model(), log, "open.glb", {"--open"});
  ASSERT_TRUE(closed.character && open.character);
  expect_valid("open.glb");
  const std::uint32_t m = mesh_named(*open.character, "Cactus");
  const Mesh& mesh = open.character->meshes[m];
  const Mesh& before = closed.character->meshes[m];
  ASSERT_EQ(mesh.morph_targets.size(), 2u);
  EXPECT_EQ(mesh.morph_targets[0], before.morph_targets[0]);
  EXPECT_EQ(mesh.morph_targets[1].name, "Open");
  EXPECT_EQ(mesh.positions, before.positions);
  EXPECT_EQ(mesh.weights, before.weights);
  EXPECT_EQ(open.character->rest_morph_weights[mesh.first_morph_weight + 1], 1.0f);

  const json report = read_json("open.glb.json")["open"];
  const double gap = report["widest_gap"].get<double>();
  EXPECT_GT(gap, 0.01);
  EXPECT_LT(gap, 0.1);
  // Nothing is displaced until the tear; from its end on, all of it.
  const auto apart = [&](double time) {
    const PoseSpec pose = ClipPose{std::uint32_t{0}, time};
    return farthest(posed(*open.character, m, pose), posed(*closed.character, m, pose));
  };
  EXPECT_LT(apart(0.3), 1e-5);
  EXPECT_LT(apart(0.8), 1e-5);
  EXPECT_GT(apart(2.0), 0.25 * gap);
  EXPECT_LT(apart(0.9), apart(2.0) * 1.2);
  EXPECT_GT(
      farthest(posed(*open.character, m, RestPose{}), posed(*closed.character, m, RestPose{})),
      0.25 * gap);
}

TEST_F(OpenCommand, vertices_that_were_one_gape_as_the_report_says) {
  const std::string log = write("one.json", kOneTear);
  const LoadedCharacter closed = torn(model(), log, "closed.glb", {});
  const LoadedCharacter open = torn(model(), log, "open.glb", {"--open=baked"});
  ASSERT_TRUE(closed.character && open.character);
  expect_valid("open.glb");
  const std::uint32_t m = mesh_named(*open.character, "Cactus");
  const Mesh &mesh = open.character->meshes[m], &before = closed.character->meshes[m];
  EXPECT_EQ(mesh.morph_targets, before.morph_targets);
  const PoseSpec pose = ClipPose{std::uint32_t{0}, 0.8};  // in which the tear was made
  const std::vector<Vec3f> places = posed(*open.character, m, pose);
  std::map<std::array<float, 3>, std::vector<std::uint32_t>> coincident;
  for (std::uint32_t v = 0; v < before.vertex_count(); ++v)
    coincident[{before.positions[v].x(), before.positions[v].y(), before.positions[v].z()}]
        .push_back(v);
  double widest = 0;
  for (const auto& [place, vertices] : coincident)
    for (const std::uint32_t v : vertices)
      widest = std::max(widest, static_cast<double>((places[v] - places[vertices[0]]).norm()));
  EXPECT_NEAR(widest, read_json("open.glb.json")["open"]["widest_gap"].get<double>(),
              0.02 * widest);
}

TEST_F(OpenCommand, without_a_wound_the_file_is_as_without_the_option_and_that_is_a_finding) {
  const std::string log = write("miss.json", R"({"sunder_operations": 1, "operations": [
    {"op": "tear", "stroke": [{"base": [9, 9, 9], "tip": [9, 9, 8]}, {"base": [9.1, 9, 9], "tip": [9.1, 9, 8]}]}]})");
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", log, "-o", path("missed.glb"), "--open"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("--open: no operation left lips that could gape"));
  EXPECT_EQ(bytes("missed.glb"), bytes("cactus.glb"));
}

TEST_F(OpenCommand, an_unknown_form_is_refused) {
  const CommandResult result = run_sunder(
      {"tear", model(), "--ops", write("one.json", kOneTear), "-o", path("x.glb"), "--open=wide"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--open=baked"));
  EXPECT_FALSE(exists("x.glb"));
}

/// Our own models, and the shared ones if they are there: textured, quantised, with many materials
/// and with morph targets.
TEST_F(OpenCommand, any_rigged_model_stays_valid_and_keeps_what_it_has) {
  for (const auto& file : rigged_gltf_models()) {
    SCOPED_TRACE(file);
    const std::string folder = path("of_" + file.stem().string());
    const CommandResult demo = run_sunder({"demo", file.string(), "-o", folder, "--no-pictures"});
    if (demo.exit_code > 1) continue;  // A file without a surface that can be torn.
    const std::string log = folder + "/ops.json";
    const LoadedCharacter closed = torn(file.string(), log, "closed.glb", {});
    for (const char* const form : {"--open", "--open=baked"}) {
      const LoadedCharacter open = torn(file.string(), log, "open.glb", {form});
      if (!closed.character || !open.character) continue;
      expect_valid("open.glb");
      ASSERT_EQ(open.character->meshes.size(), closed.character->meshes.size());
      for (std::size_t m = 0; m < open.character->meshes.size(); ++m) {
        const Mesh &after = open.character->meshes[m], &before = closed.character->meshes[m];
        EXPECT_EQ(after.triangles, before.triangles);
        EXPECT_EQ(after.uv_sets, before.uv_sets);
        EXPECT_EQ(after.submeshes, before.submeshes);
        ASSERT_GE(after.morph_targets.size(), before.morph_targets.size());
        EXPECT_LE(after.morph_targets.size(), before.morph_targets.size() + 1);
        EXPECT_TRUE(std::equal(before.morph_targets.begin(), before.morph_targets.end(),
                               after.morph_targets.begin()));
      }
      ASSERT_EQ(open.character->clips.size(), closed.character->clips.size());
      for (std::size_t c = 0; c < open.character->clips.size(); ++c)
        EXPECT_EQ(open.character->clips[c].duration, closed.character->clips[c].duration);
    }
  }
}

}  // namespace
}  // namespace sunder::command_test
