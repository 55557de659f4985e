#include <sunder/tear/torn_asset.h>

#include <algorithm>
#include <new>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "tear/model/asset_parts.h"
#include "tear/model/growth.h"
#include "tear/surface/copy_with_room.h"
#include "tear/surface/memory_use.h"

namespace sunder {
namespace {

/// Corners have 32-bit indices; this leaves half of them for triangles that tears append.
constexpr std::size_t kMaximumTriangles = kNone / 6;

}  // namespace

Status check_size(const Character& character, const TornCapacity& capacity) {
  const bool is_limit = tear::is_limit(capacity);
  std::size_t triangles = is_limit ? 0 : capacity.triangles;
  for (const Mesh& mesh : character.meshes) triangles += mesh.triangles.size();
  if (is_limit && triangles <= kMaximumTriangles) return {};
  if (triangles <= kMaximumTriangles && capacity.vertices <= kMaximumTriangles &&
      capacity.operations <= kMaximumTriangles)
    return {};
  return Status::failure(
      StatusCode::limit_exceeded, kNone,
      "the model has %zu triangles, including the capacity; at most %zu are supported", triangles,
      kMaximumTriangles);
}

std::shared_ptr<const TornAsset> TornAsset::Parts::make_private(
    std::shared_ptr<const Character> character) {
  auto parts = std::make_unique<Parts>(std::move(character));
  parts->is_private = true;
  return std::shared_ptr<const TornAsset>(new TornAsset(std::move(parts)));
}

std::unique_ptr<TornModel::State> TornAsset::Parts::make_workspace(const TornCapacity& capacity) {
  return std::make_unique<TornModel::State>(
      character,
      is_private ? std::move(surface)
                 : tear::copy_with_room(surface, capacity, character->meshes.size()),
      *trees, capacity, cells);
}

std::unique_ptr<TornModel::State> TornAsset::Parts::take(const TornCapacity& capacity) {
  {
    const std::lock_guard lock(mutex);
    const auto found = std::find_if(idle.begin(), idle.end(), [&](const auto& workspace) {
      return workspace->capacity == capacity;
    });
    if (found != idle.end()) {
      std::unique_ptr<TornModel::State> taken = std::move(*found);
      idle.erase(found);
      return taken;
    }
  }
  return make_workspace(capacity);
}

void TornAsset::Parts::give_back(std::unique_ptr<TornModel::State> workspace) noexcept {
  if (is_private) return;
  const auto is_full = [&] { return idle.size() >= kept || idle.size() == idle.capacity(); };
  {
    const std::lock_guard lock(mutex);
    if (is_full()) return;
  }
  if (!workspace->reset()) return;
  const std::lock_guard lock(mutex);
  if (!is_full()) idle.push_back(std::move(workspace));
}

Result<std::shared_ptr<const TornAsset>> TornAsset::create(
    std::shared_ptr<const Character> character) {
  if (!character) return Status::failure(StatusCode::empty_input, kNone, "the character is null");
  if (Status status = validate_character(*character); !status) return status;
  if (Status status = check_size(*character, {}); !status) return status;
  try {
    auto parts = std::make_unique<Parts>(std::move(character));
    parts->idle.reserve(parts->kept);
    (void)parts->trees->of_meshes();
    parts->cells = tear::make_cells(parts->surface, *parts->character);
    return std::shared_ptr<const TornAsset>(new TornAsset(std::move(parts)));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

TornAsset::TornAsset(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
TornAsset::~TornAsset() = default;

Status TornAsset::prepare(std::uint32_t count, const TornCapacity& capacity) const {
  if (Status status = check_size(*parts_->character, capacity); !status) return status;
  const auto missing = [&] {
    const auto found =
        std::count_if(parts_->idle.begin(), parts_->idle.end(),
                      [&](const auto& workspace) { return workspace->capacity == capacity; });
    return static_cast<std::size_t>(found) < count;
  };
  try {
    while (true) {
      {
        const std::lock_guard lock(parts_->mutex);
        if (!missing()) return {};
      }
      auto workspace = parts_->make_workspace(capacity);
      workspace->posed.cover(workspace->editor.surface().point_count());
      const std::lock_guard lock(parts_->mutex);
      if (!missing()) return {};
      parts_->kept = std::max(parts_->kept, parts_->idle.size() + 1);
      parts_->idle.reserve(parts_->kept);
      parts_->idle.push_back(std::move(workspace));
    }
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

const std::shared_ptr<const Character>& TornAsset::character() const { return parts_->character; }

TornMemory TornAsset::memory_bytes() const {
  TornMemory memory;
  tear::MemoryUse use;
  use.add(parts_->surface);
  memory.shared = sizeof(TornAsset) + sizeof(Parts) + use.held() + parts_->trees->bytes() +
                  (parts_->cells ? parts_->cells->bytes() : 0);
  const std::lock_guard lock(parts_->mutex);
  for (const auto& workspace : parts_->idle) memory.reserved += workspace->memory_use().held();
  return memory;
}

}  // namespace sunder
