// The record of torn files, and tools/check_torn.mjs, which proves them from the source.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <cstdlib>
#include <cstring>
#include <utility>

#include "support/machine/gltf_validator.h"
#include "support/machine/node_program.h"
#include "support/machine/stress.h"
#include "support/models/gltf_builder.h"
#include "support/models/shared_models.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

using test::rigged_models;

struct Check {
  int exit_code = -1;
  std::string output;
};

Check check_torn(const std::string& source, const std::string& torn, const std::string& more = "") {
  const auto run =
      test::run_node_program("../../tools/check_torn.mjs",
                             "'" + source + "' '" + torn + "' " + more + " 2>&1; echo exit $?");
  if (!run) return {};
  const std::size_t end = run->output.rfind("exit ");
  return {std::atoi(run->output.c_str() + end + 5), run->output.substr(0, end)};
}

/// Every kind of operation, placed by the bounds of a model.
std::string operations_for(const Character& character) {
  Vec3d low = Vec3d::Constant(1e30), high = -low;
  const auto info = make_pose(character, RestPose{});
  if (!info) return "";
  for (const Mesh& mesh : character.meshes) {
    DeformedMesh posed;
    std::vector<Affine3f> palette(character.skins[mesh.skin].bones.size());
    if (!compute_palette(character.skins[mesh.skin], *info, palette) ||
        !deform_mesh(mesh, palette, info->morph_weights, posed))
      return "";
    for (const Vec3f& at : posed.positions) {
      low = low.cwiseMin(at.cast<double>());
      high = high.cwiseMax(at.cast<double>());
    }
  }
  const Vec3d middle = 0.5 * (low + high), extent = high - low;
  const double size = extent.maxCoeff();
  const auto at = [&](double x, double y, double z) {
    return json{middle.x() + x * extent.x(), middle.y() + y * extent.y(), middle.z() + z * size};
  };
  const auto stroke = [&](double x0, double y0, double x1, double y1) {
    return json{{{"base", at(x0, y0, 1)}, {"tip", at(x0, y0, -1)}},
                {{"base", at(x1, y1, 1)}, {"tip", at(x1, y1, -1)}}};
  };
  const json operations = {
      {{"op", "tear"}, {"wall_depth", 0.01 * size}, {"stroke", stroke(-0.6, -0.1, 0.6, 0.15)}},
      {{"op", "cut"},
       {"plane", {{"point", at(0, 0.05, 0)}, {"normal", {0.1, 1, 0.1}}}},
       {"caps", true}},
      {{"op", "tear"}, {"layers", "all"}, {"stroke", stroke(-0.05, -0.7, 0.06, 0.7)}},
      {{"op", "tear"}, {"width", 0.02 * size}, {"stroke", stroke(-0.4, -0.3, 0.4, -0.2)}},
      {{"op", "drill"},
       {"axis", {{"origin", at(0.03, 0.2, 1)}, {"direction", {0, 0, -1}}}},
       {"radius", 0.04 * size},
       {"depth", 2 * size},
       {"wall", true}}};
  return json{{"sunder_operations", 1}, {"operations", operations}}.dump();
}

class TornFile : public CactusSuite {
 protected:
  void SetUp() override {
    if (!test::has_node_packages({})) GTEST_SKIP() << "needs node";
  }

  static std::string torn(const std::string& source, const std::string& log,
                          const std::string& name, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"tear", source, "--ops", log, "-o", path(name), "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run_sunder(arguments);
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << source << '\n' << result.err;
    return path(name);
  }

  static json document_of(const std::string& file) {
    const std::vector<std::byte> all = test::read_bytes(file);
    std::uint32_t length = 0;
    std::memcpy(&length, all.data() + 12, 4);
    return json::parse(std::string(reinterpret_cast<const char*>(all.data()) + 20, length));
  }

  /// A copy of a file in which a float of an attribute of the first primitive with a record is
  /// something else.
  static std::string with_other_float(const std::string& file, const char* attribute,
                                      std::uint32_t vertex, float change) {
    std::vector<std::byte> all = test::read_bytes(file);
    const json document = document_of(file);
    std::uint32_t length = 0;
    std::memcpy(&length, all.data() + 12, 4);
    const json& primitive = first_recorded(document);
    const json& accessor =
        document["accessors"][primitive["attributes"][attribute].get<std::size_t>()];
    const json& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t components = accessor["type"].get<std::string>()[3] - '0';
    const std::size_t at = 28 + length + view.value("byteOffset", std::size_t{0}) +
                           accessor.value("byteOffset", std::size_t{0}) + 4 * components * vertex;
    float value = 0;
    std::memcpy(&value, all.data() + at, 4);
    value += change;
    std::memcpy(all.data() + at, &value, 4);
    std::ofstream(path("changed.glb"), std::ios::binary)
        .write(reinterpret_cast<const char*>(all.data()), static_cast<std::streamsize>(all.size()));
    return path("changed.glb");
  }

  static const json& first_recorded(const json& document) {
    static const json none;
    for (const json& mesh : document["meshes"])
      for (const json& primitive : mesh["primitives"])
        if (primitive.contains("extensions") &&
            primitive["extensions"].contains("SUNDER_torn_mesh"))
          return primitive;
    return none;
  }
};

TEST_F(TornFile, of_every_rigged_model_is_proved) {
  const std::string nothing =
      write("nothing.json", R"({"sunder_operations": 1, "operations": []})");
  int proved = 0;
  for (const auto& file : rigged_models({".glb", ".gltf", ".fbx", ".dae", ".x", ".b3d"})) {
    const auto loaded = load_character(file);
    ASSERT_TRUE(loaded) << file;
    const std::string log = write("log.json", operations_for(*loaded->character));
    const std::string result = torn(file.string(), log, "torn.glb");
    // Of other formats the source is the GLB to which they are converted.
    const bool is_gltf = file.extension() == ".glb" || file.extension() == ".gltf";
    const std::string source =
        is_gltf ? file.string() : torn(file.string(), nothing, "converted.glb");
    const Check check = check_torn(source, result);
    EXPECT_EQ(check.exit_code, 0) << file << '\n' << check.output.substr(0, 2000);
    ++proved;
  }
  EXPECT_GE(proved, test::shared_models().empty() ? 8 : 22);
}

TEST_F(TornFile, is_proved_whatever_its_weights_and_lips_are) {
  const std::string all = write("all.json", kAll), weighed = write("weighed.json", kWeighed);
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {},
           {"--influences", "4"},
           {"--influences", "all"},
           {"--weights-as", "u8"},
           {"--weights-as", "u16"},
           {"--max-error", "1mm"},
           {"--weights", "pose_exact"},
           {"--weights", "refit", "--weights-as", "u8", "--influences", "4"},
           {"--weights", "exact"},
           {"--open"},
           {"--flesh", "source"},
           {"--weld", "all"}})
    for (const std::string& log : {all, weighed}) {
      const std::string result = torn(model(), log, "torn.glb", options);
      const Check check = check_torn(model(), result);
      EXPECT_EQ(check.exit_code, 0) << testing::PrintToString(options) << '\n'
                                    << check.output.substr(0, 2000);
    }
}

TEST_F(TornFile, marks_scars_and_says_when_there_is_nothing_to_weld) {
  const std::string log = write("one.json", kOneTear);
  const json welded = document_of(
      torn(model(), log, "welded.glb", {"--weld", "all", "--save-log", path("w.json")}));
  EXPECT_TRUE(first_recorded(welded)["attributes"].contains("_SCAR"));
  EXPECT_FALSE(
      first_recorded(document_of(torn(model(), log, "torn.glb")))["attributes"].contains("_SCAR"));
  // The log that was saved does the same.
  torn(model(), path("w.json"), "again.glb");
  EXPECT_EQ(test::read_bytes(path("again.glb")), test::read_bytes(path("welded.glb")));
  const CommandResult twice = run_sunder({"tear", model(), "--ops", log, "-o", path("twice.glb"),
                                          "--weld", "all", "--weld", "0/1/0,reach=0.1"});
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_NE(twice.err.find("no lips lie on one another"), std::string::npos) << twice.err;
  for (const char* bad : {"nowhere", "0/1", "0/1/0,reach=-1", "0/1/0,width=1", "all,reach=1"})
    EXPECT_EQ(
        run_sunder({"tear", model(), "--ops", log, "-o", path("bad.glb"), "--weld", bad}).exit_code,
        2)
        << bad;
}

TEST_F(TornFile, opens_less_where_wounds_are_sewn) {
  const std::string log = write("one.json", kOneTear);
  const auto widest_gap = [&](const std::vector<std::string>& more) {
    std::vector<std::string> options = {"--open", "--report", path("r.json")};
    options.insert(options.end(), more.begin(), more.end());
    torn(model(), log, "open.glb", options);
    return json::parse(test::read_bytes(path("r.json")))["open"]["widest_gap"].get<double>();
  };
  const double open = widest_gap({});
  EXPECT_LT(widest_gap({"--suture", "all,spacing=0.05", "--save-log", path("s.json")}), 0.5 * open);
  EXPECT_NEAR(widest_gap({"--suture", "all,strength=1e-9"}), open, 0.05 * open);
  const json logged = json::parse(test::read_bytes(path("s.json")))["operations"].back();
  EXPECT_EQ(logged["op"], "suture");
  EXPECT_EQ(logged["spacing"], 0.05);
  for (const char* bad : {"nowhere", "all,spacing=-1", "all,width=1", "all,spacing", "all,reach=1"})
    EXPECT_EQ(run_sunder({"tear", model(), "--ops", log, "-o", path("bad.glb"), "--suture", bad})
                  .exit_code,
              2)
        << bad;
}

TEST_F(TornFile, with_policies_tells_how_many_vertices_are_fitted) {
  const std::string result = torn(model(), write("weighed.json", kWeighed), "weighed.glb");
  const Check check = check_torn(model(), result, "--json");
  ASSERT_EQ(check.exit_code, 0) << check.output;
  const json report = json::parse(check.output);
  EXPECT_GT(report["meshes"][0]["fitted"], 0);
  EXPECT_GT(report["meshes"][0]["derived"], report["meshes"][0]["fitted"]);
  EXPECT_GT(report["meshes"][0]["reduced"], 0);
}

TEST_F(TornFile, that_was_changed_is_refused_by_vertex_and_attribute) {
  const std::string result = torn(model(), write("one.json", kOneTear), "one.glb");
  const json document = document_of(result);
  const json& record = first_recorded(document)["extensions"]["SUNDER_torn_mesh"];
  const auto created = record["firstVertex"].get<std::uint32_t>();
  for (const std::uint32_t vertex : {created + 3, created - 1})
    for (const char* const attribute : {"POSITION", "NORMAL", "TEXCOORD_0", "WEIGHTS_0"}) {
      if (!first_recorded(document)["attributes"].contains(attribute)) continue;
      const Check check = check_torn(model(), with_other_float(result, attribute, vertex, -0.001f));
      EXPECT_EQ(check.exit_code, 1) << attribute << '\n' << check.output;
      EXPECT_THAT(check.output, HasSubstr("vertex " + std::to_string(vertex) + ": " +
                                          std::string(attribute).substr(0, 7)));
    }
}

TEST_F(TornFile, cannot_be_checked_without_its_source_or_record) {
  const std::string log = write("one.json", kOneTear);
  const std::string result = torn(model(), log, "one.glb");
  EXPECT_EQ(check_torn((test::own_data() / "rigged/tube.glb").string(), result).exit_code, 2);
  EXPECT_EQ(check_torn(model(), torn(model(), log, "bare.glb", {"--no-origins"})).exit_code, 2);
  EXPECT_EQ(check_torn(model(), torn(model(), log, "baked.glb", {"--open=baked"})).exit_code, 2);
  EXPECT_EQ(check_torn(model(), path("absent.glb")).exit_code, 2);
  std::vector<std::byte> half = test::read_bytes(result);
  half.resize(half.size() / 2);
  std::ofstream(path("half.glb"), std::ios::binary)
      .write(reinterpret_cast<const char*>(half.data()), static_cast<std::streamsize>(half.size()));
  const Check check = check_torn(model(), path("half.glb"));
  EXPECT_EQ(check.exit_code, 2);
  EXPECT_THAT(check.output, HasSubstr("truncated"));
}

TEST_F(TornFile, of_a_model_with_a_flat_or_huge_node_is_written_and_proved) {
  const std::vector<std::byte> tube =
      test::read_bytes((test::own_data() / "rigged/tube.glb").string());
  const auto log = [&] {
    const auto loaded = load_character((test::own_data() / "rigged/tube.glb").string());
    return write("log.json", operations_for(*loaded->character));
  }();
  const std::pair<const char*, bool> cases[] = {
      {R"({"scale": [0, 0, 0]})", false},         {R"({"scale": [1e-10, 1e-10, 1e-10]})", true},
      {R"({"scale": [1, 0, 1]})", false},         {R"({"scale": [1e30, 1e30, 1e30]})", true},
      {R"({"translation": [3e38, 0, 0]})", true}, {R"({"translation": [1, 0, 0]})", true}};
  for (const auto& [transform, has_bound] : cases) {
    // A triangle of its own below the last joint, so that it becomes a bone.
    auto builder = test::GltfBuilder::from_glb(tube);
    test::Json prop = test::Json::parse(transform);
    prop["mesh"] = builder.json["meshes"].size();
    const std::size_t positions =
        builder.add(std::vector<float>{0, 0, 0, 0.1f, 0, 0, 0, 0.1f, 0}, "VEC3");
    builder.json["accessors"][positions]["min"] = {0.0, 0.0, 0.0};
    builder.json["accessors"][positions]["max"] = {0.1f, 0.1f, 0.0};
    builder.json["meshes"].push_back(
        {{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
    test::Json& joint = builder.json["nodes"][builder.json["skins"][0]["joints"].back().get<int>()];
    joint["children"].push_back(builder.json["nodes"].size());
    builder.json["nodes"].push_back(prop);
    const std::vector<std::byte> all = builder.glb();
    const std::string source = path("prop.glb");
    std::ofstream(source, std::ios::binary)
        .write(reinterpret_cast<const char*>(all.data()), static_cast<std::streamsize>(all.size()));
    const std::string result = torn(source, log, "torn_prop.glb");
    const json document = document_of(result);
    ASSERT_TRUE(document.contains("extensions")) << transform;
    const json& record = document["extensions"]["SUNDER_torn_mesh"];
    EXPECT_EQ(record.contains("placeBound"), has_bound) << transform << record;
    const Check check = check_torn(source, result);
    EXPECT_EQ(check.exit_code, 0) << transform << '\n' << check.output.substr(0, 2000);
  }
}

TEST_F(TornFile, reads_as_if_it_had_no_record) {
  const std::string log = write("all.json", kAll);
  const std::string with = torn(model(), log, "with.glb"),
                    without = torn(model(), log, "without.glb", {"--no-origins"});
  const auto one = load_character(with), other = load_character(without);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(*one->character, *other->character);
  EXPECT_EQ(document_of(without).contains("extensionsUsed"), false);
  if (!test::has_gltf_validator()) GTEST_SKIP() << "needs gltf-validator";
  const auto report = test::validate_glb(with);
  EXPECT_EQ(report.errors, 0) << report.output;
}

TEST_F(TornFile, follows_the_schema) {
  std::ifstream stream(SUNDER_SOURCE_DIR "/docs/torn_file.schema.json");
  json schema = json::parse(stream);
  const std::string result =
      torn(model(), write("all.json", kAll), "all.glb", {"--max-error", "1mm"});
  const json document = document_of(result);
  const auto faults = [&](const json& of, const json& value) {
    const auto run =
        test::run_node_program("schema.mjs", "'" + write("schema.json", of.dump()) + "' '" +
                                                 write("value.json", value.dump()) + "'");
    return run ? run->output : std::string("node did not run");
  };
  EXPECT_EQ(faults(schema, document["extensions"]["SUNDER_torn_mesh"]), "[]\n");
  const json of_primitive = {{"$ref", "#/$defs/primitive"}, {"$defs", schema["$defs"]}};
  json record = first_recorded(document)["extensions"]["SUNDER_torn_mesh"];
  EXPECT_EQ(faults(of_primitive, record), "[]\n");
  record["firstVertex"] = -1;
  EXPECT_NE(faults(of_primitive, record), "[]\n");
}

TEST_F(TornFile, that_is_torn_again_tells_of_the_last_tear) {
  const std::string first = torn(model(), write("one.json", kOneTear), "first.glb"),
                    second = torn(first, write("all.json", kAll), "second.glb");
  EXPECT_EQ(check_torn(first, second).exit_code, 0);
  EXPECT_EQ(check_torn(model(), second).exit_code, 2);
  const std::string bare = torn(first, write("all.json", kAll), "bare.glb", {"--no-origins"});
  EXPECT_TRUE(first_recorded(document_of(bare)).is_null());
  EXPECT_FALSE(document_of(bare).contains("extensions"));
}

TEST_F(TornFile, with_another_document_is_refused) {
  std::string pairs;
  for (const char* const option : {"--quiet", "--open"}) {
    const std::string result =
        torn(model(), write("all.json", kAll), std::string(option).substr(2) + ".glb", {option});
    pairs += " '" + model() + "' '" + result + "'";
  }
  const std::string sheet = (test::own_data() / "rigged/seamed_sheet.glb").string();
  const auto loaded = load_character(sheet);
  ASSERT_TRUE(loaded);
  pairs += " '" + sheet + "' '" +
           torn(sheet, write("log.json", operations_for(*loaded->character)), "sheet.glb") + "'";
  const auto run = test::run_node_program("torn_mutants.mjs", "0 1" + pairs);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run->succeeded) << run->output.substr(0, 3000);
  const json counts = json::parse(run->output, nullptr, false);
  ASSERT_TRUE(counts.is_object()) << run->output.substr(0, 3000);
  EXPECT_GE(counts["documents"].size(), 20u);
  EXPECT_EQ(counts["documents"]["no node has a mesh"], 3);
  EXPECT_EQ(counts["documents"]["a chain of new vertices between all of the source"], 3);
}

TEST_F(TornFile, of_which_a_mesh_is_gone_says_so_and_is_proved) {
  // Two nodes with a mesh of their own, and a bore with which the smaller one goes.
  auto builder = test::GltfBuilder::from_glb(
      test::read_bytes((test::own_data() / "rigged/tube.glb").string()));
  const std::size_t positions =
      builder.add(std::vector<float>{9, 0, 0, 9.1f, 0, 0, 9, 0.1f, 0}, "VEC3");
  builder.json["accessors"][positions]["min"] = {9.0, 0.0, 0.0};
  builder.json["accessors"][positions]["max"] = {9.1f, 0.1f, 0.0};
  const std::size_t node = builder.json["nodes"].size();
  builder.json["nodes"].push_back({{"mesh", builder.json["meshes"].size()}});
  builder.json["scenes"][0]["nodes"].push_back(node);
  builder.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
  const std::vector<std::byte> all = builder.glb();
  const std::string source = path("two.glb");
  std::ofstream(source, std::ios::binary)
      .write(reinterpret_cast<const char*>(all.data()), static_cast<std::streamsize>(all.size()));
  const json bore = {{"op", "drill"},
                     {"axis", {{"origin", {9.05, 0.05, 1}}, {"direction", {0, 0, -1}}}},
                     {"radius", 0.5},
                     {"depth", 2}};
  json log = json::parse(operations_for(*load_character(source)->character));
  log["operations"] = json::array({bore, log["operations"][1]});
  log["operations"][1]["plane"]["point"] = {0, 0.5, 0};
  const std::string result = torn(source, write("log.json", log.dump()), "one_of_two.glb");
  const json document = document_of(result);
  ASSERT_FALSE(document["nodes"][node].contains("mesh"));
  EXPECT_EQ(document["extensions"]["SUNDER_torn_mesh"]["gone"],
            json::array({{{"node", node}, {"primitives", {0}}}}));
  const Check check = check_torn(source, result);
  EXPECT_EQ(check.exit_code, 0) << check.output.substr(0, 2000);
}

TEST_F(TornFile, with_one_other_byte_is_refused_or_harmless) {
  // Small files, so that many mutants can be checked: a wall, a cap, a gap and a tear.
  const std::pair<const char*, std::size_t> cases[] = {
      {"seamed_sheet", 0}, {"tube_weights_u8", 1}, {"two_clips", 3}, {"scaled_bones", 2}};
  std::string pairs;
  for (const auto& [name, operation] : cases) {
    const std::string file = (test::own_data() / "rigged" / name).string() + ".glb";
    const auto loaded = load_character(file);
    ASSERT_TRUE(loaded);
    json log = json::parse(operations_for(*loaded->character));
    log["operations"] = json::array({log["operations"][operation]});
    const std::string result =
        torn(file, write("log.json", log.dump()), std::string(name) + ".glb");
    pairs += " '" + file + "' '" + result + "'";
  }
  const std::string count = std::to_string(test::stressed(2'500, 40));
  const auto run = test::run_node_program("torn_mutants.mjs", count + " 20261129" + pairs);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run->succeeded) << run->output.substr(0, 3000);
  const json counts = json::parse(run->output, nullptr, false);
  ASSERT_TRUE(counts.is_object()) << run->output.substr(0, 3000);
  EXPECT_EQ(counts["mutants"], std::stoi(count));
  EXPECT_GT(counts["refused"].get<int>(), counts["mutants"].get<int>() * 9 / 10);
  RecordProperty("counts", run->output);
}

}  // namespace
}  // namespace sunder::command_test
