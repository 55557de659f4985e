#include "tools/command_line/number_option.h"
#include "tools/command_line/options.h"

namespace sunder::tools {

CLI::App* add_studio(CLI::App& app, StudioRequest& request) {
  CLI::App* const verb = app.add_subcommand(
      "studio", "Open a page in which a moving character is torn by hand, until Ctrl-C");
  verb->add_option("MODEL", request.model,
                   "Model file, as for `sunder info`; default: the characters of the page")
      ->type_name("FILE");
  verb->add_flag_callback(
      "--no-open", [&request] { request.opens_browser = false; },
      "Print the page's address, but open no browser");
  takes_count(verb->add_option("--port", request.port,
                               "Port of this machine at which the page is; 0: a free one")
                  ->capture_default_str(),
              0, 65'535);
  verb->add_option("--page", request.page,
                   "The studio's page; default: the installed one, or the one that was built")
      ->type_name("FILE");
  add_model_reading(*verb, request.reading);
  add_budget(*verb, request.budget);
  verb->footer(
      "Only programs of this machine reach the page; see docs/studio.md.\n\n"
      "Example: sunder studio fox.glb");
  return verb;
}

}  // namespace sunder::tools
