#include "tools/tear/tear_summary.h"

#include <system_error>

#include "tools/messages/printed.h"
#include "tools/tear/tear_files.h"
#include "tools/written_weights/written_influences.h"

namespace sunder::tools {
namespace {

std::uint64_t vertices_of(const Character& character) {
  std::uint64_t count = 0;
  for (const Mesh& mesh : character.meshes) count += mesh.vertex_count();
  return count;
}

std::string operations_line(const TearRun& run) {
  const RunTotals& totals = run.totals;
  std::string line = printed("operations  %zu done", totals.done);
  if (totals.missed > 0) line += printed(", %zu missed", totals.missed);
  if (totals.refused > 0) line += printed(", %zu left out", totals.refused);
  if (totals.blocked > 0)
    line += printed(", %llu places blocked", static_cast<unsigned long long>(totals.blocked));
  return line;
}

std::string surface_line(const TearRun& run) {
  const std::uint64_t added = vertices_of(run.model.character()) - vertices_of(run.model.source());
  return printed(
      "surface     %llu faces crossed, %llu vertices added, %zu pieces; %u components, "
      "%u boundary loops",
      static_cast<unsigned long long>(run.totals.faces_crossed),
      static_cast<unsigned long long>(added), run.totals.pieces, run.result.components,
      run.result.boundary_loops);
}

std::string weights_line(const TearRun& run) {
  const SaveOptions& save = run.request.save;
  std::string line = std::string("weights     ") + weight_policy_name(run.weighing.options.policy);
  if (run.weighing.refit) line += " over " + refit_over_text(*run.weighing.refit);
  if (run.certified)
    return line +
           printed("; written within %g m of the unpruned skin", run.request.maximum_error->metres);
  const PruningLoss& loss = run.pruning;
  // Meshes that nothing tore are copied, with the weights and formats of their file.
  if (loss.most == 0) return "weights     those of the model; no mesh changed";
  line += printed("; written with at most %u influences as %s", loss.most,
                  weight_format_name(save.weights));
  if (loss.vertices_pruned > 0)
    line += printed(
        ": %llu vertices lost some, at most %.2g %% of their weight, and move by at most %.2g m",
        static_cast<unsigned long long>(loss.vertices_pruned), 100 * loss.dropped_mass_max,
        loss.pruning_error_max);
  return line;
}

std::string file_text(const std::filesystem::path& file) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  if (error) return file.string();
  return bytes < 1'000'000
             ? printed("%s (%.0f kB)", file.c_str(), 1e-3 * static_cast<double>(bytes))
             : printed("%s (%.1f MB)", file.c_str(), 1e-6 * static_cast<double>(bytes));
}

std::string files_line(const TearRun& run) {
  const TearRequest& request = run.request;
  if (request.dry_run || !request.output) return "written     nothing: a dry run";
  std::string line = "written     " + file_text(*request.output);
  if (request.report && !reports_to_stdout(request)) line += ", " + request.report->string();
  if (request.log) line += ", " + request.log->string();
  for (const std::string& piece : run.piece_files) line += ", " + file_text(piece);
  if (run.has_picture) line += ", " + request.picture->string();
  return line;
}

}  // namespace

Lines tear_summary(const TearRun& run) {
  Lines lines;
  lines.add(operations_line(run));
  lines.add(surface_line(run));
  lines.add(weights_line(run));
  lines.add(files_line(run));
  return lines;
}

std::string times_line(const RunTimes& times, double seconds_in_all) {
  const double named = times.loading + times.operations + times.saving;
  return printed(
      "%.3f s: loading %.3f s, operations %.3f s, saving %.3f s, other %.3f s; %.0f %% in "
      "loading, operations and saving",
      seconds_in_all, times.loading, times.operations, times.saving, seconds_in_all - named,
      seconds_in_all > 0 ? 100 * named / seconds_in_all : 100.0);
}

}  // namespace sunder::tools
