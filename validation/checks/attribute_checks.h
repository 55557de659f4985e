#pragma once

#include "validation/checks/finding_list.h"
#include "validation/checks/weight_rows.h"

namespace sunder::validation {

/// Morph displacements, normals, tangents and texture coordinates beside those of the source.
void check_attributes(const RowReader& reader, FindingList& findings);

/// Faces without area and edges of more than two faces.
void check_mesh_health(const RowReader& reader, FindingList& findings);

}  // namespace sunder::validation
