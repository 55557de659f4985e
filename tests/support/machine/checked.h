#pragma once

#include <sunder/core/status.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

namespace sunder::test {

/// For scenes whose making must not fail: prints the failure and ends the program.
inline void check(const Status& status) {
  if (status) return;
  std::fprintf(stderr, "%s\n", std::string(status.text()).c_str());
  std::abort();
}

template <class T>
T checked(Result<T> result) {
  if (!result) check(result.error());
  return std::move(*result);
}

}  // namespace sunder::test
