#pragma once

#include "bench/cut_share/cut_sides.h"

namespace sunder::bench {

/// CGAL's Polygon_mesh_processing::clip() with `clip_volume`, exact predicates and inexact
/// constructions, once for each side. Built if CGAL is found.
CutSidesOfAll cut_by_cgal(const std::vector<test::HardCut>& cuts);

}  // namespace sunder::bench
