#include "core/internal/nearest_names.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace sunder {
namespace {

constexpr std::size_t kMost = 3;  ///< Names that are proposed.
/// Of longer names only the beginnings are compared: files may have names of megabytes, and the
/// time grows with the product of two lengths.
constexpr std::size_t kMostLetters = 128;

std::string_view beginning_of(std::string_view name) {
  return without_namespace(name).substr(0, kMostLetters);
}

std::string without_capitals(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return text;
}

/// Number of letters to insert, delete, replace or swap with their neighbour.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

bool is_near(std::size_t edits, const std::string& a, const std::string& b) {
  return 3 * edits <= std::max(a.size(), b.size());
}

/// Whether a mistyped name may stand for one word of a name.
bool is_near_a_word(const std::string& key, std::string_view name) {
  constexpr std::size_t kShortest = 3;  // of shorter words each is near to each
  return key.size() >= kShortest &&
         std::ranges::any_of(words_of(name), [&](const std::string& word) {
           return word.size() >= kShortest && is_near(edit_distance(key, word), key, word);
         });
}

}  // namespace

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  bool is_open = false, was_small = false;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    const bool is_letter = std::isalpha(letter) != 0 || letter >= 0x80;
    if (is_letter && (!is_open || (was_small && std::isupper(letter) != 0))) words.emplace_back();
    if (is_letter) words.back() += static_cast<char>(std::tolower(letter));
    is_open = is_letter;
    was_small = std::islower(letter) != 0;
  }
  return words;
}

std::vector<std::string> nearest_names(const std::string& wanted,
                                       std::span<const std::string> names) {
  const std::string key = without_capitals(std::string(beginning_of(wanted)));
  std::vector<std::pair<std::size_t, std::string>> near;
  for (const std::string& name : names) {
    const std::string_view beginning = beginning_of(name);
    const std::string other = without_capitals(std::string(beginning));
    const std::size_t edits = edit_distance(key, other);
    const bool is_part =
        key.size() > 2 && (other.find(key) != std::string::npos ||
                           (other.size() > 2 && key.find(other) != std::string::npos));
    if (is_part || is_near(edits, key, other) || is_near_a_word(key, beginning))
      near.emplace_back(edits, name);
  }
  std::ranges::stable_sort(near, {}, &std::pair<std::size_t, std::string>::first);
  std::vector<std::string> result;
  for (std::size_t i = 0; i < std::min(near.size(), kMost); ++i)
    result.push_back(std::move(near[i].second));
  return result;
}

std::string listed_names(std::span<const std::string> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + ("'" + names[i] + "'");
  return text;
}

std::string_view without_namespace(std::string_view name) {
  const std::size_t end = name.find_last_of(":|");
  return end == std::string_view::npos || end + 1 == name.size() ? name : name.substr(end + 1);
}

}  // namespace sunder
