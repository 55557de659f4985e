#pragma once

#include <vector>

#include "tear/surface/surface_editor.h"
#include "tear/wound_mask/spread.h"

namespace sunder::tear {

/// The parts of one triangle of the source that operations left.
struct TornParts {
  std::vector<LipSegment> lips;  ///< Ascending, each once.
  /// Barycentric coordinates of the corners of what is left; empty unless skin was removed.
  std::vector<std::array<std::array<double, 3>, 3>> parts;
  bool is_cut_away = false;  ///< Whether skin was removed.

  bool operator==(const TornParts&) const = default;

  /// Whether a place was removed.
  [[nodiscard]] bool is_removed(const std::array<double, 3>& place) const;
};

/// Finds the parts of source triangles in a torn surface, and keeps in step with it.
class PartFinder {
 public:
  explicit PartFinder(const Surface& source) : newest_(source.first_triangle.back(), kNone) {}

  /// Learns the triangles that were appended, and forgets those that were removed.
  void follow(const Surface& torn);
  /// @param face  of the source. O(its parts).
  [[nodiscard]] TornParts find(Index face, const Surface& source, const SurfaceEditor& torn) const;

 private:
  struct Appended {
    Index origin = 0;    ///< The source triangle; kNone for a wall or cap.
    Index previous = 0;  ///< The part of the same origin before; kNone for the first one.
  };

  std::vector<Index> newest_;  ///< Per source triangle: its newest part; kNone.
  std::vector<Appended> appended_;
};

}  // namespace sunder::tear
