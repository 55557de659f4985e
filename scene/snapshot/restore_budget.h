#pragma once

#include <sunder/scene/scene.h>

namespace sunder::scene {

/// Counts down what a snapshot may still use of RestoreOptions. The failures name the limit, and
/// what was found.
class RestoreBudget {
 public:
  explicit RestoreBudget(const RestoreOptions& options)
      : options_(options), operations_(options.operations), memory_(options.memory) {}

  [[nodiscard]] const TornCapacity& capacity() const { return options_.capacity; }
  /// Bytes that are left.
  [[nodiscard]] std::size_t memory() const { return memory_; }

  [[nodiscard]] Status check_places(std::uint32_t found) const {
    if (found <= options_.instances) return {};
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "the snapshot has places for %u instances; RestoreOptions::instances "
                           "allows %u",
                           found, options_.instances);
  }
  [[nodiscard]] Status take_operations(std::size_t found) {
    if (found > operations_)
      return Status::failure(
          StatusCode::limit_exceeded, kNone,
          "the snapshot has %llu operations or more; RestoreOptions::operations "
          "allows %llu",
          static_cast<unsigned long long>(options_.operations - operations_ + found),
          static_cast<unsigned long long>(options_.operations));
    operations_ -= found;
    return {};
  }
  /// Whether an instance of this size fits. @param bytes  CharacterInstance::memory_bytes().
  [[nodiscard]] Status check_memory(std::size_t bytes) const {
    if (bytes <= memory_) return {};
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "the snapshot needs %zu bytes of memory or more; "
                           "RestoreOptions::memory allows %zu",
                           options_.memory - memory_ + bytes, options_.memory);
  }
  [[nodiscard]] Status take_memory(std::size_t bytes) {
    if (Status status = check_memory(bytes); !status) return status;
    memory_ -= bytes;
    return {};
  }

 private:
  const RestoreOptions& options_;
  std::uint64_t operations_;
  std::size_t memory_;
};

}  // namespace sunder::scene
