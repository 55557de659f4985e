// `sunder tear --wound-mask` from the outside.

#include "tools/command_fixture.h"
#include "tools/picture_pixels.h"

namespace sunder::command_test {
namespace {

using testing::HasSubstr;

class WoundMaskCommand : public CactusSuite {
 protected:
  static CommandResult tear(const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "tear", model(), "--ops", write("ops.json", kStroke), "-o", path(name + ".glb")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sunder(arguments);
  }

  static constexpr const char* kStroke = R"({"sunder_operations": 1,
    "operations": [{"op": "drill", "axis": {"origin": [0, 0.9, 2], "direction": [0, 0, -1]},
                    "radius": 0.05, "depth": 4}]})";
};

TEST_F(WoundMaskCommand, paints_lips_red_and_holes_green) {
  const CommandResult result = tear("torn", {"--wound-mask", path("wound.png"), "--wound-mask-size",
                                             "256", "--wound-mask-reach", "0.05"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("wrote " + path("wound.png")));
  const auto pixels = test::read_png(path("wound.png"));
  ASSERT_TRUE(pixels);
  EXPECT_EQ(pixels->width, 256);
  EXPECT_EQ(pixels->height, 256);
  const auto count_of = [&](auto counts) {
    const auto box = test::box_of(*pixels, counts);
    return box ? box->count : 0;
  };
  using Color = test::Pixels::Color;
  const int used = count_of([](const Color&c) { return c[2] == 255; }),
            near_lips = count_of([](const Color&c) { return c[0] > 0; }),
            removed = count_of([](const Color&c) { return c[1] == 255; });
  EXPECT_GT(removed, 0);
  EXPECT_GT(near_lips, removed);
  EXPECT_GT(used, 2 * near_lips);
  EXPECT_EQ(count_of([](const Color& c) { return c[1] == 255 && c[0] != 255; }), 0)
      << "what was removed is red too";
}

TEST_F(WoundMaskCommand, options_out_of_range_are_refused) {
  for (const char* const size : {"0", "16385"})
    EXPECT_EQ(tear("no", {"--wound-mask", path("no.png"), "--wound-mask-size", size}).exit_code, 2);
  EXPECT_EQ(tear("no", {"--wound-mask", path("no.png"), "--wound-mask-reach", "0"}).exit_code, 2);
  EXPECT_EQ(tear("no", {"--wound-mask-size", "64"}).exit_code, 2) << "it needs --wound-mask";
  EXPECT_FALSE(exists("no.png"));
}

}  // namespace
}  // namespace sunder::command_test
