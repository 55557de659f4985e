#include "tools/picture/bone_marks.h"

#include <algorithm>

namespace sunder::tools {
namespace {

const Vec4f kOutline(0.01f, 0.02f, 0.06f, 1), kBone(0.36f, 0.66f, 1.0f, 1);
const Vec4f kJoint(1.0f, 0.85f, 0.10f, 1), kName(0.01f, 0.02f, 0.06f, 1);
constexpr double kJointPixels = 4.5, kOutlinePixels = 1.5;

bool is_before_the_eye(const Viewport& viewport, const Vec3d& place) {
  return viewport.depth(place) > 0.05 * viewport.middle_depth();
}

/// A kite from one pixel to another, thickest near its start.
void draw_spindle(Marks& marks, const Vec2d& from, const Vec2d& to) {
  const Vec2d along = to - from;
  const double length = along.norm();
  if (length < 2) return;
  const Vec2d across = Vec2d(-along.y(), along.x()) / length;
  const auto kite = [&](double width) {
    const Vec2d thick = from + 0.18 * along;
    return std::vector<Vec2d>{from, thick + width * across, to, thick - width * across};
  };
  const double scale = marks.viewport().line_scale();
  const double width = std::clamp(0.07 * length, 2.0, 7.0 * scale);
  marks.polygon(kite(width + scale * kOutlinePixels), kOutline);
  marks.polygon(kite(width), kBone);
}

}  // namespace

void draw_bones(const Skeleton& skeleton, const std::vector<BoneExtent>& extents, Marks& marks) {
  const Viewport& viewport = marks.viewport();
  // Nodes above all that moves, such as the scene's root, are not shown.
  std::vector<bool> is_of_body(extents.size());
  for (std::size_t bone = 0; bone < extents.size(); ++bone) {
    const std::uint32_t parent = skeleton.bones[bone].parent;
    is_of_body[bone] = extents[bone].vertices > 0 || (parent != kNone && is_of_body[parent]);
  }
  const auto is_shown = [&](std::size_t bone) {
    return is_of_body[bone] && extents[bone].vertices_of_branch > 0 &&
           is_before_the_eye(viewport, extents[bone].joint);
  };
  for (std::size_t bone = 0; bone < extents.size(); ++bone) {
    const std::uint32_t parent = skeleton.bones[bone].parent;
    if (parent == kNone || !is_shown(bone) || !is_shown(parent)) continue;
    draw_spindle(marks, viewport.pixel(extents[parent].joint), viewport.pixel(extents[bone].joint));
  }
  for (std::size_t bone = 0; bone < extents.size(); ++bone) {
    if (!is_shown(bone)) continue;
    marks.disc(extents[bone].joint, kJointPixels + kOutlinePixels, 16, kOutline,
               Marks::Layer::on_top);
    marks.disc(extents[bone].joint, kJointPixels, 16, kJoint, Marks::Layer::on_top);
  }
}

std::size_t name_bones(const Skeleton& skeleton, const std::vector<BoneExtent>& extents,
                       const Viewport& viewport, Labels& labels) {
  std::vector<std::size_t> named;
  for (std::size_t bone = 0; bone < extents.size(); ++bone)
    if (extents[bone].vertices > 0 && is_before_the_eye(viewport, extents[bone].joint) &&
        viewport.is_inside(viewport.pixel(extents[bone].joint)))
      named.push_back(bone);
  std::stable_sort(named.begin(), named.end(), [&](std::size_t a, std::size_t b) {
    return extents[a].vertices > extents[b].vertices;
  });
  return static_cast<std::size_t>(std::count_if(named.begin(), named.end(), [&](std::size_t bone) {
    return !labels.place_beside(viewport.pixel(extents[bone].joint), skeleton.bones[bone].name,
                                kName);
  }));
}

}  // namespace sunder::tools
