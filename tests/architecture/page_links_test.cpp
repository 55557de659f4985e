// Checks that the links between the documents lead somewhere, that docs/README.md leads to every
// page, and that sources name no page that does not exist.

#include <cctype>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "architecture/source_tree.h"

namespace sunder::test {
namespace {

namespace pages = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// The name of a heading in links, by GitHub's rule: small letters, no punctuation, hyphens instead
/// of spaces.
std::string anchor_of(std::string_view heading) {
  std::string anchor;
  for (const char letter : heading) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte >= 0x80 || std::isalnum(byte) != 0 || letter == '_' || letter == '-')
      anchor += static_cast<char>(std::tolower(byte));
    else if (letter == ' ')
      anchor += '-';
  }
  return anchor;
}

/// The text of a page without blocks of code.
std::string without_code(const std::string& page) {
  std::istringstream stream(page);
  std::string text;
  bool is_code = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.find("```") != std::string::npos)
      is_code = !is_code;
    else if (!is_code)
      text += line + "\n";
  }
  return text;
}

std::set<std::string> anchors_of(const std::string& page) {
  std::set<std::string> anchors;
  std::istringstream stream(without_code(page));
  for (std::string line; std::getline(stream, line);) {
    const std::size_t level = line.find_first_not_of('#');
    if (level == 0 || level == std::string::npos || line[level] != ' ') continue;
    const std::string anchor = anchor_of(std::string_view(line).substr(level + 1));
    std::string next = anchor;
    for (int i = 1; !anchors.insert(next).second; ++i) next = anchor + "-" + std::to_string(i);
  }
  return anchors;
}

/// The targets of `[text](target)`, but those of the network.
std::vector<std::string> links_of(const std::string& page) {
  const std::string text = without_code(page);
  std::vector<std::string> links;
  for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 2)) {
    const std::size_t end = text.find(')', at);
    if (end == std::string::npos) break;
    const std::string target = text.substr(at + 2, end - at - 2);
    if (target.find("://") == std::string::npos &&
        target.find_first_of(" \n`") == std::string::npos)
      links.push_back(target);
  }
  return links;
}

std::vector<pages::path> pages_of(const pages::path& root) {
  std::vector<pages::path> found;
  const auto add = [&](const pages::directory_entry& entry) {
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  };
  for (const auto& entry : pages::directory_iterator(root)) add(entry);
  if (pages::exists(root / "docs"))
    for (const auto& entry : pages::recursive_directory_iterator(root / "docs")) add(entry);
  return found;
}

/// "page: target" of each link that leads nowhere.
std::vector<std::string> broken_links(const pages::path& root) {
  std::vector<std::string> broken;
  for (const pages::path& page : pages_of(root))
    for (const std::string& target : links_of(text_of(page))) {
      const std::size_t hash = target.find('#');
      const std::string file = target.substr(0, hash);
      const pages::path to = file.empty() ? page : page.parent_path() / file;
      const bool is_found =
          pages::exists(to) && (hash == std::string::npos || to.extension() != ".md" ||
                                anchors_of(text_of(to)).contains(target.substr(hash + 1)));
      if (!is_found) broken.push_back(name_below(root, page) + ": " + target);
    }
  return broken;
}

/// The pages of docs/ to which docs/README.md does not lead.
std::vector<std::string> unlisted_pages(const pages::path& root) {
  const pages::path index = root / "docs" / "README.md";
  std::set<pages::path> listed = {index};
  for (const std::string& target : links_of(text_of(index)))
    listed.insert((root / "docs" / target.substr(0, target.find('#'))).lexically_normal());
  std::vector<std::string> missing;
  for (const pages::path& page : pages_of(root))
    if (page.parent_path() != root && !listed.contains(page))
      missing.push_back(name_below(root, page));
  return missing;
}

/// "file: page" of each `docs/….md` that a source names and that does not exist.
std::vector<std::string> pages_named_in_vain(const pages::path& root) {
  const std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_-/";
  std::vector<std::string> missing;
  for (const pages::path& file : source_files(root)) {
    const std::string name = name_below(root, file);
    if (name.starts_with("build/") || name.find("node_modules/") != std::string::npos) continue;
    const std::string text = text_of(file);
    for (std::size_t at = text.find("docs/"); at != std::string::npos;
         at = text.find("docs/", at + 1)) {
      const std::size_t end = text.find_first_not_of(letters, at);
      if (end == std::string::npos || text.compare(end, 3, ".md") != 0) continue;
      const std::string page = text.substr(at, end - at) + ".md";
      if (!pages::exists(root / page)) missing.push_back(name + ": " + page);
    }
  }
  return missing;
}

TEST(PageLinks, lead_somewhere) { EXPECT_THAT(broken_links(SUNDER_SOURCE_DIR), IsEmpty()); }

TEST(PageLinks, of_the_index_lead_to_every_page) {
  EXPECT_THAT(unlisted_pages(SUNDER_SOURCE_DIR), IsEmpty());
  EXPECT_GT(links_of(text_of(pages::path(SUNDER_SOURCE_DIR) / "docs" / "README.md")).size(), 25u);
  EXPECT_NE(text_of(pages::path(SUNDER_SOURCE_DIR) / "README.md").find("](docs/README.md)"),
            std::string::npos);
}

TEST(PageLinks, pages_that_sources_name_exist) {
  EXPECT_THAT(pages_named_in_vain(SUNDER_SOURCE_DIR), IsEmpty());
}

TEST(PageLinks, faults_are_found) {
  const FixtureTree page("docs/README.md",
                         "# A b: `c`\n[x](#a-b-c) [y](#d) [z](other.md) [n](https://a.b/c.md)\n"
                         "```\n[code](nowhere.md)\n```\n");
  EXPECT_THAT(broken_links(page.root()),
              ElementsAre("docs/README.md: #d", "docs/README.md: other.md"));
  const FixtureTree unlisted("docs/method/evaluation.md", "# A\n");
  EXPECT_THAT(unlisted_pages(unlisted.root()), ElementsAre("docs/method/evaluation.md"));
  const FixtureTree source("tear/a.h",
                           "/// See doc"
                           "s/no_page.md.\n");
  EXPECT_THAT(pages_named_in_vain(source.root()), SizeIs(1));
}

}  // namespace
}  // namespace sunder::test
