#pragma once

#include <map>
#include <string>

#include "bench/stress/worker.h"

namespace sunder::stress {

/// Totals of a run.
class Summary {
 public:
  void add(const Outcome& outcome);
  /// A line per family, and the laws that were broken.
  void print_table() const;
  /// One JSON object.
  void print_json() const;
  [[nodiscard]] bool is_clean() const { return violations_.empty(); }

 private:
  struct OfFamily {
    std::uint64_t cases = 0, failed = 0;
    CaseReport total;
    double seconds = 0;
  };
  std::map<std::string, OfFamily> families_;
  std::map<std::string, std::uint64_t> violations_;  ///< Cases by the law that they broke.
};

}  // namespace sunder::stress
