#pragma once

#include <memory>

#include "core/internal/threads.h"

namespace sunder::particles {

struct Structure;

/// Connects a set with its fork, which copies the set on another thread.
struct ForkLink {
  Mutex mutex;                              ///< Held while the structure is copied.
  const Structure* from = nullptr;          ///< Null: the fork has ended.
  std::shared_ptr<const Structure> shared;  ///< Of the asset.
};

}  // namespace sunder::particles
