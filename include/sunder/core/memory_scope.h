#pragma once

#include <sunder/core/api.h>

#include <memory_resource>

namespace sunder {

/// The memory resource from which this thread allocates while a scope is open. Scenes, instances
/// and assets open the one of their options around all that they do, on every thread.
///
/// It takes effect through the global operators new and delete, so that all containers follow it:
/// include <sunder/core/memory_operators.h> in one source file of the program, or let operators of
/// your own ask current(). Each block goes back to the resource from which it came.
class SUNDER_API MemoryScope {
 public:
  /// @param memory  thread-safe; outlives all that is allocated from it. Null: the heap.
  explicit MemoryScope(std::pmr::memory_resource* memory);
  ~MemoryScope();
  MemoryScope(const MemoryScope&) = delete;
  MemoryScope& operator=(const MemoryScope&) = delete;

  /// The resource of the innermost open scope; null: the heap.
  [[nodiscard]] static std::pmr::memory_resource* current();

 private:
  std::pmr::memory_resource* outer_;
};

}  // namespace sunder
