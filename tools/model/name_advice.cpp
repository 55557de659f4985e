#include "tools/model/name_advice.h"

#include <algorithm>
#include <vector>

#include "core/internal/nearest_names.h"

namespace sunder::tools {
namespace {

constexpr std::size_t kMostListed = 10;  ///< Names that are listed if none is near.

}  // namespace

std::string name_advice(const std::string& wanted, const char* kind,
                        std::span<const std::string> names) {
  const std::vector<std::string> near = nearest_names(wanted, names);
  if (!near.empty()) return "; did you mean " + listed_names(near) + "?";
  if (names.empty()) return std::string("; the model has no ") + kind;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostListed); ++i)
    text += (i == 0 ? "'" : ", '") + names[i] + "'";
  if (names.size() > kMostListed)
    text += " and " + std::to_string(names.size() - kMostListed) + " more";
  return std::string("; its ") + kind + ": " + text;
}

}  // namespace sunder::tools
