// Small files that describe large models: reading ends with limit_exceeded before it takes more
// memory than 64 MiB or 20 times the files, and an option allows more.

#include <gtest/gtest.h>

#include "support/machine/peak_memory.h"
#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"

namespace sunder::test {
namespace {

constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20;

void expect_limit(const char* name, const std::string& content) {
  SCOPED_TRACE(name);
  const TemporaryFolder folder;
  const auto file = folder.write("a.gltf", content);
  const PeakMemory memory;
  const auto loaded = load_character(file);
  EXPECT_EQ(loaded.error().code(), StatusCode::limit_exceeded) << loaded.error().text();
  if (PeakMemory::is_measured()) {
    EXPECT_LE(memory.bytes(), std::max<std::uint64_t>(kLeastMemory, 20 * content.size()));
  }
}

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

TEST(MemoryBound, accessors_without_data) {
  for (const bool is_sparse : {false, true}) {
    GltfBuilder builder = skinned_strip();
    Json zeros = {{"componentType", 5126}, {"count", 4'000'000'000u}, {"type", "VEC3"}};
    if (is_sparse)
      zeros["sparse"] = {{"count", 1},
                         {"indices", {{"bufferView", 0}, {"componentType", 5125}}},
                         {"values", {{"bufferView", 0}}}};
    builder.json["accessors"][0] = zeros;
    expect_limit("zeros", builder.text());
  }
}

/// A few hundred primitives that each read the same large accessor.
TEST(MemoryBound, many_primitives_of_one_accessor) {
  GltfBuilder builder = skinned_strip();
  const std::size_t positions =
      builder.add(std::vector<std::uint8_t>(3 * 200'000, 1), "VEC3", true);
  Json& primitives = builder.json["meshes"][0]["primitives"];
  Json other = {{"attributes", {{"POSITION", positions}}}};
  for (int i = 0; i < 400; ++i) {
    other["attributes"]["_A" + std::to_string(i)] = positions;  // so each has vertices of its own
    primitives.push_back(other);
    other["attributes"].erase("_A" + std::to_string(i));
  }
  expect_limit("primitives", builder.text());
}

TEST(MemoryBound, many_instances) {
  GltfBuilder builder = skinned_strip();
  const std::size_t positions = builder.add(std::vector<float>(3 * 50'000, 1.0f), "VEC3");
  builder.json["meshes"][0]["primitives"] = {{{"attributes", {{"POSITION", positions}}}}};
  for (int i = 0; i < 2'000; ++i) {
    builder.json["scenes"][0]["nodes"].push_back(builder.json["nodes"].size());
    builder.json["nodes"].push_back({{"mesh", 0}});
  }
  expect_limit("instances", builder.text());
}

TEST(MemoryBound, dense_json) {
  const std::string begin = R"({"asset":{"version":"2.0"},"extras":[)", end = "0]}";
  expect_limit("arrays", begin + repeated("[],", 1'500'000) + end);
  expect_limit("objects", begin + repeated("{},", 1'500'000) + end);
  expect_limit("numbers", begin + repeated("0,", 4'000'000) + end);
  expect_limit("nodes",
               R"({"asset":{"version":"2.0"},"nodes":[)" + repeated("{},", 500'000) + "{}]}");
}

TEST(MemoryBound, is_an_option) {
  GltfBuilder builder = skinned_strip();
  const std::size_t positions = builder.add(std::vector<float>(3 * 50'000, 1.0f), "VEC3");
  builder.json["meshes"][0]["primitives"] = {{{"attributes", {{"POSITION", positions}}}}};
  for (int i = 0; i < 60; ++i) {
    builder.json["scenes"][0]["nodes"].push_back(builder.json["nodes"].size());
    builder.json["nodes"].push_back({{"mesh", 0}});
  }
  EXPECT_EQ(builder.load().error().code(), StatusCode::limit_exceeded);
  LoadOptions options;
  options.maximum_memory = std::uint64_t{1} << 30;
  EXPECT_TRUE(builder.load(options));
}

}  // namespace
}  // namespace sunder::test
