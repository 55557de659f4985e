#include "tools/command_line/unknown_words.h"

#include <algorithm>
#include <vector>

#include "core/internal/nearest_names.h"
#include "tools/command_line/listed_options.h"

namespace sunder::tools {
namespace {

/// What is often looked for, and why no verb has it.
struct AbsentOption {
  const char* name;
  const char* reason;
};
constexpr AbsentOption kAbsentOptions[] = {
    {"--perforation",
     "a perforation shows only where force tears, which this command does not do; a program can "
     "tear by force (tear_overstretched())"}};

std::string advice(const std::string& wanted, const std::vector<std::string>& names) {
  const std::vector<std::string> near = nearest_names(wanted, names);
  return near.empty() ? "" : "; did you mean " + listed_names(near) + "?";
}

std::string unknown_verb(const std::string& word, const std::vector<ListedVerb>& verbs) {
  std::vector<std::string> names;
  for (const ListedVerb& verb : verbs)
    if (!verb.name.empty()) names.push_back(verb.name);
  const std::string near = advice(word, names);
  return "sunder has no verb '" + word + "'" +
         (near.empty() ? "; its verbs: " + listed_names(names) : near);
}

std::string unknown_option(const std::string& word, const ListedVerb& verb) {
  const std::string command = verb.name.empty() ? "sunder" : "sunder " + verb.name;
  if (!word.starts_with('-')) return command + ": one argument too many: '" + word + "'";
  const std::string option = word.substr(0, word.find('='));
  for (const AbsentOption& absent : kAbsentOptions)
    if (option == absent.name) return command + " has no option '" + option + "': " + absent.reason;
  std::vector<std::string> names;
  for (const ListedOption& listed : verb.options)
    names.insert(names.end(), listed.names.begin(), listed.names.end());
  return command + " has no option '" + option + "'" + advice(option, names);
}

}  // namespace

std::string unknown_word(const CLI::App& app) {
  const std::vector<ListedVerb> verbs = list_verbs(app);
  for (const CLI::App* const parsed : app.get_subcommands()) {
    const std::vector<std::string> rest = parsed->remaining();
    if (rest.empty()) continue;
    const auto verb = std::ranges::find(verbs, parsed->get_name(), &ListedVerb::name);
    // An unknown option is named rather than the value that follows it.
    const auto option =
        std::ranges::find_if(rest, [](const std::string& word) { return word.starts_with('-'); });
    if (verb != verbs.end()) return unknown_option(option == rest.end() ? rest[0] : *option, *verb);
  }
  const std::vector<std::string> rest = app.remaining();
  if (rest.empty()) return {};
  if (rest[0].starts_with('-')) return unknown_option(rest[0], verbs.front());
  return app.get_subcommands().empty() ? unknown_verb(rest[0], verbs)
                                       : unknown_option(rest[0], verbs.front());
}

}  // namespace sunder::tools
