// Checks the includes between the rooms (folders) inside a module, as module_arrows_test.cpp does
// between modules.

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "architecture/module_folders.h"
#include "architecture/source_tree.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The rooms of a module and, for each, the rooms it may include in addition to itself. "." is the
/// module's root. Every room may include `internal`, which includes no room.
using Rooms = std::map<std::string, std::set<std::string>>;

const std::map<std::string, Rooms> kRooms = {
    {"tear",
     {{".",
       {"model", "detached", "suture", "weld", "operation", "pieces", "posed", "surface", "weights",
        "geometry"}},
      {"suture", {"weld", "operation", "posed", "surface", "geometry"}},
      {"weld", {"operation", "sheet", "posed", "surface", "geometry"}},
      {"model", {"detached", "operation", "pieces", "posed", "surface", "weights", "geometry"}},
      {"contact", {"model", "operation", "pieces", "posed", "surface", "geometry"}},
      {"wound_mask", {"model", "surface", "geometry"}},
      {"detached", {"posed", "surface", "geometry"}},
      {"operation", {"filling", "path", "sheet", "posed", "surface", "geometry"}},
      {"filling", {"section", "path", "sheet", "posed", "surface", "geometry"}},
      {"sheet", {"path", "posed", "surface", "geometry"}},
      {"path", {"posed", "surface", "geometry"}},
      {"pieces", {"posed", "surface"}},
      {"weights", {"surface", "geometry"}},
      {"posed", {"surface", "geometry"}},
      {"section", {}},
      {"surface", {"geometry"}},
      {"geometry", {}}}},
    {"particles",
     {{".", {"authored", "bullet", "clusters", "contact", "front", "motion", "repair", "rupture"}},
      {"authored", {"clusters"}},
      {"bullet", {}},
      {"contact", {"clusters", "motion"}},
      {"motion", {"clusters"}},
      {"rupture", {"clusters", "motion"}},
      {"repair", {"clusters", "front"}},
      {"clusters", {"front"}},
      {"front", {}}}},
    {"scene",
     {{".", {"actor", "drawing", "snapshot", "threads"}},
      {"actor", {"snapshot", "threads"}},
      {"snapshot", {}},
      {"drawing", {}},
      {"threads", {}}}},
    {"validation",
     {{".", {"checks", "match"}}, {"checks", {"match"}}, {"transfer", {"match"}}, {"match", {}}}},
    {"io",
     {{".",
       {"contained_import", "gltf", "gltf_read", "gltf_write", "gltf_patch", "gltf_decoders",
        "gltf_files", "operation_log", "files", "trajectory", "urdf", "usd_write"}},
      {"contained_import", {"assimp", "import_checks", "import_messages", "files"}},
      {"import_helper", {"assimp", "import_messages", "files"}},
      {"import_messages", {"files"}},
      {"assimp", {"collada", "fbx", "import_checks", "files"}},
      {"collada", {}},
      {"fbx", {}},
      {"import_checks", {}},
      {"gltf", {}},
      {"gltf_read", {"gltf"}},
      {"gltf_write", {"gltf"}},
      {"gltf_patch", {"gltf", "gltf_read", "gltf_write"}},
      {"gltf_decoders", {"gltf", "gltf_read", "compression"}},
      {"gltf_files", {"gltf", "files"}},
      {"compression", {}},
      {"urdf", {"gltf", "gltf_read", "gltf_write", "files"}},
      {"usd_write", {"gltf", "gltf_read", "gltf_write"}},
      {"json", {}},
      {"operation_log", {}},
      {"trajectory", {"operation_log"}},
      {"files", {}}}},
};

/// The room of a file, given relative to its module: "surface" for "surface/undo.h".
std::string room_of(const std::string& file) {
  const std::size_t slash = file.rfind('/');
  return slash == std::string::npos ? "." : file.substr(0, slash);
}

bool may_include(const Rooms& rooms, const std::string& from, const std::string& to) {
  if (from == to) return true;
  if (to == "internal") return true;
  const auto room = rooms.find(from);
  return room != rooms.end() && room->second.contains(to);
}

/// One line per include that no arrow of `rooms` allows, sorted.
std::vector<std::string> room_faults(const fs::path& root, const std::string& module,
                                     const Rooms& rooms) {
  const std::string folder = folder_of(module);
  std::vector<std::string> faults;
  for (const fs::path& path : source_files(root / folder)) {
    if (module_of(name_below(root, path)) != module) continue;
    const std::string file = name_below(root / folder, path);
    const std::string from = room_of(file);
    if (from != "internal" && !rooms.contains(from))
      faults.push_back(module + "/" + from + ": not a room");
    for (const Include& include : includes_of(path)) {
      if (!include.quoted || module_of(include.path) != module) continue;
      const std::string to = room_of(include.path.substr(folder.size() + 1));
      if (!may_include(rooms, from, to))
        faults.push_back(module + "/" + file + ": " + include.path + ": the arrow from " + from +
                         " to " + to + " is not allowed");
    }
  }
  std::sort(faults.begin(), faults.end());
  faults.erase(std::unique(faults.begin(), faults.end()), faults.end());
  return faults;
}

/// The rooms that are on a cycle of arrows.
std::vector<std::string> rooms_in_circles(const Rooms& rooms) {
  std::vector<std::string> found;
  for (const auto& [start, unused] : rooms) {
    std::set<std::string> reached;
    std::vector<std::string> open = {start};
    while (!open.empty()) {
      const std::string room = open.back();
      open.pop_back();
      const auto arrows = rooms.find(room);
      if (arrows == rooms.end()) continue;
      for (const std::string& next : arrows->second)
        if (reached.insert(next).second) open.push_back(next);
    }
    if (reached.contains(start)) found.push_back(start);
  }
  return found;
}

/// Arrows of the table that lead to an unknown room.
std::vector<std::string> unknown_rooms(const Rooms& rooms) {
  std::vector<std::string> found;
  for (const auto& [room, arrows] : rooms)
    for (const std::string& to : arrows)
      if (!rooms.contains(to)) found.push_back(room + " -> " + to);
  return found;
}

const Rooms kExample = {{".", {"upper"}}, {"upper", {"lower"}}, {"lower", {}}};

std::vector<std::string> room_faults_of(const std::string& file, const std::string& content) {
  const FixtureTree tree(file, content);
  return room_faults(tree.root(), "tear", kExample);
}

TEST(RoomArrows, our_rooms_follow_them) {
  for (const auto& [module, rooms] : kRooms) {
    ASSERT_FALSE(source_files(fs::path(SUNDER_SOURCE_DIR) / folder_of(module)).empty()) << module;
    EXPECT_THAT(room_faults(SUNDER_SOURCE_DIR, module, rooms), IsEmpty());
  }
}

TEST(RoomArrows, have_no_circle) {
  for (const auto& [module, rooms] : kRooms) {
    EXPECT_THAT(rooms_in_circles(rooms), IsEmpty()) << module;
    EXPECT_THAT(unknown_rooms(rooms), IsEmpty()) << module;
  }
}

TEST(RoomArrows, name_rooms_that_exist) {
  for (const auto& [module, rooms] : kRooms)
    for (const auto& [room, unused] : rooms)
      EXPECT_TRUE(fs::is_directory(fs::path(SUNDER_SOURCE_DIR) / folder_of(module) / room))
          << module << "/" << room;
}

TEST(RoomArrows, an_arrow_that_is_not_in_the_table_is_found) {
  EXPECT_THAT(room_faults_of("tear/lower/a.cpp", "#include \"tear/upper/b.h\""),
              ElementsAre(HasSubstr("from lower to upper")));
  EXPECT_THAT(room_faults_of("tear/lower/a.cpp", "#include \"tear/b.h\""),
              ElementsAre(HasSubstr("from lower to .")));
  EXPECT_THAT(room_faults_of("tear/a.cpp", "#  include  \"tear/lower/b.h\""),
              ElementsAre(HasSubstr("from . to lower")));
  EXPECT_THAT(room_faults_of("tear/a.cpp", "#include \"tear/upper/b.h\"\n#include \"tear/c.h\""),
              IsEmpty());
  EXPECT_THAT(room_faults_of("tear/upper/a.cpp", "// #include \"tear/other/b.h\""), IsEmpty());
}

TEST(RoomArrows, all_rooms_may_include_internal_headers_which_include_none) {
  EXPECT_THAT(room_faults_of("tear/lower/a.cpp", "#include \"tear/internal/b.h\""), IsEmpty());
  EXPECT_THAT(room_faults_of("tear/internal/a.h", "#include \"tear/internal/b.h\""), IsEmpty());
  EXPECT_THAT(room_faults_of("tear/internal/a.h", "#include \"tear/lower/b.h\""),
              ElementsAre(HasSubstr("from internal to lower")));
}

TEST(RoomArrows, a_room_that_is_not_in_the_table_is_found) {
  EXPECT_THAT(room_faults_of("tear/attic/a.cpp", "#include <vector>"),
              ElementsAre("tear/attic: not a room"));
  EXPECT_THAT(room_faults_of("tear/upper/attic/a.cpp", "#include <vector>"),
              ElementsAre("tear/upper/attic: not a room"));
}

TEST(RoomArrows, a_circle_is_found) {
  EXPECT_THAT(rooms_in_circles({{"a", {"b"}}, {"b", {"c"}}, {"c", {"a"}}, {"d", {"a"}}}),
              ElementsAre("a", "b", "c"));
  EXPECT_THAT(rooms_in_circles(kExample), IsEmpty());
}

}  // namespace
}  // namespace sunder::test
