#pragma once

#include <span>

#include "tear/filling/wall_ends.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// How far the posed surface is from a place of it, along a way into the body.
/// @param way  a displacement; nothing beyond it is looked for.
/// @param own  walls of the same stroke, which do not count; nor do faces that touch the place.
/// @return a fraction of the way, at most 1.
[[nodiscard]] double room_below(const Vec3d& place, const Vec3d& way,
                                std::span<const FillingSubmesh> own, const Workpiece& work);

}  // namespace sunder::tear
