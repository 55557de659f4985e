#pragma once

#include <memory>

#include "bench/tear/tear_scene.h"

namespace sunder::bench {

/// VTK on the scene's surface in its first pose: vtkPolyDataPlaneClipper keeps one side of the
/// middle plane, on one thread, and interpolates normals and texture coordinates. It does not
/// interpolate weights, close the cut, or identify its parts. Built if VTK is found.
class VtkPeer {
 public:
  explicit VtkPeer(const Scene& scene);
  ~VtkPeer();

  /// @return seconds.
  double clip();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sunder::bench
