#include <sunder/io/character_file.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "io/internal/read_input.h"
#include "tools/messages/lines.h"
#include "tools/messages/messages.h"
#include "tools/model/load_notes.h"
#include "tools/studio/browser.h"
#include "tools/studio/loopback_server.h"
#include "tools/verbs.h"

namespace sunder::tools {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMostPageBytes = std::uint64_t{256} << 20;
constexpr const char* kModelPath = "/model.glb";

/// The installed page, or the one that scripts/js_package made in this tree.
Result<fs::path> find_page() {
  std::error_code error;
  const fs::path own = fs::canonical("/proc/self/exe", error).parent_path();
  for (const char* const place : {SUNDER_STUDIO_FROM_BIN, SUNDER_STUDIO_OF_BUILD})
    if (const fs::path page = own / place; fs::is_regular_file(page, error)) return page;
  return Status::failure(StatusCode::unsupported_feature, kNone,
                         "the studio's page is not installed, and not built by scripts/setup wasm "
                         "and scripts/js_package; --page names another one");
}

/// The model as the GLB that the page reads. A GLB without faults stays as it is.
Result<std::string> read_model(const StudioRequest& request) {
  const fs::path& file = *request.model;
  Budget budget(request.budget, file.string());
  const auto loaded = load_character(file, load_options(request.reading));
  if (!loaded) return loaded.error();
  warn_of_repairs(file.string(), loaded->report, Messages(Verbosity::normal));
  const auto bytes = save_glb(*loaded->character, *loaded);
  if (!bytes) return bytes.error();
  std::string content(bytes->size(), '\0');
  std::transform(bytes->begin(), bytes->end(), content.begin(),
                 [](std::byte byte) { return static_cast<char>(byte); });
  budget.end();
  return content;
}

/// Says where the page is, and opens it.
void announce(const std::string& address, bool opens) {
  Lines lines;
  lines.add(address);
  print(lines);
  const Messages messages(Verbosity::normal);
  if (opens && !open_in_browser(address))
    messages.warn("no program opens addresses here (xdg-open); open it yourself");
  messages.say("Ctrl-C ends the studio");
}

}  // namespace

ExitCode run_studio(const StudioRequest& request) {
  const Result<fs::path> page = request.page ? *request.page : find_page();
  if (!page) return complain("studio", page.error(), ExitCode::usage);
  Result<std::string> html = read_input(*page, kMostPageBytes);
  if (!html) return complain(page->string(), html.error(), ExitCode::unreadable_input);
  std::vector<ServedFile> files = {{"/", "text/html; charset=utf-8", std::move(*html)}};
  std::string query;
  if (request.model) {
    Result<std::string> model = read_model(request);
    if (!model) return complain(request.model->string(), model.error(), ExitCode::unreadable_input);
    files.push_back({kModelPath, "model/gltf-binary", std::move(*model)});
    query =
        "?model=" + std::string(kModelPath) + "&name=" + in_address(request.model->stem().string());
  }
  const Status status = serve_on_loopback(files, request.port, [&](const std::string& origin) {
    announce(origin + "/" + query, request.opens_browser);
  });
  return status ? ExitCode::ok : complain("studio", status, ExitCode::usage);
}

}  // namespace sunder::tools
