#include "particles/motion/point_places.h"

#include <sunder/skinning/deform.h>

#include "particles/clusters/rest_terms.h"

namespace sunder::particles {

void PointPlaces::set_pose(const TornModel& model, const ModelPose& pose, std::uint64_t epoch) {
  if (epoch_ == epoch) return;
  epoch_ = epoch;
  const std::vector<Skin>& skins = model.character().skins;
  first_slot_.assign(1, 0);
  for (const Skin& skin : skins) first_slot_.push_back(first_slot_.back() + static_cast<Index>(skin.bones.size()));
  palette_.resize(first_slot_.back());
  for (std::size_t s = 0; s < skins.size(); ++s)
    (void)compute_palette(skins[s], pose, std::span(palette_).subspan(first_slot_[s], skins[s].bones.size()));
  morph_weights_.assign(pose.morph_weights.begin(), pose.morph_weights.end());
}

Vec3d PointPlaces::place(const TornModel& model, Index point) const {
  const VertexRef of = vertex_of(model, point);
  if (of.vertex == kNone) return Vec3d::Zero();
  Vec3d sum = Vec3d::Zero();
  for_each_rest_term(
      model, first_slot_, of, [&](Index slot, const Vec4d& term) { sum += palette_[slot].matrix() * term; },
      [&](Index morph_weight, Index slot, const Vec3d& term) {
        if (morph_weights_[morph_weight] != 0) sum += double{morph_weights_[morph_weight]} * (palette_[slot].linear() * term);
      });
  return sum;
}

}  // namespace sunder::particles
