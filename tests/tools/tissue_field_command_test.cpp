// `sunder tear --tissue-field` from the outside.

#include <sunder/particles/authored_tissue.h>

#include <fstream>
#include <memory>

#include "tools/command_fixture.h"
#include "tools/picture_pixels.h"

namespace sunder::command_test {
namespace {

/// One wound on the trunk's upper part, one on its lower part.
constexpr const char* kTwoWounds = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "stroke": [{"base": [-0.1, 1.4, 2], "tip": [-0.1, 1.4, 0]},
                            {"base": [-0.1, 1.62, 2], "tip": [-0.1, 1.62, 0]}]},
  {"op": "tear", "stroke": [{"base": [-0.1, 0.35, 2], "tip": [-0.1, 0.35, 0]},
                            {"base": [-0.1, 0.55, 2], "tip": [-0.1, 0.55, 0]}]}]})";

class TissueFieldCommand : public CactusSuite {
 protected:
  /// How far each wound gapes, metres.
  static std::vector<double> gaps(const std::string& from, const std::vector<std::string>& fields) {
    std::vector<std::string> arguments = {"tear",
                                          from,
                                          "--ops",
                                          write("two.json", kTwoWounds),
                                          "-o",
                                          path("out.glb"),
                                          "--force",
                                          "--report",
                                          path("out.json"),
                                          "--open"};
    for (const std::string& field : fields) {
      arguments.emplace_back("--tissue-field");
      arguments.push_back(field);
    }
    const CommandResult result = run_sunder(arguments);
    EXPECT_LE(result.exit_code, 1) << result.err;
    return result.exit_code > 1 ? std::vector<double>(2)
                                : read_json("out.json")["open"]["gaps"].get<std::vector<double>>();
  }
};

/// The width of a slit in a membrane on a foundation goes with the tension. Where it is short, it
/// goes with one over the stiffness; where it is long, with one over the root of the stiffness.
TEST_F(TissueFieldCommand, lips_gape_as_a_membrane_on_a_foundation_does) {
  const std::vector<double> uniform = gaps(model(), {});
  ASSERT_EQ(uniform.size(), 2u);
  const auto everywhere = [&](const std::string& factor, const std::string& value) {
    return gaps(model(), {factor + "=bone:Trunk4,at_zero=" + value + ",at_one=" + value});
  };
  struct Case {
    const char *factor, *value;
    double least, most;
  };
  for (const Case& of : {Case{"tension", "0.25", 0.245, 0.255},
                         {"stiffness", "4", 0.25, 0.5},
                         {"thickness", "2", 0.49, 0.51},
                         {"tension", "1", 1 - 1e-6, 1 + 1e-6}}) {
    SCOPED_TRACE(of.factor);
    const std::vector<double> found = everywhere(of.factor, of.value);
    for (std::size_t w = 0; w < 2; ++w) {
      EXPECT_GT(found[w] / uniform[w], of.least);
      EXPECT_LT(found[w] / uniform[w], of.most);
    }
  }
}

TEST_F(TissueFieldCommand, a_field_changes_only_the_wound_where_it_differs) {
  const std::vector<double> uniform = gaps(model(), {}),
                            half = gaps(model(), {"tension=bone:Trunk4,at_one=0.5"}),
                            both = gaps(model(), {"tension=bone:Trunk4,at_one=0.5",
                                                  "stiffness=bone:Trunk1,at_one=4"});
  EXPECT_NEAR(half[0], 0.5 * uniform[0], 0.1 * uniform[0]) << "Trunk3 moves it a little";
  EXPECT_NEAR(half[1], uniform[1], 1e-6 * uniform[1]);
  EXPECT_NEAR(both[0], half[0], 1e-3 * half[0]);
  EXPECT_LT(both[1], 0.8 * uniform[1]);
}

/// The same values in a bone's weights, in colours, in an attribute and in an image.
TEST_F(TissueFieldCommand, all_sources_are_read_alike) {
  Character painted = tools::make_cactus();
  for (std::uint32_t m = 0; m < painted.meshes.size(); ++m) {
    Mesh& mesh = painted.meshes[m];
    const std::vector<float> values = *sample_field(painted, m, {BoneWeight{"Trunk4"}, 0.0, 1.0});
    mesh.color_sets.assign(1, {});
    for (const float value : values) mesh.color_sets[0].emplace_back(0.0f, value, 0.0f, 1.0f);
    if (mesh.name == "Pot") continue;  // Without the attribute a mesh has the factor 1.
    CustomAttribute attribute = {"_CHARRED", 2, true, {}};
    for (const float value : values) {
      attribute.values.push_back(0.0f);
      attribute.values.push_back(value);
    }
    mesh.custom_attributes.push_back(attribute);
    mesh.uv_sets.resize(1);
    mesh.uv_sets[0].clear();
    for (const float value : values) mesh.uv_sets[0].emplace_back(0.25f + 0.5f * value, 0.5f);
  }
  const std::string file = path("painted.glb");
  ASSERT_TRUE(save_glb(file, painted));
  const std::vector<std::byte> png = test::make_png(2, 1, {{0, 0, 0, 255}, {0, 255, 0, 255}});
  std::ofstream(path("mask.png"), std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  const std::vector<double> bone = gaps(file, {"tension=bone:Trunk4,at_one=0.5"});
  EXPECT_LT(bone[0], 0.8 * bone[1]);
  for (const std::string& source :
       {std::string("color:COLOR_0,channel=g"), std::string("attribute:_CHARRED,component=1"),
        "texture:" + path("mask.png") + ",channel=g,uv=0"}) {
    const std::vector<double> found = gaps(file, {"tension=" + source + ",at_one=0.5"});
    for (std::size_t w = 0; w < 2; ++w) EXPECT_NEAR(found[w], bone[w], 0.01 * bone[w]) << source;
  }
  const CommandResult over =
      run_sunder({"tear", file, "--ops", write("two.json", kTwoWounds), "-o", path("mask.png"),
                  "--open", "--tissue-field", "tension=texture:" + path("mask.png")});
  EXPECT_EQ(over.exit_code, 2);
  EXPECT_THAT(over.err, HasSubstr("--tissue-field"));
}

TEST_F(TissueFieldCommand, tissue_without_tension_stays_shut) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("two.json", kTwoWounds), "-o", path("shut.glb"),
                  "--open", "--tissue-field", "tension=bone:Trunk4,at_zero=0,at_one=0"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("--open: no operation left lips that could gape"));
}

TEST_F(TissueFieldCommand, pictures_show_fields) {
  const auto picture = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "tear", model(),           "--ops",  write("one.json", kOneTear), "--picture", path(name),
        "-o",   path("drawn.glb"), "--force"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_sunder(arguments).exit_code, 0);
    return bytes(name);
  };
  EXPECT_NE(picture("with.png", {"--tissue-field", "tension=bone:Trunk3,at_one=0.2"}),
            picture("without.png", {}));
}

TEST_F(TissueFieldCommand, wrong_fields_are_explained) {
  const std::string log = write("one.json", kOneTear);
  write("text.png", "no image");
  struct Case {
    std::string field;
    int code;
    const char* told;
  };
  for (const Case& of : {Case{"strength=bone:Trunk1", 2, "only where force tears"},
                         {"perforation=bone:Trunk1", 2, "only where force tears"},
                         {"toughness=bone:Trunk1", 2, "only where force tears"},
                         {"weight=bone:Trunk1", 2, "stiffness, tension or thickness"},
                         {"tension", 2, "texture:FILE.png"},
                         {"tension=bones:Trunk1", 2, "bone:NAME"},
                         {"tension=bone:", 2, "bone:NAME"},
                         {"tension=bone:Trunk9", 2, "did you mean"},
                         {"tension=color:0", 2, "color:COLOR_0"},
                         {"tension=color:COLOR_7", 2, "has no colours 7"},
                         {"tension=color:COLOR_0,channel=x", 2, "channel=r, g, b or a"},
                         {"tension=attribute:_NONE", 2, "'_NONE'"},
                         {"tension=bone:Trunk1,channel=r", 2, "channel of colours"},
                         {"tension=bone:Trunk1,at_one=x", 2, "a number"},
                         {"tension=bone:Trunk1,at_one=2,at_one=3", 2, "given twice"},
                         {"tension=bone:Trunk1,at_one=-1", 2, "the factor of tension is"},
                         {"stiffness=bone:Trunk1", 2, "must be from 0.001"},
                         {"tension=texture:" + path("none.png"), 3, "none.png"},
                         {"tension=texture:" + path("text.png"), 2, "text.png"}}) {
    const CommandResult result = run_sunder(
        {"tear", model(), "--ops", log, "-o", path("x.glb"), "--open", "--tissue-field", of.field});
    EXPECT_EQ(result.exit_code, of.code) << of.field;
    EXPECT_THAT(result.err, HasSubstr("--tissue-field " + of.field)) << of.field;
    EXPECT_THAT(result.err, HasSubstr(of.told)) << of.field;
    EXPECT_FALSE(exists("x.glb"));
  }
  const CommandResult alone = run_sunder({"tear", model(), "--ops", log, "-o", path("x.glb"),
                                          "--tissue-field", "tension=bone:Trunk1"});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_THAT(alone.err, HasSubstr("needs --open or --picture"));
  const CommandResult twice =
      run_sunder({"tear", model(), "--ops", log, "-o", path("x.glb"), "--open", "--tissue-field",
                  "tension=bone:Trunk1", "--tissue-field", "tension=bone:Trunk2"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("a second field of tension"));
}

}  // namespace
}  // namespace sunder::command_test
