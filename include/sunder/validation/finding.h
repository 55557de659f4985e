#pragma once

#include <sunder/core/math.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sunder {

/// The consequence of a finding.
enum class Severity : std::uint8_t {
  note,     ///< Worth knowing; nothing looks or loads wrong.
  warning,  ///< Looks wrong.
  error,    ///< Loads wrong or breaks.
};

/// How a figure is known.
enum class Evidence : std::uint8_t {
  exact,       ///< Computed from all data; no pose is involved, or it holds in every pose.
  certified,   ///< An upper bound for all poses within the joint limits.
  sampled,     ///< The largest value over the poses that were tried.
  not_tested,  ///< Could not be computed; the text says why.
};

/// A place in the target: any member may be absent (kNone).
struct FindingPlace {
  std::uint32_t mesh = kNone;
  std::uint32_t vertex = kNone;
  std::uint32_t bone = kNone;  ///< In the skeleton of the target.
  /// Where the vertex, or the bone's origin, stands in the bind pose of the target: model space, in
  /// the unit of the target's vertices after the division by ValidationReport::scale. That is
  /// metres unless an armature scales the model; see ValidationReport::metres_per_bind_unit.
  Vec3d position = Vec3d::Zero();
  double value = 0.0;  ///< In the finding's unit.
};

/// One kind of fault of a skin, aggregated over all vertices that have it.
struct Finding {
  /// Stable code, "SUNDER_W_SUM"; docs/validation_codes.md lists all of them.
  std::string_view code;
  Severity severity = Severity::note;
  Evidence evidence = Evidence::exact;
  std::string text;            ///< One sentence with numbers: what is wrong, where, how much.
  std::string_view advice;     ///< One sentence: what to do about it.
  std::string_view gltf_code;  ///< The code of the Khronos glTF Validator; empty if it has none.
  double value = 0.0;          ///< The worst value.
  double threshold = 0.0;      ///< The value from which it is reported.
  std::string_view unit;       ///< "m", "share", "count", ….
  std::uint64_t count = 0;     ///< Number of vertices, bones or edges concerned.
  std::vector<FindingPlace> places;  ///< The worst ones, worst first, at most 64.
};

}  // namespace sunder
