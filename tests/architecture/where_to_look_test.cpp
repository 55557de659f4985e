// Checks that each place exists that the table "to change … look in …" of docs/where_to_look.md
// names.

#include <cstddef>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "architecture/source_tree.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::size_t kFewestBehaviours = 25;

struct Row {
  std::string behaviour;
  std::vector<std::string> places;  ///< The texts between backticks, in order.
};

std::vector<std::string> texts_in_backticks(const std::string& cell) {
  std::vector<std::string> texts;
  for (std::size_t open = cell.find('`'); open != std::string::npos;) {
    const std::size_t close = cell.find('`', open + 1);
    if (close == std::string::npos) break;
    texts.push_back(cell.substr(open + 1, close - open - 1));
    open = cell.find('`', close + 1);
  }
  return texts;
}

/// The rows of the table whose header begins "| to change".
std::vector<Row> table_of(const std::string& page) {
  std::vector<Row> rows;
  std::istringstream stream(page);
  bool is_inside = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("| to change")) {
      is_inside = true;
    } else if (!line.starts_with("|")) {
      is_inside = false;
    } else if (is_inside && !line.starts_with("|-") && !line.starts_with("| -")) {
      const std::size_t middle = line.find('|', 1);
      rows.push_back({line.substr(2, middle - 2), texts_in_backticks(line.substr(middle))});
    }
  }
  return rows;
}

bool contains(const fs::path& file, const std::string& name) {
  return text_of(file).find(name) != std::string::npos;
}

/// The names in a row that do not exist. A text with a slash is a file or folder below `root`; any
/// other is a name that must occur in the file before it.
std::vector<std::string> missing_places(const fs::path& root, const Row& row) {
  std::vector<std::string> missing;
  fs::path file;
  for (const std::string& place : row.places) {
    if (place.find('/') != std::string::npos) {
      file = root / place;
      if (!fs::exists(file)) missing.push_back(row.behaviour + ": no " + place);
    } else if (!contains(file, place)) {
      missing.push_back(row.behaviour + ": no " + place + " in " + file.filename().string());
    }
  }
  if (file.empty()) missing.push_back(row.behaviour + ": no place is named");
  return missing;
}

TEST(WhereToLook, names_places_that_exist) {
  const fs::path root = SUNDER_SOURCE_DIR;
  const std::vector<Row> rows = table_of(text_of(root / "docs/where_to_look.md"));
  EXPECT_GE(rows.size(), kFewestBehaviours);
  for (const Row& row : rows) EXPECT_THAT(missing_places(root, row), IsEmpty());
}

TEST(WhereToLook, a_place_that_does_not_exist_is_found) {
  const FixtureTree tree("tear/path/entry.cpp", "void find_entry() {}");
  const auto missing = [&](const std::string& row) {
    const auto rows = table_of("| to change | look in |\n|---|---|\n" + row);
    EXPECT_EQ(rows.size(), 1u);
    return missing_places(tree.root(), rows.at(0));
  };
  EXPECT_THAT(missing("| where a tear enters | `tear/path/entry.cpp`: `find_entry` |"), IsEmpty());
  EXPECT_THAT(missing("| where a tear enters | `tear/path/` |"), IsEmpty());
  EXPECT_THAT(missing("| where a tear enters | `tear/path/exit.cpp` |"),
              ElementsAre(HasSubstr("no tear/path/exit.cpp")));
  EXPECT_THAT(missing("| where a tear enters | `tear/path/entry.cpp`: `find_exit` |"),
              ElementsAre(HasSubstr("no find_exit")));
  EXPECT_THAT(missing("| where a tear enters | somewhere |"),
              ElementsAre(HasSubstr("no place is named")));
}

}  // namespace
}  // namespace sunder::test
