#pragma once

#include "bench/cut_share/cut_sides.h"

namespace sunder::bench {

/// VTK's vtkClipClosedSurface, in double, once for each side. Built if VTK is found.
CutSidesOfAll cut_by_vtk(const std::vector<test::HardCut>& cuts);

}  // namespace sunder::bench
