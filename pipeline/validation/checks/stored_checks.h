#pragma once

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/skinned.h"

namespace sunder::validation {

/// The faults of the influences that the files hold, one list of places per code.
struct StoredFaults {
  Places sum, sum_integer, negative, not_finite, duplicate, out_of_range, unweighted, unsorted,
      zero_joint;
  bool is_tested = false;
};
[[nodiscard]] StoredFaults find_stored_faults(const Skinned& skin);

/// Influences as they were loaded.
struct InfluenceFigures {
  std::vector<std::uint64_t> histogram;  ///< Vertices by number of influences.
  Places many;                           ///< More than `kept`; the dropped mass.
  Places prunable;
};
[[nodiscard]] InfluenceFigures count_influences(const Skinned& skin, std::size_t kept);

/// The number of units of a stored integer weight. @param format  not float32.
[[nodiscard]] std::uint32_t units_of(float weight, WeightFormat format);
[[nodiscard]] std::uint32_t units_of_one(WeightFormat format);

}  // namespace sunder::validation
