#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "io/gltf/cursor.h"

namespace sunder::gltf {

/// Parts of a document that violate the schema of glTF 2.0.
struct SchemaFaults {
  std::size_t count = 0;
  std::string first;  ///< JSON pointer.

  void add(const std::string& pointer) {
    if (count++ == 0) first = pointer;
  }
};

/// Makes a document that the reader accepted follow the schema of glTF 2.0 and of the ratified
/// extensions: a property that violates it is removed, an entry of a list whose required properties
/// do is replaced by an empty one. Entries keep their indices; a primitive that cannot be kept
/// becomes null. What the schema does not describe (extras, unknown extensions) stays. A valid
/// document stays as it is.
SchemaFaults enforce_schema(Json& document);

/// An entry of a top-level list ("accessors") that follows the schema, in place of one that is not
/// kept. Of meshes and animations it is an empty object, which does not follow it.
[[nodiscard]] Json empty_entry(std::string_view list);

}  // namespace sunder::gltf
