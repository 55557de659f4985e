#include <sunder/particles/particle_set.h>
#include <sunder/skinning/deform.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

#include "particles/clusters/decompose.h"
#include "particles/clusters/gradients.h"
#include "particles/clusters/rest_terms.h"
#include "particles/repair/repair.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {
using particles::Particle;
using particles::Structure;

Status check_pose(const Structure& structure, const ModelPose& pose) {
  if (pose.model_from_bone.size() != structure.bone_count)
    return Status::failure(StatusCode::size_mismatch, kNone, "the pose has %zu bones, the character %zu",
                           pose.model_from_bone.size(), structure.bone_count);
  if (pose.morph_weights.size() != structure.morph_weight_count)
    return Status::failure(StatusCode::size_mismatch, kNone, "the pose has %zu morph weights, the character %zu",
                           pose.morph_weights.size(), structure.morph_weight_count);
  for (std::uint32_t bone = 0; bone < pose.model_from_bone.size(); ++bone)
    if (!pose.model_from_bone[bone].matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, bone, "the pose of bone %u is not finite", bone);
  for (std::uint32_t i = 0; i < pose.morph_weights.size(); ++i)
    if (!std::isfinite(pose.morph_weights[i]))
      return Status::failure(StatusCode::non_finite_value, i, "morph weight %u is not finite", i);
  return {};
}

/// Points, and what moves them, of a model.
void read_model(const TornModel& model, const ModelPose& pose, Structure& structure) {
  const Character& character = model.character();
  structure.skins = character.skins;
  structure.first_slot = {0};
  for (const Skin& skin : character.skins)
    structure.first_slot.push_back(structure.first_slot.back() + static_cast<Index>(skin.bones.size()));
  structure.source = &model.source();
  structure.posed_points = particles::PosedPoints(character, pose);
  const tear::Surface& surface = model.surface();
  structure.vertex_points.resize(character.meshes.size());
  for (Index m = 0; m < character.meshes.size(); ++m) structure.vertex_points[m].assign(character.meshes[m].vertex_count(), kNone);
  structure.positions.resize(surface.point_count(), Vec3f::Zero());
  structure.vertices.resize(surface.point_count());
  for (Index t = 0; t < surface.triangle_count(); ++t) {
    const tear::TriangleRef ref = surface.triangle(t);
    const Triangle& triangle = character.meshes[ref.mesh].triangles[ref.triangle];
    if (surface.has_repeated_point(t)) continue;
    for (Index k = 0; k < 3; ++k) {
      const Index now = surface.corner_point[3 * t + k];
      const Index before = std::exchange(structure.vertex_points[ref.mesh][triangle[k]], now);
      if ((before != kNone) & (before != now)) structure.share_vertex(ref.mesh, triangle[k], before, now);
      structure.vertices[now] = {ref.mesh, triangle[k]};
    }
  }
  for (Index p = 0; p < surface.point_count(); ++p)
    if (const particles::VertexRef& of = structure.vertices[p]; of.vertex != kNone)
      structure.positions[p] = structure.posed_points.at(character.meshes[of.mesh], of.vertex);
}

/// Mean length of the edges: of some of them, all over the surface.
float edge_length_of(const Structure& structure, const tear::Surface& surface) {
  const Index corners = 3 * surface.triangle_count(), step = corners / 1024 + 1;
  double sum = 0;
  std::size_t count = 0;
  for (Index c = 0; c < corners; c += step) {
    if (surface.has_repeated_point(c / 3)) continue;
    const Vec3f &a = structure.positions[surface.corner_point[c]],
                &b = structure.positions[surface.corner_point[tear::Surface::next(c)]];
    sum += (b - a).norm();
    ++count;
  }
  return count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0.0f;
}

double diagonal_of(const Structure& structure, const tear::Surface& surface) {
  Eigen::AlignedBox3f box;
  for (Index p = 0; p < structure.point_count(); ++p)
    if (surface.point_corner[p] != kNone) box.extend(Eigen::Vector3f(structure.positions[p]));
  return box.isEmpty() ? 0.0 : double{box.diagonal().norm()};
}

}  // namespace

ParticleSet::ParticleSet(std::unique_ptr<Structure> structure) : structure_(std::move(structure)) {}
ParticleSet::~ParticleSet() = default;
ParticleSet::ParticleSet(ParticleSet&&) noexcept = default;
ParticleSet& ParticleSet::operator=(ParticleSet&&) noexcept = default;

Result<ParticleSet> ParticleSet::create(const TornModel& model, const ModelPose& pose, const DecompositionOptions& options) {
  if (!(options.range > 0) || !std::isfinite(options.range))
    return Status::failure(StatusCode::invalid_argument, kNone, "the range of particles is %g; it must be finite and above 0",
                           options.range);
  try {
    const auto begin = std::chrono::steady_clock::now();
    auto structure = std::make_unique<Structure>();
    structure->bone_count = model.character().skeleton.bones.size();
    structure->morph_weight_count = model.character().rest_morph_weights.size();
    if (Status status = check_pose(*structure, pose); !status) return status;
    read_model(model, pose, *structure);
    const double diagonal = diagonal_of(*structure, model.surface());
    if (!(diagonal > 0)) return Status::failure(StatusCode::empty_input, kNone, "the model has no face to divide into particles");
    structure->report.range = options.is_fraction ? options.range * diagonal : options.range;
    if (const double range = structure->report.range;
        !(range >= double{std::numeric_limits<float>::min()} && range <= double{std::numeric_limits<float>::max()}))
      return Status::failure(StatusCode::invalid_argument, kNone, "the range of particles is %g metres, which no float holds",
                             range);
    structure->edge_length = edge_length_of(*structure, model.surface());
    particles::decompose(model, options, *structure);
    structure->prepare_for_tears(model.surface().triangle_count());
    structure->report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return ParticleSet(std::move(structure));
  } catch (const std::length_error&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "a range of %g makes more than %zu particles", options.range,
                           particles::kMaximumParticles);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

const DecompositionReport& ParticleSet::report() const { return structure_->report; }
std::uint32_t ParticleSet::particle_count() const { return static_cast<Index>(structure_->particles.size()); }
std::uint64_t ParticleSet::serial(std::uint32_t particle) const { return structure_->particles[particle].serial; }
std::uint32_t ParticleSet::seed(std::uint32_t particle) const { return structure_->particles[particle].seed; }
double ParticleSet::range(std::uint32_t particle) const { return double{structure_->particles[particle].range}; }
std::uint32_t ParticleSet::member_count(std::uint32_t particle) const { return structure_->particles[particle].member_count; }

std::vector<std::uint32_t> ParticleSet::members(std::uint32_t particle) const { return structure_->members_of(particle); }

std::span<const ParticleNeighbour> ParticleSet::neighbours(std::uint32_t particle) const {
  return structure_->particles[particle].neighbours;
}

double ParticleSet::coupling(std::uint32_t particle, const ParticleNeighbour& neighbour) const {
  const double least = std::min(structure_->particles[particle].weight, structure_->particles[neighbour.particle].weight);
  return least > 0 ? std::min(1.0, neighbour.shared / least) : 0.0;
}

const ParticleInfluences& ParticleSet::parents(std::uint32_t particle) const { return structure_->particles[particle].parents; }
std::uint32_t ParticleSet::point_count() const { return structure_->point_count(); }
std::span<const ParticleMembership> ParticleSet::memberships(std::uint32_t point) const {
  return structure_->memberships_of(point);
}
std::span<const ParticleInfluences> ParticleSet::influences() const { return structure_->influences; }
std::span<const ParticleGradients> ParticleSet::gradients(const TornModel& model) {
  return structure_->gradients->of(model.surface(), *structure_);
}
bool ParticleSet::is_settled() const { return structure_->band == nullptr; }
std::span<const std::uint32_t> ParticleSet::vertex_points(std::uint32_t mesh) const { return structure_->vertex_points[mesh]; }
std::span<const Vec3f> ParticleSet::positions() const { return structure_->positions; }
std::span<const LipEdge> ParticleSet::lips() const { return structure_->lips; }
std::uint64_t ParticleSet::revision() const { return structure_->revision; }

DirtyRanges ParticleSet::dirty_points() const {
  std::vector<Index> dirty = structure_->dirty;
  std::sort(dirty.begin(), dirty.end());
  return DirtyRanges::covering(dirty);
}

Status ParticleSet::rest(const ModelPose& pose, std::span<const std::uint32_t> particles, std::span<ParticleRest> rest) const {
  const Structure& structure = *structure_;
  if (Status status = check_pose(structure, pose); !status) return status;
  if (rest.size() != particles.size())
    return Status::failure(StatusCode::size_mismatch, kNone, "%zu particles, room for %zu", particles.size(), rest.size());
  std::vector<Affine3d>& palette = structure.palette;
  palette.resize(structure.first_slot.back());
  for (std::size_t s = 0; s < structure.skins.size(); ++s)
    if (Status status = compute_palette(structure.skins[s], pose,
                                        std::span(palette).subspan(structure.first_slot[s], structure.skins[s].bones.size()));
        !status)
      return status;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Particle& particle = structure.particles[particles[i]];
    Eigen::Matrix<double, 3, 4> blended = Eigen::Matrix<double, 3, 4>::Zero();
    Vec3d sum = Vec3d::Zero();
    for (const particles::RestTerm& term : particle.terms) {
      sum += palette[term.slot].matrix() * term.sum;
      blended += term.sum.w() * palette[term.slot].matrix();
    }
    for (const particles::RestMorphTerm& term : particle.morph_terms)
      sum += double{pose.morph_weights[term.morph_weight]} * (palette[term.slot].linear() * term.sum);
    const double per_member = particle.member_count > 0 ? 1.0 / particle.member_count : 0.0;
    rest[i].place = per_member * sum;
    rest[i].linear = per_member * blended.leftCols<3>();
  }
  return {};
}

Status ParticleSet::follow(const TornModel& model, std::span<const ChangeRecord> changes) {
  Structure& structure = *structure_;
  if (&model.source() != structure.source)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the particles are of another model, or it was compacted since; they must be decomposed anew");
  if (structure.is_broken)
    return Status::failure(StatusCode::invalid_argument, kNone, "memory ran out; the particles must be decomposed anew");
  try {
    const std::uint64_t newest = model.newest_operation();
    auto &done = structure.done, &undone = structure.undone;
    const auto has = [&](const std::vector<particles::Change>& stack) {
      return std::ranges::any_of(stack, [&](const particles::Change& change) { return change.operation == newest; });
    };
    structure.is_broken = true;  // until all is well
    structure.dirty.clear();
    const bool is_undo = !model.is_in_stroke() && (newest == 0 || has(done));
    // Of what is taken back, with the points that it made, nothing is to be completed.
    if (is_undo && !done.empty() && done.back().operation != newest) structure.band.reset();
    if (structure.band) particles::complete_band(model, structure);
    if (is_undo) {
      while (!done.empty() && done.back().operation != newest) {
        particles::exchange(structure, done.back());
        undone.push_back(std::move(done.back()));
        done.pop_back();
      }
    } else if (!model.is_in_stroke() && has(undone)) {
      while (done.empty() || done.back().operation != newest) {
        particles::exchange(structure, undone.back());
        done.push_back(std::move(undone.back()));
        undone.pop_back();
      }
    } else {
      particles::follow_operation(model, structure, changes);
      if (!model.is_in_stroke()) done.back().operation = newest;
    }
    structure.gradients->forget(model.surface(), structure.dirty);
    structure.gradients->forget(model, structure, changes);
    structure.triangle_count = model.surface().triangle_count();
    structure.is_broken = false;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory; the particles must be decomposed anew");
  }
  return {};
}

bool ParticleSet::settle(const TornModel& model, std::uint32_t points) {
  Structure& structure = *structure_;
  if (!structure.band || structure.is_broken || &model.source() != structure.source) return false;
  structure.dirty.clear();
  try {
    particles::widen_band(model, structure, std::max(1u, points));
  } catch (const std::bad_alloc&) {
    structure.is_broken = true;
    return false;
  }
  structure.gradients->forget(model.surface(), structure.dirty);
  return structure.band != nullptr;
}

}  // namespace sunder
