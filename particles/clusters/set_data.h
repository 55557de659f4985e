#pragma once

#include <memory>

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// The data of a ParticleSet: a decomposition that other sets share, or after the first tear one of
/// its own.
struct SetData {
  std::shared_ptr<const Structure> shared;  ///< Null if the set was made alone.
  std::unique_ptr<Structure> own;
  SurfacePose pose;        ///< Memory of ParticleSet::rest(): the pose of its last call.
  bool has_pose = false;   ///< Whether `pose` has memory.
  bool is_broken = false;  ///< Memory ran out before there was a structure of its own.

  [[nodiscard]] const Structure& now() const { return own ? *own : *shared; }
  /// The structure to be changed. The first call copies the shared one. @throws std::bad_alloc
  [[nodiscard]] Structure& to_change() {
    if (!own) own = shared->copy();
    return *own;
  }
  [[nodiscard]] std::size_t memory_bytes() const;
};

}  // namespace sunder::particles
