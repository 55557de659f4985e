#pragma once

#include "bindings/c/errors.h"

namespace sunder::c {

/// Whether the caller's struct is of the size that this library knows; keeps the failure.
template <class Struct>
[[nodiscard]] sunder_status check_struct(const Struct* of_caller, const char* name) {
  if (of_caller == nullptr) return null_pointer(name);
  if (of_caller->struct_size == sizeof(Struct)) return SUNDER_OK;
  return fail(SUNDER_INVALID_STRUCT, kNone,
              "`%s`: struct_size is %u, expected %zu: make it by sunder_default_...(), or set it",
              name, of_caller->struct_size, sizeof(Struct));
}

/// As check_struct(); null stands for the defaults.
template <class Struct>
[[nodiscard]] sunder_status check_options(const Struct* of_caller, const char* name) {
  return of_caller == nullptr ? sunder_status{SUNDER_OK} : check_struct(of_caller, name);
}

/// Fails with the field that is no enumerator. @param most  the last enumerator.
[[nodiscard]] inline sunder_status check_enum(std::uint32_t value, std::uint32_t most,
                                              const char* name) {
  if (value <= most) return SUNDER_OK;
  return fail(SUNDER_INVALID_ARGUMENT, kNone, "`%s` is %u; expected 0 to %u", name, value, most);
}

}  // namespace sunder::c

/// Returns the failure of a check from the enclosing function.
#define SUNDER_C_TRY(check) \
  if (const sunder_status failure = (check); failure != SUNDER_OK) return failure
