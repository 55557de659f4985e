// The work that the command does for strangers is limited: in time, in memory and in what
// operations add.
#include <algorithm>
#include <filesystem>

#include "tools/command_fixture.h"
#include "tools/textured_squares.h"

namespace sunder::command_test {
namespace {

class BudgetCommand : public CactusSuite {
 protected:
  /// The names of the files in a folder.
  static std::vector<std::string> files_in(const std::string& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path(folder)))
      names.push_back(entry.path().filename().string());
    return names;
  }
  static std::string new_folder(const std::string& name) {
    std::filesystem::create_directory(path(name));
    return path(name);
  }
};

/// A stroke through all layers that winds around the trunk.
std::string winding_stroke(int blades) {
  std::string text =
      R"({"sunder_operations": 1, "operations": [{"op": "tear", "layers": "all", "stroke": [)";
  for (int i = 0; i < blades; ++i) {
    const double x = 0.3 * ((i * 37 % 101) / 50.0 - 1), y = 0.2 + 1.4 * (i * 53 % 97) / 97.0;
    const std::string at = "[" + std::to_string(x) + "," + std::to_string(y) + ",";
    text += std::string(i == 0 ? "" : ",") + R"({"base":)" + at + R"(2],"tip":)" + at + "-2]}";
  }
  return text + "]}]}";
}

TEST_F(BudgetCommand, vertices_are_limited) {
  const std::string log = write("all.json", kAll), folder = new_folder("vertices");
  const CommandResult refused = run_sunder(
      {"tear", model(), "--ops", log, "-o", folder + "/torn.glb", "--report",
       folder + "/report.json", "--save-log", folder + "/log.json", "--max-vertices", "60"});
  EXPECT_EQ(refused.exit_code, 4) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr(log + ": /operations/"));
  EXPECT_THAT(
      refused.err,
      HasSubstr("no room left for vertices: operations may add 60 vertices "
                "and 240 triangles to a mesh; --max-vertices allows more (capacity_exceeded)"));
  EXPECT_THAT(files_in("vertices"), IsEmpty());

  const CommandResult allowed = run_sunder(
      {"tear", model(), "--ops", log, "-o", path("torn.glb"), "--max-vertices", "100000"});
  const CommandResult by_default =
      run_sunder({"tear", model(), "--ops", log, "-o", path("same.glb")});
  EXPECT_EQ(allowed.exit_code, by_default.exit_code);
  EXPECT_EQ(bytes("torn.glb"), bytes("same.glb"));
}

TEST_F(BudgetCommand, time_is_limited_within_an_operation) {
  const std::string log = write("winding.json", winding_stroke(3000)),
                    folder = new_folder("seconds");
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", log, "-o", folder + "/torn.glb", "--max-seconds", "2"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_THAT(result.err, HasSubstr("sunder: " + log +
                                    ": /operations/0: takes more than 2 s; --max-seconds allows "
                                    "more (limit_exceeded)"));
  EXPECT_THAT(files_in("seconds"), IsEmpty());
}

TEST_F(BudgetCommand, memory_is_limited) {
  const std::string log = write("one.json", kOneTear), folder = new_folder("memory");
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", log, "-o", folder + "/torn.glb", "--max-memory", "1"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_THAT(result.err, HasSubstr("takes more than 1 MB of memory; --max-memory allows more"));
  EXPECT_THAT(files_in("memory"), IsEmpty());
}

TEST_F(BudgetCommand, every_verb_has_a_budget) {
  const std::string log = write("one.json", kOneTear), folder = new_folder("verbs");
  const std::vector<std::vector<std::string>> commands = {
      {"info", model(), "--report", folder + "/info.json"},
      {"tear", model(), "--ops", log, "-o", folder + "/torn.glb"},
      {"transfer", model(), model(), "-o", folder + "/out.glb"},
      {"bind", model(), "--skeleton", model(), "-o", folder + "/out.glb"},
      {"validate", model(), model(), "--ops", log, "--report", folder + "/report.json"},
      {"view", model(), "--ops", log, "-o", folder + "/page.html"},
      {"picture", model(), "--ops", log, "-o", folder + "/picture.png"},
      {"demo", model(), "--no-pictures", "-o", folder}};
  for (std::vector<std::string> command : commands)
    for (const char* const limit : {"--max-seconds", "--max-memory"}) {
      std::vector<std::string> limited = command;
      limited.insert(limited.end(), {limit, "0.0001"});
      const CommandResult result = run_sunder(limited);
      EXPECT_EQ(result.exit_code, 4) << command[0] << ": " << result.err;
      EXPECT_THAT(result.err, HasSubstr(std::string(limit) + " allows more (limit_exceeded)"));
      EXPECT_THAT(files_in("verbs"), IsEmpty()) << command[0];
    }
}

/// Squares behind each other, which are cut out by their alpha: each ray meets all of them.
void write_layers(const std::string& file, std::uint16_t count) {
  test::GltfBuilder builder;
  std::vector<float> places;
  std::vector<std::uint16_t> corners;
  for (std::uint16_t i = 0; i < count; ++i) {
    const float z = -0.5f * static_cast<float>(i) / count;
    for (const float x : {0.0f, 1.0f})
      for (const float y : {0.0f, 1.0f}) places.insert(places.end(), {x, y, z});
    for (const int corner : {0, 2, 3, 0, 3, 1})
      corners.push_back(static_cast<std::uint16_t>(4 * i + corner));
  }
  const auto positions = builder.add<float>(places, "VEC3");
  const auto indices = builder.add<std::uint16_t>(corners, "SCALAR");
  OrderedJson& json = builder.json;
  json["materials"].push_back(
      {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0}}}}, {"alphaMode", "MASK"}});
  json["meshes"].push_back(
      {{"primitives", OrderedJson::array({{{"attributes", {{"POSITION", positions}}},
                                           {"indices", indices},
                                           {"material", 0}}})}});
  json["nodes"].push_back({{"mesh", 0}});
  json["scenes"][0]["nodes"].push_back(0);
  const std::vector<std::byte> glb = builder.glb();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
}

/// What is torn is written before it is drawn, and stays.
TEST_F(BudgetCommand, pictures_of_what_was_torn_are_limited) {
  const std::string folder = new_folder("pictures"), layers = path("layers.glb");
  write_layers(layers, 4000);
  const std::string log = write("through.json", R"({"sunder_operations": 1, "operations": [
    {"op": "tear", "stroke": [{"base": [0.4, 0.5, 1], "tip": [0.4, 0.5, -0.00001]},
                              {"base": [0.6, 0.5, 1], "tip": [0.6, 0.5, -0.00001]}]}]})");
  const CommandResult torn = run_sunder({"tear", layers, "--ops", log, "-o", folder + "/torn.glb",
                                         "--picture", folder + "/torn.png", "--max-seconds", "8"});
  EXPECT_EQ(torn.exit_code, 4) << torn.err;
  EXPECT_THAT(torn.err, HasSubstr("torn.png: takes more than 16 s; --max-seconds allows more"));
  EXPECT_THAT(files_in("pictures"), testing::ElementsAre("torn.glb"));

  const std::string demo = new_folder("demo");
  const CommandResult shown = run_sunder({"demo", layers, "-o", demo, "--max-seconds", "1"});
  EXPECT_EQ(shown.exit_code, 4) << shown.err;
  for (const std::string& name : files_in("demo")) EXPECT_NE(name[0], '.') << name;
}

/// The limit is one for each pair, of all pairs together: two seconds.
TEST_F(BudgetCommand, pairs_that_are_done_keep_their_reports) {
  const std::string folder = new_folder("pairs");
  json pairs = json::array();
  for (int i = 0; i < 400; ++i)
    pairs.push_back({{"source", model()},
                     {"target", model()},
                     {"report", "report" + std::to_string(i) + ".json"}});
  write("pairs/pairs.json", json{{"pairs", pairs}}.dump());
  const CommandResult result = run_sunder({"validate", "--manifest", path("pairs/pairs.json"),
                                           "--max-seconds", "0.005", "--jobs", "2"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  for (const std::string& name : files_in("pairs")) {
    EXPECT_THAT(name, testing::EndsWith(".json"));
    EXPECT_TRUE(read_json("pairs/" + name).is_object()) << name;
  }
}

}  // namespace
}  // namespace sunder::command_test
