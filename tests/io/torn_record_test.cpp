// SaveOptions::origins: what is refused, what is written, and what becomes of an older record.

#include <sunder/io/character_bytes.h>
#include <sunder/io/character_file.h>

#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/fake_tear.h"
#include "support/models/gltf_builder.h"
#include "support/models/shared_models.h"
#include "support/oracles/glb_contents.h"

namespace sunder::test {
namespace {

constexpr const char* kRecord = "SUNDER_torn_mesh";

/// A file whose first mesh was torn in two triangles, with the origins of its new vertices.
struct Torn {
  Torn() {
    const auto& source = loaded.character->meshes[0];
    character = *loaded.character;
    fake_tear(character.meshes[0]);
    for (const Mesh& mesh : loaded.character->meshes)
      origins.push_back({mesh.vertex_count(), {}, {}});
    for (std::size_t t = 0; t < 2; ++t)
      for (const std::uint32_t vertex : source.triangles[t])
        origins[0].vertices.push_back({{vertex, vertex, vertex}, {1, 0, 0}});
  }
  [[nodiscard]] Result<std::vector<std::byte>> save(std::vector<MeshOrigins> with) const {
    SaveOptions options;
    options.origins = std::move(with);
    return save_glb(character, loaded, options);
  }

  LoadedCharacter loaded = *load_character(own_data() / "rigged/two_skins.glb");
  Character character;
  std::vector<MeshOrigins> origins;
};

TEST(TornRecord, refuses_origins_that_do_not_fit) {
  const Torn torn;
  const auto code = [&](auto change) {
    std::vector<MeshOrigins> origins = torn.origins;
    change(origins);
    const auto saved = torn.save(origins);
    return saved ? StatusCode::ok : saved.error().code();
  };
  EXPECT_EQ(code([](auto&) {}), StatusCode::ok);
  EXPECT_EQ(code([](auto& of) { of.pop_back(); }), StatusCode::size_mismatch);
  EXPECT_EQ(code([](auto& of) { ++of[0].first_vertex; }), StatusCode::size_mismatch);
  EXPECT_EQ(code([](auto& of) { of[0].vertices.resize(7, of[0].vertices[0]); }),
            StatusCode::size_mismatch);
  EXPECT_EQ(code([](auto& of) { of[0].vertices[3].parents[2] = of[0].first_vertex + 3; }),
            StatusCode::invalid_argument);
  EXPECT_EQ(code([](auto& of) {
              of[0].vertices[3].parts = {1, 0.5, 0};
            }),
            StatusCode::invalid_argument);
  EXPECT_EQ(code([](auto& of) {
              of[0].vertices[3].parts = {2, -1, 0};
            }),
            StatusCode::invalid_argument);
  EXPECT_EQ(code([](auto& of) { of[0].vertices[3].parts[0] = std::nan(""); }),
            StatusCode::invalid_argument);
  EXPECT_EQ(code([](auto& of) { of[0].vertices[3].policy = 4; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](auto& of) {
              of[0].reduced = {{1u << 30, 0.5}};
            }),
            StatusCode::index_out_of_range);
  EXPECT_EQ(code([](auto& of) { of[0].reduced = {{0, 1.5}}; }), StatusCode::index_out_of_range);
}

TEST(TornRecord, has_the_origins) {
  Torn torn;
  torn.origins[0].vertices.pop_back();  // a vertex that is said to come from nowhere
  torn.origins[0].reduced = {{5, 0.25}};
  const auto saved = torn.save(torn.origins);
  ASSERT_TRUE(saved) << saved.error().text();
  const GlbContents file(*saved);
  EXPECT_EQ(file.json["extensionsUsed"], Json::array({kRecord}));
  std::size_t with = 0;
  for (const auto& mesh : file.json["meshes"])
    for (const auto& primitive : mesh["primitives"]) {
      if (!primitive.contains("extensions")) continue;
      ++with;
      const auto& record = primitive["extensions"][kRecord];
      const auto numbers = [&](const char* name) {
        return file.numbers(record[name].template get<std::size_t>());
      };
      EXPECT_EQ(record["firstVertex"], torn.origins[0].first_vertex);
      EXPECT_EQ(numbers("kinds"), (std::vector<double>{0, 0, 0, 0, 0, 8}));
      EXPECT_EQ(numbers("reduced"), std::vector<double>{5});
      EXPECT_EQ(numbers("remaining"), std::vector<double>{0.25});
      const auto places = numbers("places"), parents = numbers("parents");
      for (std::size_t i = 0; i < 5; ++i)
        EXPECT_EQ(parents[3 * static_cast<std::size_t>(places[i])],
                  torn.origins[0].vertices[i].parents[0]);
      EXPECT_EQ(places[5], parents.size() / 3);
    }
  EXPECT_EQ(with, torn.loaded.character->meshes[0].submeshes.size());
  const auto plain = save_glb(torn.character, torn.loaded);
  ASSERT_TRUE(plain);
  EXPECT_EQ(*load_glb(*saved)->character, *load_glb(*plain)->character);
}

TEST(TornRecord, of_an_older_tear_goes_with_the_meshes_that_it_was_of) {
  const Torn torn;
  const auto first = torn.save(torn.origins);
  ASSERT_TRUE(first);
  const auto loaded = load_glb(*first);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(*save_glb(*loaded->character, *loaded), *first);  // nothing changed
  Character again = *loaded->character;
  retire(again.meshes[0], 3);
  const auto second = save_glb(again, *loaded);
  ASSERT_TRUE(second);
  const GlbContents file(*second);
  EXPECT_FALSE(file.json.contains("extensionsUsed"));
  EXPECT_EQ(file.json.dump().find(kRecord), std::string::npos);
  EXPECT_EQ(file.referenced_accessors().size(), file.json["accessors"].size());
}

TEST(TornRecord, that_makes_no_sense_is_ignored_and_goes) {
  const auto bytes = read_bytes(own_data() / "rigged/two_skins.glb");
  for (const Json& nonsense :
       {Json(7), Json("text"), Json::array({1, 2}), Json{{"parts", 4000000000u}},
        Json{{"parts", -1}, {"kinds", "x"}, {"places", Json::array()}}, Json{{"parents", 1e300}}}) {
    GltfBuilder builder = GltfBuilder::from_glb(bytes);
    for (Json& mesh : builder.json["meshes"])
      for (Json& primitive : mesh["primitives"]) primitive["extensions"][kRecord] = nonsense;
    builder.json["extensions"][kRecord] = nonsense;
    builder.json["extensionsUsed"] = Json::array({kRecord});
    const auto loaded = builder.load();
    ASSERT_TRUE(loaded) << nonsense << loaded.error().text();
    Character with_clip = *loaded->character;  // no mesh is written: the record stays as it is
    if (!with_clip.clips.empty()) with_clip.clips.push_back(with_clip.clips[0]);
    ASSERT_TRUE(save_glb(with_clip, *loaded)) << nonsense;
    Character torn = *loaded->character;
    fake_tear(torn.meshes[0]);
    const auto saved = save_glb(torn, *loaded);
    ASSERT_TRUE(saved) << nonsense << saved.error().text();
    EXPECT_EQ(GlbContents(*saved).json.dump().find(kRecord), std::string::npos) << nonsense;
  }
}

}  // namespace
}  // namespace sunder::test
