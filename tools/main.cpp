#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <string>

#include <CLI/CLI.hpp>

#if SUNDER_COUPLED_REFIT
#include <sunder/coupled_refit/use.h>
#endif

#include "tools/command_line/options.h"

namespace sunder::tools {
namespace {

constexpr const char* kExitCodes =
    "`sunder VERB --help` describes one verb; docs/command.md has all details.\n\n"
    "Exit codes:\n"
    "  0  done\n"
    "  1  done, with findings\n"
    "  2  the command line or the operations are invalid\n"
    "  3  a file cannot be read or written\n"
    "  4  a limit was exceeded: size, memory, time\n"
    "  5  internal error; please report it\n"
    "Data goes to stdout, messages go to stderr.";

struct Requests {
  InfoRequest info;
  PictureRequest picture;
  TearRequest tear;
  DemoRequest demo;
  TransferRequest transfer;
  ValidateRequest validate;
};

/// A verb and its run after parsing.
struct Verb {
  const CLI::App* app;
  std::function<ExitCode()> run;
};

int run(int argc, char** argv) {
#if SUNDER_COUPLED_REFIT
  use_coupled_refit();
#endif
  Requests requests;
  CLI::App app("Tears rigged, animated models.", "sunder");
  app.set_version_flag("--version", "sunder " SUNDER_VERSION);
  app.require_subcommand(1);
  app.footer(kExitCodes);
  const Verb verbs[] = {
      {add_info(app, requests.info), [&] { return run_info(requests.info); }},
      {add_picture(app, requests.picture), [&] { return run_picture(requests.picture); }},
      {add_tear(app, requests.tear), [&] { return run_tear(requests.tear); }},
      {add_transfer(app, requests.transfer), [&] { return run_transfer(requests.transfer); }},
      {add_validate(app, requests.validate), [&] { return run_validate(requests.validate); }},
      {add_demo(app, requests.demo), [&] { return run_demo(requests.demo); }},
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? static_cast<int>(ExitCode::ok)
                                : static_cast<int>(ExitCode::usage);
  }
  for (const Verb& verb : verbs)
    if (verb.app->parsed()) return static_cast<int>(verb.run());
  return static_cast<int>(ExitCode::usage);  // Not reached: a verb is required.
}

}  // namespace
}  // namespace sunder::tools

int main(int argc, char** argv) {
  using sunder::tools::ExitCode;
  try {
    return sunder::tools::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("sunder: out of memory\n", stderr);
    return static_cast<int>(ExitCode::limit_exceeded);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sunder: internal error: %s\n", error.what());
    return static_cast<int>(ExitCode::internal_error);
  }
}
