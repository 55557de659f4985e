#pragma once

#include <string>
#include <vector>

namespace sunder::gltf {

/// Makes every name unique and not empty. The first of equal names keeps it, the next become
/// "<name>#2", "<name>#3" …; an empty one becomes "<kind> <index>". No new name is one that the
/// file itself uses.
/// @return how many names changed.
std::size_t make_unique(std::vector<std::string>& names, const std::string& kind);

}  // namespace sunder::gltf
