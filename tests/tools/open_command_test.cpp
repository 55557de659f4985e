// `sunder tear --open` from the outside.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <tuple>

#include "support/machine/gltf_validator.h"
#include "support/machine/node_program.h"
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

  template <class T>
  static bool begins_with(const std::vector<T>& list, const std::vector<T>& beginning) {
    return list.size() >= beginning.size() &&
           std::equal(beginning.begin(), beginning.end(), list.begin());
  }
  static bool begins_with(const MorphTarget& target, const MorphTarget& beginning) {
    return target.name == beginning.name &&
           begins_with(target.position_deltas, beginning.position_deltas) &&
           begins_with(target.normal_deltas, beginning.normal_deltas) &&
           begins_with(target.tangent_deltas, beginning.tangent_deltas);
  }

  /// Over the vertices that both have: walls are appended.
  static double farthest(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    double far = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      far = std::max(far, static_cast<double>((a[i] - b[i]).norm()));
    return far;
  }

  static json materials_of(const std::string& name) {
    const std::vector<std::byte> file = bytes(name);
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + 12, 4);
    const char* const text = reinterpret_cast<const char*>(file.data()) + 20;
    return json::parse(text, text + length)["materials"];
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
  EXPECT_TRUE(begins_with(mesh.morph_targets[0], before.morph_targets[0]));
  EXPECT_EQ(mesh.morph_targets[1].name, "Open");
  EXPECT_TRUE(begins_with(mesh.positions, before.positions));
  EXPECT_TRUE(begins_with(mesh.weights.influences, before.weights.influences));
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

/// A seam that opens during a clip, though it was cut at rest.
TEST_F(OpenCommand, lips_open_over_a_span_of_a_clip) {
  const std::string log = write("rest.json", R"({"sunder_operations": 1, "operations": [
    {"op": "tear", "stroke": [{"base": [-0.1, 1.15, 2], "tip": [-0.1, 1.15, 0]},
                              {"base": [-0.12, 1.4, 2], "tip": [-0.12, 1.4, 0]}]}]})");
  const LoadedCharacter closed = torn(model(), log, "closed.glb", {});
  const LoadedCharacter open =
      torn(model(), log, "open.glb", {"--open", "--open-span", "Sway@0.5..1.5"});
  ASSERT_TRUE(closed.character && open.character);
  expect_valid("open.glb");
  const std::uint32_t m = mesh_named(*open.character, "Cactus");
  const std::uint32_t weight = open.character->meshes[m].first_morph_weight + 1;
  const auto apart = [&](double time) {
    const PoseSpec pose = ClipPose{std::uint32_t{0}, time};
    return farthest(posed(*open.character, m, pose), posed(*closed.character, m, pose));
  };
  const auto share = [&](double time) {
    const Result<ModelPose> pose = make_pose(*open.character, ClipPose{std::uint32_t{0}, time});
    return pose ? pose->morph_weights[weight] : -1.0f;
  };
  EXPECT_LT(apart(0.3), 1e-5);
  EXPECT_LT(apart(0.5), 1e-5);
  EXPECT_GT(apart(1.5), 0.005);
  for (const double time : {0.5, 0.75, 1.0, 1.2, 1.5})
    EXPECT_NEAR(share(time), time - 0.5, 1e-5) << "evenly";
  EXPECT_NEAR(share(1.8), 1, 1e-6);
  const LoadedCharacter at_once =
      torn(model(), log, "open.glb", {"--open", "--open-span", "Sway@0.5"});
  ASSERT_TRUE(at_once.character);
  const Result<ModelPose> late = make_pose(*at_once.character, ClipPose{std::uint32_t{0}, 1.5});
  ASSERT_TRUE(late);
  EXPECT_GT(late->morph_weights[weight], 0.9f) << "as fast as tissue moves";
}

TEST_F(OpenCommand, spans_that_no_clip_has_are_refused) {
  const std::string log = write("one.json", kOneTear);
  for (const auto& [span, told] :
       {std::pair{"Swya@0.5", "Sway"}, std::pair{"Sway@0.5..99", "lasts"},
        std::pair{"Sway@1..0.5", "ascending"}, std::pair{"Sway", "CLIP@START"},
        std::pair{"Sway@x", "CLIP@START"}, std::pair{"Sway@-1", "CLIP@START"}}) {
    const CommandResult result = run_sunder(
        {"tear", model(), "--ops", log, "-o", path("x.glb"), "--open", "--open-span", span});
    EXPECT_EQ(result.exit_code, 2) << span;
    EXPECT_THAT(result.err, HasSubstr("--open-span")) << span;
    EXPECT_THAT(result.err, HasSubstr(told)) << span;
    EXPECT_FALSE(exists("x.glb"));
  }
  for (const char* const form : {"--open=baked", "--dry-run"})
    EXPECT_EQ(run_sunder({"tear", model(), "--ops", log, "-o", path("x.glb"), form, "--open-span",
                          "Sway@0.5"})
                  .exit_code,
              2)
        << form;
}

TEST_F(OpenCommand, vertices_that_were_one_gape_as_the_report_says) {
  const std::string log = write("one.json", kOneTear);
  const LoadedCharacter closed = torn(model(), log, "closed.glb", {});
  const LoadedCharacter open = torn(model(), log, "open.glb", {"--open=baked"});
  ASSERT_TRUE(closed.character && open.character);
  expect_valid("open.glb");
  const std::uint32_t m = mesh_named(*open.character, "Cactus");
  const Mesh &mesh = open.character->meshes[m], &before = closed.character->meshes[m];
  ASSERT_EQ(mesh.morph_targets.size(), before.morph_targets.size());
  EXPECT_TRUE(begins_with(mesh.morph_targets[0], before.morph_targets[0]));
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

/// Walls leave no crack to their lips, and none at the tips: the surface has the borders that it
/// had before it was torn.
TEST_F(OpenCommand, walls_shut_the_wound) {
  const std::string log = write("one.json", kOneTear);
  const LoadedCharacter closed = torn(model(), log, "closed.glb", {}),
                        source = *load_character(model());
  ASSERT_TRUE(closed.character);
  const TopologyCounts before = *count_topology(*source.character);
  EXPECT_GT(count_topology(*closed.character)->boundary_edges, before.boundary_edges);
  for (const char* const form : {"--open", "--open=baked"}) {
    SCOPED_TRACE(form);
    const LoadedCharacter open = torn(model(), log, "open.glb", {form});
    ASSERT_TRUE(open.character);
    const TopologyCounts counts = *count_topology(*open.character);
    EXPECT_EQ(counts.boundary_edges, before.boundary_edges);
    EXPECT_EQ(counts.non_manifold_edges, before.non_manifold_edges);
    EXPECT_EQ(counts.degenerate_triangles, before.degenerate_triangles);
    EXPECT_GT(read_json("open.glb.json")["open"]["wall_faces"].get<int>(), 100);
  }
}

/// Stitches are closed tubes in the file, which stay at their lips in other poses.
TEST_F(OpenCommand, threads_of_sutures_are_written) {
  const std::string log = write("one.json", kOneTear);
  const LoadedCharacter source = *load_character(model());
  for (const std::string form : {"--open", "--open=baked"}) {
    SCOPED_TRACE(form);
    const LoadedCharacter sewn =
        torn(model(), log, "open.glb", {form, "--suture", "all,spacing=0.04"});
    ASSERT_TRUE(sewn.character);
    expect_valid("open.glb");
    EXPECT_GT(read_json("open.glb.json")["open"]["thread_faces"].get<int>(), 100);
    EXPECT_EQ(materials_of("open.glb").back()["name"], "Threads");
    EXPECT_EQ(count_topology(*sewn.character)->boundary_edges,
              count_topology(*source.character)->boundary_edges);
    const std::uint32_t m = mesh_named(*sewn.character, "Cactus");
    const Mesh& mesh = sewn.character->meshes[m];
    const auto threads = static_cast<std::uint32_t>(mesh.submeshes.size()) - 1;
    std::vector<bool> is_thread(mesh.vertex_count(), false);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      for (const std::uint32_t vertex : mesh.triangles[t])
        if (mesh.triangle_submesh[t] == threads) is_thread[vertex] = true;
    EXPECT_GT(std::ranges::count(is_thread, true), 100);
    const ModelPose pose = *make_pose(*sewn.character, ClipPose{std::uint32_t{0}, 1.3});
    const std::vector<Vec3f> places = posed(*sewn.character, m, pose);
    double farthest = 0;
    for (std::uint32_t v = 0; v < places.size(); ++v) {
      if (!is_thread[v]) continue;
      double nearest = 1;
      for (std::uint32_t other = 0; other < places.size(); ++other)
        if (!is_thread[other])
          nearest = std::min(nearest, static_cast<double>((places[v] - places[other]).norm()));
      farthest = std::max(farthest, nearest);
    }
    EXPECT_LT(farthest, 0.03);  // About a cell of the cactus.
  }
  const LoadedCharacter broken =
      torn(model(), log, "open.glb", {"--open", "--suture", "all,spacing=0.04,strength=1e-9"});
  ASSERT_TRUE(broken.character);
  EXPECT_EQ(read_json("open.glb.json")["open"]["thread_faces"].get<int>(), 0);
}

/// Where wounds cross, four lips end: the ground between them is shut too.
TEST_F(OpenCommand, walls_shut_wounds_that_cross) {
  const std::string log = write("cross.json", R"({"sunder_operations": 1, "operations": [
    {"op": "tear", "stroke": [{"base": [-0.04, 0.6, 2], "tip": [-0.04, 0.6, 0]},
                              {"base": [0.05, 0.75, 2], "tip": [0.05, 0.75, 0]}]},
    {"op": "tear", "stroke": [{"base": [0.05, 0.6, 2], "tip": [0.05, 0.6, 0]},
                              {"base": [-0.04, 0.75, 2], "tip": [-0.04, 0.75, 0]}]}]})");
  const LoadedCharacter open = torn(model(), log, "open.glb", {"--open"}),
                        source = *load_character(model());
  ASSERT_TRUE(open.character);
  EXPECT_EQ(count_topology(*open.character)->boundary_edges,
            count_topology(*source.character)->boundary_edges);
}

TEST_F(OpenCommand, walls_are_of_a_flesh_that_can_be_chosen) {
  const std::string log = write("one.json", kOneTear);
  const LoadedCharacter closed = torn(model(), log, "closed.glb", {});
  const std::size_t count = materials_of("closed.glb").size();
  struct Case {
    std::vector<std::string> options;
    std::size_t submeshes, materials;
  };
  for (const Case& of : {Case{{"--open"}, 3, count + 1},
                         {{"--open", "--flesh", "source"}, 3, count},
                         {{"--open", "--flesh", "none"}, 2, count}}) {
    SCOPED_TRACE(of.options.back());
    const LoadedCharacter open = torn(model(), log, "open.glb", of.options);
    ASSERT_TRUE(open.character);
    expect_valid("open.glb");
    const Mesh& mesh = open.character->meshes[mesh_named(*open.character, "Cactus")];
    EXPECT_EQ(mesh.submeshes.size(), of.submeshes);
    EXPECT_EQ(materials_of("open.glb").size(), of.materials);
  }
  (void)torn(model(), log, "open.glb", {"--open", "--flesh", "#0080ff,roughness=0.25,name=Ice"});
  const json ice = materials_of("open.glb").back();
  EXPECT_EQ(ice["name"], "Ice");
  const json surface = ice["pbrMetallicRoughness"];
  EXPECT_EQ(surface["roughnessFactor"], 0.25);
  EXPECT_EQ(surface["baseColorFactor"][0], 0.0);
  EXPECT_NEAR(surface["baseColorFactor"][1].get<double>(), 0.2159, 1e-4);  // sRGB 128
  EXPECT_EQ(surface["baseColorFactor"][2], 1.0);
  for (const char* const wrong :
       {"red", "#12345", "#12345g", "roughness=2", "roughness=", "name="}) {
    const CommandResult result = run_sunder(
        {"tear", model(), "--ops", log, "-o", path("x.glb"), "--open", "--flesh", wrong});
    EXPECT_EQ(result.exit_code, 2) << wrong;
    EXPECT_THAT(result.err, HasSubstr("--flesh")) << wrong;
  }
}

constexpr const char* kCutOff = R"({"sunder_operations": 1, "operations": [
  {"op": "cut", "plane": {"point": [0, 1.2, 0], "normal": [0, 1, 0]}, "caps": true},
  {"op": "detach", "piece": {"near": [0, 3, 0]}}]})";

/// As pictures show them: without --open, in the model and in its pieces.
TEST_F(OpenCommand, caps_are_of_flesh_in_the_model_and_its_pieces) {
  const std::string log = write("cut.json", kCutOff);
  const auto names_in = [&](const char* file) {
    std::vector<std::string> names;
    for (const json& material : materials_of(file)) names.push_back(material.value("name", ""));
    return names;
  };
  (void)torn(model(), log, "torn.glb", {"--pieces", path("piece")});
  for (const char* const file : {"torn.glb", "piece1.glb"}) {
    expect_valid(file);
    EXPECT_EQ(names_in(file).back(), "Wound") << file;
  }
  (void)torn(model(), log, "torn.glb", {"--pieces", path("piece"), "--flesh", "source"});
  for (const char* const file : {"torn.glb", "piece1.glb"})
    EXPECT_EQ(std::ranges::count(names_in(file), "Wound"), 0) << file;
}

TEST_F(OpenCommand, a_piece_that_would_overwrite_the_model_is_refused_before_anything_is_written) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("cut.json", kCutOff), "-o", path("top1.glb"),
                  "--pieces", path("top"), "--force"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--pieces"));
  EXPECT_FALSE(exists("top1.glb"));
}

/// A pot does not bleed, nor does a cactus of cloth; a material that an operation names stays.
TEST_F(OpenCommand, what_has_no_flesh_keeps_its_material) {
  const std::string pot = write("pot.json", R"({"sunder_operations": 1, "operations": [
    {"op": "tear", "stroke": [{"base": [-0.1, 0.1, 2], "tip": [-0.1, 0.1, 0]},
                              {"base": [0.1, 0.12, 2], "tip": [0.1, 0.12, 0]}]}]})");
  Character coat = tools::make_cactus();
  for (Mesh& mesh : coat.meshes)
    for (Submesh& submesh : mesh.submeshes) submesh.name = "Cloth";
  ASSERT_TRUE(save_glb(path("coat.glb"), coat));
  const std::string on_coat = path("coat.glb"), one = write("one.json", kOneTear);
  for (const auto& [file, log, mesh_name] :
       {std::tuple{model(), pot, "Pot"}, std::tuple{on_coat, one, "Cactus"}}) {
    SCOPED_TRACE(mesh_name);
    const LoadedCharacter open = torn(file, log, "open.glb", {"--open"});
    ASSERT_TRUE(open.character);
    const Mesh& mesh = open.character->meshes[mesh_named(*open.character, mesh_name)];
    ASSERT_EQ(mesh.submeshes.size(), 3u);
    EXPECT_EQ(mesh.submeshes[2].material, mesh.submeshes[0].material);
    EXPECT_EQ(mesh.submeshes[2].name, "Wound");
  }
  const char* const cap = R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "plane": {"point": [0, 1.2, 0], "normal": [0, 1, 0.1]}, "caps": true%s},
    {"op": "tear", "stroke": [{"base": [-0.02, 0.6, 2], "tip": [-0.02, 0.6, 0]},
                              {"base": [0.02, 0.8, 2], "tip": [0.02, 0.8, 0]}]}]})";
  for (const bool is_named : {false, true}) {
    std::string log = cap;
    log.replace(log.find("%s"), 2, is_named ? ", \"cap_material\": 1" : "");
    const LoadedCharacter open = torn(model(), write("cap.json", log), "open.glb", {"--open"});
    ASSERT_TRUE(open.character);
    const std::size_t flesh = materials_of("open.glb").size() - 1;
    const Mesh& mesh = open.character->meshes[mesh_named(*open.character, "Cactus")];
    ASSERT_GT(mesh.submeshes.size(), 2u);
    EXPECT_EQ(mesh.submeshes[2].material, is_named ? 1 : flesh);
    EXPECT_EQ(mesh.submeshes.back().material, flesh);
  }
}

/// Without tension of its own, a wound gapes no wider than the one that would fold first.
TEST_F(OpenCommand, each_wound_gapes_as_if_it_were_alone) {
  const std::string first = R"({"op": "tear", "stroke": [
    {"base": [-0.1, 1.15, 2], "tip": [-0.1, 1.15, 0]}, {"base": [-0.1, 1.4, 2], "tip": [-0.1, 1.4, 0]}]})",
                    second = R"({"op": "tear", "stroke": [
    {"base": [-0.02, 0.5, 2], "tip": [-0.02, 0.5, 0]}, {"base": [0, 0.54, 2], "tip": [0, 0.54, 0]}]})";
  const auto gap = [&](const std::string& operations) {
    const std::string log =
        write("slashes.json", R"({"sunder_operations": 1, "operations": [)" + operations + "]}");
    (void)torn(model(), log, "open.glb", {"--open"});
    return read_json("open.glb.json")["open"]["gaps"];
  };
  const double of_first = gap(first)[0].get<double>(), of_second = gap(second)[0].get<double>();
  const json both = gap(first + ", " + second);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NEAR(both[0].get<double>(), of_first, 0.25 * of_first);
  EXPECT_NEAR(both[1].get<double>(), of_second, 0.25 * of_second);
  EXPECT_GT(of_first, 1.5 * of_second) << "the slashes are not alike";
}

/// three.js is the judge: through the wound one sees flesh, and no background where the closed
/// surface covers it.
TEST_F(OpenCommand, three_js_shows_flesh_in_wounds_and_nothing_behind) {
  if (!test::has_node_packages({"three", "puppeteer-core"}) ||
      std::system("command -v chromium > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "needs node, three, puppeteer-core and Chromium";
  std::string files;
  std::size_t count = 0;
  for (const auto& file : rigged_gltf_models()) {
    const std::string name = file.stem().string(), folder = path("seen_" + name);
    if (run_sunder({"demo", file.string(), "-o", folder, "--no-pictures"}).exit_code > 1) continue;
    const std::string out = path("seen_" + name + ".glb");
    const CommandResult result = run_sunder(
        {"tear", file.string(), "--ops", folder + "/ops.json", "-o", out, "--open", "-q"});
    if (result.exit_code > 1) continue;
    files += " '" + out + "'";
    ++count;
  }
  ASSERT_GE(count, test::shared_models().empty() ? 1u : 10u);
  std::size_t hollow = 0, looked_at = 0;
  for (const char* const at : {"", "--at 1"}) {
    const auto run = test::run_node_program("flesh.mjs", at + files);
    ASSERT_TRUE(run && run->succeeded) << (run ? run->output : std::string());
    std::istringstream lines(run->output);
    for (std::string line; std::getline(lines, line); ++looked_at) {
      SCOPED_TRACE(line);
      const json found = json::parse(line);
      ASSERT_FALSE(found["wounds"].empty());
      const json& wound = found["wounds"][0];
      EXPECT_GT(wound["flesh"].get<double>(), 0.003);
      EXPECT_LT(wound["background"].get<double>(), 2e-5);  // a pixel
      EXPECT_LT(wound["fleshWhenClosed"].get<double>(), 0.1 * wound["flesh"].get<double>());
      hollow += wound["hollow"].get<double>() > 0.3 * wound["flesh"].get<double>() ? 1 : 0;
    }
  }
  EXPECT_EQ(looked_at, 2 * count);
  EXPECT_GT(hollow, count / 2) << "without flesh, one sees through most models";
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

/// A tear across the front of a cactus that was scaled.
std::string tear_at_scale(double scale) {
  json stroke = json::array();
  for (const auto& [x, y] : {std::pair(-0.1, 1.15), std::pair(-0.12, 1.25), std::pair(-0.1, 1.4)})
    stroke.push_back(
        {{"base", {x * scale, y * scale, 2 * scale}}, {"tip", {x * scale, y * scale, 0}}});
  return json{{"sunder_operations", 1}, {"operations", {{{"op", "tear"}, {"stroke", stroke}}}}}
      .dump();
}

/// The cactus at rest, some times as large.
Character scaled_cactus(float scale) {
  Character cactus = tools::make_cactus();
  cactus.clips.clear();
  for (Mesh& mesh : cactus.meshes) {
    for (Vec3f& at : mesh.positions) at *= scale;
    for (MorphTarget& target : mesh.morph_targets)
      for (Vec3f& delta : target.position_deltas) delta *= scale;
  }
  for (Bone& bone : cactus.skeleton.bones) bone.rest.translation *= scale;
  for (Skin& skin : cactus.skins)
    for (Affine3f& matrix : skin.bone_from_bind) matrix.translation() *= scale;
  return cactus;
}

// What cannot be opened for its size is an error of the input (2), never one of the command (5).
TEST_F(OpenCommand, a_size_that_cannot_be_opened_is_no_internal_error) {
  for (const double scale : {1e-24, 3e-23, 1e-22, 1e-20, 1e8, 1e10, 1e12, 1e16, 1e24}) {
    SCOPED_TRACE(scale);
    ASSERT_TRUE(save_glb(path("scaled.glb"), scaled_cactus(static_cast<float>(scale))));
    std::vector<std::string> arguments = {"tear",  path("scaled.glb"),
                                          "--ops", write("scaled.json", tear_at_scale(scale)),
                                          "-o",    path("scaled_torn.glb")};
    const CommandResult closed = run_sunder(arguments);
    EXPECT_TRUE(closed.exit_code == 0 || closed.exit_code == 1) << closed.err;
    arguments.push_back("--open");
    const CommandResult open = run_sunder(arguments);
    EXPECT_TRUE(open.exit_code >= 0 && open.exit_code <= 2) << open.exit_code << ": " << open.err;
    if (open.exit_code == 2) {
      EXPECT_THAT(open.err, HasSubstr("--open: "));
    }
  }
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
        EXPECT_TRUE(begins_with(after.triangles, before.triangles));
        for (std::size_t i = 0; i < before.uv_sets.size(); ++i)
          EXPECT_TRUE(begins_with(after.uv_sets[i], before.uv_sets[i]));
        EXPECT_TRUE(begins_with(after.submeshes, before.submeshes));
        ASSERT_GE(after.morph_targets.size(), before.morph_targets.size());
        EXPECT_LE(after.morph_targets.size(), before.morph_targets.size() + 1);
        for (std::size_t i = 0; i < before.morph_targets.size(); ++i)
          EXPECT_TRUE(begins_with(after.morph_targets[i], before.morph_targets[i]));
      }
      ASSERT_EQ(open.character->clips.size(), closed.character->clips.size());
      for (std::size_t c = 0; c < open.character->clips.size(); ++c)
        EXPECT_EQ(open.character->clips[c].duration, closed.character->clips[c].duration);
    }
  }
}

}  // namespace
}  // namespace sunder::command_test
