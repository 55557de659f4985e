// `sunder validate` from the outside: exit codes, the report, and faults of files as stored.

#include <sunder/io/character_file.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/machine/node_program.h"
#include "support/machine/temporary_folder.h"
#include "tools/demo/demo_rig.h"
#include "tools/run_command.h"

namespace sunder {
namespace {

using nlohmann::json;
using test::run_sunder;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Subtracts one unit from the first weight of some vertices of the first mesh of a GLB with bytes.
void spoil_weights(const std::filesystem::path& file, std::size_t vertices) {
  std::vector<std::byte> bytes = test::read_bytes(file);
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, bytes.data() + 12, 4);
  const json document =
      json::parse(std::string(reinterpret_cast<const char*>(bytes.data()) + 20, json_size));
  const std::size_t accessor =
      document["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"].get<std::size_t>();
  const json& of = document["accessors"][accessor];
  ASSERT_EQ(of["componentType"], 5121);
  const json& view = document["bufferViews"][of["bufferView"].get<std::size_t>()];
  const std::size_t first = 20 + json_size + 8 + view.value("byteOffset", std::size_t{0}) +
                            of.value("byteOffset", std::size_t{0});
  const std::size_t stride = view.value("byteStride", std::size_t{4});
  for (std::size_t v = 0; v < vertices; ++v) {
    std::byte& weight = bytes[first + v * stride];
    weight = static_cast<std::byte>(static_cast<unsigned>(weight) - 1);
  }
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

json read_report(const std::filesystem::path& file) {
  return json::parse(std::ifstream(file), nullptr, false);
}

class Validate : public testing::Test {
 protected:
  Validate() {
    const SaveOptions bytes{0, WeightFormat::unorm8};
    EXPECT_TRUE(save_glb(path("model.glb"), tools::make_cactus(), bytes));
    EXPECT_TRUE(save_glb(path("spoiled.glb"), tools::make_cactus(), bytes));
    spoil_weights(path("spoiled.glb"), 7);
  }
  std::string path(const std::string& name) { return (folder_.path() / name).string(); }

  test::TemporaryFolder folder_;
};

TEST_F(Validate, a_model_beside_itself_has_no_finding_above_a_note) {
  const auto result = run_sunder({"validate", path("model.glb"), path("model.glb"), "--fail-on",
                                  "warning", "--report", path("r.json")});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("PASS: 0 errors, 0 warnings"));
  EXPECT_THAT(result.out, Not(HasSubstr("\x1b"))) << "colour only on a terminal";
  const json report = read_report(path("r.json"));
  EXPECT_EQ(report["sunder_validation"], 1);
  EXPECT_EQ(report["certificate"]["certified"], 0.0);
  EXPECT_EQ(report["verdicts"]["SUNDER_W_SUM"]["result"], "Pass");
  EXPECT_EQ(report["verdicts"]["SUNDER_W_POP"]["result"], "Not tested");
  EXPECT_THAT(report["verdicts"]["SUNDER_W_POP"]["why"].get<std::string>(), Not(IsEmpty()));
}

TEST_F(Validate, a_deviation_is_an_error_by_its_size) {
  Character stiff = tools::make_cactus();
  for (Mesh& mesh : stiff.meshes) {
    const std::vector<Influence> first = {{0, 1.0f}};
    mesh.weights = {};
    for (Index v = 0; v < mesh.vertex_count(); ++v) mesh.weights.append(first);
  }
  ASSERT_TRUE(save_glb(path("stiff.glb"), stiff));
  const auto failed = run_sunder({"validate", path("model.glb"), path("stiff.glb")});
  EXPECT_EQ(failed.exit_code, 1) << failed.err;
  EXPECT_THAT(failed.out, HasSubstr("error    SUNDER_W_DEVIATION"));
  EXPECT_THAT(failed.out, HasSubstr("FAIL: "));
  EXPECT_THAT(failed.out, HasSubstr("% of the diagonal"));
  for (const char* const option : {"--error-deviation", "--max-seconds", "--max-memory"})
    for (const char* const bad : {"-1", "nan"}) {
      const auto refused =
          run_sunder({"validate", path("model.glb"), path("stiff.glb"), option, bad});
      EXPECT_EQ(refused.exit_code, 2) << option << " " << bad;
      EXPECT_THAT(refused.err, HasSubstr(option));
    }
}

TEST_F(Validate, no_model_is_overwritten) {
  const auto before = test::read_bytes(path("model.glb"));
  for (const char* const option : {"--report", "--html"}) {
    const auto result =
        run_sunder({"validate", path("spoiled.glb"), path("model.glb"), option, path("model.glb")});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("would overwrite TARGET"));
  }
  EXPECT_EQ(test::read_bytes(path("model.glb")), before);
}

TEST_F(Validate, sums_that_loading_would_repair_are_found_as_stored) {
  const auto result =
      run_sunder({"validate", path("model.glb"), path("spoiled.glb"), "--report", path("r.json")});
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  const json report = read_report(path("r.json"));
  const json& finding = report["findings"][0];
  EXPECT_EQ(finding["code"], "SUNDER_W_SUM_INTEGER");
  EXPECT_EQ(finding["count"], 7);
  EXPECT_EQ(finding["gltf_validator"], "ACCESSOR_WEIGHTS_NON_NORMALIZED");
  EXPECT_EQ(finding["evidence"], "exact");
  for (const json& place : finding["places"]) {
    EXPECT_LT(place["vertex"].get<int>(), 7);
    EXPECT_EQ(place["pointer"], "/meshes/0/primitives/0/attributes/WEIGHTS_0");
  }
  EXPECT_EQ(report["verdicts"]["SUNDER_W_SUM_INTEGER"]["result"], "Fail");
}

TEST_F(Validate, a_fault_that_the_source_has_too_is_inherited) {
  const auto result =
      run_sunder({"validate", path("spoiled.glb"), path("spoiled.glb"), "--fail-on", "warning"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("SUNDER_W_SUM_INTEGER"));
  EXPECT_THAT(result.out, HasSubstr("Inherited"));
}

TEST_F(Validate, a_manifest_compares_many_pairs_and_the_worst_exit_code_counts) {
  std::ofstream(path("pairs.json")) << R"({"pairs": [
    {"source": "model.glb", "target": "model.glb", "report": "a.json"},
    {"source": "model.glb", "target": "spoiled.glb", "report": "b.json", "limits": "clips"}]})";
  const auto result =
      run_sunder({"validate", "--manifest", path("pairs.json"), "--jobs", "2", "--json-lines"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  std::istringstream lines(result.out);
  std::size_t results = 0;
  for (std::string line; std::getline(lines, line);) {
    const json event = json::parse(line, nullptr, false);
    ASSERT_TRUE(event.is_object()) << line;
    results += event["event"] == "result";
  }
  EXPECT_EQ(results, 2u);
  EXPECT_EQ(read_report(path("a.json"))["counts"]["error"], 0);
  EXPECT_EQ(read_report(path("b.json"))["counts"]["error"], 1);
}

TEST_F(Validate, a_manifest_is_no_output) {
  const std::string manifest = R"({"pairs": [
    {"source": "model.glb", "target": "model.glb", "report": "self.json"}]})";
  std::ofstream(path("self.json")) << manifest;
  const auto result = run_sunder({"validate", "--manifest", path("self.json")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("would overwrite --manifest"));
  EXPECT_EQ(read_report(path("self.json")), json::parse(manifest));
}

TEST_F(Validate, the_page_has_the_deviation_over_the_time_of_each_clip) {
  ASSERT_TRUE(save_glb(path("four.glb"), tools::make_cactus(), {4, WeightFormat::float32}));
  const auto result = run_sunder({"validate", path("model.glb"), path("four.glb"), "--report",
                                  path("r.json"), "--html", path("r.html")});
  if (result.err.find("scripts/setup page") != std::string::npos || !test::has_node_packages({}))
    GTEST_SKIP() << "needs node and a build with the page (scripts/setup page)";
  ASSERT_LE(result.exit_code, 1) << result.err;
  std::ostringstream html;
  html << std::ifstream(path("r.html")).rdbuf();
  const std::string page = html.str(), mark = "<script id=\"data\" type=\"text/plain\">";
  const std::size_t first = page.find(mark) + mark.size();
  std::ofstream(path("data")) << page.substr(first, page.find("</script>", first) - first);
  const auto decoded = test::run_node_program("decode_page.mjs", "'" + path("data") + "' 0 0");
  ASSERT_TRUE(decoded && decoded->succeeded) << (decoded ? decoded->output : "");
  const json series = json::parse(decoded->output)["series"];
  ASSERT_EQ(series.size(), 2u);
  EXPECT_EQ(series[0]["name"], "Largest deviation");
  EXPECT_EQ(series[1]["name"], "RMS");
  double largest = 0;
  for (std::size_t i = 0; i < series[0]["times"].size(); ++i) {
    const double maximum = series[0]["values"][i].get<double>();
    EXPECT_LE(series[1]["values"][i].get<double>(), maximum);
    largest = std::max(largest, maximum);
  }
  // The report samples the same clip at fewer times.
  const json report = read_report(path("r.json"));
  const json& of_clips = report["posed"][0];
  EXPECT_EQ(of_clips["poses"], "clips");
  EXPECT_NEAR(largest, of_clips["max"].get<double>(), 0.05 * largest);
  EXPECT_GT(largest, 1e-4);
}

TEST_F(Validate, a_build_without_the_page_refuses_html_before_it_compares) {
  const auto result =
      test::run_sunder_without_page({"validate", path("model.glb"), path("model.glb"), "--report",
                                     path("r.json"), "--html", path("r.html")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, HasSubstr("--html"));
  EXPECT_THAT(result.err, HasSubstr("scripts/setup page"));
  EXPECT_FALSE(std::filesystem::exists(path("r.html")));
  EXPECT_FALSE(std::filesystem::exists(path("r.json")));
  std::ofstream(path("pairs.json"))
      << R"({"pairs": [{"source": "model.glb", "target": "model.glb", "html": "r.html"}]})";
  EXPECT_EQ(test::run_sunder_without_page({"validate", "--manifest", path("pairs.json")}).exit_code,
            2);
  EXPECT_EQ(
      test::run_sunder_without_page({"validate", path("model.glb"), path("model.glb")}).exit_code,
      0);
}

TEST_F(Validate, wrong_command_lines_and_files_have_their_exit_codes) {
  const std::string model = path("model.glb");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"validate"},
                                             {"validate", model},
                                             {"validate", model, model, "--fail-on", "never"},
                                             {"validate", model, model, "--profile", "ps1"}}) {
    const auto result = run_sunder(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
  }
  EXPECT_EQ(run_sunder({"validate", model, path("absent.glb")}).exit_code, 3);
  std::ofstream(path("limits.json")) << R"({"limits": {"no such bone": {"angle": 3}}})";
  const auto limits = run_sunder({"validate", model, model, "--limits", path("limits.json")});
  EXPECT_EQ(limits.exit_code, 2);
  EXPECT_THAT(limits.err, HasSubstr("no such bone"));
  std::ofstream(path("bones.json")) << R"({"x": 3})";
  EXPECT_EQ(run_sunder({"validate", model, model, "--bone-names", path("bones.json")}).exit_code,
            2);
}

}  // namespace
}  // namespace sunder
