// The files that a glTF names: the one that was checked is the one that is read.

#include <sunder/io/character_file.h>

#include <atomic>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <stdio.h>
#include <string>
#include <sys/stat.h>
#include <thread>

#include <gtest/gtest.h>

#include "io/files/allowed_files.h"
#include "support/machine/temporary_folder.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTriangle = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
  "nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
  "buffers":[{"uri":"data.bin","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],
  "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[9,1,0]}]})";

/// The positions of a triangle with one corner at (x, 0, 0).
std::string corners(float x) {
  const float values[9] = {0, 0, 0, x, 0, 0, 0, 1, 0};
  std::string bytes(sizeof values, '\0');
  std::memcpy(bytes.data(), values, sizeof values);
  return bytes;
}

class SideFiles : public testing::Test {
 protected:
  SideFiles() {
    fs::create_directory(folder_.path() / "model");
    folder_.write("secret.bin", std::string_view(corners(9)));
    model_ = folder_.write("model/model.gltf", std::string_view(kTriangle));
    data_ = folder_.write("model/data.bin", std::string_view(corners(1)));
  }

  test::TemporaryFolder folder_;
  fs::path model_, data_;
};

TEST_F(SideFiles, are_read) {
  const auto loaded = load_character(model_);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(loaded->character->meshes.at(0).positions.at(1).x(), 1.0f);
}

TEST_F(SideFiles, are_regular_files) {
  fs::remove(data_);
  fs::create_symlink(folder_.path() / "secret.bin", data_);
  EXPECT_EQ(load_character(model_).error().code(), StatusCode::path_not_allowed);
  fs::remove(data_);
  ASSERT_EQ(mkfifo(data_.c_str(), 0600), 0);
  EXPECT_EQ(load_character(model_).error().code(), StatusCode::file_unreadable);
  fs::remove(data_);
  fs::create_directory(data_);
  EXPECT_EQ(load_character(model_).error().code(), StatusCode::file_unreadable);
  fs::remove(data_);
  EXPECT_EQ(load_character(model_).error().code(), StatusCode::file_not_found);
}

TEST_F(SideFiles, that_became_a_link_after_the_check_are_refused) {
  const fs::path checked = fs::canonical(data_);
  EXPECT_TRUE(files::open_checked_file(checked));
  fs::remove(data_);
  fs::create_symlink(folder_.path() / "secret.bin", data_);
  EXPECT_FALSE(files::open_checked_file(checked));
  EXPECT_TRUE(files::open_regular_file(data_));
}

#if defined(RENAME_EXCHANGE)
TEST_F(SideFiles, that_change_places_with_a_link_lead_nowhere) {
  const fs::path link = folder_.path() / "model/link.bin";
  fs::create_symlink(folder_.path() / "secret.bin", link);
  std::atomic<bool> ends = false;
  std::thread attacker([&] {
    while (!ends) renameat2(AT_FDCWD, link.c_str(), AT_FDCWD, data_.c_str(), RENAME_EXCHANGE);
  });
  int good = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto loaded = load_character(model_);
    if (!loaded) continue;
    ++good;
    EXPECT_EQ(loaded->character->meshes.at(0).positions.at(1).x(), 1.0f) << "after " << i;
  }
  ends = true;
  attacker.join();
  EXPECT_GT(good, 0);
}
#endif

}  // namespace
}  // namespace sunder
