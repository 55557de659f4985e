#pragma once

#include <string>
#include <vector>

#include "tools/command_line/listed_options.h"

namespace sunder::tools {

// Scripts that complete verbs, options, choices and files in a shell.
[[nodiscard]] std::string bash_completions(const std::vector<ListedVerb>& verbs);
[[nodiscard]] std::string zsh_completions(const std::vector<ListedVerb>& verbs);
[[nodiscard]] std::string fish_completions(const std::vector<ListedVerb>& verbs);

}  // namespace sunder::tools
