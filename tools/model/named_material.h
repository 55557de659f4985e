#pragma once

#include <sunder/io/character_file.h>
#include <sunder/operation/aimed_operation.h>

namespace sunder::tools {

/// The field of an operation that names the material of its walls or caps.
struct MaterialField {
  const char* name = "";           ///< "cap_material"; empty for operations without one.
  std::uint32_t material = kNone;  ///< kNone: that of the surface.
};
[[nodiscard]] MaterialField material_field(const LoggedOperation& operation);

/// Sets it, for an operation that has one.
void set_material(AimedOperation& operation, std::uint32_t material);

/// @param source  null: nothing is refused.
/// @return index_out_of_range with the field and its range if the file has no such material.
[[nodiscard]] Status check_material(const LoggedOperation& operation, const SourceDocument* source);

}  // namespace sunder::tools
