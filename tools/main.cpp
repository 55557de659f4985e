#include <exception>
#include <new>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>

#if SUNDER_COUPLED_REFIT
#include <sunder/coupled_refit/use.h>
#endif

#include "tools/command_line/command_line.h"
#include "tools/command_line/unknown_words.h"
#include "tools/messages/lines.h"
#include "tools/messages/messages.h"

namespace sunder::tools {
namespace {

/// Prints help to stdout and errors to stderr.
ExitCode refuse(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success))
    if (const std::string unknown = unknown_word(app); !unknown.empty()) {
      print_error(unknown);
      print_error("Run with --help for more information.");
      return ExitCode::usage;
    }
  std::ostringstream out, err;
  const int code = app.exit(error, out, err);
  print_text(out.str());
  // The message may contain an argument with line ends, which print_error() shows as escapes.
  std::string text = err.str();
  if (const std::string message = error.what(); !message.empty() && text.starts_with(message)) {
    print_error(message);
    text.erase(0, text.find('\n', message.size()) + 1);
  }
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) print_error(line);
  return code == 0 ? ExitCode::ok : ExitCode::usage;
}

ExitCode run(int argc, char** argv) {
#if SUNDER_COUPLED_REFIT
  use_coupled_refit();
#endif
  Requests requests;
  CLI::App app;
  describe_command(app);
  const std::vector<Verb> verbs = add_verbs(app, requests);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return refuse(app, error);
  }
  for (const Verb& verb : verbs)
    if (verb.app->parsed()) return verb.run();
  return ExitCode::usage;  // Not reached: a verb is required.
}

}  // namespace
}  // namespace sunder::tools

int main(int argc, char** argv) {
  using sunder::tools::ExitCode;
  using sunder::tools::print_error;
  try {
    return static_cast<int>(sunder::tools::run(argc, argv));
  } catch (const std::bad_alloc&) {
    print_error("sunder: out of memory");
    return static_cast<int>(ExitCode::limit_exceeded);
  } catch (const std::exception& error) {
    print_error(std::string("sunder: internal error: ") + error.what());
    return static_cast<int>(ExitCode::internal_error);
  }
}
