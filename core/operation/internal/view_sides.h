#pragma once

#include <sunder/operation/aimed_operation.h>

#include <array>

namespace sunder {

/// A side as logs and the command name it.
struct NamedSide {
  const char* name;
  ViewSide side;
  std::array<double, 3> viewer;  ///< Direction from the model to the viewer, model space.

  [[nodiscard]] Vec3d towards_viewer() const { return {viewer[0], viewer[1], viewer[2]}; }
};

/// In the order of ViewSide.
inline constexpr std::array<NamedSide, 6> kViewSides = {{{"front", ViewSide::front, {0, 0, 1}},
                                                         {"back", ViewSide::back, {0, 0, -1}},
                                                         {"left", ViewSide::left, {1, 0, 0}},
                                                         {"right", ViewSide::right, {-1, 0, 0}},
                                                         {"top", ViewSide::top, {0, 1, 0}},
                                                         {"bottom", ViewSide::bottom, {0, -1, 0}}}};

}  // namespace sunder
