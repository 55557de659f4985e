// The options of the command agree with docs/command/, the manual page and the completions.

#include "tools/command_line/command_line.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "tools/command_line/listed_options.h"
#include "tools/run_command.h"
#include "tools/tear/aimed_fields.h"

namespace sunder::tools {
namespace {

using test::CommandResult;
using test::run_sunder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::vector<ListedVerb> all_verbs() {
  CLI::App app;
  Requests requests;
  describe_command(app);
  const std::vector<Verb> verbs = add_verbs(app, requests);
  EXPECT_GT(verbs.size(), 5u);
  return list_verbs(app);
}

/// "-o, --output FILE".
std::string signature(const ListedOption& option) {
  std::string text;
  for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + name;
  return option.value.empty() ? text : text + ' ' + option.value;
}

std::string default_of(const ListedOption& option) {
  return option.is_required ? "required" : option.default_text;
}

using OptionTable = std::map<std::string, std::string>;  // Defaults by signature.

OptionTable options_in_app(const ListedVerb& verb) {
  OptionTable table;
  for (const ListedOption& option : verb.options)
    if (verb.name.empty() || option.names.back() != "--help")
      table[signature(option)] = default_of(option);
  return table;
}

/// The rows "| `--option VALUE` | text | default |" of a part of a page.
OptionTable options_in_page(const std::string& part) {
  OptionTable table;
  const std::regex row(R"(\| `(-[^`]*)` \|(.*)\| *([^|]*?) *\|)");
  std::istringstream lines(part);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, row)) continue;
    const std::string name = std::regex_replace(match[1].str(), std::regex(R"(\\\|)"), "|");
    table[name] = std::regex_replace(match[3].str(), std::regex("`"), "");
  }
  return table;
}

/// docs/command.md with an empty name, and the pages of docs/command/ by the verb of their titles.
/// One without a verb has no options.
std::map<std::string, std::string> pages_by_verb() {
  std::map<std::string, std::string> pages;
  const std::filesystem::path docs = SUNDER_SOURCE_DIR "/docs";
  pages[""] = test::read_text(docs / "command.md");
  for (const auto& entry : std::filesystem::directory_iterator(docs / "command")) {
    const std::string text = test::read_text(entry.path());
    std::smatch title;
    if (std::regex_search(text, title, std::regex("^# `sunder ([a-z]+)")))
      pages[title[1]] = text;
    else
      EXPECT_TRUE(options_in_page(text).empty()) << entry.path();
  }
  return pages;
}

TEST(CommandLine, the_page_lists_every_option_with_its_default) {
  std::map<std::string, std::string> pages = pages_by_verb();
  std::set<std::string> verbs;
  for (const ListedVerb& verb : all_verbs()) {
    EXPECT_EQ(options_in_page(pages[verb.name]), options_in_app(verb)) << "sunder " << verb.name;
    verbs.insert(verb.name);
  }
  for (const auto& [verb, page] : pages) EXPECT_TRUE(verbs.contains(verb)) << verb;
}

TEST(CommandLine, help_and_manual_and_completions_have_every_option) {
  const std::string manual = run_sunder({"man"}).out;
  const std::string fish = run_sunder({"completions", "fish"}).out;
  const std::string zsh = run_sunder({"completions", "zsh"}).out;
  const std::string bash = run_sunder({"completions", "bash"}).out;
  for (const ListedVerb& verb : all_verbs()) {
    std::vector<std::string> arguments = {"--help-all"};
    if (!verb.name.empty()) arguments.insert(arguments.begin(), verb.name);
    const std::string help = run_sunder(arguments).out;
    const std::size_t section = verb.name.empty() ? 0 : manual.find(".SS \"sunder " + verb.name);
    ASSERT_NE(section, std::string::npos) << verb.name;
    const std::string of_verb = manual.substr(section, manual.find(".S", section + 3) - section);
    for (const ListedOption& option : verb.options)
      for (const std::string& name : option.names) {
        EXPECT_THAT(help, HasSubstr(name));
        if (!verb.name.empty()) {
          EXPECT_THAT(of_verb,
                      HasSubstr("\\fB" + std::regex_replace(name, std::regex("-"), "\\-")));
        }
        EXPECT_THAT(zsh, HasSubstr(name));
        EXPECT_THAT(bash, HasSubstr(name));
        const bool is_long = name.starts_with("--");
        EXPECT_THAT(fish, HasSubstr((is_long ? " -l " : " -s ") + name.substr(is_long ? 2 : 1)));
      }
  }
  EXPECT_THAT(run_sunder({"--help"}).out, testing::Not(HasSubstr("completions")));
}

/// Runs a shell script. @return its exit code and output.
CommandResult run_script(const char* shell, const std::string& script) {
  return test::run_program(shell, {"-c", script});
}

bool has(const char* program) {
  return std::system((std::string("command -v ") + program + " >/dev/null 2>&1").c_str()) == 0;
}

std::string save(const test::TemporaryFolder& folder, const std::string& name,
                 const std::string& text) {
  const std::string file = (folder.path() / name).string();
  std::ofstream(file) << text;
  return file;
}

TEST(CommandLine, help_is_short_and_says_that_there_is_more) {
  for (const ListedVerb& verb : all_verbs()) {
    if (verb.name.empty()) continue;
    const std::string help = run_sunder({verb.name, "--help"}).out;
    EXPECT_LE(std::ranges::count(help, '\n'), 60) << verb.name;
    std::size_t listed = 0;
    for (const ListedOption& option : verb.options)
      listed += help.find("  " + option.names.front()) != std::string::npos ? 1 : 0;
    const std::regex counted(R"((\d+) options, listed by --help-all)");
    for (std::sregex_iterator line(help.begin(), help.end(), counted), end; line != end; ++line)
      listed += std::stoul((*line)[1]);
    EXPECT_EQ(listed, verb.options.size()) << help;
  }
}

TEST(CommandLine, the_manual_is_valid) {
  if (!has("man") && !has("mandoc")) GTEST_SKIP() << "needs man or mandoc";
  const test::TemporaryFolder folder;
  const std::string page = save(folder, "sunder.1", run_sunder({"man"}).out);
  if (has("mandoc")) {
    const CommandResult lint = run_script("/bin/sh", "mandoc -Tlint -W error '" + page + "'");
    EXPECT_EQ(lint.exit_code, 0) << lint.out;
  }
  if (!has("man")) return;
  const CommandResult shown =
      run_script("/bin/sh", "MANWIDTH=100 man --warnings=w -l '" + page + "'");
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.err, testing::Not(HasSubstr("warning")));
}

class BashCompletion : public testing::Test {
 protected:
  void SetUp() override {
    if (!has("bash")) GTEST_SKIP() << "needs bash";
    script_ = save(folder_, "sunder", run_sunder({"completions", "bash"}).out);
    save(folder_, "two words.glb", "");
  }
  /// What the script proposes for the last of these words.
  std::vector<std::string> complete(const std::string& words) {
    const CommandResult result = run_script(
        "/bin/bash", "set -u; cd '" + folder_.path().string() + "'; source '" + script_ +
                         "'; COMP_WORDS=(" + words +
                         "); COMP_CWORD=$(( ${#COMP_WORDS[@]} - 1 )); _sunder; "
                         "(( ${#COMPREPLY[@]} == 0 )) || printf '%s\\n' \"${COMPREPLY[@]}\"");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::vector<std::string> proposals;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) proposals.push_back(line);
    return proposals;
  }
  test::TemporaryFolder folder_;
  std::string script_;
};

TEST_F(BashCompletion, it_completes_verbs_options_choices_and_files) {
  EXPECT_EQ(run_script("/bin/bash", "bash -n '" + script_ + "'").exit_code, 0);
  EXPECT_THAT(complete("sunder t"), UnorderedElementsAre("tear", "transfer"));
  EXPECT_THAT(complete("sunder --v"), ElementsAre("--version"));
  EXPECT_THAT(complete("sunder tear --refit"),
              UnorderedElementsAre("--refit-over", "--refit-bound"));
  EXPECT_THAT(complete("sunder tear --weights-as u"), UnorderedElementsAre("u16", "u8"));
  EXPECT_THAT(complete("sunder tear --weights-as = u1"), ElementsAre("u16"));
  EXPECT_THAT(complete("sunder tear --weights-as ="), UnorderedElementsAre("float", "u16", "u8"));
  EXPECT_THAT(complete("sunder tear two"), ElementsAre("two words.glb"));
  EXPECT_THAT(complete("sunder tear --ops two"), ElementsAre("two words.glb"));
  EXPECT_THAT(complete("sunder tear --refit-bound t"), IsEmpty());
  EXPECT_THAT(complete("sunder transfer --m"),
              UnorderedElementsAre("--method", "--mix", "--max-error", "--memory", "--max-seconds",
                                   "--max-memory"));
}

TEST(CommandLine, other_shells_can_read_their_completions) {
  bool is_checked = false;
  const test::TemporaryFolder folder;
  for (const char* const shell : {"zsh", "fish"}) {
    if (!has(shell)) continue;
    is_checked = true;
    const std::string script = save(folder, shell, run_sunder({"completions", shell}).out);
    const CommandResult result = run_script("/bin/sh", std::string(shell) + " -n '" + script + "'");
    EXPECT_EQ(result.exit_code, 0) << shell << result.err;
  }
  if (!is_checked) GTEST_SKIP() << "needs zsh or fish";
}

TEST(CommandLine, ItsPageListsTheFieldsOfAimedOperations) {
  std::ifstream file(std::filesystem::path(SUNDER_SOURCE_DIR) / "docs/command/tear.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  for (const char* const op : {"slash", "sever", "puncture"}) {
    const std::size_t begin = page.find("| `--" + std::string(op) + " BONE");
    ASSERT_NE(begin, std::string::npos) << op;
    const std::string row = page.substr(begin, page.find('\n', begin) - begin);
    for (const AimedField& field : aimed_fields(op).fields)
      if (field.name != kShareField) {
        EXPECT_THAT(row, HasSubstr("`" + std::string(field.name) + "`"));
      }
  }
}

}  // namespace
}  // namespace sunder::tools
