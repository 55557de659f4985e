#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tear/surface/surface_editor.h"
#include "tear/wound_mask/spread.h"

namespace sunder::tear {

/// What is left of one triangle of the source.
struct LeftSkin {
  /// Barycentric coordinates of the corners of what is left; empty unless skin was removed.
  std::vector<std::array<std::array<double, 3>, 3>> parts;
  bool is_cut_away = false;  ///< Whether skin was removed.

  bool operator==(const LeftSkin&) const = default;

  /// Whether a place was removed.
  [[nodiscard]] bool is_removed(const std::array<double, 3>& place) const;
};

/// The parts of one triangle of the source that operations left.
struct TornParts {
  std::vector<LipSegment> lips;  ///< Ascending, each once.
  LeftSkin skin;
  LeftSkin before;  ///< What was left before the first operation that counts.

  bool operator==(const TornParts&) const = default;

  /// Whether an operation that counts removed a place.
  [[nodiscard]] bool is_removed(const std::array<double, 3>& place) const {
    return skin.is_removed(place) && !before.is_removed(place);
  }
};

/// A place that an area of a triangle contains if it is not negative, but for rounding: the least
/// of the areas that it makes with the sides, in areas of the whole triangle.
[[nodiscard]] double area_inside(const std::array<std::array<double, 3>, 3>& part,
                                 const std::array<double, 3>& place);

/// Whether a triangle of a torn surface is one of a wall or cap.
[[nodiscard]] bool is_filling(Index triangle, const Surface& torn);

/// Finds the parts of source triangles in a torn surface, and keeps in step with it.
class PartFinder {
 public:
  explicit PartFinder(const Surface& source) : newest_(source.first_triangle.back(), kNone) {}

  /// Learns the triangles that were appended, and forgets those that were removed.
  void follow(const Surface& torn);
  /// Whether it follows a surface with as many triangles.
  [[nodiscard]] bool is_in_step(const Surface& torn) const {
    return appended_.size() == torn.appended.size();
  }
  /// @param face  of the source. O(its parts).
  /// @param when  a time before an operation, as it was then; otherwise as it is now.
  [[nodiscard]] TornParts find(Index face, const Surface& source, const SurfaceEditor& torn,
                               const std::optional<EditLog::Extent>& when = {}) const;
  /// Which operation made each lip of a face as it is now.
  /// @param begins  the times at which the operations began.
  /// O(lips x parts x operations that changed them)
  [[nodiscard]] std::vector<Index> operations_of(Index face, std::span<const LipSegment> lips,
                                                 const Surface& source, const SurfaceEditor& torn,
                                                 std::span<const EditLog::Extent> begins) const;
  /// Calls visit(triangle) for each triangle that is or was a part of a face.
  template <class Visit>
  void for_each_part(Index face, const Surface& torn, Visit visit) const {
    visit(face);
    const Index first = torn.first_triangle.back();
    for (Index p = newest_[face]; p != kNone; p = appended_[p - first].previous) visit(p);
  }

 private:
  struct Appended {
    Index origin = 0;    ///< The source triangle; kNone for a wall or cap.
    Index previous = 0;  ///< The part of the same origin before; kNone for the first one.
  };

  std::vector<Index> newest_;  ///< Per source triangle: its newest part; kNone.
  std::vector<Appended> appended_;
};

}  // namespace sunder::tear
