#pragma once

#include <memory>
#include <vector>

#include "tear/model/history.h"
#include "tear/weights/refit_task.h"

namespace sunder::tear {

/// All operations of a model that has no workspace: what they changed, as undoing all of them keeps
/// it for redo, and the history.
struct PackedOperations {
  SurfaceEditor::Redo change;
  History history;
  std::vector<std::weak_ptr<RefitTask>> refits;
};

}  // namespace sunder::tear
