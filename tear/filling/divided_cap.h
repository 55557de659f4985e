#pragma once

#include "tear/filling/cap_rim.h"
#include "tear/filling/cap_shapes.h"

namespace sunder::tear {

/// Gives a cap points that its shape does not have, where the faces around it require them: in the
/// middle of the cap of an isolated face, and on edges between points that are joined already.
/// @param own  written: the shape with these points.
/// @return false if the shape can be used as it is.
[[nodiscard]] bool divide_cap(const CapRim& rim, const CapShape& shape, const Surface& surface,
                              CapShape& own);

}  // namespace sunder::tear
