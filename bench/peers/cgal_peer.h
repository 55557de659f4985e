#pragma once

#include <memory>

#include "bench/tear/tear_scene.h"

namespace sunder::bench {

/// CGAL on the scene's surface in its first pose: the closest equivalent of a tear. Built if CGAL
/// is found.
class CgalPeer {
 public:
  explicit CgalPeer(const Scene& scene);
  ~CgalPeer();

  /// Creates the edges in which the surface meets the rectangle that the stroke sweeps: corefine()
  /// with exact predicates, and a visitor that interpolates the eight floats of position, normal
  /// and texture coordinates of new vertices. Weights are not interpolated and lips are not opened.
  /// Copying the input and the sheet is not timed. @return seconds.
  double corefine();
  /// Number of new vertices of the last corefine().
  [[nodiscard]] std::size_t new_vertices() const;

  /// Builds an AABB tree of the posed faces. @return seconds.
  double build_tree();
  /// Finds all faces that the rectangle meets, by the tree that build_tree() built. @return
  /// seconds.
  double query_tree();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sunder::bench
