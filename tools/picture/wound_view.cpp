#include "tools/picture/wound_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/render/triangle_tree.h"

namespace sunder::tools {
namespace {

constexpr std::size_t kMostPatches = 2000;
constexpr double kGoodEnough = 0.55;  ///< Of the flesh that the best view shows.
/// What a view is worth in addition, as shares of the same: near to the preferred one, and level.
constexpr double kNear = 0.15, kLevel = 0.1;
constexpr double kLevelElevation = 0.12;
/// A wound is covered if no view shows more than this share of its area.
constexpr double kLeastSeen = 0.02;

/// A triangle of flesh.
struct Patch {
  Vec3f middle;
  Vec3f normal;  ///< As long as twice the area.
};

class Visibility {
 public:
  explicit Visibility(const RenderScene& scene) : tree_(corners_of(scene)) {
    Vec3f least = Vec3f::Constant(TriangleTree::kFar), greatest = -least;
    std::vector<Patch> all;
    for (const RenderTriangle& triangle : scene.triangles) {
      const auto& [a, b, c] = triangle.corners;
      for (const Vec3f& corner : triangle.corners) {
        least = least.cwiseMin(corner);
        greatest = greatest.cwiseMax(corner);
      }
      if (scene.materials[triangle.material].is_flesh)
        all.push_back({(a + b + c) / 3, (b - a).cross(c - a)});
    }
    above_ = 1e-4f * (greatest - least).norm();
    const std::size_t step = 1 + all.size() / kMostPatches;
    for (std::size_t i = 0; i < all.size(); i += step) patches_.push_back(all[i]);
  }

  /// The flesh that is visible from a side, as an area.
  [[nodiscard]] double from(const Vec3d& towards_eye) const {
    const Vec3f eye = towards_eye.cast<float>();
    double sum = 0;
    for (const Patch& patch : patches_)
      if (!tree_.is_blocked(patch.middle + above_ * eye, eye))
        sum += static_cast<double>(std::abs(patch.normal.dot(eye)));
    return sum;
  }
  /// Of all flesh, in the same unit.
  [[nodiscard]] double area() const {
    double sum = 0;
    for (const Patch& patch : patches_) sum += static_cast<double>(patch.normal.norm());
    return sum;
  }

 private:
  static std::vector<TriangleTree::Corners> corners_of(const RenderScene& scene) {
    std::vector<TriangleTree::Corners> corners;
    for (const RenderTriangle& triangle : scene.triangles) corners.push_back(triangle.corners);
    return corners;
  }

  TriangleTree tree_;
  std::vector<Patch> patches_;
  float above_ = 0;  ///< Where rays start.
};

}  // namespace

WoundView see_wound(const RenderScene& scene, const ViewFrame& preferred) {
  const Visibility visibility(scene);
  struct View {
    ViewFrame frame;
    double flesh = 0, liking = 0;
  };
  std::vector<View> views;
  double most = visibility.from(preferred.towards_eye);
  const double before = most;
  for (const double elevation : {kLevelElevation, 0.45, 0.9, -0.25, -0.9})
    for (int i = 0; i < 16; ++i) {
      const double angle = std::numbers::pi * i / 8;
      const ViewFrame frame = view_from({std::sin(angle), elevation, std::cos(angle)});
      const double liking = kNear * frame.towards_eye.dot(preferred.towards_eye) -
                            kLevel * std::abs(elevation - kLevelElevation);
      views.push_back({frame, visibility.from(frame.towards_eye), liking});
      most = std::max(most, views.back().flesh);
    }
  const bool is_covered = most < kLeastSeen * visibility.area();
  if (before >= kGoodEnough * most) return {preferred, is_covered};
  const auto worth = [most](const View& view) { return view.flesh / most + view.liking; };
  const auto best = std::max_element(views.begin(), views.end(), [&](const View& a, const View& b) {
    return worth(a) < worth(b);
  });
  return {best->frame, is_covered};
}

}  // namespace sunder::tools
