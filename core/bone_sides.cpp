#include "core/internal/bone_sides.h"

#include <algorithm>
#include <map>
#include <string_view>

namespace sunder {
namespace {

bool is_upper(char letter) { return letter >= 'A' && letter <= 'Z'; }
bool is_lower(char letter) { return letter >= 'a' && letter <= 'z'; }
bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }
bool is_separator(char letter) {
  return std::string_view(" ._-/").find(letter) != std::string_view::npos;
}
char lower(char letter) {
  return is_upper(letter) ? static_cast<char>(letter - 'A' + 'a') : letter;
}

/// The words of a name without its namespaces ("rig:", "Armature|"), in lower case: separators and
/// capitals part them.
std::vector<std::string> name_words(std::string_view name) {
  if (const std::size_t end = name.find_last_of(":|"); end != std::string_view::npos)
    name.remove_prefix(end + 1);
  std::vector<std::string> words;
  bool begins = true;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (is_separator(name[i])) {
      begins = true;
      continue;
    }
    const bool is_capital =
        i > 0 && is_upper(name[i]) &&
        (!is_upper(name[i - 1]) || (i + 1 < name.size() && is_lower(name[i + 1])));
    if (begins || is_capital) words.emplace_back();
    words.back() += lower(name[i]);
    begins = false;
  }
  return words;
}

int side_of_word(const std::string& word) {
  if (word == "l" || word == "left") return -1;
  return word == "r" || word == "right" ? 1 : 0;
}

int side_of_words(const std::vector<std::string>& words) {
  for (const std::string& word : words)
    if (const int side = side_of_word(word); side != 0) return side;
  return 0;
}

/// The first word of more than half of all names ("mixamorig", "def"); empty if there is none.
std::string common_prefix(const std::vector<std::vector<std::string>>& names) {
  std::map<std::string, std::size_t> count;
  for (const auto& words : names)
    if (words.size() > 1 && side_of_word(words[0]) == 0) ++count[words[0]];
  for (const auto& [word, times] : count)
    if (2 * times > names.size()) return word;
  return {};
}

/// Whether a name would still be one without its first word.
bool has_own_words(const std::vector<std::string>& words) {
  return std::any_of(words.begin() + 1, words.end(), [](const std::string& word) {
    return side_of_word(word) == 0 && !std::ranges::all_of(word, is_digit);
  });
}

}  // namespace

std::vector<std::string> fuzzy_names(const Skeleton& skeleton) {
  std::vector<std::vector<std::string>> names;
  for (const Bone& bone : skeleton.bones) names.push_back(name_words(bone.name));
  const std::string prefix = common_prefix(names);
  std::vector<std::string> keys;
  for (const auto& words : names) {
    const int side = side_of_words(words);
    std::string& key = keys.emplace_back();
    bool has_side = false;
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (i == 0 && words[0] == prefix && has_own_words(words)) continue;
      if (!has_side && side_of_word(words[i]) != 0)
        has_side = true;
      else
        key += words[i];
    }
    key += side < 0 ? "<" : side > 0 ? ">" : "";
  }
  return keys;
}

int side_of_name(const std::string& name) { return side_of_words(name_words(name)); }

std::vector<Index> mirrored_bones(const Skeleton& skeleton) {
  const std::vector<std::string> keys = fuzzy_names(skeleton);
  std::map<std::string_view, std::vector<Index>> holders;
  for (Index i = 0; i < keys.size(); ++i) holders[keys[i]].push_back(i);
  std::vector<Index> mirrored(keys.size(), kNone);
  for (Index i = 0; i < keys.size(); ++i) {
    if (keys[i].empty() || (keys[i].back() != '<' && keys[i].back() != '>')) continue;
    std::string other = keys[i];
    other.back() = other.back() == '<' ? '>' : '<';
    const auto found = holders.find(other);
    if (found != holders.end() && found->second.size() == 1 && holders[keys[i]].size() == 1)
      mirrored[i] = found->second[0];
  }
  return mirrored;
}

}  // namespace sunder
