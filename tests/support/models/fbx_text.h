#pragma once

#include <sunder/core/index.h>
#include <sunder/core/math.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sunder::test {

/// A key of a curve: FBX time in seconds, and a value.
struct FbxKey {
  double seconds = 0.0, value = 0.0;
};
using FbxCurve = std::vector<FbxKey>;  ///< Straight lines between keys; empty: not animated.

/// A model with a triangle of its own, whose place in its parent is
/// T Roff Rp Rpre R Rpost⁻¹ Rp⁻¹ Soff Sp S Sp⁻¹. Angles in degrees.
struct FbxModel {
  std::string name;
  std::uint32_t parent = kNone;  ///< Smaller than the model's own index.
  Vec3d translation = Vec3d::Zero(), rotation = Vec3d::Zero(), scaling = Vec3d::Ones();
  Vec3d pre_rotation = Vec3d::Zero(), post_rotation = Vec3d::Zero();
  Vec3d rotation_offset = Vec3d::Zero(), rotation_pivot = Vec3d::Zero();
  Vec3d scaling_offset = Vec3d::Zero(), scaling_pivot = Vec3d::Zero();
  int rotation_order = 0;  ///< As the file counts: xyz, xzy, yzx, yxz, zxy, zyx.
  int inherit_type = 1;    ///< 0: R r S s, 1: R S r s, 2: R r s.
  std::array<Vec3d, 3> triangle = {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0.5)};
};

/// The animation of one model in a take: curves of x, y and z.
struct FbxMotion {
  std::uint32_t model = 0;
  std::array<FbxCurve, 3> translation, rotation, scaling;
};

struct FbxTake {
  std::string name;
  double start = 0.0, stop = 0.0;  ///< Seconds; both 0: the file gives no span.
  std::vector<FbxMotion> motions;
};

struct FbxFile {
  std::vector<FbxModel> models;
  std::vector<FbxTake> takes;
};

/// The text of an FBX 7.4 file in metres, y up.
std::string fbx_text(const FbxFile& file);

}  // namespace sunder::test
