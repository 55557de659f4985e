#pragma once

#include "tear/geometry/plane_side.h"
#include "tear/path/entry.h"
#include "tear/posed/posed_points.h"

namespace sunder::test {

// The queries of tear/, answered by testing every face.

std::optional<tear::SurfaceHit> scan_for_hit(const Blade& blade, const tear::SurfaceEditor& editor,
                                             tear::PosedPoints& posed);
std::optional<tear::SurfaceHit> scan_for_contact(const tear::BladePlane& plane, double progress,
                                                 const tear::SurfaceEditor& editor,
                                                 tear::PosedPoints& posed);
std::vector<Index> scan_for_faces_in(const tear::Cell& cell, const tear::SurfaceEditor& editor,
                                     tear::PosedPoints& posed);
std::vector<Index> scan_for_faces_across(const tear::Sheet& sheet,
                                         const tear::SurfaceEditor& editor,
                                         tear::PosedPoints& posed);

}  // namespace sunder::test
