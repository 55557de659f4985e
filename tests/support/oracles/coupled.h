#pragma once

#include "weights/internal/coupled_refit.h"

#if SUNDER_TEST_COUPLED_REFIT
#include <sunder/coupled_refit/use.h>
#endif

namespace sunder::test {

/// Turns coupled refits on, if they were built. @return whether they are on.
inline bool use_coupled_refit() {
#if SUNDER_TEST_COUPLED_REFIT
  sunder::use_coupled_refit();
#endif
  return has_coupled_refit();
}

}  // namespace sunder::test
