#pragma once

#include <sunder/core/character.h>
#include <sunder/core/status.h>

#include <cstddef>
#include <cstdint>
#include <memory>

namespace sunder {

/// The number of elements that the operations on a model may append, summed over all that are done
/// and not undone. With a fixed capacity the memory for tears is allocated at the start, and an
/// operation without room changes nothing and returns capacity_exceeded. A cut across n faces
/// appends about 2 n vertices and triangles; where it removes large areas it may allocate.
///
/// With `operations` = kNone, vertices and triangles are limits alone, for operations of strangers:
/// nothing is allocated at the start, and the model grows as needed up to the limits, which are
/// checked after each segment of a stroke and after each other operation.
struct TornCapacity {
  std::uint32_t vertices = 0;    ///< Per mesh.
  std::uint32_t triangles = 0;   ///< Per mesh.
  std::uint32_t operations = 0;  ///< kNone: any number.

  /// Whether memory is allocated at the start. All zero: the model grows as needed, and an
  /// operation allocates where it has to grow.
  [[nodiscard]] constexpr bool is_fixed() const {
    return operations != kNone && (vertices > 0 || triangles > 0 || operations > 0);
  }

  bool operator==(const TornCapacity&) const = default;
};

/// Memory in bytes, without what the allocator adds to each block.
struct TornMemory {
  std::size_t shared = 0;    ///< Of the asset, without its character and its idle workspaces.
  std::size_t own = 0;       ///< In use by this model alone.
  std::size_t reserved = 0;  ///< Held by this model, not in use.
};

/// All that tears need to know about a character, built once and shared by the models made from
/// it: topology and search trees. A model that nothing has torn refers to its asset and has next
/// to no memory of its own.
///
/// An operation works on a *workspace*, a copy of the arrays. The model takes one at its first
/// operation and gives it back in TornModel::pack() or when it is destroyed; the asset keeps idle
/// ones for others. All calls are safe at the same time on several threads.
class SUNDER_API TornAsset {
 public:
  /// @param character  must satisfy validate_character(); kept.
  /// @return the first fault of the character; empty_input if it is null; limit_exceeded above 700
  ///         million triangles or out of memory. O(n log n) in the triangles.
  static Result<std::shared_ptr<const TornAsset>> create(
      std::shared_ptr<const Character> character);

  /// Makes idle workspaces for models of a capacity, up to `count`, so that their first operations
  /// need not. As many are kept from then on. O(size of the character) each.
  /// @return limit_exceeded: out of memory; those made so far stay.
  Status prepare(std::uint32_t count = 1, const TornCapacity& capacity = {}) const;

  [[nodiscard]] const std::shared_ptr<const Character>& character() const;
  /// @return TornMemory::shared of its models in `shared`, and its idle workspaces in `reserved`.
  [[nodiscard]] TornMemory memory_bytes() const;

  TornAsset(const TornAsset&) = delete;
  TornAsset& operator=(const TornAsset&) = delete;
  ~TornAsset();

 private:
  friend class TornModel;
  struct Parts;
  explicit TornAsset(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace sunder
