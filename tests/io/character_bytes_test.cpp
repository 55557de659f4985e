// load_glb() and save_glb() in memory do what load_character() and save_glb() do with files.

#include <sunder/io/character_file.h>

#include <span>
#include <string>

#include <gtest/gtest.h>

#include "io/internal/load_bytes.h"
#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;

/// The files of a folder.
class Folder : public FileResolver {
 public:
  explicit Folder(fs::path path) : path_(std::move(path)) {}

  [[nodiscard]] Result<std::vector<std::byte>> read(std::string_view uri) const override {
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i)
      if (uri[i] == '%' && i + 2 < uri.size()) {
        name.push_back(
            static_cast<char>(std::stoi(std::string(uri.substr(i + 1, 2)), nullptr, 16)));
        i += 2;
      } else {
        name.push_back(uri[i]);
      }
    if (!fs::is_regular_file(path_ / name))
      return Status::failure(StatusCode::file_not_found, kNone, "no such file");
    return read_bytes(path_ / name);
  }

 private:
  fs::path path_;
};

TEST(CharacterBytes, are_read_and_written_as_files_are) {
  const TemporaryFolder folder;
  for (const fs::path& file : rigged_gltf_models()) {
    SCOPED_TRACE(file.filename().string());
    const auto of_file = load_character(file);
    if (!of_file) continue;
    const auto resolver = std::make_shared<Folder>(file.parent_path());
    const auto of_bytes = load_glb(read_bytes(file), {}, resolver);
    ASSERT_TRUE(of_bytes) << of_bytes.error().text();
    EXPECT_EQ(*of_bytes->character, *of_file->character);
    EXPECT_EQ(of_bytes->report.notes.size(), of_file->report.notes.size());
    Character changed = *of_file->character;
    changed.meshes[0].positions[0].x() += 0.001f;
    ASSERT_TRUE(save_glb(folder.path() / "a.glb", changed, *of_file));
    const auto written = save_glb(changed, *of_bytes);
    ASSERT_TRUE(written) << written.error().text();
    EXPECT_TRUE(read_bytes(folder.path() / "a.glb") == *written);
  }
}

TEST(CharacterBytes, characters_without_a_source_are_written_as_to_files) {
  const TemporaryFolder folder;
  const Character character = make_tube(8, 6, 4);
  ASSERT_TRUE(save_glb(folder.path() / "a.glb", character));
  const auto bytes = save_glb(character);
  ASSERT_TRUE(bytes);
  EXPECT_TRUE(read_bytes(folder.path() / "a.glb") == *bytes);
  Character broken = character;
  broken.meshes[0].skin = 9;
  EXPECT_EQ(save_glb(broken).error().code(), StatusCode::index_out_of_range);
}

TEST(CharacterBytes, names_that_are_not_utf8_are_mended_for_a_valid_file) {
  Character character = make_tube(8, 6, 4);
  character.name = "\xFF";
  character.meshes[0].name = "a\xC0\x80";
  character.skeleton.bones[1].name = "\xED\xA0\x80 b";
  const auto bytes = save_glb(character);
  ASSERT_TRUE(bytes) << bytes.error().text();
  const auto again = load_glb(*bytes);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_NE(again->character->skeleton.bones[1].name.find("\xEF\xBF\xBD"), std::string::npos);
}

TEST(CharacterBytes, nothing_is_read_without_a_resolver) {
  GltfBuilder builder = skinned_strip();
  const std::vector<std::byte> glb = builder.glb();
  const auto loaded = load_glb(glb);
  ASSERT_TRUE(loaded) << loaded.error().text();
  builder.json["images"] = Json::array({{{"uri", "picture.png"}}});
  const auto with_image = load_glb(builder.glb());
  ASSERT_TRUE(with_image) << with_image.error().text();  // noted; the reference stays
  EXPECT_EQ(with_image->report.notes.size(), loaded->report.notes.size() + 1);
  ReadOptions few;
  few.maximum_bytes = glb.size() - 1;
  EXPECT_EQ(load_glb(glb, few).error().code(), StatusCode::limit_exceeded);
  EXPECT_EQ(load_glb({}).error().code(), StatusCode::malformed_file);
}

/// Gives the same bytes for every name, and counts them.
class OneFile : public FileResolver {
 public:
  explicit OneFile(std::string content) : content_(std::move(content)) {}

  [[nodiscard]] Result<std::vector<std::byte>> read(std::string_view /*uri*/) const override {
    bytes_read += content_.size();
    const auto bytes = std::as_bytes(std::span<const char>(content_));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  }

  mutable std::uint64_t bytes_read = 0;

 private:
  std::string content_;
};

/// Saves a strip with these images, whose bytes are the same file.
std::vector<std::byte> saved_with_images(const Json& images, const std::shared_ptr<OneFile>& file,
                                         std::uint64_t maximum_bytes) {
  GltfBuilder builder = skinned_strip();
  builder.json["images"] = images;
  for (std::size_t i = 0; i < images.size(); ++i)
    builder.json["textures"].push_back({{"source", i}});
  ReadOptions options;
  options.maximum_bytes = maximum_bytes;
  const auto loaded = load_glb(builder.glb(), options, file);
  EXPECT_TRUE(loaded) << loaded.error().text();
  if (!loaded) return {};
  file->bytes_read = 0;
  Character changed = *loaded->character;
  changed.meshes[0].positions[0].x() += 0.001f;
  auto written = save_glb(changed, *loaded);
  EXPECT_TRUE(written) << written.error().text();
  return written ? std::move(*written) : std::vector<std::byte>();
}

/// A few bytes can name a large file, in many spellings.
TEST(CharacterBytes, files_that_are_no_images_are_not_read_without_end) {
  constexpr std::uint64_t kLimit = 100'000;
  const auto file = std::make_shared<OneFile>(std::string(30'000, 'x'));
  Json images = Json::array();
  for (std::size_t i = 0; i < 50; ++i) images.push_back({{"uri", std::string(i + 1, '.') + "/x"}});
  (void)saved_with_images(images, file, kLimit);
  EXPECT_EQ(file->bytes_read, 120'000u) << "up to the limit";
  for (Json& image : images) image["uri"] = "x";
  (void)saved_with_images(images, file, kLimit);
  EXPECT_EQ(file->bytes_read, 30'000u) << "one file is read once";
}

TEST(CharacterBytes, an_image_that_many_entries_name_is_embedded_once) {
  const auto file = std::make_shared<OneFile>("RIFFsizeWEBP" + std::string(10'000, 'x'));
  Json images = Json::array();
  for (int i = 0; i < 50; ++i) images.push_back({{"uri", "x.webp"}});
  const std::vector<std::byte> written = saved_with_images(images, file, 1'000'000);
  EXPECT_EQ(file->bytes_read, 10'012u);
  EXPECT_LT(written.size(), 50'000u);
  const auto again = load_glb(written);
  ASSERT_TRUE(again) << again.error().text();
}

TEST(CharacterBytes, a_file_with_a_long_json_is_read) {
  // The limit for the JSON grows with the file: at the least limit, 4.8 MB were the most.
  GltfBuilder builder = skinned_strip();
  builder.json["extras"]["note"] = std::string(std::size_t{6} << 20, 'x');
  const auto loaded = load_glb(builder.glb());
  EXPECT_TRUE(loaded) << loaded.error().text();
}

TEST(CharacterBytes, without_decoders_compressed_files_are_refused_and_others_are_the_same) {
  for (const fs::path& file : rigged_gltf_models()) {
    SCOPED_TRACE(file.filename().string());
    const auto resolver = std::make_shared<Folder>(file.parent_path());
    const auto all = load_glb(read_bytes(file), {}, resolver);
    const auto plain = load_plain_bytes(read_bytes(file), {}, resolver);
    const std::string content = [&] {
      const auto bytes = read_bytes(file);
      return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }();
    const bool is_compressed = content.find("KHR_draco_mesh_compression") != std::string::npos ||
                               content.find("meshopt_compression") != std::string::npos;
    if (is_compressed) {
      EXPECT_EQ(plain.error().code(), StatusCode::unsupported_feature);
    } else if (all) {
      ASSERT_TRUE(plain) << plain.error().text();
      EXPECT_EQ(*plain->character, *all->character);
    }
  }
}

}  // namespace
}  // namespace sunder::test
