// Which executables are trusted to import models.

#include "io/contained_import/find_helper.h"

#include <sunder/io/character_file.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "io/assimp_text_models.h"
#include "support/machine/temporary_folder.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;
using contained_import::find_helper;

class FindHelper : public testing::Test {
 protected:
  /// A copy of the helper, in a folder of its own.
  [[nodiscard]] fs::path copy(const char* folder) const {
    const fs::path place = folder_.path() / folder;
    fs::create_directory(place);
    chmod(place.c_str(), 0755);
    fs::copy_file(SUNDER_IMPORT_HELPER, place / "sunder-import");
    chmod((place / "sunder-import").c_str(), 0755);
    return place / "sunder-import";
  }
  [[nodiscard]] Status import_by(const fs::path& helper) const {
    LoadOptions options;
    options.import_helper = helper;
    return load_character(folder_.write("square.off", std::string_view(test::kSquareOff)), options)
        .error();
  }

  test::TemporaryFolder folder_;
};

TEST_F(FindHelper, what_others_can_write_is_refused) {
  const fs::path helper = copy("good");
  EXPECT_TRUE(import_by(helper)) << import_by(helper).text();
  const auto is_refused = [&] {
    const Status status = import_by(helper);
    return status.code() == StatusCode::file_unreadable &&
           status.text().find("is refused") != std::string_view::npos;
  };
  const bool has_private_group = geteuid() != 0 && getegid() == geteuid();
  chmod(helper.c_str(), 0757);
  EXPECT_TRUE(is_refused());
  chmod(helper.c_str(), 0775);
  EXPECT_NE(is_refused(), has_private_group);
  chmod(helper.c_str(), 0755);
  EXPECT_FALSE(is_refused());
  for (const mode_t mode : {0777, 01777, 0757}) {
    chmod(helper.parent_path().c_str(), mode);
    EXPECT_TRUE(is_refused()) << std::oct << mode;
  }
  chmod(helper.parent_path().c_str(), 0755);
  EXPECT_FALSE(is_refused());
  if (geteuid() != 0) return;
  for (const fs::path& of : {helper, helper.parent_path()}) {
    ASSERT_EQ(chown(of.c_str(), 12345, 12345), 0);
    EXPECT_TRUE(is_refused()) << of;
    ASSERT_EQ(chown(of.c_str(), 0, 0), 0);
    EXPECT_FALSE(is_refused()) << of;
  }
}

/// It matters what is executed, not which link leads there.
TEST_F(FindHelper, links_are_resolved) {
  const fs::path open_folder = folder_.path() / "open";
  fs::create_directory(open_folder);
  chmod(open_folder.c_str(), 0777);
  const fs::path good = copy("good"), bad = copy("bad");
  chmod(bad.c_str(), 0777);
  fs::create_symlink(good, open_folder / "good");
  fs::create_symlink(bad, good.parent_path() / "bad");
  EXPECT_TRUE(import_by(open_folder / "good"));
  EXPECT_EQ(import_by(good.parent_path() / "bad").code(), StatusCode::file_unreadable);
}

/// What was opened is executed, whatever stands under its name by then.
TEST_F(FindHelper, the_file_is_opened_once) {
  const fs::path helper = copy("good");
  auto found = find_helper(helper);
  ASSERT_TRUE(found);
  struct stat before = {}, opened = {};
  ASSERT_EQ(stat(helper.c_str(), &before), 0);
  fs::remove(helper);
  ASSERT_EQ(fstat(found->descriptor.value(), &opened), 0);
  EXPECT_EQ(opened.st_ino, before.st_ino);
  EXPECT_EQ(find_helper(helper).error().code(), StatusCode::file_not_found);
}

TEST_F(FindHelper, scripts_are_executed_too) {
  const fs::path good = copy("good");
  const fs::path script = folder_.write("wrapper", "#!/bin/sh\nexec '" + good.string() + "'\n");
  chmod(script.c_str(), 0700);
  EXPECT_TRUE(import_by(script)) << import_by(script).text();
}

/// The built helper is found for a program in the build tree, whatever the current folder holds.
TEST_F(FindHelper, the_current_folder_has_no_influence) {
  const fs::path before = fs::current_path();
  const fs::path planted = folder_.write("sunder-import", "#!/bin/sh\ntouch ran\n");
  chmod(planted.c_str(), 0755);
  fs::current_path(folder_.path());
  const auto found = find_helper({});
  fs::current_path(before);
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_EQ(found->path, fs::path(SUNDER_IMPORT_HELPER));
}

}  // namespace
}  // namespace sunder
