// Takes the place of qhull.cpp in builds without Qhull.
#include "tear/bodies/qhull.h"

namespace sunder::bodies {

bool has_qhull() { return false; }

std::vector<Triangle> hull_faces(std::span<const Vec3d>) { return {}; }

}  // namespace sunder::bodies
