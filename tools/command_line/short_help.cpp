#include "tools/command_line/short_help.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace sunder::tools {
namespace {

constexpr const char* kDetails = "Details";
constexpr const char* kGroupsOfDetails[] = {kDetails, "A robot", "Closing wounds"};
constexpr const char* kDetailedOptions[] = {
    "--animated-pieces",  "--count-topology", "--import-seconds",
    "--limits",           "--max-error",      "--max-memory",
    "--max-seconds",      "--max-vertices",   "--memory",
    "--open-span",        "--package-root",   "--refit-bound",
    "--refit-over",       "--strict",         "--tissue-field",
    "--weights-as",       "--weight-errors",  "--wound-mask-channels",
    "--wound-mask-reach", "--wound-mask-size"};

}  // namespace

void shorten_help(CLI::App& verb) {
  for (const char* const name : kDetailedOptions)
    if (CLI::Option* const option = verb.get_option_no_throw(name)) option->group(kDetails);
}

std::string ShortHelp::make_help(const CLI::App* app, std::string name,
                                 CLI::AppFormatMode mode) const {
  has_details_ = mode != CLI::AppFormatMode::Normal;
  return CLI::Formatter::make_help(app, std::move(name), mode);
}

std::string ShortHelp::make_group(std::string group, bool is_positional,
                                  std::vector<const CLI::Option*> options) const {
  if (has_details_ || std::ranges::find(kGroupsOfDetails, group) == std::end(kGroupsOfDetails))
    return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
  return "\n" + group + ": " + std::to_string(options.size()) + " options, listed by --help-all\n";
}

}  // namespace sunder::tools
