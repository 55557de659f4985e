#include "tools/tear/detached_pieces.h"

#include <sunder/skinning/pose.h>

#include <utility>

#include "tools/model/model_output.h"

namespace sunder::tools {

Result<TearReport> DetachedPieces::apply(const Operation& operation, TornModel& model) {
  const std::uint32_t before = model.undo_count();
  const auto* const detached = std::get_if<DetachOperation>(&operation);
  if (detached == nullptr) {
    Result<TearReport> report = apply_operation(model, operation);
    if (report) keep(operation, {}, model.undo_count() > before);
    return report;
  }
  const Result<ModelPose> pose = make_pose(model.source(), detached->pose);
  if (!pose) return pose.error();
  Result<DetachedPiece> piece = detach(model, *pose, detached->piece, options_);
  if (!piece) return piece.error();
  TearReport report = piece->report;
  keep(operation, std::move(*piece), true);
  return report;
}

void DetachedPieces::keep(const Operation& operation, Step piece, bool is_recorded) {
  const auto move = [](std::vector<Step>& from, std::vector<Step>& to, std::uint32_t count) {
    for (; count > 0; --count) {
      to.push_back(std::move(from.back()));
      from.pop_back();
    }
  };
  if (const auto* const undo = std::get_if<UndoOperation>(&operation)) {
    move(done_, undone_, undo->count);
  } else if (const auto* const redo = std::get_if<RedoOperation>(&operation)) {
    move(undone_, done_, redo->count);
  } else if (is_recorded) {
    done_.push_back(std::move(piece));
    undone_.clear();
  }
}

std::vector<std::string> DetachedPieces::files() const {
  std::vector<std::string> files;
  for (const Step& step : done_)
    if (step) files.push_back(prefix_ + std::to_string(files.size() + 1) + extension_);
  return files;
}

ExitCode DetachedPieces::write(const LoadedCharacter& loaded, const SaveOptions& save,
                               const FinishPiece& finish, const Messages& messages,
                               std::vector<std::string>& written) const {
  SaveOptions options = save;
  options.weights_of_mesh.clear();  // of the meshes of the model
  const std::vector<std::string> names = files();
  for (const Step& step : done_) {
    if (!step) continue;
    const std::string& file = names[written.size()];
    const Status status = write_new(file, *finish(*step), loaded.source, options, messages);
    if (!status) return complain(file, status, ExitCode::internal_error);
    written.push_back(file);
  }
  return ExitCode::ok;
}

}  // namespace sunder::tools
