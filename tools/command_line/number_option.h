#pragma once

#include <CLI/CLI.hpp>

#include "core/internal/number_range.h"
#include "tools/model/quantity.h"

namespace sunder::tools {

/// Lets an option take a number with or without a unit of its quantity, and refuse what its range
/// does not hold, with the value and the range. The help shows the range.
CLI::Option* takes(CLI::Option* option, const NumberRange& range,
                   Quantity quantity = Quantity::number);

/// The same for whole numbers.
CLI::Option* takes_count(CLI::Option* option, unsigned least, unsigned most);

// The ranges of limits that verbs share.
inline constexpr NumberRange kSeconds = {
    .field = "the value", .least = 1e-6, .most = 1e9, .unit = " s"};
inline constexpr NumberRange kMegabytes = {
    .field = "the value", .least = 1e-6, .most = 1e6, .unit = " MB"};

inline constexpr unsigned kMostInfluences = 65'535, kMostVertices = 1'000'000'000;

/// Checks the value of an option whose text is read elsewhere, as those above do.
/// @throws CLI::ValidationError
void check_value(const char* option, const NumberRange& range, double value);

}  // namespace sunder::tools
