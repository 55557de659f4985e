#pragma once

#include <sunder/particles/soft_body.h>

#include <limits>
#include <vector>

namespace sunder {

/// Limits of a call, which tears at one place: so they also bound the speed of a tip. The smaller
/// of the two lengths applies.
struct ForceTearingOptions {
  double length = 0.5;  ///< Greatest length of a tear, as a fraction of the particles' range; in
                        ///< (0, 2].
  /// The same in metres, > 0: for instance a speed times the time between calls.
  double metres = std::numeric_limits<double>::infinity();
  /// Greatest speed, > 0, m/s. A tear of the length above is then made each time in which that
  /// speed covers it, by the time of the body's steps; calls in between tear nothing.
  double metres_per_second = std::numeric_limits<double>::infinity();
  /// A tear that would cut off a piece of less area, in the pose, is not made; >= 0, m^2. Each tear
  /// is then first tried and taken back, which costs as much again.
  double least_piece_area = 0.0;
};

struct ForceTearingReport {
  /// Greatest stretch by displacements around an awake particle whose material has a strength.
  double greatest_stretch = 1.0;
  /// Greatest energy that a tip would release by running on, joules per metre, in tissue with a
  /// toughness or strength. Pressing the lips together releases none.
  double greatest_release = 0.0;
  bool has_torn = false;
  bool is_from_tip = false;     ///< Whether the tear continues an older one.
  Vec3d place = Vec3d::Zero();  ///< Start of the tear on the posed surface; model space, metres.
  Vec3d direction = Vec3d::Zero();  ///< Direction of the tear; unit length.
  TearReport tear;
};

/// Tears the tissue where it gives way, at one place, across the direction of the greatest stretch.
/// A tip runs on if that releases at least the energy that the material takes: its toughness, or
/// that by its strength and flaws (Griffith); only pulling its lips apart and shearing them count.
/// Where no tip is near, a tear begins if the tissue is
/// stretched beyond its strength. Along a perforation a tip runs on if that releases the energy
/// that the line takes, at the angle at which it turns, and if nothing tears more easily; tissue
/// next to the line tears there. Loads hardly depend on the range and the mesh, see
/// docs/particles.md. Call it after SoftBody::step(). The tear is an operation in the history,
/// which can be undone and replayed. Deterministic; one thread at a time per model.
///
/// @param body       its materials have strengths and toughnesses; of the two lips at a tip, the
///                   weaker one counts.
/// @param particles  those of the body; they follow the tear.
/// @param model      torn by at most one operation.
/// @param pose       that of the last step.
/// @param changes    optional; the record of the tear is appended.
/// @return invalid_argument for the options; the failure of the tear (nothing is changed);
///         limit_exceeded if out of memory. Without a tear O(awake particles x neighbours), and
///         if something is awake that can tear, also O(edges of lips + tips x faces within some
///         spacings of lip particles), and allocates; with a tear, also its cost and that of its
///         repair.
SUNDER_API Result<ForceTearingReport> tear_overstretched(
    const SoftBody& body, ParticleSet& particles, TornModel& model, const ModelPose& pose,
    const ForceTearingOptions& options = {}, std::vector<ChangeRecord>* changes = nullptr);

}  // namespace sunder
