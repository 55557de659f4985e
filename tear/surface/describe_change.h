#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

// Write change records, except lips and rims. The memory of the records is reused.

/// Describes the changes since a mark.
void describe_change(const EditLog::Mark& begin, const SurfaceEditor& editor, ChangeRecord& change);
/// Describes the changes that roll_back() will make. The record has no lips and rims.
void describe_roll_back(const EditLog::Mark& begin, const SurfaceEditor& editor,
                        ChangeRecord& change);
/// Describes the changes that redo() will make.
void describe_redo(const SurfaceEditor::Redo& redo, const SurfaceEditor& editor,
                   ChangeRecord& change);

}  // namespace sunder::tear
