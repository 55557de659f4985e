// The commands' messages about models with faults: they warn of what loading repaired or dropped,
// and refuse such models with --strict.

#include "support/models/gltf_builder.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

class RepairsCommand : public CommandSuite {
 protected:
  static void SetUpTestSuite() {
    CommandSuite::SetUpTestSuite();
    test::GltfBuilder builder = test::skinned_strip();
    write_glb("clean.glb", builder);
    test::strip_attributes(builder)["WEIGHTS_0"] =
        builder.add(std::vector<float>(4 * test::kStripVertices, 0.4f), "VEC4");
    write_glb("repaired.glb", builder);
    builder.json["meshes"][0]["primitives"][0]["indices"] = builder.add(
        std::vector<std::uint16_t>{0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4, 0, 1, 99}, "SCALAR");
    write_glb("dropped.glb", builder);
    write("cut.json", R"({"sunder_operations": 1, "operations": [
      {"op": "cut", "plane": {"point": [0, 0.3, 0], "normal": [0, 1, 0]}}]})");
  }

  static CommandResult tear(const std::string& model, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"tear",           path(model), "--ops",
                                          path("cut.json"), "-o",        path("torn.glb")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sunder(arguments);
  }

 private:
  static void write_glb(const std::string& name, const test::GltfBuilder& builder) {
    const std::vector<std::byte> glb = builder.glb();
    std::ofstream(path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
  }
};

TEST_F(RepairsCommand, tear_warns_of_repairs) {
  const CommandResult result = tear("repaired.glb");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("repaired: mesh 0 'strip': repeated joints"));
  EXPECT_THAT(tear("repaired.glb", {"--quiet"}).err, IsEmpty());
  EXPECT_EQ(tear("clean.glb").exit_code, 0);
}

TEST_F(RepairsCommand, demo_warns_of_repairs) {
  const CommandResult result =
      run_sunder({"demo", path("repaired.glb"), "--no-pictures", "-o", path("demo")});
  EXPECT_THAT(result.err, HasSubstr("warning: " + path("repaired.glb") + ": repaired: mesh 0"));
}

TEST_F(RepairsCommand, tear_ends_with_findings_if_a_part_was_dropped) {
  const CommandResult result = tear("dropped.glb");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("dropped: "));
  EXPECT_THAT(result.err, HasSubstr("triangles refer to vertices that do not exist"));
  EXPECT_EQ(run_sunder({"info", path("torn.glb"), "--strict"}).exit_code, 0)
      << "the written file has no faults";
}

TEST_F(RepairsCommand, info_prints_every_kind) {
  const CommandResult result = run_sunder({"info", path("dropped.glb")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("repaired   mesh 0 'strip'"));
  EXPECT_THAT(result.out, HasSubstr("dropped    "));
}

TEST_F(RepairsCommand, strict_refuses_in_every_command) {
  const std::string bad = path("repaired.glb"), clean = path("clean.glb"), out = path("out.glb");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"info", bad},
                                             {"tear", bad, "--ops", path("cut.json"), "-o", out},
                                             {"validate", clean, bad},
                                             {"validate", bad, clean},
                                             {"transfer", clean, bad, "-o", out},
                                             {"transfer", bad, clean, "-o", out},
                                             {"picture", bad, "-o", path("out.png")},
                                             {"view", bad, "-o", path("out.html")},
                                             {"bind", bad, "--skeleton", clean, "-o", out},
                                             {"bind", clean, "--skeleton", bad, "-o", out}}) {
    std::vector<std::string> strict = arguments;
    strict.push_back("--strict");
    const CommandResult result = run_sunder(strict);
    EXPECT_EQ(result.exit_code, 3) << arguments[0] << ": " << result.err;
    EXPECT_THAT(result.err, HasSubstr("repaired.glb")) << arguments[0];
  }
  EXPECT_FALSE(exists("out.glb"));
}

}  // namespace
}  // namespace sunder::command_test
