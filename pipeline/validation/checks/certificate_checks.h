#pragma once

#include "pipeline/validation/checks/cracks.h"

namespace sunder::validation {

/// The rows that are certified.
struct CertifiedRows {
  const SkinPoints& points;
  const SkinDifferences& differences;  ///< Per vertex of the target.
  const CrackRows& cracks;
};

/// Bounds for all poses within the limits, each beside the worst pose that a search found: the
/// deviation from the source surface, the width of cracks, and how far blended matrices of vertices
/// whose skin differs may collapse.
void check_certificates(const RowReader& reader, const CertifiedRows& rows,
                        const ValidationOptions& options, ValidationReport& report,
                        FindingList& findings);

}  // namespace sunder::validation
