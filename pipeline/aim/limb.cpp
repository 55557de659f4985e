#include "pipeline/aim/limb.h"

#include <sunder/aim/aim.h>

#include <cstdio>
#include <string>

#include "core/operation/internal/field_ranges.h"

namespace sunder::aim {

Result<Limb> find_limb(const PosedSurface& surface, const LimbPlace& place) {
  const Skeleton& skeleton = surface.character().skeleton;
  const Result<Index> bone = find_bone(skeleton, place.bone);
  if (!bone) return bone.error();
  if (const Status status = field::kShare.check(place.at); !status)
    return Status::failure(status.code(), *bone, "'%.60s': %s", place.bone.c_str(),
                           std::string(status.text()).c_str());
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

Status check_within_limb(const Limb& limb, const char* field, double value, double most,
                         const char* size) {
  constexpr double kRounding = 1e-6;
  if (value <= most * (1 + kRounding)) return {};
  return Status::failure(StatusCode::invalid_argument, limb.bones.bone(),
                         "%s: %s is %.4g m; it must be at most %.4g m, as %s; lengths are in "
                         "metres, or in widths of the limb",
                         limb.label.c_str(), field, value, most, size);
}

}  // namespace sunder::aim
