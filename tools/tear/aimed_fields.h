#pragma once

#include <string_view>
#include <vector>

#include "tools/model/quantity.h"

namespace sunder::tools {

/// The field that may stand behind the bone: BONE@SHARE.
inline constexpr std::string_view kShareField = "at";

/// A field of an aimed operation that an option of the command may have.
struct AimedField {
  const char* name;
  Quantity quantity = Quantity::number;
  bool takes_widths = false;  ///< A length that may be in widths of the limb.
  bool is_material = false;
};

struct AimedFields {
  const char* bone = "";  ///< The field that names the bone.
  std::vector<AimedField> fields;

  /// Null if there is none of that name.
  [[nodiscard]] const AimedField* find(std::string_view name) const;
};

/// @param op  "slash", "sever" or "puncture".
[[nodiscard]] const AimedFields& aimed_fields(std::string_view op);

}  // namespace sunder::tools
