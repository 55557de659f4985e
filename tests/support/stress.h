#pragma once

#include <cstdlib>

namespace sunder::test {

/// How many random cases to run: `usual`, or with SUNDER_STRESS set `times` as many.
inline int stressed(int usual, int times) {
  return std::getenv("SUNDER_STRESS") != nullptr ? times * usual : usual;
}

}  // namespace sunder::test
