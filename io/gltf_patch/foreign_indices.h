#pragma once

#include <cstdint>
#include <set>

#include "io/gltf/cursor.h"

namespace sunder::gltf {

/// What the extensions of a document may refer to.
struct ForeignIndices {
  /// An extension whose content we do not know: entries of lists must keep their numbers.
  bool exist = false;
  bool may_name_meshes = false;  ///< An extension refers to meshes by number, or may do so.
  bool may_name_bytes = false;   ///< One has offsets into the buffer, beside the buffer views.
  /// The whole numbers in unknown extensions: each may be that of an accessor or a buffer view.
  std::set<std::uint64_t> numbers;
};

/// Numbers in extras are not taken for references.
[[nodiscard]] ForeignIndices foreign_indices(const Json& document);

}  // namespace sunder::gltf
