#include "tools/command_line/command_line.h"

#include <memory>
#include <string>

#include "tools/command_line/completions.h"
#include "tools/command_line/listed_options.h"
#include "tools/command_line/manual.h"
#include "tools/command_line/options.h"
#include "tools/command_line/short_help.h"
#include "tools/messages/lines.h"

namespace sunder::tools {
namespace {

constexpr const char* kVersion = "sunder " SUNDER_VERSION;
constexpr const char* kExitCodes =
    "`sunder VERB --help` describes one verb; docs/command.md leads to all details.\n\n"
    "Exit codes:\n"
    "  0  done\n"
    "  1  done, with findings\n"
    "  2  the command line or the operations are invalid\n"
    "  3  a file cannot be read or written\n"
    "  4  a limit was exceeded: size, memory, time, vertices; --max-seconds, --max-memory and\n"
    "     --max-vertices allow more\n"
    "  5  internal error; please report it\n"
    "Data goes to stdout, messages go to stderr.";

ExitCode print(const std::string& text) {
  print_text(text);
  return ExitCode::ok;
}

std::string completions_for(const std::string& shell, const CLI::App& app) {
  const std::vector<ListedVerb> verbs = list_verbs(app);
  if (shell == "zsh") return zsh_completions(verbs);
  return shell == "fish" ? fish_completions(verbs) : bash_completions(verbs);
}

CLI::App* add_hidden(CLI::App& app, const char* name, const char* text) {
  return app.add_subcommand(name, text)->group("");
}

}  // namespace

void describe_command(CLI::App& app) {
  app.description("Tears rigged, animated models.");
  app.name("sunder");
  app.set_version_flag("--version", kVersion, "Print the version and exit");
  app.require_subcommand(1);
  app.formatter(std::make_shared<ShortHelp>());
  app.set_help_all_flag("--help-all", "Print help with all options and exit");
  app.footer(kExitCodes);
}

std::vector<Verb> add_verbs(CLI::App& app, Requests& requests) {
  std::vector<Verb> verbs = {
      {add_info(app, requests.info), [&] { return run_info(requests.info); }},
      {add_picture(app, requests.picture), [&] { return run_picture(requests.picture); }},
      {add_tear(app, requests.tear), [&] { return run_tear(requests.tear); }},
      {add_plan(app, requests.plan), [&] { return run_plan(requests.plan); }},
      {add_transfer(app, requests.transfer), [&] { return run_transfer(requests.transfer); }},
      {add_bind(app, requests.bind), [&] { return run_bind(requests.bind); }},
      {add_validate(app, requests.validate), [&] { return run_validate(requests.validate); }},
      {add_view(app, requests.view), [&] { return run_view(requests.view); }},
      {add_studio(app, requests.studio), [&] { return run_studio(requests.studio); }},
      {add_demo(app, requests.demo), [&] { return run_demo(requests.demo); }},
      {add_hidden(app, "man", "Print the manual page"),
       [&] { return print(manual_page(list_verbs(app), kVersion)); }},
  };
  CLI::App* const completions = add_hidden(app, "completions", "Print completions for a shell");
  completions->add_option("SHELL", requests.shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  for (CLI::App* const verb : app.get_subcommands([](const CLI::App*) { return true; }))
    shorten_help(*verb);
  verbs.push_back({completions, [&] { return print(completions_for(requests.shell, app)); }});
  return verbs;
}

}  // namespace sunder::tools
