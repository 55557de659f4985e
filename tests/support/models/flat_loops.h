#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "support/machine/random.h"
#include "tear/section/flat_section.h"

namespace sunder::test {

// Loops of all shapes, for flat sections.

double area_of(std::span<const Vec2d> loop);
bool is_inside(const tear::FlatLoop& loop, const Vec2d& p);

Vec2d polar(double angle, double radius);
/// Around `centre`, at a distance between 0.6 and 1 of `radius`.
tear::FlatLoop star(Random& random, std::uint32_t count, const Vec2d& centre, double radius);
tear::FlatLoop spiral(int turns, int points_a_turn, double width);
tear::FlatLoop comb(int teeth, double depth);
std::vector<tear::FlatLoop> grid_of_holes(int side, int parts);
std::vector<std::vector<tear::FlatLoop>> letters();
/// Random loops nested up to five deep, moved and scaled.
std::vector<tear::FlatLoop> random_nested(Random& random);

/// Adds points on the edges: exactly collinear if coordinates allow it.
tear::FlatLoop refined(const tear::FlatLoop& loop, int parts);
/// Orients the loops so that holes are opposite to the loop around them.
std::vector<tear::FlatLoop> alternated(std::vector<tear::FlatLoop> loops);

}  // namespace sunder::test
