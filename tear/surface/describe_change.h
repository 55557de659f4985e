#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

// What an engine copies to do what the editor did, but for lips and rims. Records are written in
// the memory that they have.

/// What changed since a mark.
void describe_change(const EditLog::Mark& begin, const SurfaceEditor& editor, ChangeRecord& change);
/// What roll_back() is about to change; there are no lips and rims.
void describe_roll_back(const EditLog::Mark& begin, const SurfaceEditor& editor,
                        ChangeRecord& change);
/// What redo() is about to do.
void describe_redo(const SurfaceEditor::Redo& redo, const SurfaceEditor& editor,
                   ChangeRecord& change);

}  // namespace sunder::tear
