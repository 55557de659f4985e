#pragma once

#include <cstdint>

#include "bench/stress/torn_subject.h"

namespace sunder::stress {

/// Random numbers of one step of a case; step 0 belongs to the model.
inline test::Random random_of(std::uint64_t seed, std::uint32_t step) {
  return test::Random(seed * 0x9e3779b97f4a7c15u + step * 0xbf58476d1ce4e5b9u + 1);
}

/// Carries out steps 1 to `count` until a law is broken, then undoes and replays.
/// @param act  act(subject, random numbers of the step, step).
template <class Act>
void run_steps(TornSubject& subject, std::uint64_t seed, const Steps& steps, std::uint32_t count,
               Act act) {
  for (std::uint32_t step = 1; step <= count && !subject.has_failed(); ++step) {
    if (!steps.has(step)) continue;
    test::Random random = random_of(seed, step);
    act(subject, random, step);
  }
  test::Random random = random_of(seed, count + 1);
  if (!subject.has_failed()) subject.finish(random);
}

}  // namespace sunder::stress
