// Tools that merge equal vertices, which users run on torn files, must leave the lips apart. Lips
// coincide and may agree in every attribute that a file has, except for the tear sides. The merging
// is done by our own code and, where they are installed, by the tools themselves.
#include <sunder/io/character_file.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "support/gltf_tools.h"
#include "support/rigs.h"
#include "support/shared_models.h"
#include "support/temporary_folder.h"
#include "support/weld_vertices.h"

namespace sunder {
namespace {

using test::Random;

/// A stroke, one that crosses it in the middle, and one that ends on it, all along the same piece
/// of surface.
std::vector<Stroke> crossing_strokes(const Character& character, const ModelPose& pose,
                                     Random& random) {
  const Stroke first = test::random_stroke(character, pose, random, 0.25, 3);
  const Vec3d outwards = (first[0].base - first[0].tip).normalized();
  const Vec3d along = first[3].base - first[0].base;
  const Vec3d across = outwards.cross(along) * 0.4;
  const auto beside = [&](const Blade& blade, double distance) {
    return Blade{blade.base + distance * across, blade.tip + distance * across};
  };
  // Not through the blades: those are where the first stroke has its corners.
  const auto between = [&](std::size_t i, double t) {
    return Blade{(1 - t) * first[i].base + t * first[i + 1].base,
                 (1 - t) * first[i].tip + t * first[i + 1].tip};
  };
  const Blade middle = between(1, 0.53), late = between(2, 0.37);
  return {first,
          {beside(middle, -1.0), beside(middle, 0.1), beside(middle, 1.0)},
          {beside(late, 1.0), beside(late, 0.5), late}};
}

std::string text_of(const TopologyCounts& counts) {
  return std::to_string(counts.components) + " components, " +
         std::to_string(counts.boundary_edges) + " boundary edges, " +
         std::to_string(counts.boundary_loops) + " boundary loops, " +
         std::to_string(counts.triangles) + " triangles, " +
         std::to_string(counts.degenerate_triangles) + " degenerate, " +
         std::to_string(counts.vertices) + " vertices";
}

/// Torn by several groups of strokes, each in a pose of its own.
Character tear(std::shared_ptr<const Character> source, Random& random) {
  auto model = TornModel::create(std::move(source));
  EXPECT_TRUE(model) << model.error().text();
  std::uint32_t runs = 0;
  for (int group = 0; group < 3; ++group) {
    const ModelPose pose = test::random_pose(model->character(), random, 0.4, 1.1);
    for (const Stroke& stroke : crossing_strokes(model->character(), pose, random)) {
      const auto report = model->tear(pose, stroke);
      EXPECT_TRUE(report) << report.error().text();
      runs += report->runs;
    }
  }
  EXPECT_GT(runs, 0u) << "no stroke tore anything";
  return model->character();
}

std::optional<TopologyCounts> counts_of(const std::filesystem::path& file) {
  const auto loaded = load_character(file);
  EXPECT_TRUE(loaded) << file << ": " << loaded.error().text();
  if (!loaded) return {};
  return *count_topology(*loaded->character);
}

struct Model {
  std::string name;
  std::function<std::filesystem::path()> file;  ///< Empty: the model is made here.
  std::function<Character()> make;
};

std::ostream& operator<<(std::ostream& stream, const Model& model) { return stream << model.name; }

class StaysTorn : public testing::TestWithParam<Model> {
 protected:
  void SetUp() override {
    GetParam().make ? write_made() : write_loaded();
    if (HasFatalFailure()) return;
    before_ = counts_of(torn_);
    untorn_before_ = counts_of(untorn_);
    ASSERT_TRUE(before_ && untorn_before_);
    ASSERT_GT(before_->boundary_edges, untorn_before_->boundary_edges);
  }

  /// The topology of a file after our own merging.
  static std::optional<TopologyCounts> welded(float tolerance, const std::filesystem::path& file) {
    const auto loaded = load_character(file);
    if (!loaded) return {};
    return *count_topology(test::weld_vertices(*loaded->character, tolerance));
  }

  /// The topology of a file after a tool ran on it.
  std::optional<TopologyCounts> welded(const std::string& tool, const std::filesystem::path& file) {
    const auto result = folder_.path() / (tool + "_" + file.filename().string());
    const std::string complaint = test::weld_by_tool(tool, file, result);
    EXPECT_EQ(complaint, "");
    return complaint.empty() ? counts_of(result) : std::nullopt;
  }

  std::optional<TopologyCounts> before_, untorn_before_;
  const test::TemporaryFolder folder_;
  const std::filesystem::path torn_ = folder_.path() / "torn.glb",
                              untorn_ = folder_.path() / "untorn.glb";

 private:
  void write_made() {
    const auto source = std::make_shared<const Character>(GetParam().make());
    ASSERT_TRUE(save_glb(untorn_, *source));
    ASSERT_TRUE(save_glb(torn_, tear(source, random_)));
  }

  void write_loaded() {
    const auto loaded = load_character(GetParam().file());
    ASSERT_TRUE(loaded) << loaded.error().text();
    ASSERT_TRUE(save_glb(untorn_, *loaded->character, *loaded));
    ASSERT_TRUE(save_glb(torn_, tear(loaded->character, random_), *loaded));
  }

  Random random_{std::hash<std::string>()(GetParam().name)};
};

TEST_P(StaysTorn, whatever_merges_equal_vertices) {
  const auto expect_unchanged = [&](const std::string& tool,
                                    const std::optional<TopologyCounts>& after) {
    ASSERT_TRUE(after) << tool;
    const std::string change = tool + ": " + text_of(*before_) + " became " + text_of(*after);
    EXPECT_EQ(after->components, before_->components) << change;
    EXPECT_EQ(after->boundary_edges, before_->boundary_edges) << change;
    EXPECT_EQ(after->boundary_loops, before_->boundary_loops) << change;
  };
  expect_unchanged("our own", welded(0.0f, torn_));
  if (!test::has_welding_tools()) return;
  for (const std::string tool : test::kWeldingTools) expect_unchanged(tool, welded(tool, torn_));
}

/// Tools with a tolerance also merge neighbours on one lip, which makes triangles degenerate, and
/// borders that the model had before; but they close no tear.
TEST_P(StaysTorn, whatever_merges_near_vertices) {
  const auto expect_torn = [&](const std::string& tool, const std::optional<TopologyCounts>& after,
                               const std::optional<TopologyCounts>& untorn_after) {
    ASSERT_TRUE(after && untorn_after) << tool;
    const TopologyCounts &now = *after, &before = *before_;
    const TopologyCounts &untorn_now = *untorn_after, &untorn_before = *untorn_before_;
    const std::string change = tool + ": " + text_of(before) + " became " + text_of(now) +
                               "; untorn, " + text_of(untorn_before) + " became " +
                               text_of(untorn_now);
    // Each border edge that collapses takes a triangle's area with it.
    const std::uint32_t collapsed = (before.triangles - before.degenerate_triangles) -
                                    (now.triangles - now.degenerate_triangles);
    EXPECT_EQ(now.components - untorn_now.components, before.components - untorn_before.components)
        << change;
    EXPECT_EQ(now.boundary_loops - untorn_now.boundary_loops,
              before.boundary_loops - untorn_before.boundary_loops)
        << change;
    EXPECT_GE(now.boundary_edges - untorn_now.boundary_edges + collapsed,
              before.boundary_edges - untorn_before.boundary_edges)
        << change;
  };
  constexpr float kTolerance = 1e-4f;  // three.js's default
  expect_torn("our own", welded(kTolerance, torn_), welded(kTolerance, untorn_));
  if (!test::has_welding_tools()) return;
  for (const std::string tool : test::kCoarseWeldingTools)
    expect_torn(tool, welded(tool, torn_), welded(tool, untorn_));
}

std::vector<Model> models() {
  std::vector<Model> all = {
      {"sheet", {}, [] { return test::make_sheet(12); }},
      {"tube", {}, [] { return test::make_tube(16, 12, 4); }},
      {"fine tube", {}, [] { return test::make_tube(40, 32, 6); }},
  };
  const auto add = [&](const std::string& group, const std::filesystem::path& file) {
    if (std::filesystem::exists(file))
      all.push_back({group + file.filename().string(), [file] { return file; }, {}});
  };
  for (const auto& file : test::files_below(test::own_data() / "rigged", {".glb"}))
    add("tests/data/rigged/", file);
  for (const char* const name :
       {"cactoro.glb", "cesium_man.dae", "fox.glb", "godot_hand_r.gltf", "mannequiny.glb",
        "minetest_character.b3d", "rigged_simple.glb", "robot_expressive.glb", "simple_skin.gltf",
        "simple_skin_weights_u8.gltf", "soft_tube_14bones.fbx", "vr_glove.fbx",
        "webxr_hand_right.glb", "wuson.x"})
    add("../shared/models/rigged/", test::shared_models() / "rigged" / name);
  for (const char* const name :
       {"FBX/animation_with_skeleton.fbx", "FBX/huesitos.fbx", "MD5/SimpleCube.md5mesh",
        "MDL/MDL (HL1)/man.mdl", "MDL/MDL (HL1)/unnamed_bones.mdl", "X/BCN_Epileptic.X",
        "X/Testwuson.X", "X/anim_test.x", "glTF2/simple_skin/simple_skin.gltf"})
    add("assimp-testmodels ", test::assimp_models() / name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(all, StaysTorn, testing::ValuesIn(models()), [](const auto& test_case) {
  std::string name = test_case.param.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

/// The tests above ask for something: without tear sides, merging joins vertices of the two lips.
TEST(Welding, closes_tears_that_do_not_have_sides) {
  Random random(5);
  Character character = tear(std::make_shared<const Character>(test::make_sheet(12)), random);
  const test::TemporaryFolder folder;
  const auto with = folder.path() / "with.glb", without = folder.path() / "without.glb";
  ASSERT_TRUE(save_glb(with, character));
  const Character with_sides = character;
  character.meshes[0].custom_attributes.clear();
  ASSERT_TRUE(save_glb(without, character));
  EXPECT_LT(test::weld_vertices(character, 0.0f).meshes[0].vertex_count(),
            test::weld_vertices(with_sides, 0.0f).meshes[0].vertex_count());
  SUNDER_SKIP_WITHOUT_WELDING_TOOLS();
  for (const std::string tool : test::kWeldingTools) {
    SCOPED_TRACE(tool);
    const auto welded_with = folder.path() / (tool + "_with.glb"),
               welded_without = folder.path() / (tool + "_without.glb");
    ASSERT_EQ(test::weld_by_tool(tool, with, welded_with), "");
    ASSERT_EQ(test::weld_by_tool(tool, without, welded_without), "");
    EXPECT_LT(counts_of(welded_without)->vertices, counts_of(welded_with)->vertices);
  }
}

}  // namespace
}  // namespace sunder
