#pragma once

#include <sunder/particles/particle_set.h>

#include <memory>
#include <span>

namespace sunder {

/// A copy of a ParticleSet that follows an operation on another thread, while the set is used, so
/// that the frame in which the operation takes effect only exchanges the two:
///
///   auto fork = ParticleFork::create(set, model);  // in a frame
///   fork->follow(replica, changes);  // on a thread, by OperationJob::Observer
///   if (!fork->take(set, model)) set.follow(model, changes);  // in the frame of swap_in()
///
/// The set does not settle while it has a fork. ParticleSet::follow() on the set ends the fork.
class SUNDER_API ParticleFork {
 public:
  /// @param set  has followed its model; no stroke is in progress on it. An earlier fork of it
  /// ends.
  /// @return invalid_argument in a stroke, or if the set is_broken(); limit_exceeded:
  /// out of memory. O(1) for a set of an asset.
  static Result<ParticleFork> create(ParticleSet& set, const TornModel& model);
  ~ParticleFork();
  ParticleFork(ParticleFork&&) noexcept;
  ParticleFork& operator=(ParticleFork&&) noexcept;

  /// Copies the set, and follows the operation on a replica of its model. Call it once, on any
  /// thread. @return as ParticleSet::follow(); invalid_argument if the fork has ended.
  /// O(size of the set), allocates.
  Status follow(const TornModel& replica, std::span<const ChangeRecord> changes);
  /// Makes the set what it would be if it had followed the operation now, with the work of earlier
  /// ones that is left begun anew. Call it in place of ParticleSet::follow().
  /// @param model  that of the set, with the operation as the last one.
  /// @return invalid_argument if the fork has ended or has not followed: nothing is changed.
  /// O(operations), allocates nothing.
  Status take(ParticleSet& set, const TornModel& model);

 private:
  struct Data;
  explicit ParticleFork(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace sunder
