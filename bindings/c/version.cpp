#include <sunder/bodies/convex_hulls.h>

#include "bindings/c/errors.h"
#include "core/internal/threads.h"

using namespace sunder::c;

extern "C" {

uint32_t sunder_version(void) { return SUNDER_C_VERSION; }

uint32_t sunder_features(void) {
  return (sunder::kHasThreads ? SUNDER_FEATURE_THREADS : 0) |
         (sunder::has_convex_hulls() ? SUNDER_FEATURE_HULLS : 0) |
         (SUNDER_C_VALIDATION ? SUNDER_FEATURE_VALIDATION : 0) |
         (SUNDER_C_ALLOCATOR ? SUNDER_FEATURE_ALLOCATOR : 0);
}

sunder_status sunder_check_abi(uint32_t version, uint32_t features) {
  // Before 1.0 each minor version may change structs.
  if (version >> 8u != SUNDER_C_VERSION >> 8u)
    return fail(SUNDER_UNSUPPORTED_FEATURE, sunder::kNone,
                "the program was built for version %u.%u; the library is %u.%u", version >> 16u,
                version >> 8u & 0xFFu, SUNDER_C_VERSION >> 16u, SUNDER_C_VERSION >> 8u & 0xFFu);
  if (const uint32_t missing = features & ~sunder_features(); missing != 0)
    return fail(SUNDER_UNSUPPORTED_FEATURE, sunder::kNone, "the library lacks features 0x%x",
                missing);
  return SUNDER_OK;
}

}  // extern "C"
