// The command writes USD where the output's name asks for it.
#include <algorithm>

#include "support/models/gltf_builder.h"
#include "tools/command_fixture.h"
#include "tools/textured_squares.h"

namespace sunder::command_test {
namespace {

class UsdCommand : public CactusSuite {
 protected:
  static void SetUpTestSuite() {
    CactusSuite::SetUpTestSuite();
    write("one.json", kOneTear);
  }
  static std::string text(const std::string& name) {
    const std::vector<std::byte> found = bytes(name);
    return {reinterpret_cast<const char*>(found.data()), found.size()};
  }
};

TEST_F(UsdCommand, tears_write_what_the_output_is_called) {
  const CommandResult as_text =
      run_sunder({"tear", model(), "--ops", path("one.json"), "-o", path("torn.usda")});
  ASSERT_EQ(as_text.exit_code, 0) << as_text.err;
  EXPECT_EQ(as_text.err.find("warning"), std::string::npos) << as_text.err;
  EXPECT_EQ(as_text.err.find("does not end in"), std::string::npos) << as_text.err;
  EXPECT_TRUE(text("torn.usda").starts_with("#usda 1.0\n"));
  EXPECT_FALSE(exists("torn_textures")) << "the cactus has no textures";
  ASSERT_EQ(
      run_sunder({"tear", model(), "--ops", path("one.json"), "-o", path("torn.USDZ")}).exit_code,
      0);
  const std::string package = text("torn.USDZ");
  EXPECT_TRUE(package.starts_with("PK"));
  EXPECT_NE(package.find(text("torn.usda")), std::string::npos) << "the same text, stored";
}

TEST_F(UsdCommand, open_lips_and_pieces_are_written_alike) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", path("one.json"), "--open", "-o", path("open.usda")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(text("open.usda"), HasSubstr("def BlendShape \"Open"));
  const CommandResult severed = run_sunder({"tear", model(), "--sever", "Trunk4@0.5", "--pieces",
                                            path("piece"), "-o", path("severed.usda")});
  ASSERT_LE(severed.exit_code, 1) << severed.err;
  EXPECT_TRUE(text("piece1.usda").starts_with("#usda 1.0\n"));
}

TEST_F(UsdCommand, textures_are_files_beside_the_text) {
  test::GltfBuilder builder;
  add_square(builder, 0, 0, textured(add_texture(builder, Texel{200, 30, 40, 255})));
  const std::vector<std::byte> glb = builder.glb();
  write("square.glb", {reinterpret_cast<const char*>(glb.data()), glb.size()});
  write("none.json", R"({"sunder_operations": 1, "operations": []})");
  for (const char* const output : {"a b@c.usda", "package.usdz"}) {
    const CommandResult result =
        run_sunder({"tear", path("square.glb"), "--ops", path("none.json"), "-o", path(output)});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  const std::string usd = text("a b@c.usda"), package = text("package.usdz");
  const std::size_t name = usd.find("@./a_b_c_textures/image_0_");
  ASSERT_NE(name, std::string::npos);
  const std::string image = usd.substr(name + 3, usd.find('@', name + 3) - name - 3);
  const std::string png = text(image);
  EXPECT_TRUE(png.starts_with("\x89PNG"));
  EXPECT_NE(package.find(image.substr(image.find("textures/"))), std::string::npos);
  EXPECT_NE(package.find(png), std::string::npos);
}

TEST_F(UsdCommand, what_makes_no_sense_with_it_is_named) {
  const auto refused = [&](const std::vector<std::string>& more, const std::string& output) {
    std::vector<std::string> arguments = {"tear",           model(), "--ops",
                                          path("one.json"), "-o",    path(output)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run_sunder(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_FALSE(exists(output));
    return result.err;
  };
  EXPECT_THAT(refused({"--weights-as", "u8"}, "no.usda"), HasSubstr("--weights-as: is for GLB"));
  EXPECT_THAT(refused({"--max-error", "1mm"}, "no.usdz"), HasSubstr("--max-error: is for GLB"));
  EXPECT_THAT(refused({}, "no.usdc"), HasSubstr("'.usdc' is not written"));
}

TEST_F(UsdCommand, transfer_and_bind_write_it_too) {
  const CommandResult moved = run_sunder({"transfer", model(), model(), "-o", path("moved.usda")});
  ASSERT_LE(moved.exit_code, 1) << moved.err;
  EXPECT_TRUE(text("moved.usda").starts_with("#usda 1.0\n"));
  const CommandResult bound =
      run_sunder({"bind", model(), "--skeleton", model(), "-o", path("bound.usdz")});
  ASSERT_LE(bound.exit_code, 1) << bound.err;
  EXPECT_TRUE(text("bound.usdz").starts_with("PK"));
  EXPECT_THAT(run_sunder({"bind", model(), "--skeleton", model(), "-o", path("bound.usda"),
                          "--weights-as", "u16"})
                  .err,
              HasSubstr("--weights-as: is for GLB"));
}

TEST_F(UsdCommand, is_not_read_and_says_why) {
  write("in.usda", "#usda 1.0\n");
  const CommandResult result = run_sunder({"info", path("in.usda")});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("USD"));
}

}  // namespace
}  // namespace sunder::command_test
