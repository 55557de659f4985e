#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace sunder::tools {

/// Puts the options that are details into a group of their own.
/// @param verb  with all its options.
void shorten_help(CLI::App& verb);

/// Help in which `--help` lists what most people need, and `--help-all` the groups of details too.
class ShortHelp : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override;

 private:
  mutable bool has_details_ = false;  ///< Of the help that is being made.
};

}  // namespace sunder::tools
