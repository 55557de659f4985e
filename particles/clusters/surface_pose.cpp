#include "particles/clusters/surface_pose.h"

#include <sunder/skinning/deform.h>

#include "core/internal/ordered.h"
#include "tear/internal/surface.h"

namespace sunder::particles {

void SurfacePose::begin(std::span<const Skin> skins, std::size_t morph_weights) {
  first_slots_.assign(1, 0);
  for (const Skin& skin : skins)
    first_slots_.push_back(first_slots_.back() + static_cast<Index>(skin.bones.size()));
  palette_.resize(first_slots_.back());
  morph_weights_.reserve(morph_weights);
}

Status SurfacePose::set(std::span<const Skin> skins, const ModelPose& pose) {
  for (std::size_t s = 0; s < skins.size(); ++s) {
    const auto slots = std::span(palette_).subspan(first_slots_[s], skins[s].bones.size());
    if (Status status = compute_palette(skins[s], pose, slots); !status) return status;
  }
  morph_weights_.assign(pose.morph_weights.begin(), pose.morph_weights.end());
  return {};
}

ParticleRest SurfacePose::rest(const Particle& particle) const {
  Eigen::Matrix<double, 3, 4> blended = Eigen::Matrix<double, 3, 4>::Zero();
  Vec3d sum = Vec3d::Zero();
  for (const RestTerm& term : particle.terms) {
    sum += posed(term.slot, term.sum);
    blended += term.sum.w() * palette_[term.slot].matrix();
  }
  for (const RestMorphTerm& term : particle.morph_terms)
    sum += posed_morph(term.morph_weight, term.slot, term.sum);
  const double per_member = particle.member_count > 0 ? 1.0 / particle.member_count : 0.0;
  return {per_member * sum, per_member * blended.leftCols<3>()};
}

Vec3d SurfacePose::place(const TornModel& model, Index point) const {
  const VertexRef of = vertex_of(model, point);
  return of.vertex == kNone ? Vec3d(Vec3d::Zero()) : place(model, of);
}

Vec3d SurfacePose::place(const TornModel& model, const VertexRef& of) const {
  Vec3d sum = Vec3d::Zero();
  MeshRestTerms(model, first_slots_, of.mesh)
      .for_each(
          of.vertex, [&](Index slot, const Vec4d& term) { sum += posed(slot, term); },
          [&](Index morph_weight, Index slot, const Vec3d& term) {
            if (morph_weights_[morph_weight] != 0) sum += posed_morph(morph_weight, slot, term);
          });
  return sum;
}

Vec3d SurfacePose::normal(const TornModel& model, Index point) const {
  const tear::Surface& surface = model.surface();
  Vec3d sum = Vec3d::Zero();
  const Vec3d at = place(model, point);
  surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
    const Vec3d a = place(model, surface.corner_point[tear::Surface::next(corner)]) - at;
    const Vec3d b = place(model, surface.corner_point[tear::Surface::previous(corner)]) - at;
    sum += a.cross(b);
  });
  const double length = norm(sum);
  return length > 0 ? Vec3d(sum / length) : Vec3d(Vec3d::Zero());
}

}  // namespace sunder::particles
