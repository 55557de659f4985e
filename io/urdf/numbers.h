#pragma once

#include <span>
#include <string>
#include <string_view>

#include "io/urdf/findings.h"

namespace sunder::urdf {

/// Reads as many numbers as `numbers` holds, separated by white space, whatever the locale. If the
/// text is anything else, or a number is not finite, they stay as they were, and that is a finding.
/// @param attribute  the name of the text, for the finding.
bool read_numbers(std::string_view text, const char* attribute, const Place& place,
                  std::span<double> numbers, Findings& findings);

}  // namespace sunder::urdf
