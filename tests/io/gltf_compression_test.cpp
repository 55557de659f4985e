// load_character() on glTF that meshoptimizer or Draco compressed, and save_glb() of such models.

#include <sunder/io/character_file.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <meshoptimizer.h>
#include <random>

#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/node_program.h"
#include "support/machine/stress.h"
#include "support/machine/temporary_folder.h"
#include "support/models/compressed_gltf.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

/// Without the vertices that submeshes share: Draco gives each primitive its own.
Character with_one_submesh(Character character) {
  for (Mesh& mesh : character.meshes) {
    mesh.submeshes.resize(1);
    mesh.triangle_submesh.assign(mesh.triangle_count(), 0);
  }
  return character;
}

Character loaded_from(const GltfBuilder& builder, const LoadOptions& options = {}) {
  const auto loaded = builder.load(options);
  EXPECT_TRUE(loaded.has_value()) << loaded.error().text();
  return loaded ? *loaded->character : Character();
}

/// The first vertex of every triangle is its smallest.
Character with_turned_triangles(Character character) {
  for (Mesh& mesh : character.meshes)
    for (Triangle& triangle : mesh.triangles)
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                  triangle.end());
  return character;
}

std::map<std::string, Character> some_rigs() {
  return {{"sheet", make_sheet(9)},
          {"tube", make_tube(12, 10, 3)},
          {"two tubes", make_two_tubes(8, 9)},
          {"many bones", [] {
             Character ball = make_bumpy_ball(400);
             rig_along(ball, 300);
             return ball;
           }()}};
}

Json& extension_of_view(GltfBuilder& builder, std::size_t view) {
  return builder.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
}

std::size_t view_of(const GltfBuilder& builder, const std::string& attribute) {
  const Json& primitive = builder.json["meshes"][0]["primitives"][0];
  const Json& accessor =
      attribute == "indices" ? primitive["indices"] : primitive["attributes"][attribute];
  return builder.json["accessors"][accessor.get<std::size_t>()]["bufferView"];
}

TEST(LoadMeshopt, data_compressed_without_loss_comes_back_bit_for_bit) {
  for (const auto& [name, rig] : some_rigs())
    for (const char* const extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      SCOPED_TRACE(name + " " + extension);
      const GltfBuilder plain = built_from(rig);
      const Character expected = loaded_from(plain);
      EXPECT_EQ(loaded_from(packed_by_meshopt(plain, {extension, true}), strict()), expected);
      // Triangles may be turned.
      EXPECT_EQ(with_turned_triangles(loaded_from(packed_by_meshopt(plain, {extension, false}))),
                with_turned_triangles(expected));
    }
}

TEST(LoadMeshopt, says_that_saving_writes_more) {
  const auto loaded = packed_by_meshopt(built_from(make_sheet(9))).load();
  ASSERT_TRUE(loaded.has_value());
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::information, "uncompressed"));
}

/// Compresses an array with a filter into a view of its own. @return the accessor.
template <class T, class Filter>
std::size_t add_filtered(GltfBuilder& builder, std::size_t count, std::size_t stride,
                         const Json& accessor, const char* filter, const Filter& encode) {
  std::vector<T> filtered(count * stride / sizeof(T));
  encode(filtered.data());
  std::vector<std::uint8_t> packed(meshopt_encodeVertexBufferBound(count, stride));
  packed.resize(
      meshopt_encodeVertexBuffer(packed.data(), packed.size(), filtered.data(), count, stride));
  const std::size_t source = builder.add_view(packed);
  const Json compressed = builder.json["bufferViews"][source];
  builder.json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", count * stride}});
  const std::size_t view = builder.json["bufferViews"].size() - 1;
  extension_of_view(builder, view) = {{"buffer", 0},
                                      {"byteOffset", compressed["byteOffset"]},
                                      {"byteLength", packed.size()},
                                      {"byteStride", stride},
                                      {"count", count},
                                      {"mode", "ATTRIBUTES"},
                                      {"filter", filter}};
  builder.json["bufferViews"][view]["byteStride"] = stride;
  Json described = accessor;
  described["bufferView"] = view;
  described["count"] = count;
  builder.json["accessors"].push_back(described);
  return builder.json["accessors"].size() - 1;
}

std::vector<Vec4f> random_directions(std::size_t count) {
  Random random(4);
  std::vector<Vec4f> directions;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d direction = random.direction();
    directions.push_back(direction.cast<float>().homogeneous());
  }
  return directions;
}

TEST(LoadMeshopt, octahedral_directions_come_back_within_their_bits) {
  const auto directions = random_directions(kStripVertices);
  for (const int bits : {8, 12, 16}) {
    SCOPED_TRACE(bits);
    const std::size_t stride = bits <= 8 ? 4 : 8;
    GltfBuilder builder = skinned_strip();
    strip_attributes(builder)["NORMAL"] = add_filtered<std::uint8_t>(
        builder, kStripVertices, stride,
        {{"componentType", bits <= 8 ? 5120 : 5122}, {"normalized", true}, {"type", "VEC3"}},
        "OCTAHEDRAL", [&](void* out) {
          meshopt_encodeFilterOct(out, kStripVertices, stride, bits, directions[0].data());
        });
    const Character character = loaded_from(builder);
    for (std::size_t v = 0; v < kStripVertices; ++v)
      EXPECT_LE((character.meshes.at(0).normals[v] - directions[v].head<3>()).norm(),
                4.0 / (1 << bits) + 2.0 / (bits <= 8 ? 127 : 32767));
  }
}

TEST(LoadMeshopt, floats_with_shared_exponents_come_back_within_their_bits) {
  Random random(5);
  std::vector<float> numbers(3 * kStripVertices);
  for (float& number : numbers) number = static_cast<float>(random.uniform(-10, 10));
  for (const int bits : {8, 15, 23}) {
    SCOPED_TRACE(bits);
    GltfBuilder builder = skinned_strip();
    strip_attributes(builder)["POSITION"] = add_filtered<std::uint8_t>(
        builder, kStripVertices, 12, {{"componentType", 5126}, {"type", "VEC3"}}, "EXPONENTIAL",
        [&](void* out) { meshopt_encodeFilterExp(out, kStripVertices, 12, bits, numbers.data()); });
    const Character character = loaded_from(builder);
    for (std::size_t v = 0; v < kStripVertices; ++v)
      EXPECT_LE((character.meshes.at(0).positions[v] - Eigen::Map<Vec3f>(&numbers[3 * v])).norm(),
                64.0 / (1 << bits));
  }
}

TEST(LoadMeshopt, rotations_of_three_numbers_come_back_as_quaternions) {
  Random random(6);
  constexpr std::size_t kKeys = 40;
  std::vector<Vec4f> rotations;
  std::vector<float> times;
  for (std::size_t i = 0; i < kKeys; ++i) {
    rotations.push_back(Vec4d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                              random.uniform(-1, 1))
                            .normalized()
                            .cast<float>());
    times.push_back(static_cast<float>(i));
  }
  GltfBuilder builder = skinned_strip();
  const std::size_t input = builder.add(times, "SCALAR"),
                    output = add_filtered<std::uint8_t>(
                        builder, kKeys, 8,
                        {{"componentType", 5122}, {"normalized", true}, {"type", "VEC4"}},
                        "QUATERNION", [&](void*out) {
                          meshopt_encodeFilterQuat(out, kKeys, 8, 12, rotations[0].data());
                        });
  builder.json["animations"] = {
      {{"name", "turn"},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}},
       {"samplers", {{{"input", input}, {"output", output}}}}}};
  const Character character = loaded_from(builder);
  const std::vector<float>& values = character.clips.at(0).channels.at(0).values;
  ASSERT_EQ(values.size(), 4 * kKeys);
  for (std::size_t i = 0; i < kKeys; ++i) {
    const Vec4f found = Eigen::Map<const Vec4f>(&values[4 * i]).normalized();
    EXPECT_NEAR(std::abs(found.dot(rotations[i])), 1.0f, 1e-6f) << i;
  }
}

/// Saves a change and checks the file by the validator and by our own reader.
LoadedCharacter torn_and_saved(const LoadedCharacter& loaded, Json& json) {
  Character torn = *loaded.character;
  Mesh& mesh = torn.meshes[0];
  mesh.triangles[0].fill(0);  // retired
  const TemporaryFolder folder;
  const auto file = folder.path() / "torn.glb";
  const Status status = save_glb(file, torn, loaded);
  EXPECT_TRUE(status) << status.text();
  if (has_gltf_validator()) {
    const ValidatorReport report = validate_glb(file);
    EXPECT_EQ(report.errors, 0) << report.output;
  }
  json = GltfBuilder::from_glb(read_bytes(file)).json;
  auto again = load_character(file);
  EXPECT_TRUE(again.has_value()) << again.error().text();
  mesh.triangles.erase(mesh.triangles.begin());
  for (std::size_t i = 0; i < torn.meshes.size(); ++i) {
    EXPECT_EQ(again->character->meshes[i].positions, torn.meshes[i].positions);
    EXPECT_EQ(again->character->meshes[i].weights, torn.meshes[i].weights);
    EXPECT_EQ(again->character->meshes[i].morph_targets, torn.meshes[i].morph_targets);
  }
  EXPECT_EQ(again->character->clips, torn.clips);
  EXPECT_EQ(again->character->skins, torn.skins);
  return *again;
}

TEST(SaveCompressed, a_torn_model_is_written_uncompressed_and_an_untouched_one_as_it_was) {
  for (const bool is_draco : {false, true})
    for (const auto& [name, rig] : some_rigs()) {
      SCOPED_TRACE(name + (is_draco ? ", Draco" : ", meshopt"));
      const GltfBuilder builder =
          is_draco ? packed_by_draco(built_from(with_one_submesh(rig)), {true, 0})
                   : packed_by_meshopt(built_from(rig));
      const auto loaded = builder.load();
      ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
      const TemporaryFolder folder;
      ASSERT_TRUE(save_glb(folder.path() / "same.glb", *loaded->character, *loaded));
      EXPECT_EQ(read_bytes(folder.path() / "same.glb"), builder.glb());
      Json json;
      torn_and_saved(*loaded, json);
      EXPECT_EQ(json.dump().find("compression"), std::string::npos);
    }
}

Status error_of(const GltfBuilder& builder, const LoadOptions& options = {}) {
  const auto loaded = builder.load(options);
  return loaded ? Status() : loaded.error();
}

TEST(LoadMeshopt, claims_are_checked_before_memory_is_taken) {
  const GltfBuilder good = packed_by_meshopt(built_from(make_tube(12, 10, 3)));
  const auto code_with = [&](const char* attribute, const char* key, const Json& value) {
    GltfBuilder builder = good;
    const std::size_t view = view_of(builder, attribute);
    Json& extension = extension_of_view(builder, view);
    extension[key] = value;
    if (extension["count"].is_number() && extension["byteStride"].is_number())
      builder.json["bufferViews"][view]["byteLength"] =
          extension["count"].get<std::uint64_t>() * extension["byteStride"].get<std::uint64_t>();
    const Status error = error_of(builder);
    EXPECT_NE(error.text().find("EXT_meshopt_compression"), std::string_view::npos) << error.text();
    return error.code();
  };
  constexpr auto kMalformed = StatusCode::malformed_file;
  EXPECT_EQ(code_with("POSITION", "count", 1'000'000'000), kMalformed);
  EXPECT_EQ(code_with("POSITION", "count", 0), kMalformed);
  EXPECT_EQ(code_with("indices", "count", 3'000'000'000), kMalformed);
  EXPECT_EQ(code_with("indices", "count", 4), kMalformed);
  EXPECT_EQ(code_with("indices", "byteStride", 8), kMalformed);
  EXPECT_EQ(code_with("POSITION", "byteStride", 0), kMalformed);
  EXPECT_EQ(code_with("POSITION", "byteStride", 6), kMalformed);
  EXPECT_EQ(code_with("POSITION", "byteStride", 1024), kMalformed);
  EXPECT_EQ(code_with("POSITION", "mode", "POINTS"), kMalformed);
  EXPECT_EQ(code_with("POSITION", "mode", "INDICES"), kMalformed);
  EXPECT_EQ(code_with("POSITION", "filter", "OCTAHEDRAL"), kMalformed);
  EXPECT_EQ(code_with("POSITION", "filter", "QUATERNION"), kMalformed);
  EXPECT_EQ(code_with("indices", "filter", "EXPONENTIAL"), kMalformed);
  EXPECT_EQ(code_with("POSITION", "filter", "COLOR"), StatusCode::unsupported_feature);
  EXPECT_EQ(code_with("POSITION", "buffer", 9), StatusCode::index_out_of_range);
  EXPECT_EQ(code_with("POSITION", "byteOffset", 1 << 30), StatusCode::index_out_of_range);
  EXPECT_EQ(code_with("POSITION", "byteLength", 1 << 30), StatusCode::index_out_of_range);
  EXPECT_EQ(code_with("POSITION", "byteLength", 100), kMalformed);
  EXPECT_EQ(code_with("POSITION", "byteLength", "x"), kMalformed);
  // The fallback buffer has no data.
  EXPECT_EQ(code_with("POSITION", "buffer", 1), StatusCode::index_out_of_range);
}

TEST(LoadMeshopt, a_view_and_its_compressed_data_must_agree) {
  GltfBuilder builder = packed_by_meshopt(built_from(make_sheet(5)));
  builder.json["bufferViews"][view_of(builder, "POSITION")]["byteLength"] = 12;
  EXPECT_EQ(error_of(builder).code(), StatusCode::malformed_file);
}

TEST(LoadMeshopt, a_view_of_the_fallback_buffer_without_compressed_data_is_refused) {
  GltfBuilder builder = packed_by_meshopt(built_from(make_sheet(5)));
  builder.json["bufferViews"][view_of(builder, "POSITION")].erase("extensions");
  EXPECT_EQ(error_of(builder).code(), StatusCode::index_out_of_range);
}

TEST(LoadMeshopt, many_views_of_the_same_bytes_share_the_limit) {
  GltfBuilder builder = packed_by_meshopt(built_from(make_sheet(40)));
  const Json view = builder.json["bufferViews"][view_of(builder, "POSITION")];
  for (int i = 0; i < 500; ++i) builder.json["bufferViews"].push_back(view);
  LoadOptions options;
  options.maximum_bytes = 1 << 20;
  EXPECT_EQ(error_of(builder, options).code(), StatusCode::limit_exceeded);
}

TEST(LoadMeshopt, later_codecs_are_named) {
  GltfBuilder builder = packed_by_meshopt(built_from(make_sheet(5)));
  const std::size_t view = view_of(builder, "POSITION");
  std::vector<std::byte> glb = builder.glb();
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  glb[28 + length + extension_of_view(builder, view)["byteOffset"].get<std::size_t>()] =
      std::byte{0xA1};
  const auto loaded = load_bytes("later.glb", glb);
  EXPECT_EQ(loaded.error().code(), StatusCode::unsupported_feature) << loaded.error().text();
}

/// A corner of a triangle with all that its vertex has, as numbers.
std::vector<float> corner(const Mesh& mesh, std::uint32_t vertex) {
  std::vector<float> numbers(mesh.positions[vertex].begin(), mesh.positions[vertex].end());
  if (!mesh.normals.empty())
    numbers.insert(numbers.end(), mesh.normals[vertex].begin(), mesh.normals[vertex].end());
  for (const auto& uvs : mesh.uv_sets)
    numbers.insert(numbers.end(), uvs[vertex].begin(), uvs[vertex].end());
  for (const Influence& influence : mesh.weights.of(vertex)) {
    numbers.push_back(static_cast<float>(influence.slot));
    numbers.push_back(influence.weight);
  }
  return numbers;
}

/// The triangles as numbers, whatever the order of triangles, corners and vertices.
std::vector<std::vector<std::vector<float>>> surface_of(const Mesh& mesh) {
  std::vector<std::vector<std::vector<float>>> surface;
  for (const Triangle& triangle : mesh.triangles) {
    std::vector<std::vector<float>> corners;
    for (const std::uint32_t vertex : triangle) corners.push_back(corner(mesh, vertex));
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    surface.push_back(std::move(corners));
  }
  std::sort(surface.begin(), surface.end());
  return surface;
}

TEST(LoadDraco, sequential_data_without_loss_comes_back_bit_for_bit) {
  for (const auto& [name, rig] : some_rigs()) {
    SCOPED_TRACE(name);
    // The tubes have morph targets, which stay plain.
    const GltfBuilder plain = built_from(with_one_submesh(rig));
    EXPECT_EQ(loaded_from(packed_by_draco(plain, {true, 0}), strict()), loaded_from(plain));
  }
}

TEST(LoadDraco, edgebreaker_keeps_the_surface_and_its_weights) {
  for (auto [name, rig] : some_rigs()) {
    SCOPED_TRACE(name);
    for (Mesh& mesh : rig.meshes) mesh.morph_targets.clear();  // The vertices change their order.
    rig.rest_morph_weights.clear();
    rig.clips.clear();
    const GltfBuilder plain = built_from(rig);
    const Character expected = loaded_from(plain),
                    found = loaded_from(packed_by_draco(plain, {false, 0}));
    std::vector<std::vector<std::vector<float>>> all_expected, all_found;
    for (const Mesh& mesh : expected.meshes)
      for (auto& triangle : surface_of(mesh)) all_expected.push_back(std::move(triangle));
    for (const Mesh& mesh : found.meshes)
      for (auto& triangle : surface_of(mesh)) all_found.push_back(std::move(triangle));
    std::sort(all_expected.begin(), all_expected.end());
    std::sort(all_found.begin(), all_found.end());
    EXPECT_EQ(all_found, all_expected);
  }
}

TEST(LoadDraco, quantised_vertices_come_back_within_their_bits) {
  const GltfBuilder plain = built_from(make_sheet(12));
  const Character expected = loaded_from(plain);
  for (const int bits : {9, 14})
    for (const bool is_sequential : {false, true}) {
      SCOPED_TRACE(bits);
      const Character found = loaded_from(packed_by_draco(plain, {is_sequential, bits}));
      const Mesh &a = expected.meshes.at(0), &b = found.meshes.at(0);
      ASSERT_EQ(b.triangle_count(), a.triangle_count());
      const float step = 1.0f / static_cast<float>((1 << bits) - 1);
      for (std::uint32_t v = 0; v < b.vertex_count(); ++v) {
        std::uint32_t nearest = 0;
        for (std::uint32_t w = 1; w < a.vertex_count(); ++w)
          if ((a.positions[w] - b.positions[v]).norm() <
              (a.positions[nearest] - b.positions[v]).norm())
            nearest = w;
        EXPECT_LE((a.positions[nearest] - b.positions[v]).cwiseAbs().maxCoeff(), step);
        EXPECT_LE((a.uv_sets[0][nearest] - b.uv_sets[0][v]).cwiseAbs().maxCoeff(), step);
        for (const Influence& influence : b.weights.of(v)) {
          float original = 0;
          for (const Influence& other : a.weights.of(nearest))
            if (other.slot == influence.slot) original = other.weight;
          EXPECT_NEAR(influence.weight, original, 4 * step);
        }
      }
    }
}

TEST(LoadDraco, data_that_is_there_uncompressed_too_is_used) {
  const GltfBuilder plain = built_from(make_sheet(7));
  GltfBuilder builder = packed_by_draco(plain, {false, 6});
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["attributes"] = plain.json["meshes"][0]["primitives"][0]["attributes"];
  primitive["indices"] = plain.json["meshes"][0]["primitives"][0]["indices"];
  builder.json.erase("extensionsRequired");
  EXPECT_EQ(loaded_from(builder, strict()), loaded_from(plain));
}

/// Where the stream of the first primitive begins in the BIN chunk.
std::size_t draco_offset(const GltfBuilder& builder) {
  const Json& extension =
      builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
  return builder.json["bufferViews"][extension["bufferView"].get<std::size_t>()]["byteOffset"];
}

constexpr std::size_t kDracoHeader = 11;

TEST(LoadDraco, claims_are_checked_before_memory_is_taken) {
  for (const bool is_sequential : {false, true}) {
    SCOPED_TRACE(is_sequential);
    const GltfBuilder good = packed_by_draco(built_from(make_sheet(7)), {is_sequential, 8});
    std::vector<std::byte> glb = good.glb();
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    std::byte* const stream = glb.data() + 28 + length + draco_offset(good);
    // The counts are varints of a byte each: of triangles and points; or, after the traversal, the
    // other way round.
    for (const std::size_t count : {0u, 1u}) {
      const std::size_t at = kDracoHeader + count + (is_sequential ? 0 : 1);
      std::vector<std::byte> damaged = glb;
      std::byte* const counts = damaged.data() + (stream - glb.data()) + at;
      for (int i = 0; i < 4; ++i) counts[i] = std::byte{0xFF};
      counts[4] = std::byte{0x0F};
      const auto loaded = load_bytes("claims.glb", damaged);
      EXPECT_EQ(loaded.error().code(), StatusCode::malformed_file) << loaded.error().text();
    }
  }
}

TEST(LoadDraco, an_accessor_does_not_raise_the_limit) {
  GltfBuilder builder = packed_by_draco(built_from(make_sheet(60)), {false, 8});
  LoadOptions options;
  options.maximum_bytes = 300'000;  // more than the file, less than its decoded triangles take
  ASSERT_LT(builder.glb().size(), options.maximum_bytes);
  EXPECT_EQ(error_of(builder, options).code(), StatusCode::limit_exceeded);
}

TEST(LoadDraco, faults_are_named) {
  const GltfBuilder good = packed_by_draco(built_from(make_sheet(5)));
  const auto code_with = [&](const char* key, const Json& value) {
    GltfBuilder builder = good;
    Json& extension =
        builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
    extension[Json::json_pointer(key)] = value;
    return error_of(builder).code();
  };
  EXPECT_EQ(code_with("/bufferView", 99), StatusCode::index_out_of_range);
  EXPECT_EQ(code_with("/attributes/POSITION", 5), StatusCode::malformed_file);
  EXPECT_EQ(code_with("/attributes/POSITION", 5e9), StatusCode::malformed_file);
  EXPECT_EQ(code_with("/attributes/COLOR_0", 1), StatusCode::malformed_file);
  EXPECT_EQ(code_with("/attributes", 1), StatusCode::malformed_file);
  GltfBuilder builder = good;
  builder.json["bufferViews"][0]["byteLength"] = 40;
  builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]
              ["bufferView"] = 0;
  EXPECT_EQ(error_of(builder).code(), StatusCode::malformed_file);
}

TEST(LoadCompressed, random_damage_never_breaks_more_than_the_file) {
  const GltfBuilder plain = built_from(make_sheet(6));
  std::mt19937 random(7);
  const TemporaryFolder folder;
  for (const auto& original :
       {packed_by_meshopt(plain).glb(), packed_by_draco(plain, {false, 10}).glb(),
        packed_by_draco(plain, {true, 0}).glb()}) {
    std::uint32_t json_length = 0;
    std::memcpy(&json_length, original.data() + 12, 4);
    const std::size_t binary = 28 + json_length;
    for (int round = 0; round < 1000; ++round) {
      auto damaged = original;
      for (auto hits = 1 + random() % 3; hits > 0; --hits) {
        // Most hits go into the compressed data.
        const std::size_t first = random() % 8 == 0 ? 0 : binary;
        damaged[first + random() % (damaged.size() - first)] =
            static_cast<std::byte>(random() % 256);
      }
      SCOPED_TRACE(round);
      const auto loaded = load_character(folder.write("damaged.glb", damaged));
      if (loaded) {
        EXPECT_TRUE(validate_character(*loaded->character));
      } else {
        EXPECT_FALSE(loaded.error().text().empty());
        EXPECT_NE(loaded.error().code(), StatusCode::internal_error) << loaded.error().text();
      }
    }
  }
}

#define SKIP_WITHOUT_DECOMPRESSOR()                                                     \
  if (!has_node_packages(                                                               \
          {"@gltf-transform/core", "@gltf-transform/extensions", "gltfpack", "three"})) \
  GTEST_SKIP() << "needs node, gltf-transform, gltfpack and three: npm ci --prefix tests/npm"

/// Loads a file as three.js' decoders decompress it.
Character decompressed_by_three(const std::filesystem::path& file) {
  const TemporaryFolder folder;
  const auto plain = folder.path() / "plain.glb";
  const auto run =
      run_node_program("decompress.mjs", "'" + file.string() + "' '" + plain.string() + "'");
  EXPECT_TRUE(run && run->succeeded) << (run ? run->output.substr(0, 2000) : "");
  const auto loaded = load_character(plain);
  EXPECT_TRUE(loaded.has_value()) << loaded.error().text();
  return loaded ? *loaded->character : Character();
}

template <class Vector>
double greatest_difference(const std::vector<Vector>& a, const std::vector<Vector>& b) {
  if (a.size() != b.size()) return 1e300;
  double greatest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    greatest = std::max(greatest, static_cast<double>((a[i] - b[i]).norm()));
  return greatest;
}

/// The same but for the rounding of filters, which differs between processors by a unit of the
/// stored integers.
void expect_same_content(const Character& found, const Character& expected) {
  ASSERT_EQ(found.meshes.size(), expected.meshes.size());
  for (std::size_t i = 0; i < found.meshes.size(); ++i) {
    const Mesh &a = found.meshes[i], &b = expected.meshes[i];
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_LE(greatest_difference(a.normals, b.normals), 2.0 / 127);
    EXPECT_EQ(a.uv_sets, b.uv_sets);
    EXPECT_EQ(a.weights, b.weights);
    EXPECT_EQ(a.morph_targets, b.morph_targets);
    EXPECT_EQ(a.triangles, b.triangles);
  }
  ASSERT_EQ(found.clips.size(), expected.clips.size());
  for (std::size_t c = 0; c < found.clips.size(); ++c) {
    ASSERT_EQ(found.clips[c].channels.size(), expected.clips[c].channels.size());
    for (std::size_t i = 0; i < found.clips[c].channels.size(); ++i) {
      const Channel &a = found.clips[c].channels[i], &b = expected.clips[c].channels[i];
      EXPECT_EQ(a.times, b.times);
      ASSERT_EQ(a.values.size(), b.values.size());
      for (std::size_t k = 0; k < a.values.size(); ++k)
        ASSERT_NEAR(a.values[k], b.values[k], 2.0 / 32767);
    }
  }
}

TEST(LoadCompressed, our_decoders_agree_with_those_of_three) {
  SKIP_WITHOUT_DECOMPRESSOR();
  const TemporaryFolder folder;
  for (const auto& [name, rig] : some_rigs())
    for (const DracoPacking& packing : {DracoPacking{true, 11}, DracoPacking{true, 0}}) {
      SCOPED_TRACE(name);
      const auto file = folder.write(
          "draco.glb", packed_by_draco(built_from(with_one_submesh(rig)), packing).glb());
      expect_same_content(*load_character(file)->character, decompressed_by_three(file));
    }
}

TEST(LoadCompressed, files_of_gltfpack_are_read_as_three_reads_them) {
  SKIP_WITHOUT_DECOMPRESSOR();
  const TemporaryFolder folder;
  const std::array<const char*, 3> all_options = {"-c", "-cc -vpf -vnf", "-c -cf"};
  std::size_t next = 0;
  for (const auto& model : rigged_gltf_models())
    for (int i = 0; i < test::stressed(1, 3); ++i) {  // Models take turns with the options.
      const char* const options = all_options[next++ % all_options.size()];
      SCOPED_TRACE(model.filename().string() + " " + options);
      const auto file = folder.path() / "packed.glb";
      const auto run = run_node_program(
          "node_modules/gltfpack/cli.js",
          "-i '" + model.string() + "' -o '" + file.string() + "' -kn -km -ke " + options);
      ASSERT_TRUE(run && run->succeeded) << (run ? run->output : "");
      const auto loaded = load_character(file);
      ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
      expect_same_content(*loaded->character, decompressed_by_three(file));
      Json json;
      torn_and_saved(*loaded, json);
      EXPECT_EQ(json.dump().find("meshopt"), std::string::npos);
    }
}

TEST(SaveCompressed, a_torn_model_is_read_by_gltf_transform) {
  SKIP_WITHOUT_DECOMPRESSOR();
  const GltfBuilder plain = built_from(make_sheet(8));
  for (const GltfBuilder& builder : {packed_by_meshopt(plain), packed_by_draco(plain)}) {
    const auto loaded = builder.load();
    ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
    Character torn = *loaded->character;
    torn.meshes[0].triangles[0].fill(0);  // retired
    const TemporaryFolder folder;
    const auto file = folder.path() / "torn.glb";
    ASSERT_TRUE(save_glb(file, torn, *loaded));
    expect_same_content(decompressed_by_three(file), *load_character(file)->character);
  }
}

TEST(LoadCompressed, a_draco_file_of_others_is_read_as_three_reads_it) {
  SKIP_WITHOUT_DECOMPRESSOR();
  const auto file = assimp_models() / "glTF2/draco/2CylinderEngine.gltf";
  if (assimp_models().empty()) GTEST_SKIP() << "needs Debian's package assimp-testmodels";
  const auto loaded = load_character(file);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  expect_same_content(*loaded->character, decompressed_by_three(file));
  Json json;
  torn_and_saved(*loaded, json);
  EXPECT_EQ(json.dump().find("draco"), std::string::npos);
}

}  // namespace
}  // namespace sunder::test
