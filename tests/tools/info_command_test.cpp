// `sunder info`, help, and command lines that are wrong.

#include "tools/command_fixture.h"
#include "tools/textured_squares.h"

namespace sunder::command_test {
namespace {

class InfoCommand : public CactusSuite {};

TEST_F(InfoCommand, help_has_an_example_for_each_verb) {
  for (const char* const verb :
       {"info", "picture", "tear", "transfer", "bind", "validate", "view", "demo"}) {
    const CommandResult result = run_sunder({verb, "--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, testing::ContainsRegex(std::string("Examples?:\\s+sunder ") + verb));
    EXPECT_THAT(result.err, IsEmpty());
  }
  EXPECT_EQ(run_sunder({"--help"}).exit_code, 0);
  EXPECT_THAT(run_sunder({"--version"}).out, HasSubstr("sunder 0."));
}

TEST_F(InfoCommand, a_wrong_command_line_exits_with_2) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {}, {"sew"}, {"info"}, {"info", model(), "--xml"}, {"tear", model()}}) {
    const CommandResult result = run_sunder(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, testing::Not(IsEmpty()));
  }
  EXPECT_EQ(run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("x.glb"),
                        "--influences", "5"})
                .exit_code,
            2);
  EXPECT_EQ(run_sunder({"tear", model(), "--ops", path("a.json"), "-o", path("x.glb"),
                        "--weights-as", "u32"})
                .exit_code,
            2);
  EXPECT_FALSE(exists("x.glb"));
}

TEST_F(InfoCommand, unknown_words_are_named_with_what_they_may_stand_for) {
  const auto error_of = [](const std::vector<std::string>& arguments) {
    const CommandResult result = run_sunder(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    return result.err.substr(0, result.err.find('\n'));
  };
  EXPECT_EQ(error_of({"taer", "a.glb"}), "sunder has no verb 'taer'; did you mean 'tear'?");
  EXPECT_THAT(error_of({"sew"}), HasSubstr("no verb 'sew'; its verbs: 'info', 'picture', "));
  EXPECT_EQ(error_of({"--verison"}), "sunder has no option '--verison'; did you mean '--version'?");
  EXPECT_EQ(error_of({"tear", model(), "--servr", "Neck", "-o", path("x.glb")}),
            "sunder tear has no option '--servr'; did you mean '--sever'?");
  EXPECT_EQ(
      error_of({"tear", model(), "--perforation=holes.json"})
          .find("sunder tear has no option '--perforation': a perforation shows only where force"),
      0u);
  EXPECT_EQ(error_of({"info", model(), "--xyz=1"}), "sunder info has no option '--xyz'");
  EXPECT_EQ(error_of({"info", model(), "more"}), "sunder info: one argument too many: 'more'");
}

TEST_F(InfoCommand, a_model_that_nothing_bends_is_said_to_be_static) {
  EXPECT_THAT(run_sunder({"info", model()}).out, testing::Not(HasSubstr("static  ")));
  const std::string still = write("still.gltf", R"({"asset": {"version": "2.0"},
    "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "buffers": [{"byteLength": 36, "uri":
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]})");
  EXPECT_THAT(run_sunder({"info", still}).out,
              HasSubstr("static     no clips, and no skin of several bones"));
}

TEST_F(InfoCommand, info_counts_the_parts_of_a_model) {
  const CommandResult result = run_sunder({"info", model(), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json info = json::parse(result.out);
  EXPECT_EQ(info["sunder_info"], 1);
  EXPECT_EQ(info["meshes"].size(), 2u);
  EXPECT_EQ(info["clips"][0]["name"], "Sway");
  EXPECT_DOUBLE_EQ(info["clips"][0]["duration"].get<double>(), 2.0);
  EXPECT_EQ(info["topology"]["components"], 2);
  EXPECT_EQ(info["topology"]["boundary_loops"], 0);
  EXPECT_EQ(info["topology"]["non_manifold_edges"], 0);
  EXPECT_NEAR(info["bounds"]["min"][1].get<double>(), 0.0, 1e-6);
  EXPECT_NEAR(info["weight_sum_max"].get<double>(), 1.0, 1e-6);
  for (const json& mesh : info["meshes"]) EXPECT_GE(mesh["vertices"], mesh["points"]);
}

TEST_F(InfoCommand, info_speaks_to_people_too) {
  const CommandResult result = run_sunder({"info", model()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("'Cactus'"));
  EXPECT_THAT(result.out, HasSubstr("clip 0"));
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(InfoCommand, materials_have_the_indices_that_operations_take) {
  test::GltfBuilder builder;
  builder.json["scene"] = 0;
  builder.json["materials"].push_back({{"name", "unused"}});
  add_square(builder, 0, 0, {{"name", "second"}});
  add_square(builder, 1, 0, {{"name", "third"}});
  std::swap(builder.json["scenes"][0]["nodes"][0], builder.json["scenes"][0]["nodes"][1]);
  const std::vector<std::byte> glb = builder.glb();
  write("materials.glb", {reinterpret_cast<const char*>(glb.data()), glb.size()});
  const CommandResult result = run_sunder({"info", path("materials.glb")});
  EXPECT_THAT(result.out, HasSubstr("material 1 'second': 2 triangles"));
  EXPECT_THAT(result.out, HasSubstr("material 2 'third': 2 triangles"));
}

TEST_F(InfoCommand, an_unreadable_model_exits_with_3) {
  for (const std::string& file :
       {path("no such.glb"), write("garbage.glb", "not a model"), write("text.txt", "hello")}) {
    const CommandResult result = run_sunder({"info", file});
    EXPECT_EQ(result.exit_code, 3) << file;
    EXPECT_THAT(result.err, HasSubstr(file));
    EXPECT_THAT(result.out, IsEmpty());
  }
}

}  // namespace
}  // namespace sunder::command_test
