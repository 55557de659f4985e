#include "bindings/c/handles.h"

#include <array>
#include <atomic>
#include <vector>

#include "core/internal/threads.h"

namespace sunder::c {
namespace {

constexpr std::uint32_t kSlotBits = 20, kMostGeneration = (1u << (32 - kSlotBits)) - 1;
constexpr std::uint32_t kChunkBits = 10, kChunkSize = 1u << kChunkBits;
constexpr std::uint32_t kMostSlots = 1u << kSlotBits;

struct Slot {
  /// Kind << 16 | generation; without the kind: free.
  std::atomic<std::uint32_t> tag{0};
  std::unique_ptr<Object> object;
};
using Chunk = std::array<Slot, kChunkSize>;

std::uint32_t tag_of(Kind kind, std::uint32_t generation) {
  return static_cast<std::uint32_t>(kind) << 16u | generation;
}

class Registry {
 public:
  ~Registry() {
    for (auto& chunk : chunks_) delete chunk.load();
  }

  /// @return null for an index that was never used.
  Slot* slot(std::uint32_t index) {
    Chunk* const chunk = chunks_[index >> kChunkBits].load(std::memory_order_acquire);
    return chunk == nullptr ? nullptr : &(*chunk)[index & (kChunkSize - 1)];
  }

  std::uint32_t add(Kind kind, std::unique_ptr<Object> object) {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) grow();
    const std::uint32_t index = free_.back();
    Slot& slot = *this->slot(index);
    const std::uint32_t generation = (slot.tag.load() & 0xFFFFu) + 1;
    free_.pop_back();
    slot.object = std::move(object);
    slot.tag.store(tag_of(kind, generation), std::memory_order_release);
    return generation << kSlotBits | index;
  }

  /// @return what has to be destroyed; null if another thread was faster.
  std::unique_ptr<Object> remove(std::uint32_t index, std::uint32_t tag) {
    const std::lock_guard lock(mutex_);
    Slot& slot = *this->slot(index);
    const std::uint32_t generation = tag & 0xFFFFu;
    if (!slot.tag.compare_exchange_strong(tag, generation)) return nullptr;
    if (generation < kMostGeneration) free_.push_back(index);  // its memory is reserved by grow()
    return std::move(slot.object);
  }

 private:
  void grow() {
    const MemoryScope heap(nullptr);  // it stays when all objects of a caller are gone
    if (used_ == kMostSlots) throw std::bad_alloc();
    free_.reserve(used_ + kChunkSize);
    auto chunk = std::make_unique<Chunk>();
    chunks_[used_ >> kChunkBits].store(chunk.release(), std::memory_order_release);
    for (std::uint32_t i = kChunkSize; i-- > 0;)
      if (used_ + i != 0) free_.push_back(used_ + i);
    used_ += kChunkSize;
  }

  Mutex mutex_;
  std::array<std::atomic<Chunk*>, (kMostSlots >> kChunkBits)> chunks_{};
  std::vector<std::uint32_t> free_;  ///< The next one last.
  std::uint32_t used_ = 0;
};

/// Never destroyed: destructors of static objects may still use handles.
Registry& registry() {
  static auto* const all = [] {
    const MemoryScope heap(nullptr);
    return new Registry;
  }();
  return *all;
}

}  // namespace

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::none: break;
    case Kind::bytes: return "bytes";
    case Kind::character: return "a character";
    case Kind::asset: return "an asset";
    case Kind::scene: return "a scene";
    case Kind::piece: return "a piece";
    case Kind::ragdoll: return "a ragdoll";
    case Kind::report: return "a report";
  }
  return "nothing";
}

std::uint32_t add_object(Kind kind, std::unique_ptr<Object> object) {
  return registry().add(kind, std::move(object));
}

namespace {

/// Keeps the failure. @param tag  of the slot, as it is.
void refuse_handle(std::uint32_t handle, Kind kind, std::uint32_t tag) {
  const std::uint32_t generation = handle >> kSlotBits;
  const auto is = static_cast<Kind>(tag >> 16u);
  if (handle == 0)
    (void)fail(SUNDER_INVALID_HANDLE, kNone, "no object; expected %s", name_of(kind));
  else if (is != Kind::none && (tag & 0xFFFFu) == generation)
    (void)fail(SUNDER_INVALID_HANDLE, kNone, "%u names %s; expected %s", handle, name_of(is),
               name_of(kind));
  else
    (void)fail(SUNDER_INVALID_HANDLE, kNone, "%u names nothing, or what was destroyed; expected %s",
               handle, name_of(kind));
}

}  // namespace

Object* find_object(std::uint32_t handle, Kind kind) {
  Slot* const slot = registry().slot(handle & (kMostSlots - 1));
  const std::uint32_t tag = slot == nullptr ? 0 : slot->tag.load(std::memory_order_acquire);
  if (slot != nullptr && tag == tag_of(kind, handle >> kSlotBits)) return slot->object.get();
  refuse_handle(handle, kind, tag);
  return nullptr;
}

sunder_status destroy_object(std::uint32_t handle, Kind kind) {
  return guarded([&] {
    if (find_object(handle, kind) == nullptr) return sunder_status{SUNDER_INVALID_HANDLE};
    const std::unique_ptr<Object> removed =
        registry().remove(handle & (kMostSlots - 1), tag_of(kind, handle >> kSlotBits));
    if (removed != nullptr) return sunder_status{SUNDER_OK};
    refuse_handle(handle, kind, 0);
    return sunder_status{SUNDER_INVALID_HANDLE};
  });
}

}  // namespace sunder::c
