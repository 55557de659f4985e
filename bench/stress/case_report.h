#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace sunder::stress {

/// A law that does not hold.
struct Violation {
  std::string law;   ///< Its name, by which violations are counted.
  std::string text;  ///< What was found.
};

/// The result of one case.
struct CaseReport {
  std::uint64_t operations = 0;  ///< Done; those that missed the surface count.
  std::uint64_t refused = 0;     ///< Refused with an error that the interface documents.
  std::uint64_t faces = 0;       ///< After the last operation.
  double weight_sum_error = 0;   ///< Largest deviation of a vertex's weights from a sum of one.
  /// Bind-space area of the parts of unremoved source triangles against that of these triangles;
  /// relative.
  double area_drift = 0;
  double smallest_angle = 180;            ///< First percentile over the faces at the end, degrees.
  std::uint64_t allocation_failures = 0;  ///< Operations that ran out of memory on purpose.
  /// Of all states that the case went through, the same on every machine, with every compiler and
  /// number of threads. 0 if the case made none.
  std::uint64_t digest = 0;
  std::vector<Violation> violations;

  /// Adds a state to the digest.
  void mix(std::uint64_t state) {
    digest = (digest ^ state) * 0x9E3779B97F4A7C15u;
    digest ^= digest >> 32;
  }

  /// Only the first few are kept: later ones follow from them.
  void violate(const char* law, std::string text) {
    constexpr std::size_t kMost = 4;
    if (violations.size() < kMost) violations.push_back({law, std::move(text)});
  }
};

/// The steps of a case, each with random numbers of its own, so that a step does the same if others
/// are left out.
class Steps {
 public:
  Steps() = default;
  /// Only these.
  explicit Steps(std::set<std::uint32_t> kept) : is_all_(false), kept_(std::move(kept)) {}

  [[nodiscard]] bool has(std::uint32_t step) const { return is_all_ || kept_.contains(step); }
  [[nodiscard]] bool is_all() const { return is_all_; }
  [[nodiscard]] const std::set<std::uint32_t>& kept() const { return kept_; }

 private:
  bool is_all_ = true;
  std::set<std::uint32_t> kept_;
};

/// Names a case.
struct CaseName {
  std::string family;
  std::uint64_t seed = 0;
};

}  // namespace sunder::stress
