#include <sunder/particles/particle_set.h>

#include <new>

#include "core/internal/out_of_memory.h"
#include "particles/clusters/describe.h"
#include "particles/clusters/gradients.h"
#include "particles/clusters/set_data.h"
#include "particles/clusters/validate.h"
#include "tear/internal/former_triangles.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {

using particles::Change;
using particles::Structure;
using particles::Tape;

constexpr std::uint32_t kParticlesVersion = 5;

Status check_version(const StateArrays& state) {
  if (state.version == kParticlesVersion) return {};
  return Status::failure(StatusCode::invalid_argument, kNone,
                         "a recorded state of particles has version %u; this library reads %u",
                         state.version, kParticlesVersion);
}

/// Points whose memberships or faces are not those of the decomposition. Repeated.
std::vector<Index> changed_points(const TornModel& model, const Structure& structure,
                                  const Structure& decomposition) {
  std::vector<Index> changed;
  for (Index p = 0; p < decomposition.points.count(); ++p) {
    const particles::MembershipSlab &now = structure.points.slabs[p],
                                    &before = decomposition.points.slabs[p];
    if (now.first != before.first || now.count != before.count) changed.push_back(p);
  }
  const tear::Surface& surface = model.surface();
  const auto add_triangle = [&](Index triangle) {
    const Index* const points = &surface.corner_point[3 * std::size_t{triangle}];
    changed.insert(changed.end(), points, points + 3);
  };
  const std::vector<tear::TriangleHistory> histories = tear::triangles_before_operations(model);
  for (const tear::TriangleHistory& history : histories)
    for (const tear::FormerTriangle& former : history.former) {
      changed.insert(changed.end(), former.points.begin(), former.points.end());
      add_triangle(former.triangle);
    }
  for (Index t = decomposition.tears.triangle_count; t < surface.triangle_count(); ++t)
    add_triangle(t);
  return changed;
}

/// Sets what a recorded state does not contain. The structure has the gradients of the
/// decomposition; those of other points are computed here and not in the next frame.
void complete(const TornModel& model, const Structure& decomposition, Structure& structure) {
  structure.authored.follow(model, structure.points.vertices, decomposition.points.count());
  (void)structure.follow_threads(model);
  structure.gradients->forget(model.surface(), changed_points(model, structure, decomposition),
                              nullptr);
  if (structure.gradients->is_wanted()) (void)structure.gradients->of(model.surface(), structure);
  if (structure.tears.done.empty()) return;
  for (Change& change : structure.tears.done) change.operation = Change::kUnnamed;
  structure.tears.done.back().operation = model.newest_operation();
  particles::resume_log(structure);
}

}  // namespace

Result<StateArrays> ParticleSet::save() const {
  if (is_broken() || !data_->shared)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the particles cannot be recorded: memory ran out, or they were not "
                           "made from a ParticleAsset");
  if (data_->own && !data_->own->tears.done.empty() && data_->own->tears.done.back().operation == 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the particles cannot be recorded while a stroke is in progress");
  try {
    StateArrays state;
    state.version = kParticlesVersion;
    Tape tape = Tape::writer(state);
    bool is_torn = data_->own != nullptr;
    tape(is_torn);
    const bool was_packed = data_->is_packed();
    if (is_torn) particles::describe(tape, data_->to_change(), *data_->shared);
    if (was_packed) data_->pack();
    return state;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Result<ParticleSet> ParticleSet::restore(std::shared_ptr<const ParticleAsset> asset,
                                         const TornModel& model, const StateArrays& state) {
  if (!asset)
    return Status::failure(StatusCode::empty_input, kNone, "there is no asset of particles");
  if (Status status = check_version(state); !status) return status;
  const Structure& shared = *asset->structure_;
  if (&model.source() != shared.character.source || model.is_in_stroke())
    return Status::failure(
        StatusCode::invalid_argument, kNone,
        "the asset of particles is of another model, or a stroke is in progress");
  try {
    Tape tape = Tape::reader(state);
    bool is_torn = false;
    tape(is_torn);
    if (!is_torn) {
      tape.end();
      if (!tape.status()) return tape.status();
      return create(std::move(asset), model);
    }
    auto data = std::make_unique<particles::SetData>();
    data->shared = asset->structure_;
    data->own = shared.copy();
    particles::describe(tape, *data->own, shared);
    tape.end();
    if (!tape.status()) return tape.status();
    if (Status status = particles::validate(*data->own, shared, model); !status) return status;
    complete(model, shared, *data->own);
    return ParticleSet(std::move(data));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

}  // namespace sunder
