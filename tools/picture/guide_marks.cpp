#include "tools/picture/guide_marks.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace sunder::tools {
namespace {

constexpr double kAxisPixels = 46, kCornerPixels = 74;
const Vec4f kAxisColors[] = {Vec4f(0.80f, 0.02f, 0.03f, 1), Vec4f(0.02f, 0.42f, 0.03f, 1),
                             Vec4f(0.02f, 0.12f, 0.80f, 1)};
const Vec4f kThinLine(0.45f, 0.47f, 0.50f, 1), kHeavyLine(0.16f, 0.17f, 0.19f, 1);

/// Draws the lines along one axis of the ground.
void draw_lines(const Grid& grid, const Vec3d& least, const Vec3d& greatest, int across,
                Marks& marks) {
  const int along = 2 - across;
  const auto first = static_cast<long>(std::lround(least[across] / grid.spacing));
  const auto last = static_cast<long>(std::lround(greatest[across] / grid.spacing));
  for (long i = first; i <= last; ++i) {
    Vec3d from(0, grid.height, 0), to(0, grid.height, 0);
    from[across] = to[across] = static_cast<double>(i) * grid.spacing;
    from[along] = least[along];
    to[along] = greatest[along];
    const bool is_heavy = i % 10 == 0;
    marks.line(from, to, is_heavy ? 2.0 : 1.2, is_heavy ? kHeavyLine : kThinLine,
               Marks::Layer::in_scene);
  }
}

}  // namespace

void draw_axes(Marks& marks, Labels& labels) {
  const Viewport& viewport = marks.viewport();
  const double scale = viewport.line_scale();
  const Vec2d corner = Vec2d(0, viewport.size().height) + scale * kCornerPixels * Vec2d(1, -1);
  // The axis that points to the eye covers the others, so it is drawn last.
  int order[] = {0, 1, 2};
  std::sort(std::begin(order), std::end(order), [&](int a, int b) {
    return viewport.frame().towards_eye[a] < viewport.frame().towards_eye[b];
  });
  for (const int axis : order) {
    const Vec2d direction(viewport.frame().right[axis], -viewport.frame().up[axis]);
    const Vec2d tip = corner + scale * kAxisPixels * direction;
    marks.line(corner, tip, 4, kAxisColors[axis]);
    labels.place_beside(tip + scale * 6 * direction, std::string(1, "XYZ"[axis]),
                        kAxisColors[axis]);
  }
}

Grid choose_grid(const Bounds& model) {
  Grid grid;
  const double size = model.size().maxCoeff();
  // Rounded up a little, so that a model of just below 3 m has the grid of one of 3 m.
  if (size > 0) grid.spacing = std::pow(10.0, std::floor(std::log10(size / 2.9)));
  grid.height = model.least.y() < -0.02 * size ? model.least.y() : 0.0;
  return grid;
}

void draw_grid(const Grid& grid, const Bounds& model, Marks& marks) {
  const double beside = 0.4 * model.size().maxCoeff();
  Vec3d least, greatest;
  for (int axis = 0; axis < 3; ++axis) {
    least[axis] = grid.spacing * std::floor((model.least[axis] - beside) / grid.spacing);
    greatest[axis] = grid.spacing * std::ceil((model.greatest[axis] + beside) / grid.spacing);
  }
  for (const int across : {0, 2}) draw_lines(grid, least, greatest, across, marks);
}

}  // namespace sunder::tools
