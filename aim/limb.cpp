#include "aim/limb.h"

#include <sunder/aim/aim.h>

#include <cmath>
#include <cstdio>

namespace sunder::aim {

Result<Limb> find_limb(const PosedSurface& surface, const LimbPlace& place) {
  const Skeleton& skeleton = surface.character().skeleton;
  const Result<Index> bone = find_bone(skeleton, place.bone);
  if (!bone) return bone.error();
  if (!(place.at >= 0.0 && place.at <= 1.0))
    return Status::failure(StatusCode::invalid_argument, *bone,
                           "'%.60s' at %g: expected a share of the bone from 0 to 1",
                           place.bone.c_str(), place.at);
  const BoneTree tree(surface);
  const Result<BoneSegment> segment = bone_segment(surface, tree, *bone);
  if (!segment) return segment.error();
  return limb_at(Limb{surface, LimbBones(surface, tree, *bone), *segment}, place.at);
}

Limb limb_at(const Limb& limb, double at) {
  char share[32];
  std::snprintf(share, sizeof share, " at %.3g", at);
  Limb other = limb;
  other.at = at;
  other.place = limb.segment.place(at);
  const std::string& name = limb.surface.character().skeleton.bones[limb.bones.bone()].name;
  other.label = "'" + name.substr(0, 60) + "'" + share;
  return other;
}

Status check_length(const AimedLength& length, const char* what) {
  if (std::isfinite(length.value) && length.value > 0) return {};
  return Status::failure(StatusCode::invalid_argument, kNone, "the %s is %g; expected above 0",
                         what, length.value);
}

}  // namespace sunder::aim
