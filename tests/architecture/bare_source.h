#pragma once

#include <string>

namespace sunder::test {

/// The source with comments, preprocessor lines and the contents of literals taken out; lines keep
/// their places.
std::string without_comments_and_literals(const std::string& source);

}  // namespace sunder::test
