#include <sunder/particles/particle_fork.h>

#include <new>
#include <optional>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "particles/clusters/fork_link.h"
#include "particles/clusters/gradients.h"
#include "particles/clusters/set_data.h"
#include "particles/clusters/structure_of.h"
#include "particles/repair/lip_band.h"

namespace sunder {
namespace {

using particles::Structure;
using particles::StructureOf;

Status refuse(const char* why) {
  return Status::failure(StatusCode::invalid_argument, kNone, "%s", why);
}

/// A copy with the work that is left.
std::unique_ptr<Structure> fork_of(const Structure& from) {
  std::unique_ptr<Structure> made = from.fork();
  resume_work(*made, particles::pending_work(from), from.tears.waiting != nullptr);
  return made;
}

}  // namespace

struct ParticleFork::Data {
  std::shared_ptr<particles::ForkLink> link;
  std::uint64_t revision = 0;       ///< Of the set when it was copied.
  std::optional<ParticleSet> copy;  ///< After follow().
};

ParticleFork::ParticleFork(std::unique_ptr<Data> data) : data_(std::move(data)) {}
ParticleFork::~ParticleFork() = default;
ParticleFork::ParticleFork(ParticleFork&&) noexcept = default;
ParticleFork& ParticleFork::operator=(ParticleFork&&) noexcept = default;

Result<ParticleFork> ParticleFork::create(ParticleSet& set, const TornModel& model) {
  particles::SetData& of = StructureOf::data(set);
  const std::vector<particles::Change>& done = of.without_points().tears.done;
  if (set.is_broken()) return refuse("the particles are broken; create a new ParticleSet");
  if (model.is_in_stroke() || (!done.empty() && done.back().operation == 0))
    return refuse("a stroke is in progress");
  try {
    auto data = std::make_unique<Data>();
    data->link = std::make_shared<particles::ForkLink>();
    data->link->from = &of.now();
    data->link->shared = of.shared;
    of.end_fork();
    of.fork = data->link;
    return ParticleFork(std::move(data));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status ParticleFork::follow(const TornModel& replica, std::span<const ChangeRecord> changes) {
  try {
    auto made = std::make_unique<particles::SetData>();
    {
      const std::lock_guard lock(data_->link->mutex);
      if (data_->link->from == nullptr) return refuse("the set has changed");
      data_->revision = data_->link->from->revision;
      made->shared = data_->link->shared;
      made->own = fork_of(*data_->link->from);
    }
    ParticleSet copy = StructureOf::set_of(std::move(made));
    if (Status status = copy.follow(replica, changes); !status) return status;
    if (StructureOf::in(copy).gradients->is_wanted()) (void)copy.gradients(replica);
    data_->copy.emplace(std::move(copy));
    return {};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status ParticleFork::take(ParticleSet& set, const TornModel& model) {
  particles::SetData& into = StructureOf::data(set);
  if (!data_->copy || into.fork.lock() != data_->link || data_->revision != set.revision())
    return refuse("the set has changed, or the fork has not followed an operation");
  std::unique_ptr<Structure>& made = StructureOf::data(*data_->copy).own;
  std::vector<particles::Change>& done = made->tears.done;
  if (into.own)
    for (std::size_t i = 0; i < into.own->tears.done.size(); ++i)
      done[i] = std::move(into.own->tears.done[i]);
  done.back().operation = model.newest_operation();
  into.end_fork();
  into.own.swap(made);
  return {};
}

}  // namespace sunder
