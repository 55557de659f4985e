#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sunder::test {

struct ScannedFunction {
  std::string name;
  std::size_t line = 0;   ///< The line where it begins, from 1.
  std::size_t lines = 0;  ///< From its first line to its closing brace.
  std::size_t parameters = 0;
  std::size_t nesting = 0;  ///< See nesting_of().
};

/// Functions with a body of more than one line in a source that clang-format has laid out: a
/// function ends at the first brace in the column in which it began. Lambdas belong to the function
/// around them.
std::vector<ScannedFunction> scan_functions(const std::string& source);

}  // namespace sunder::test
