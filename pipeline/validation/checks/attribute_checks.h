#pragma once

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/weight_rows.h"

namespace sunder::validation {

/// Compares morph displacements, normals, tangents and texture coordinates with those of the source
/// at the place of each vertex.
void check_attributes(const RowReader& reader, FindingList& findings);

/// Faces without area and edges of more than two faces.
void check_mesh_health(const RowReader& reader, FindingList& findings);

}  // namespace sunder::validation
