#pragma once

#include <sunder/robot/robot.h>

#include <string>
#include <vector>

#include "support/machine/random.h"

namespace sunder::test {

/// A robot as URDF text: a tree of joints of all types with any origins and axes, some of which
/// mimic others. Numbers keep their bits.
/// @param link_count  at least 1. @param bushiness  0: a chain; 1: children anywhere.
[[nodiscard]] std::string random_urdf(Random& random, std::uint32_t link_count, double bushiness);

/// Values within limits, within two turns or metres where there are none.
[[nodiscard]] std::vector<double> random_values(Random& random, const Robot& robot);

}  // namespace sunder::test
