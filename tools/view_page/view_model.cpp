#include <sunder/io/character_file.h>
#include <sunder/io/operation_log.h>

#include <string>
#include <utility>
#include <vector>

#include "tools/messages/messages.h"
#include "tools/messages/overwriting.h"
#include "tools/model/load_notes.h"
#include "tools/model/plain_operations.h"
#include "tools/model/robot_joints.h"
#include "tools/page_parts/page_file.h"
#include "tools/verbs.h"
#include "tools/view_page/write_view_page.h"

namespace sunder::tools {
namespace {

/// Adds a model with its colours; `loaded` keeps what the page refers to.
Status view(const std::filesystem::path& file, const ViewRequest& request, LoadedCharacter& loaded,
            ViewedModel& viewed) {
  Result<LoadedCharacter> result = load_character(file, load_options(request.reading));
  if (!result) return result.error();
  warn_of_repairs(file.string(), result->report, Messages(Verbosity::normal));
  loaded = std::move(*result);
  const bool has_images = request.has_images;
  Result<BaseColours> colours = read_base_colours(*loaded.source, has_images ? kMostImageBytes : 0);
  if (!colours) return colours.error();
  if (has_images && colours->left_out > 0)
    Messages(Verbosity::normal)
        .warn(file.string() + ": " + std::to_string(colours->left_out) + " images cannot be shown");
  viewed = {loaded.character.get(), file.filename().string(), std::move(*colours)};
  return {};
}

/// The fault of an output that would overwrite an input; empty if there is none.
std::string overwriting_output(const ViewRequest& request) {
  std::vector<NamedFile> inputs = {{"MODEL", request.model}};
  if (request.torn) inputs.push_back({"TORN", *request.torn});
  if (request.operations) inputs.push_back({"--ops", *request.operations});
  return overwriting(inputs, {{"--output", request.output}});
}

}  // namespace

ExitCode run_view(const ViewRequest& request) {
  if (const Status status = has_pages(); !status) return complain("view", status, ExitCode::usage);
  if (const std::string fault = overwriting_output(request); !fault.empty()) {
    print_error("sunder: " + fault);
    return ExitCode::usage;
  }
  Budget budget(request.budget, request.model.string());
  ViewInput input;
  LoadedCharacter model, torn;
  if (const Status status = view(request.model, request, model, input.model); !status)
    return complain(request.model.string(), status, ExitCode::unreadable_input);
  if (request.torn)
    if (const Status status = view(*request.torn, request, torn, input.torn); !status)
      return complain(request.torn->string(), status, ExitCode::unreadable_input);
  if (request.operations) {
    const auto operations = load_plain_operations(*request.operations, model.character, budget);
    if (!operations)
      return complain(request.operations->string(), operations.error(), ExitCode::usage);
    Result<std::string> text = format_operations(*operations);
    if (!text) return complain(request.operations->string(), text.error(), ExitCode::usage);
    input.operations = std::move(*text);
  }
  budget.end();
  const Status status = write_view_page(request.output, input);
  return status ? ExitCode::ok : complain(request.output.string(), status, ExitCode::usage);
}

}  // namespace sunder::tools
