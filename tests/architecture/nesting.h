#pragma once

#include <cstddef>
#include <string_view>

namespace sunder::test {

/// How many branches, loops, `try` blocks and lambdas stand around the innermost statement of a
/// function's body, with or without braces. `else if` is on the level of its `if`. @param body
/// without comments and contents of literals.
std::size_t nesting_of(std::string_view body);

}  // namespace sunder::test
