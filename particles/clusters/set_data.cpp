#include "particles/clusters/set_data.h"

#include <mutex>
#include <new>

#include "particles/clusters/band.h"
#include "particles/clusters/gradients.h"
#include "particles/internal/vector_bytes.h"

namespace sunder::particles {

void SetData::pack() {
  if (!own || !shared || is_packed() || is_broken || !fork.expired()) return;
  const TearLog& tears = own->tears;
  const bool is_in_stroke = !tears.done.empty() && tears.done.back().operation == 0;
  if (tears.is_broken || tears.band != nullptr || is_in_stroke) return;
  if (own->gradients->is_wanted() && !own->gradients->is_up_to_date(own->points.count())) return;
  packed_ = std::make_unique<const PackedPoints>(*own, *shared);
  packed_now_.store(true, std::memory_order_release);
}

const Structure* SetData::find() const noexcept {
  try {
    return &now();
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

Index SetData::point_count() const {
  const std::lock_guard lock(unpacking_);
  return packed_ ? packed_->point_count() : without_points().points.count();
}

void SetData::unpack_points() const {
  const std::lock_guard lock(unpacking_);
  if (!packed_) return;  // another thread was faster
  packed_->unpack(*own, *shared);
  packed_.reset();
  packed_now_.store(false, std::memory_order_release);
}

std::size_t SetData::memory_bytes() const {
  const std::lock_guard lock(unpacking_);
  return sizeof(SetData) + (own ? own->memory_bytes() : 0) +
         (packed_ ? packed_->memory_bytes() : 0);
}

}  // namespace sunder::particles
