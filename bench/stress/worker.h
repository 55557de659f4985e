#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/stress/families.h"

namespace sunder::stress {

/// A case that ended.
struct Outcome {
  CaseName name;
  CaseReport report;  ///< A crash or a hang is a violation of the law "crash" or "hang".
  double seconds = 0;
};

struct RunLimits {
  std::uint64_t cases = 0;  ///< At most; 0: any number.
  double seconds = 0;       ///< No case starts later; 0: at any time.
  std::uint32_t workers = 1;
  double seconds_of_case = 600;  ///< A case that takes longer hangs.
};

/// Runs one case in a process of its own.
[[nodiscard]] Outcome run_apart(const CaseName& name, const Steps& steps, double seconds);

/// Runs cases from the number `first` on in processes of their own, many cases per process; after a
/// crash or a hang the next one starts.
/// @param is_done  cases to leave out.
/// @param end      called in this process for each case, in the order in which they end.
void run_cases(std::span<const Family* const> chosen, std::uint64_t first, const RunLimits& limits,
               const std::function<bool(const CaseName&)>& is_done,
               const std::function<void(const Outcome&)>& end);

}  // namespace sunder::stress
