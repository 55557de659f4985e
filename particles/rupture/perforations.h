#pragma once

#include <sunder/particles/particle_set.h>

#include <optional>
#include <utility>
#include <vector>

#include "particles/clusters/surface_pose.h"

namespace sunder::particles {

/// A part of a perforation along which a tear may run: arc lengths along its line, in the
/// decomposition's pose. From a tip beside the line, the tear first goes straight to `begin`.
struct Course {
  std::size_t line = 0;
  double begin = 0, end = 0;  ///< Either may be the larger one.
  double length = 0;          ///< With the way to `begin`, metres.
  double strength = 1;        ///< Of the perforation, averaged over that length.

  [[nodiscard]] bool empty() const { return length == 0; }
};

/// The perforations of a surface in the decomposition's pose. O(places), allocates.
class Perforations {
 public:
  Perforations(const ParticleSet& set, const TornModel& model);

  [[nodiscard]] bool empty() const { return lines_.empty(); }

  /// The course of a tear of a given length that goes on from a tip: that along which a tear takes
  /// least, by the energy that it releases in that direction.
  /// @param forward  unit direction in which the tear came.
  /// @param ease     written: the energy that a tear along it releases by that of one straight on,
  ///                 over the strength of the course.
  [[nodiscard]] Course from_tip(const Vec3d& tip, const Vec3d& forward, double length,
                                double& ease) const;
  /// The course of a tear whose middle is the place of a line next to a position, within a
  /// distance.
  /// @param along  written: the direction of the line there, unit length.
  [[nodiscard]] Course around(const Vec3d& position, double within, double length,
                              Vec3d& along) const;
  /// The place of a line at an arc length.
  [[nodiscard]] Vec3d place(std::size_t line, double arc) const;

  /// The places of a course in a pose, and the surface's normals there, from `begin` on.
  [[nodiscard]] std::vector<std::pair<Vec3d, Vec3d>> posed(const Course& course,
                                                           const TornModel& model,
                                                           const SurfacePose& pose) const;

 private:
  struct Line {
    std::span<const SourcePlace> places;
    std::vector<Vec3d> at;
    std::vector<double> arcs;  ///< From the first place, per place.
    double strength = 1;
    bool is_closed = false;

    [[nodiscard]] double length() const { return arcs.back(); }
  };
  /// The nearest place of a line.
  struct Nearest {
    double arc = 0, distance = 0;
  };
  /// A place between two of a line: the index of the first, and the part of the way to the second.
  struct Between {
    std::size_t first = 0;
    double part = 0;
  };
  [[nodiscard]] static Nearest nearest(const Line& line, const Vec3d& position);
  [[nodiscard]] static Between between(const Line& line, double arc);
  /// The arc length that is `by` farther, at most the end of an open line.
  [[nodiscard]] static double moved(const Line& line, double arc, double by);

  std::vector<Line> lines_;
};

/// The energy that a tear releases which turns by an angle, by that of one that goes straight on:
/// the part of the field a sqrt(r) sin(theta / 2) that is left at a tip which turns, after Sih
/// [sih1965stress].
[[nodiscard]] double release_after_turn(double angle);

}  // namespace sunder::particles
