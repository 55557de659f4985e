#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Vertices per mesh, ascending.
using VerticesOfMeshes = std::vector<std::vector<Index>>;

/// The vertices that only the triangles of a detached piece use. @throws std::bad_alloc
/// @param begin  of the detachment, which is done.
[[nodiscard]] VerticesOfMeshes released_vertices(const EditLog::Mark& begin,
                                                 const SurfaceEditor& editor);
/// The same for a detachment that is undone. @param redo  of the detachment.
[[nodiscard]] VerticesOfMeshes released_vertices(const SurfaceEditor::Redo& redo,
                                                 const SurfaceEditor& editor);

/// Moves the lists into a record of the same change.
void put_released(VerticesOfMeshes& vertices, ChangeRecord& change) noexcept;
void put_returned(VerticesOfMeshes& vertices, ChangeRecord& change) noexcept;

}  // namespace sunder::tear
