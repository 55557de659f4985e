#pragma once

#include <memory>

#include "bench/tear_scene.h"

namespace sunder::bench {

/// CGAL on the scene's surface in its first pose: what a user of CGAL has next to a tear. Built
/// where CGAL is.
class CgalPeer {
 public:
  explicit CgalPeer(const Scene& scene);
  ~CgalPeer();

  /// Makes the edges in which the surface meets the rectangle that the stroke sweeps: corefine()
  /// with exact predicates, and the eight floats of position, normal and texture coordinates of the
  /// new vertices by its visitor. Weights are not interpolated, lips not opened, the copy of the
  /// input and of the sheet not counted. @return seconds.
  double corefine();
  /// New vertices of the last corefine().
  [[nodiscard]] std::size_t new_vertices() const;

  /// An AABB tree of the posed faces. @return seconds.
  double build_tree();
  /// All faces that the rectangle meets, by the tree that build_tree() left. @return seconds.
  double query_tree();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sunder::bench
