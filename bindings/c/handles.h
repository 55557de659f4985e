#pragma once

#include <cstdint>
#include <memory>

#include "bindings/c/errors.h"

namespace sunder::c {

enum class Kind : std::uint8_t { none, bytes, character, asset, scene, piece, ragdoll, report };

[[nodiscard]] const char* name_of(Kind kind);

/// A handle names an object. Each kind of object has a class, whose `kKind` says which it is.
class Object {
 public:
  virtual ~Object() = default;
};

// A handle is the index of a slot, below 2^20, and the generation of the slot, 1 to 4095. A slot
// whose generations are used up is not used again, so a handle never names a second object. Slots
// never move: a look-up takes no lock.

/// @return the handle. @throws std::bad_alloc  also if there are too many objects.
[[nodiscard]] std::uint32_t add_object(Kind kind, std::unique_ptr<Object> object);
/// @return null, with the failure kept, for a handle that does not name an object of this kind.
[[nodiscard]] Object* find_object(std::uint32_t handle, Kind kind);
/// Destroys what the handle names.
[[nodiscard]] sunder_status destroy_object(std::uint32_t handle, Kind kind);

template <class T>
[[nodiscard]] T* find(std::uint32_t handle) {
  return static_cast<T*>(find_object(handle, T::kKind));
}

/// Adds an object and writes its handle.
template <class T>
sunder_status add(std::unique_ptr<T> object, std::uint32_t* handle) {
  *handle = add_object(T::kKind, std::move(object));
  return SUNDER_OK;
}

}  // namespace sunder::c
