#include "io/assimp/model_space.h"

#include <cmath>
#include <cstdio>
#include <optional>

#include <Eigen/LU>
#include <assimp/metadata.h>

namespace sunder::assimp_import {
namespace {

std::optional<double> number(const aiMetadata* metadata, const char* key) {
  if (metadata == nullptr) return std::nullopt;
  for (unsigned i = 0; i < metadata->mNumProperties; ++i) {
    if (metadata->mKeys[i] != aiString(key) || metadata->mValues[i].mData == nullptr) continue;
    const aiMetadataEntry& entry = metadata->mValues[i];
    switch (entry.mType) {
      case AI_INT32: return *static_cast<const std::int32_t*>(entry.mData);
      case AI_FLOAT: return static_cast<double>(*static_cast<const float*>(entry.mData));
      case AI_DOUBLE: return *static_cast<const double*>(entry.mData);
      default: return std::nullopt;
    }
  }
  return std::nullopt;
}

/// The unit vector of an axis setting such as UpAxis and UpAxisSign.
std::optional<Vec3d> axis(const aiMetadata* metadata, const char* key, const char* sign_key) {
  const std::optional<double> index = number(metadata, key);
  if (!index || !(*index == 0.0 || *index == 1.0 || *index == 2.0)) return std::nullopt;
  return Vec3d(Vec3d::Unit(static_cast<Eigen::Index>(*index)) *
               (number(metadata, sign_key).value_or(1.0) < 0.0 ? -1.0 : 1.0));
}

const char* axis_name(const Vec3d& direction) {
  static constexpr const char* kNames[] = {"x", "y", "z"};
  Eigen::Index index = 0;
  direction.cwiseAbs().maxCoeff(&index);
  return kNames[index];
}

ModelSpace fbx_space(const aiMetadata* metadata, Notes& notes) {
  ModelSpace space;
  double unit = number(metadata, "UnitScaleFactor").value_or(1.0);  // In centimetres.
  if (!std::isfinite(unit) || unit < 1e-6 || unit > 1e9) {
    notes.repaired(StatusCode::malformed_file, "settings",
                   "unit scale is not usable; centimetres are assumed");
    unit = 1.0;
  }
  space.model_from_scene.scale = Vec3d::Constant(unit * 0.01);

  const std::optional<Vec3d> right = axis(metadata, "CoordAxis", "CoordAxisSign");
  const std::optional<Vec3d> up = axis(metadata, "UpAxis", "UpAxisSign");
  const std::optional<Vec3d> front = axis(metadata, "FrontAxis", "FrontAxisSign");
  const char* up_name = "y";
  if (right && up && front) {
    Mat3d rotation;
    rotation << right->transpose(), up->transpose(), front->transpose();
    if (rotation.determinant() > 0.5) {
      space.model_from_scene.rotation = Quatd(rotation);
      up_name = axis_name(*up);
    } else {
      notes.inform("settings", "axes are not those of a right-handed space; left as they are");
    }
  }
  space.is_identity = space.model_from_scene.scale == Vec3d::Ones() &&
                      space.model_from_scene.rotation.isApprox(Quatd::Identity());

  char text[128];
  std::snprintf(text, sizeof text, "metres, y up; converted from units of %g cm, %s up", unit,
                up_name);
  space.description = text;
  return space;
}

}  // namespace

ModelSpace model_space_of(const aiScene& scene, const std::string& extension, Notes& notes) {
  if (extension == "fbx") return fbx_space(scene.mMetaData, notes);
  ModelSpace space;
  if (extension == "dae" || extension == "zae")
    space.description = "metres, y up; unit and up axis of the file applied";
  else
    space.description = "file units, taken as metres; axes as in the file";
  return space;
}

}  // namespace sunder::assimp_import
