#pragma once

#include <array>
#include <optional>
#include <vector>

#include "support/models/hard_cuts.h"

namespace sunder::bench {

/// The two closed surfaces that a program makes of a cut body: below the plane, above it.
using CutSides = std::array<test::Solid, 2>;

/// One per cut; empty if the program failed. In the order of the cuts.
using CutSidesOfAll = std::vector<std::optional<CutSides>>;

/// TornModel::cut() with caps, by stored positions.
CutSidesOfAll cut_by_sunder(const std::vector<test::HardCut>& cuts);

/// Manifold's splitByPlane(), in one run of node; nothing if it could not be run.
std::optional<CutSidesOfAll> cut_by_manifold(const std::vector<test::HardCut>& cuts);

}  // namespace sunder::bench
