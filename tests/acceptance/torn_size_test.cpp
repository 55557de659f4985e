// A torn file has at most 1.05 times the bytes of its source, and what was added: new vertices, new
// corners, the width of attributes that the source stores as integers, the description of the tear
// sides. SUNDER_WRITE_SIZES=1 prints the table of docs/io.md.
#include <sunder/io/character_file.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/temporary_folder.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "support/oracles/glb_contents.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// What the JSON of an added attribute takes.
constexpr std::size_t kDescriptions = 512;

/// What the primitives of a file take.
struct Geometry {
  std::size_t vertices = 0;      ///< Each set of attributes once.
  std::size_t vertex_bytes = 0;  ///< Without tear sides.
  std::size_t corner_bytes = 0;
};

Geometry geometry_of(const GlbContents& file) {
  Geometry found;
  std::set<std::size_t> known;
  const auto count_in = [&](const Json& attributes) {
    std::size_t bytes = 0;
    for (const auto& [name, accessor] : attributes.items()) {
      const Json& at = file.json["accessors"][accessor.get<std::size_t>()];
      const bool is_new = known.insert(accessor.get<std::size_t>()).second;
      if (is_new && at.contains("bufferView"))
        bytes += file.element_bytes(accessor.get<std::size_t>()) * at["count"].get<std::size_t>();
    }
    return bytes;
  };
  for (const Json& mesh : file.json["meshes"])
    for (const Json& primitive : mesh["primitives"]) {
      const std::size_t positions = primitive["attributes"]["POSITION"];
      if (!known.contains(positions))
        found.vertices += file.json["accessors"][positions]["count"].get<std::size_t>();
      found.vertex_bytes += count_in(primitive["attributes"]);
      for (const Json& target : primitive.value("targets", Json::array()))
        found.vertex_bytes += count_in(target);
      if (!primitive.contains("indices")) continue;
      const std::size_t indices = primitive["indices"];
      if (known.insert(indices).second)
        found.corner_bytes += file.element_bytes(indices) *
                              file.json["accessors"][indices]["count"].get<std::size_t>();
    }
  return found;
}

std::size_t difference(std::size_t after, std::size_t before) {
  return after > before ? after - before : 0;
}

class TornSize : public testing::TestWithParam<fs::path> {};

TEST_P(TornSize, is_that_of_the_source_and_what_was_added) {
  const auto loaded = load_character(GetParam());
  ASSERT_TRUE(loaded) << loaded.error().text();
  Random random(std::hash<std::string>()(GetParam().filename().string()));
  auto model = TornModel::create(loaded->character);
  ASSERT_TRUE(model);
  std::uint32_t runs = 0;
  for (int i = 0; i < 20 && runs == 0; ++i) {
    const ModelPose pose = random_pose(model->character(), random);
    const auto report = model->tear(pose, random_stroke(model->character(), pose, random));
    ASSERT_TRUE(report) << report.error().text();
    runs += report->runs;
  }
  ASSERT_GT(runs, 0u);
  const TemporaryFolder folder;
  const fs::path whole = folder.path() / "0.glb", torn = folder.path() / "1.glb";
  ASSERT_TRUE(save_glb(whole, *loaded->character, *loaded));
  ASSERT_TRUE(save_glb(torn, model->character(), *loaded));
  const GlbContents before(read_bytes(whole)), after(read_bytes(torn));
  EXPECT_LE(after.longest_unreferenced_run(), 3u);
  EXPECT_EQ(after.referenced_accessors().size(), after.json["accessors"].size());
  EXPECT_EQ(after.referenced_views().size(), after.json["bufferViews"].size());

  const Geometry old = geometry_of(before), now = geometry_of(after);
  const std::size_t added = kDescriptions + difference(now.vertex_bytes, old.vertex_bytes) +
                            difference(now.corner_bytes, old.corner_bytes),
                    size = fs::file_size(torn), source = fs::file_size(whole);
  EXPECT_LE(static_cast<double>(size),
            1.05 * static_cast<double>(source) + static_cast<double>(added))
      << "source " << source << ", added " << added;
  if (std::getenv("SUNDER_WRITE_SIZES") != nullptr)
    std::cout << "| `" << GetParam().filename().string() << "` | " << old.vertices << " | "
              << now.vertices - old.vertices << " | " << source << " | " << added << " | " << size
              << " | " << static_cast<double>(size - added) / static_cast<double>(source) << " |\n";
  if (!has_gltf_validator()) return;
  const auto reports = validate_glbs_of(folder.path());
  ASSERT_EQ(reports.size(), 2u);
  const auto unused = [](const ValidatorReport& report) {
    return Json::parse(report.output)["unused"].get<int>();
  };
  EXPECT_LE(unused(reports[1]), unused(reports[0]));
}

INSTANTIATE_TEST_SUITE_P(
    Models, TornSize,
    testing::ValuesIn(rigged_models({".glb", ".gltf", ".fbx", ".dae", ".x", ".b3d"})),
    [](const auto& test_case) {
      std::string name = test_case.param.filename().string();
      std::replace_if(
          name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
      return name + "_" + std::to_string(test_case.index);
    });

}  // namespace
}  // namespace sunder::test
