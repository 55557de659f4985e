#include "tools/nearest_names.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>
#include <vector>

namespace sunder::tools {
namespace {

constexpr std::size_t kOffered = 3;

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// Number of single characters to insert, remove or replace to get from one name to the other.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string offer_names(std::string_view name, std::span<const std::string> names) {
  if (names.empty()) return "; there are none";
  const std::string wanted = lower(name);
  std::vector<std::pair<std::size_t, const std::string*>> ranked;
  for (const std::string& candidate : names) {
    const std::string known = lower(candidate);
    const bool contains =
        !wanted.empty() && !known.empty() &&
        (known.find(wanted) != std::string::npos || wanted.find(known) != std::string::npos);
    ranked.emplace_back(contains ? 0 : edit_distance(wanted, known), &candidate);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const bool resembles = ranked.front().first <= std::max<std::size_t>(2, wanted.size() / 2);
  std::string text = resembles ? "; did you mean " : "; there are, for example, ";
  std::size_t offered = std::min(kOffered, ranked.size());
  if (resembles)  // Not those that resemble it much less than the best one.
    while (offered > 1 && ranked[offered - 1].first > 2 * ranked.front().first + 2) --offered;
  for (std::size_t i = 0; i < offered; ++i) {
    const char* const separator = i == 0            ? ""
                                  : i + 1 < offered ? ", "
                                  : resembles       ? " or "
                                                    : " and ";
    text += separator + ("'" + *ranked[i].second + "'");
  }
  return resembles ? text + "?" : text;
}

}  // namespace sunder::tools
