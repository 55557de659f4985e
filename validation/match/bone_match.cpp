#include "validation/match/bone_match.h"

#include <algorithm>
#include <map>
#include <string_view>

namespace sunder::validation {
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
std::vector<std::string> words_of(std::string_view name) {
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

/// A key per bone in which fuzzily equal names agree.
std::vector<std::string> fuzzy_keys(const Skeleton& skeleton) {
  std::vector<std::vector<std::string>> names;
  for (const Bone& bone : skeleton.bones) names.push_back(words_of(bone.name));
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

class Matching {
 public:
  Matching(const Skeleton& source, const Skeleton& target) : source_(source), target_(target) {
    match_.source_of_target.assign(target.bones.size(), kNone);
    match_.kind.assign(target.bones.size(), BoneMatchKind::none);
    match_.target_of_source.assign(source.bones.size(), kNone);
  }

  void join(Index target, Index source, BoneMatchKind kind) {
    match_.source_of_target[target] = source;
    match_.kind[target] = kind;
    if (match_.target_of_source[source] == kNone) match_.target_of_source[source] = target;
  }

  Status join_given(std::span<const BoneNames> mapping) {
    for (Index i = 0; i < mapping.size(); ++i) {
      const Index target = index_of(target_, mapping[i].target),
                  source = index_of(source_, mapping[i].source);
      if (target == kNone || source == kNone)
        return Status::failure(StatusCode::not_found, i, "pair %u: the %s has no bone '%.80s'", i,
                               target == kNone ? "target" : "source",
                               (target == kNone ? mapping[i].target : mapping[i].source).c_str());
      if (match_.source_of_target[target] != kNone)
        return Status::failure(StatusCode::invalid_argument, i,
                               "pair %u: bone '%.80s' of the target was given before", i,
                               mapping[i].target.c_str());
      join(target, source, BoneMatchKind::mapping);
    }
    return {};
  }

  /// Joins the free bones whose keys agree and are unique among the free bones of each side.
  void join_equal(const std::vector<std::string>& source_keys,
                  const std::vector<std::string>& target_keys, BoneMatchKind kind) {
    struct Holders {
      Index source = kNone, target = kNone;
      bool is_ambiguous = false;
    };
    std::map<std::string_view, Holders> holders;
    for (Index i = 0; i < source_keys.size(); ++i)
      if (match_.target_of_source[i] == kNone) {
        Holders& of_key = holders[source_keys[i]];
        of_key.is_ambiguous |= of_key.source != kNone;
        of_key.source = i;
      }
    for (Index i = 0; i < target_keys.size(); ++i)
      if (match_.source_of_target[i] == kNone) {
        Holders& of_key = holders[target_keys[i]];
        of_key.is_ambiguous |= of_key.target != kNone;
        of_key.target = i;
      }
    for (const auto& [key, of_key] : holders)
      if (!key.empty() && !of_key.is_ambiguous && of_key.source != kNone && of_key.target != kNone)
        join(of_key.target, of_key.source, kind);
  }

  BoneMatch finish() {
    for (Index i = 0; i < target_.bones.size(); ++i) {
      const Index parent = target_.bones[i].parent;
      Index driver = match_.source_of_target[i];
      if (driver == kNone) driver = parent == kNone ? 0 : match_.driver_of_target[parent];
      match_.driver_of_target.push_back(driver);
    }
    return std::move(match_);
  }

 private:
  static Index index_of(const Skeleton& skeleton, const std::string& name) {
    for (Index i = 0; i < skeleton.bones.size(); ++i)
      if (skeleton.bones[i].name == name) return i;
    return kNone;
  }

  const Skeleton& source_;
  const Skeleton& target_;
  BoneMatch match_;
};

std::vector<std::string> names_of(const Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const Bone& bone : skeleton.bones) names.push_back(bone.name);
  return names;
}

}  // namespace

Index BoneMatch::count(BoneMatchKind of_kind) const {
  return static_cast<Index>(std::ranges::count(kind, of_kind));
}

Result<BoneMatch> match_bones(const Skeleton& source, const Skeleton& target,
                              std::span<const BoneNames> mapping) {
  Matching matching(source, target);
  if (const Status status = matching.join_given(mapping); !status) return status;
  matching.join_equal(names_of(source), names_of(target), BoneMatchKind::exact);
  matching.join_equal(fuzzy_keys(source), fuzzy_keys(target), BoneMatchKind::fuzzy);
  return matching.finish();
}

int side_of_name(const std::string& name) { return side_of_words(words_of(name)); }

std::vector<Index> mirrored_bones(const Skeleton& skeleton) {
  const std::vector<std::string> keys = fuzzy_keys(skeleton);
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

}  // namespace sunder::validation
