#include "core/internal/nearest_names.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace sunder {
namespace {

constexpr std::size_t kMostNames = 3;

char lower(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

/// Levenshtein distance without regard to case.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

bool contains(std::string_view text, std::string_view part) {
  return !part.empty() &&
         std::search(text.begin(), text.end(), part.begin(), part.end(),
                     [](char a, char b) { return lower(a) == lower(b); }) != text.end();
}

}  // namespace

std::string_view without_namespace(std::string_view name) {
  const std::size_t end = name.find_last_of(":|");
  return end == std::string_view::npos || end + 1 == name.size() ? name : name.substr(end + 1);
}

std::string nearest_names(std::string_view wanted, std::span<const std::string_view> names) {
  const std::string_view plain = without_namespace(wanted);
  const std::size_t farthest = std::max<std::size_t>(2, plain.size() / 2);
  std::vector<std::pair<std::size_t, std::string_view>> near;
  for (const std::string_view name : names) {
    const std::string_view candidate = without_namespace(name);
    // A name that contains the wanted one is a good guess, however long it is.
    const std::size_t distance = contains(candidate, plain) ? 1 : edit_distance(plain, candidate);
    if (distance <= farthest) near.emplace_back(distance, name);
  }
  std::stable_sort(near.begin(), near.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (near.size() > kMostNames) near.resize(kMostNames);
  std::string text;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (i > 0) text += i + 1 == near.size() ? " or " : ", ";
    text += "'" + std::string(near[i].second.substr(0, 40)) + "'";
  }
  return text;
}

}  // namespace sunder
