#pragma once

#include <string>
#include <vector>

#include "pipeline/aim/trial_cut.h"

namespace sunder::aim {

/// The sections through which a limb is severed, or why there are none.
struct Severing {
  std::vector<Section> sections;
  std::string fault;  ///< Empty if there are sections.
  /// The sections of the limb itself, also those that do not sever it: they tell whether it was
  /// cut before.
  std::vector<Section> own;
};

/// Tries the sections with a plane and takes the first that sever the limb, judged by what would
/// come off: those that belong to the limb, those of them on its body, then others on its body, the
/// nearest first.
[[nodiscard]] Severing severing_sections(const Limb& limb, const SurfaceParts& parts,
                                         const LimbPlane& plane, const SeverJudge& judge);

}  // namespace sunder::aim
