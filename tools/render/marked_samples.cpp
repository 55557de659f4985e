#include "tools/render/marked_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sunder::tools {
namespace {

constexpr double kOnSurface = 1e-4;  ///< A mark this little behind a surface, by depth, is visible.

double cross(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The depth of a mark at a pixel: its inverse is linear in the picture.
class Depth {
 public:
  explicit Depth(const RenderMark& mark) {
    if (mark.depths.empty()) return;
    std::size_t widest = 2;
    const auto& c = mark.corners;
    for (std::size_t i = 2; i < c.size(); ++i)
      if (std::abs(cross(c[0], c[i - 1], c[i])) > std::abs(cross(c[0], c[widest - 1], c[widest])))
        widest = i;
    const double area = cross(c[0], c[widest - 1], c[widest]);
    at_origin_ = 1 / mark.depths[0];
    if (area == 0) return;
    const double by_first = 1 / mark.depths[widest - 1] - at_origin_,
                 by_second = 1 / mark.depths[widest] - at_origin_;
    const Vec2d first = c[widest - 1] - c[0], second = c[widest] - c[0];
    slope_ = Vec2d(by_first * second.y() - by_second * first.y(),
                   by_second * first.x() - by_first * second.x()) /
             area;
    at_origin_ -= slope_.dot(c[0]);
  }
  [[nodiscard]] double at(const Vec2d& place) const { return 1 / (at_origin_ + slope_.dot(place)); }

 private:
  double at_origin_ = 1;
  Vec2d slope_ = Vec2d::Zero();
};

bool contains(const std::vector<Vec2d>& corners, const Vec2d& place) {
  bool is_left = false, is_right = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double side = cross(corners[i], corners[(i + 1) % corners.size()], place);
    is_left = is_left || side > 0;
    is_right = is_right || side < 0;
  }
  return is_left != is_right;
}

/// Whether a mark at a depth is not behind what is visible, which it then becomes if it is opaque.
bool comes_first(double depth, const RenderMark& mark, float& visible) {
  if (depth > (1 + kOnSurface) * static_cast<double>(visible)) return false;
  if (mark.color.w() >= 1) visible = static_cast<float>(depth);
  return true;
}

void lay(const RenderMark& mark, SampledPart& part) {
  if (mark.corners.size() < 3) return;
  Vec2d least = mark.corners[0], greatest = least;
  for (const Vec2d& corner : mark.corners) {
    least = least.cwiseMin(corner);
    greatest = greatest.cwiseMax(corner);
  }
  const auto clamped = [](double value, int count) {
    return static_cast<int>(std::clamp(std::floor(value), -1.0, static_cast<double>(count)));
  };
  const int left = std::max(0, clamped(least.x() - part.left, part.width)),
            right = std::min(part.width - 1, clamped(greatest.x() - part.left, part.width)),
            top = std::max(0, clamped(least.y() - part.top, part.height)),
            bottom = std::min(part.height - 1, clamped(greatest.y() - part.top, part.height));
  const Depth depth(mark);
  const Vec3f color = mark.color.head<3>();
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x)
      for (std::size_t s = 0; s < part.places.size(); ++s) {
        const Vec2d place = Vec2d(part.left + x, part.top + y) + part.places[s];
        if (!contains(mark.corners, place)) continue;
        const std::size_t sample =
            static_cast<std::size_t>(y * part.width + x) * part.places.size() + s;
        if (!mark.depths.empty() && !comes_first(depth.at(place), mark, part.depths[sample]))
          continue;
        Vec3f& below = part.colors[sample];
        below += mark.color.w() * (color - below);
      }
}

}  // namespace

void lay_marks(std::span<const RenderMark> marks, SampledPart& part) {
  std::vector<std::size_t> in_scene;
  std::vector<double> farthest(marks.size(), 0);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i].depths.empty()) continue;
    in_scene.push_back(i);
    farthest[i] = *std::max_element(marks[i].depths.begin(), marks[i].depths.end());
  }
  std::stable_sort(in_scene.begin(), in_scene.end(),
                   [&](std::size_t a, std::size_t b) { return farthest[a] > farthest[b]; });
  for (const std::size_t i : in_scene) lay(marks[i], part);
  for (const RenderMark& mark : marks)
    if (mark.depths.empty()) lay(mark, part);
}

}  // namespace sunder::tools
