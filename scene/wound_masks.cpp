#include "scene/wound_masks.h"

#include <algorithm>
#include <new>
#include <utility>

namespace sunder::scene {
namespace {

TexelRectangle whole(const WoundMask& mask) {
  return {0, 0, mask.options().width, mask.options().height};
}

/// The least rectangle with both in it.
TexelRectangle joined(const TexelRectangle& a, const TexelRectangle& b) {
  if (a.is_empty()) return b;
  if (b.is_empty()) return a;
  const std::uint32_t left = std::min(a.left, b.left), top = std::min(a.top, b.top);
  return {left, top, std::max(a.left + a.width, b.left + b.width) - left,
          std::max(a.top + a.height, b.top + b.height) - top};
}

}  // namespace

Status WoundMasks::begin(const TornModel& model, Index mesh, const WoundMaskOptions& options) {
  Result<WoundMask> made = WoundMask::create(model, mesh, options);
  if (!made) return made.error();
  const TexelRectangle changed = whole(*made);
  try {
    masks_.insert_or_assign(mesh, OfMesh{std::move(*made), changed});
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, mesh, "out of memory");
  }
  return {};
}

void WoundMasks::follow(const TornModel& model, std::span<const ChangeRecord> changes) noexcept {
  for (auto& [mesh, of] : masks_)
    for (const ChangeRecord& change : changes) {
      if (of.is_stale) break;
      const Result<TexelRectangle> changed = of.mask.update(model, change);
      of.is_stale = !changed;
      if (changed) of.changed = joined(of.changed, *changed);
    }
}

Result<WoundMasks::OfMesh*> WoundMasks::find(const TornModel& model, Index mesh) {
  const auto found = masks_.find(mesh);
  if (found == masks_.end())
    return Status::failure(StatusCode::not_found, mesh, "mesh %u has no wound mask", mesh);
  OfMesh& of = found->second;
  if (of.is_stale) {
    Result<WoundMask> made = WoundMask::create(model, mesh, of.mask.options());
    if (!made) return made.error();
    of = {std::move(*made), whole(of.mask)};
  }
  return &of;
}

Result<WoundMasks::Taken> WoundMasks::take(const TornModel& model, Index mesh) {
  const Result<OfMesh*> of = find(model, mesh);
  if (!of) return of.error();
  return Taken{&(*of)->mask, std::exchange((*of)->changed, {})};
}

Result<const WoundMask*> WoundMasks::peek(const TornModel& model, Index mesh) {
  const Result<OfMesh*> of = find(model, mesh);
  if (!of) return of.error();
  return &(*of)->mask;
}

}  // namespace sunder::scene
