#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace sunder::tools {

/// An option or a positional argument as the manual, the completions and the documentation list it.
struct ListedOption {
  std::vector<std::string> names;    ///< "-o", "--output"; of a positional: "MODEL".
  std::string value;                 ///< "FILE", "float|u16|u8"; empty for a flag.
  std::vector<std::string> choices;  ///< If the value is one of a few.
  std::string text;                  ///< What it does.
  std::string default_text;          ///< Empty if there is none.
  bool is_required = false;

  /// Whether the value is the path of a file or folder.
  [[nodiscard]] bool takes_path() const;
};

/// A verb of the command, or the command itself, whose name is empty.
struct ListedVerb {
  std::string name, text, footer;
  std::vector<ListedOption> positionals, options;
};

/// The command itself, then its verbs, without hidden ones.
[[nodiscard]] std::vector<ListedVerb> list_verbs(const CLI::App& app);

}  // namespace sunder::tools
