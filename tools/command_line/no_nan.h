#pragma once

#include <cmath>
#include <string>

#include <CLI/CLI.hpp>

namespace sunder::tools {

/// Refuses what is not a number: CLI11's ranges have no bound that it violates. Shows nothing in
/// the help.
[[nodiscard]] inline CLI::Validator no_nan() {
  return {[](const std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && std::isnan(value)
                       ? "Value " + text + " is not a number"
                       : std::string();
          },
          ""};
}

}  // namespace sunder::tools
