#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// What a vertex has, or is to have.
struct VertexWeights {
  Index mesh = 0, vertex = 0;
  WeightPolicy policy = WeightPolicy::barycentric;
  Vec3f position = Vec3f::Zero();
  Index first_influence = 0, influence_count = 0;  ///< In WeightChange::influences.
  Index kept_birth = kNone;                        ///< As Births::keep() returned it.
};

struct WeightChange {
  std::vector<VertexWeights>
      vertices;  ///< Ascending per mesh, mesh after mesh; none of the source.
  std::vector<Influence> influences;
};

/// Gives vertices what is in `change`, and writes there what they had: a second call takes it back.
/// @throws CapacityExceeded, std::bad_alloc before anything is changed
void exchange_weights(WeightChange& change, SurfaceEditor& editor);

/// Describes what exchange_weights() changes, before or after it.
void describe_weights(const WeightChange& exchanged, const SurfaceEditor& editor,
                      ChangeRecord& change);

}  // namespace sunder::tear
