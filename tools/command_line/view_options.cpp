#include "tools/command_line/options.h"

namespace sunder::tools {

CLI::App* add_view(CLI::App& app, ViewRequest& request) {
  CLI::App* const verb = app.add_subcommand(
      "view", "Write a page that shows a model and in which operations are placed by clicks");
  verb->add_option("MODEL", request.model, "Model file, as for `sunder info`")
      ->type_name("FILE")
      ->required();
  verb->add_option("TORN", request.torn, "What `sunder tear` made of it, to be compared with")
      ->type_name("FILE");
  verb->add_option("--ops", request.operations,
                   "Operation log that the page lists, draws and continues")
      ->type_name("FILE");
  verb->add_option("-o,--output", request.output, "File for the page, HTML, which opens offline")
      ->type_name("FILE")
      ->required();
  verb->add_flag_callback(
      "--without-images", [&request] { request.has_images = false; },
      "Leave out the images of base colours, for a smaller page");
  add_model_reading(*verb, request.reading);
  add_budget_of_operations(*verb, request.budget);
  verb->footer(
      "The page saves an operation log that `sunder tear` takes; see docs/view_page.md.\n\n"
      "Example: sunder view fox.glb -o fox.html");
  return verb;
}

}  // namespace sunder::tools
