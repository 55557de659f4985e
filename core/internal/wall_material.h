#pragma once

#include <sunder/core/mesh.h>

#include <cmath>

namespace sunder {

/// The attribute by which an author chooses the material of walls and caps: per vertex its index in
/// the source file; below 0: that of the rim. A label: new vertices have that of the nearest
/// parent.
inline constexpr const char* kWallMaterialAttribute = "_WALL_MATERIAL";

/// Where a mesh has it; null: nowhere.
inline const CustomAttribute* find_wall_materials(const Mesh& mesh) {
  for (const CustomAttribute& attribute : mesh.custom_attributes)
    if (attribute.components == 1 && attribute.name == kWallMaterialAttribute) return &attribute;
  return nullptr;
}

/// @return kNone for values that are no index.
inline Index wall_material_of(float value) {
  return value >= 0.0f && value < 65536.0f ? static_cast<Index>(std::lround(value)) : kNone;
}

}  // namespace sunder
