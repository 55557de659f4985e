// How save_glb() writes influences: SaveOptions in include/sunder/io/character_file.h.

#include <sunder/io/character_file.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/random.h"
#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"

namespace sunder::test {
namespace {

constexpr std::uint32_t kBones = 20;

/// The strip with its two influences per vertex, on a skin of twenty bones.
LoadedCharacter strip_of_many_bones() {
  GltfBuilder builder = skinned_strip();
  Json joints = Json::array();
  for (std::uint32_t i = 0; i < kBones; ++i) {
    joints.push_back(builder.json["nodes"].size());
    builder.json["nodes"][1]["children"].push_back(builder.json["nodes"].size());
    builder.json["nodes"].push_back({{"name", "bone" + std::to_string(i)}});
  }
  builder.json["skins"][0] = {{"joints", joints}};
  const auto loaded = builder.load();
  EXPECT_TRUE(loaded.has_value()) << loaded.error().text();
  return *loaded;
}

/// A strip whose vertices have up to the given number of influences, of twenty bones, some too
/// small for any integer format.
Character strip_with_influences(std::uint32_t most) {
  Character character = *strip_of_many_bones().character;
  Random random(most);
  SkinWeights& weights = character.meshes[0].weights;
  weights = {};
  for (std::size_t v = 0; v < kStripVertices; ++v) {
    std::vector<Influence> influences;
    double sum = 0;
    for (std::uint32_t i = 0; i < most; ++i) {
      influences.push_back({(static_cast<std::uint32_t>(v) + 7 * i) % kBones,
                            static_cast<float>(std::pow(10, random.uniform(-6, 0)))});
      sum += static_cast<double>(influences.back().weight);
    }
    for (Influence& influence : influences)
      influence.weight = static_cast<float>(static_cast<double>(influence.weight) / sum);
    weights.append(influences);
  }
  return character;
}

struct SavedInfluences {
  Json json;
  std::vector<std::byte> binary;
  LoadedCharacter again;

  [[nodiscard]] const Json& attributes() const {
    return json["meshes"][0]["primitives"][0]["attributes"];
  }
  [[nodiscard]] const Json& accessor(const std::string& attribute) const {
    return json["accessors"][attributes()[attribute].get<std::size_t>()];
  }
  [[nodiscard]] bool has(const std::string& attribute) const {
    return attributes().contains(attribute);
  }

  /// Component `c` of a vertex, as stored in the file.
  template <class T>
  [[nodiscard]] T value(const std::string& attribute, std::size_t vertex, std::size_t c) const {
    const Json& view = json["bufferViews"][accessor(attribute)["bufferView"].get<std::size_t>()];
    const auto offset = view["byteOffset"].get<std::size_t>();
    EXPECT_EQ(offset % 4, 0u);
    T result;
    std::memcpy(&result, binary.data() + offset + (vertex * 4 + c) * sizeof(T), sizeof(T));
    return result;
  }
};

SavedInfluences read_back(const std::filesystem::path& file) {
  SavedInfluences saved;
  const std::vector<std::byte> glb = read_bytes(file);
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  const auto* const text = reinterpret_cast<const char*>(glb.data()) + 20;
  saved.json = Json::parse(text, text + length);
  saved.binary.assign(glb.begin() + 28 + length, glb.end());
  const auto again = load_character(file);
  EXPECT_TRUE(again.has_value()) << again.error().text();
  saved.again = *again;
  return saved;
}

SavedInfluences save(const Character& character, const SaveOptions& options) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "written.glb";
  const Status status = save_glb(file, character, options);
  EXPECT_TRUE(status) << status.text();
  if (has_gltf_validator()) {
    const ValidatorReport report = validate_glb(file);
    EXPECT_EQ(report.errors, 0) << report.output;
    EXPECT_NE(report.output.find("\"warnings\":0"), std::string::npos)
        << report.output;  // For example, joints without weight.
  }
  return read_back(file);
}

/// The vertex's weights as stored in the file: they sum to exactly one, and slots without weight
/// are 0.
template <class Integer>
void expect_exact_sum(const SavedInfluences& saved, std::size_t vertex) {
  std::uint32_t sum = 0;
  for (std::size_t set = 0; saved.has("WEIGHTS_" + std::to_string(set)); ++set)
    for (std::size_t c = 0; c < 4; ++c) {
      const auto weight = saved.value<Integer>("WEIGHTS_" + std::to_string(set), vertex, c);
      sum += weight;
      if (weight == 0) {
        EXPECT_EQ(saved.value<std::uint8_t>("JOINTS_" + std::to_string(set), vertex, c), 0);
      }
    }
  EXPECT_EQ(sum, std::numeric_limits<Integer>::max()) << "vertex " << vertex;
}

/// The largest influences of a vertex divided by their sum, by slot.
std::map<std::uint32_t, double> largest(const Character& character, std::uint32_t vertex,
                                        std::uint32_t maximum) {
  const auto all = character.meshes[0].weights.of(vertex);
  std::vector<Influence> sorted(all.begin(), all.end());
  std::sort(sorted.begin(), sorted.end(), [](auto& a, auto& b) { return a.weight > b.weight; });
  if (maximum != 0 && sorted.size() > maximum) sorted.resize(maximum);
  double sum = 0;
  for (const Influence& influence : sorted) sum += static_cast<double>(influence.weight);
  std::map<std::uint32_t, double> weights;
  for (const Influence& influence : sorted)
    weights[influence.slot] = static_cast<double>(influence.weight) / sum;
  return weights;
}

struct Format {
  WeightFormat format;
  std::uint32_t component_type;
  double unit;
};
constexpr Format kFormats[] = {{WeightFormat::float32, 5126, 1e-6},
                               {WeightFormat::unorm16, 5123, 1.0 / 65535},
                               {WeightFormat::unorm8, 5121, 1.0 / 255}};

TEST(SaveInfluences, come_back_within_one_unit_in_every_format) {
  for (const Format& format : kFormats)
    for (const std::uint32_t maximum : {0u, 4u, 8u})
      for (const std::uint32_t most : {1u, 3u, 4u, 6u, 11u, 20u}) {
        SCOPED_TRACE(testing::Message()
                     << format.component_type << ", at most " << maximum << " of " << most);
        const Character character = strip_with_influences(most);
        const SavedInfluences saved = save(character, {maximum, format.format});
        const std::uint32_t kept = maximum == 0 ? most : std::min(most, maximum);
        ASSERT_TRUE(saved.has("WEIGHTS_" + std::to_string((kept - 1) / 4)));
        ASSERT_FALSE(saved.has("WEIGHTS_" + std::to_string((kept + 3) / 4)));
        EXPECT_EQ(saved.accessor("WEIGHTS_0")["componentType"], format.component_type);
        EXPECT_EQ(saved.accessor("WEIGHTS_0").value("normalized", false),
                  format.format != WeightFormat::float32);
        EXPECT_FALSE(saved.accessor("JOINTS_0").contains("normalized"));
        const SkinWeights& weights = saved.again.character->meshes[0].weights;
        ASSERT_EQ(weights.vertex_count(), kStripVertices);
        for (std::uint32_t v = 0; v < kStripVertices; ++v) {
          if (format.format == WeightFormat::unorm16) expect_exact_sum<std::uint16_t>(saved, v);
          if (format.format == WeightFormat::unorm8) expect_exact_sum<std::uint8_t>(saved, v);
          std::map<std::uint32_t, double> found;
          double sum = 0;
          for (const Influence& influence : weights.of(v)) {
            found[influence.slot] = static_cast<double>(influence.weight);
            sum += static_cast<double>(influence.weight);
          }
          EXPECT_NEAR(sum, 1, 2e-7 * static_cast<double>(weights.of(v).size()));
          const auto expected = largest(character, v, maximum);
          for (const auto& [slot, weight] : expected)
            EXPECT_NEAR(found[slot], weight, format.unit) << "slot " << slot;
          EXPECT_LE(found.size(), expected.size());
        }
        for (const LoadNote& note : saved.again.report.notes)
          EXPECT_EQ(note.kind, LoadNote::Kind::information) << note.text;
      }
}

TEST(SaveInfluences, without_a_maximum_stay_in_their_order_bit_for_bit) {
  const Character character = strip_with_influences(11);
  EXPECT_EQ(save(character, {}).again.character->meshes[0].weights, character.meshes[0].weights);
}

TEST(SaveInfluences, of_meshes_that_stay_are_not_touched) {
  GltfBuilder builder = skinned_strip();
  builder.json["meshes"].push_back(builder.json["meshes"][0]);
  builder.json["nodes"].push_back({{"name", "other"}, {"mesh", 1}, {"skin", 0}});
  builder.json["scenes"][0]["nodes"].push_back(3);
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  const SaveOptions as_bytes{4, WeightFormat::unorm8};
  const TemporaryFolder folder;
  const auto same = folder.path() / "same.glb", torn = folder.path() / "torn.glb";
  ASSERT_TRUE(save_glb(same, *loaded->character, *loaded, as_bytes));
  EXPECT_EQ(read_bytes(same), builder.glb());

  Character changed = *loaded->character;
  changed.meshes[0].triangles[0].fill(0);  // retired
  ASSERT_TRUE(save_glb(torn, changed, *loaded, as_bytes));
  const SavedInfluences saved = read_back(torn);
  if (has_gltf_validator()) {
    EXPECT_EQ(validate_glb(torn).errors, 0);
  }
  EXPECT_EQ(saved.accessor("WEIGHTS_0")["componentType"], 5121);
  EXPECT_EQ(saved.json["meshes"][1], builder.json["meshes"][1]);
  EXPECT_EQ(saved.again.character->meshes[1].weights, changed.meshes[1].weights);
}

TEST(SaveInfluences, each_mesh_may_have_a_format_of_its_own) {
  Character character = strip_with_influences(4);
  for (int i = 0; i < 2; ++i) character.meshes.push_back(character.meshes[0]);
  SaveOptions options;
  options.weights_of_mesh = {WeightFormat::unorm16, WeightFormat::float32, WeightFormat::unorm8};
  const SavedInfluences saved = save(character, options);
  const std::uint32_t types[] = {5123, 5126, 5121};
  for (std::size_t mesh = 0; mesh < 3; ++mesh) {
    const Json& attributes = saved.json["meshes"][mesh]["primitives"][0]["attributes"];
    const Json& accessor = saved.json["accessors"][attributes["WEIGHTS_0"].get<std::size_t>()];
    EXPECT_EQ(accessor["componentType"], types[mesh]) << mesh;
  }
}

/// A model that was loaded, and its mesh as it is to be written.
struct ChangedStrip {
  LoadedCharacter loaded;
  Character changed;

  /// With two influences per vertex in the file, and this many now.
  static ChangedStrip with_more(std::uint32_t most) {
    return {strip_of_many_bones(), strip_with_influences(most)};
  }
  /// With this many in the file, and a triangle less.
  static ChangedStrip with_many_in_the_file(std::uint32_t most) {
    const TemporaryFolder folder;
    EXPECT_TRUE(save_glb(folder.path() / "many.glb", strip_with_influences(most)));
    ChangedStrip strip{*load_character(folder.path() / "many.glb"), {}};
    strip.changed = *strip.loaded.character;
    strip.changed.meshes[0].triangles[0].fill(0);  // retired
    return strip;
  }

  [[nodiscard]] std::size_t sets_written(const SaveOptions& options) const {
    const TemporaryFolder folder;
    const Status status = save_glb(folder.path() / "a.glb", changed, loaded, options);
    EXPECT_TRUE(status) << status.text();
    const SavedInfluences saved = read_back(folder.path() / "a.glb");
    std::size_t sets = 0;
    while (saved.has("WEIGHTS_" + std::to_string(sets))) ++sets;
    return sets;
  }
};

TEST(SaveInfluences, are_four_where_the_source_has_no_more_unless_asked_otherwise) {
  const ChangedStrip two_became_eleven = ChangedStrip::with_more(11),
                     eleven = ChangedStrip::with_many_in_the_file(11);
  for (const auto& [maximum, of_two, of_eleven] :
       {std::array<std::uint32_t, 3>{0, 1, 3}, {4, 1, 1}, {8, 2, 2}, {kAllInfluences, 3, 3}}) {
    EXPECT_EQ(two_became_eleven.sets_written({maximum}), of_two) << maximum;
    EXPECT_EQ(eleven.sets_written({maximum}), of_eleven) << maximum;
  }
}

/// Vertices of two meshes on their border have the same influences, and must be pruned alike.
TEST(SaveInfluences, meshes_of_one_file_have_one_limit) {
  Character source = strip_with_influences(6);
  source.meshes.push_back(strip_with_influences(2).meshes[0]);
  source.meshes[1].name = "other";
  const TemporaryFolder folder;
  ASSERT_TRUE(save_glb(folder.path() / "two.glb", source));
  const auto loaded = load_character(folder.path() / "two.glb");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  Character torn = *loaded->character;
  ASSERT_EQ(torn.meshes.size(), 2u);
  for (Mesh& mesh : torn.meshes) mesh.weights = strip_with_influences(9).meshes[0].weights;
  ASSERT_TRUE(save_glb(folder.path() / "torn.glb", torn, *loaded));
  const auto again = load_character(folder.path() / "torn.glb");
  ASSERT_TRUE(again.has_value()) << again.error().text();
  const auto& meshes = again->character->meshes;
  EXPECT_EQ(meshes[0].weights, meshes[1].weights);
  for (std::uint32_t v = 0; v < kStripVertices; ++v) EXPECT_EQ(meshes[0].weights.of(v).size(), 6u);
  for (const WrittenInfluences& mesh : *written_influences(torn, *loaded)) {
    EXPECT_EQ(mesh.maximum, 6u);
    EXPECT_EQ(mesh.vertices_pruned, kStripVertices);
  }
}

TEST(SaveInfluences, what_they_lose_is_told_without_writing) {
  const ChangedStrip file = ChangedStrip::with_more(11);
  for (const std::uint32_t maximum : {0u, 4u, 8u, kAllInfluences}) {
    SCOPED_TRACE(maximum);
    const auto written = written_influences(file.changed, file.loaded, {maximum});
    ASSERT_TRUE(written.has_value()) << written.error().text();
    ASSERT_EQ(written->size(), 1u);
    const std::uint32_t kept = maximum == kAllInfluences ? 11 : maximum == 8 ? 8 : 4;
    EXPECT_EQ(written->at(0).mesh, 0u);
    EXPECT_EQ(written->at(0).maximum, maximum == kAllInfluences ? 0 : kept);
    EXPECT_EQ(written->at(0).most, kept);
    EXPECT_EQ(written->at(0).vertices_pruned, kept == 11 ? 0 : kStripVertices);
    double dropped = 0;  // by sorting, for each vertex
    for (std::uint32_t v = 0; v < kStripVertices; ++v) {
      const auto all = file.changed.meshes[0].weights.of(v);
      std::vector<double> weights;
      for (const Influence& influence : all)
        weights.push_back(static_cast<double>(influence.weight));
      std::sort(weights.begin(), weights.end());
      double sum = 0;
      for (std::size_t i = 0; i + kept < weights.size(); ++i) sum += weights[i];
      dropped = std::max(dropped, sum);
    }
    EXPECT_NEAR(written->at(0).dropped_mass_max, dropped, 1e-6);
  }
  EXPECT_TRUE(written_influences(*file.loaded.character, file.loaded)->empty())
      << "nothing is written of a model that did not change";
  EXPECT_EQ(written_influences(file.changed, file.loaded, {5}).error().code(),
            StatusCode::invalid_argument);
}

TEST(SaveInfluences, refuses_a_format_that_does_not_exist) {
  const TemporaryFolder folder;
  SaveOptions options;
  options.weights = static_cast<WeightFormat>(3);
  const auto code = [&] {
    return save_glb(folder.path() / "a.glb", strip_with_influences(4), options).code();
  };
  EXPECT_EQ(code(), StatusCode::invalid_argument);
  options.weights = WeightFormat::float32;
  options.weights_of_mesh = {static_cast<WeightFormat>(3)};
  EXPECT_EQ(code(), StatusCode::invalid_argument);
  options.weights_of_mesh = {WeightFormat::unorm8, WeightFormat::unorm8};
  EXPECT_EQ(code(), StatusCode::size_mismatch);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace sunder::test
