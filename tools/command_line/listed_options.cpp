#include "tools/command_line/listed_options.h"

#include <algorithm>
#include <sstream>

namespace sunder::tools {
namespace {

/// The choices of a type name as CLI11 writes it: "TEXT:{float,u16,u8}".
std::vector<std::string> choices_of(const std::string& type) {
  std::vector<std::string> choices;
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return choices;
  std::istringstream list(type.substr(begin + 1, end - begin - 1));
  for (std::string choice; std::getline(list, choice, ',');) choices.push_back(choice);
  return choices;
}

std::string value_of_type(const std::string& type, const std::vector<std::string>& choices) {
  std::string value;
  for (const std::string& choice : choices) value += (value.empty() ? "" : "|") + choice;
  if (!value.empty()) return value;
  value = type.substr(0, type.find(':'));
  if (value == "UINT" || value == "INT") return "N";
  return value == "FLOAT" ? "NUMBER" : value;
}

ListedOption list_option(const CLI::Option& option) {
  ListedOption listed;
  for (const std::string& name : option.get_snames()) listed.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) listed.names.push_back("--" + name);
  if (listed.names.empty()) listed.names.push_back(option.get_name(true));
  listed.text = option.get_description();
  listed.is_required = option.get_required();
  if (option.get_items_expected_max() == 0) return listed;  // A flag.
  listed.choices = choices_of(option.get_type_name());
  listed.value = value_of_type(option.get_type_name(), listed.choices);
  listed.default_text = option.get_default_str();
  return listed;
}

ListedVerb list_verb(const CLI::App& app, const std::string& name) {
  ListedVerb listed{name, app.get_description(), app.get_footer(), {}, {}};
  for (const CLI::Option* const option : app.get_options()) {
    if (option->get_group().empty()) continue;                        // Hidden.
    if (option == app.get_help_all_ptr() && !name.empty()) continue;  // Listed of the command.
    (option->get_positional() ? listed.positionals : listed.options)
        .push_back(list_option(*option));
  }
  return listed;
}

}  // namespace

bool ListedOption::takes_path() const {
  return value.find("FILE") != std::string::npos || value == "FOLDER";
}

std::vector<ListedVerb> list_verbs(const CLI::App& app) {
  std::vector<ListedVerb> verbs = {list_verb(app, "")};
  const auto is_visible = [](const CLI::App* verb) { return !verb->get_group().empty(); };
  for (const CLI::App* const verb : app.get_subcommands(is_visible))
    verbs.push_back(list_verb(*verb, verb->get_name()));
  return verbs;
}

}  // namespace sunder::tools
