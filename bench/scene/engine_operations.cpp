#include "bench/scene/engine_operations.h"

#include <cmath>

namespace sunder::bench {
namespace {

/// From the front into the tube.
Blade blade_at(double x, double y) { return {{x, y, 1.0}, {x, y, 0.35}}; }

}  // namespace

TearOptions walled(double width) {
  TearOptions options;
  options.width = width;
  options.wall_depth = 0.03;
  return options;
}

Blade engine_stroke_at(double way) { return blade_at(-0.25 + 0.5 * way, 0.9 + 0.1 * way); }

Stroke engine_gap(int segments, double length, double height) {
  Stroke stroke;
  for (int i = 0; i <= segments; ++i) {
    const double way = static_cast<double>(i) / segments;
    stroke.push_back(blade_at(length * (way - 0.5), height + 0.02 * std::sin(6 * way)));
  }
  return stroke;
}

PlaneCut engine_cut() {
  PlaneCut cut;
  cut.point = {0, 1.75, 0};
  cut.normal = {0.1, 1, 0.2};
  cut.caps = true;
  return cut;
}

Bore engine_bore() {
  Bore bore;
  bore.origin = {0, 0.4, 1};
  bore.direction = {0, 0, -1};
  bore.radius = 0.08;
  bore.depth = 1;
  bore.wall = true;
  return bore;
}

}  // namespace sunder::bench
