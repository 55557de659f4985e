#include "io/gltf/names.h"

#include <unordered_map>
#include <unordered_set>

namespace sunder::gltf {

std::size_t make_unique(std::vector<std::string>& names, const std::string& kind) {
  const std::unordered_set<std::string> originals(names.begin(), names.end());
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string, std::size_t> next_number;
  std::size_t changed = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!names[i].empty() && taken.insert(names[i]).second) continue;
    const std::string base = names[i].empty() ? kind + " " + std::to_string(i) : names[i];
    std::string candidate = base;
    std::size_t& number = next_number.try_emplace(base, 1).first->second;
    while (originals.count(candidate) != 0 || taken.count(candidate) != 0)
      candidate = base + "#" + std::to_string(++number);
    taken.insert(candidate);
    names[i] = candidate;
    ++changed;
  }
  return changed;
}

}  // namespace sunder::gltf
