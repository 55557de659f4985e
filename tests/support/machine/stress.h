#pragma once

#include <cstdlib>

namespace sunder::test {

/// The number of random cases to run: `usual`, multiplied by `times` if SUNDER_STRESS is set.
inline int stressed(int usual, int times) {
  return std::getenv("SUNDER_STRESS") != nullptr ? times * usual : usual;
}

}  // namespace sunder::test
