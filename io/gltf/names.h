#pragma once

#include <string>
#include <vector>

namespace sunder::gltf {

/// Makes every name unique and not empty. The first of several equal names keeps it; the next
/// become "<name>#2", "<name>#3" …; an empty name becomes "<kind> <index>". No new name equals one
/// that the file itself uses.
/// @return number of changed names.
std::size_t make_unique(std::vector<std::string>& names, const std::string& kind);

}  // namespace sunder::gltf
