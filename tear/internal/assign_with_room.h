#pragma once

#include <cstddef>
#include <vector>

namespace sunder {

/// Copies values into an empty array, with room for `more` after them.
template <class Value>
void assign_with_room(const std::vector<Value>& from, std::size_t more, std::vector<Value>& to) {
  to.reserve(from.size() + more);
  to.assign(from.begin(), from.end());
}

}  // namespace sunder
