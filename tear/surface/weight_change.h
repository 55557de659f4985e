#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// The current or future weights of a vertex.
struct VertexWeights {
  Index mesh = 0, vertex = 0;
  WeightPolicy policy = WeightPolicy::barycentric;
  Vec3f position = Vec3f::Zero();
  Index first_influence = 0, influence_count = 0;  ///< Range in WeightChange::influences.
  Index kept_birth = kNone;                        ///< Result of Births::keep().
};

struct WeightChange {
  /// Ascending by mesh, then by vertex; only appended vertices.
  std::vector<VertexWeights> vertices;
  std::vector<Influence> influences;
  /// Memory of the weights that the last exchange put in place, for the next one.
  std::vector<VertexWeights> spare_vertices;
  std::vector<Influence> spare_influences;
};

/// Exchanges the weights of vertices with those in `change`. A second call restores them, and does
/// not allocate.
/// @throws CapacityExceeded, std::bad_alloc before anything is changed
void exchange_weights(WeightChange& change, SurfaceEditor& editor);

/// Describes what exchange_weights() changes, before or after it.
void describe_weights(const WeightChange& exchanged, const SurfaceEditor& editor,
                      ChangeRecord& change);

}  // namespace sunder::tear
