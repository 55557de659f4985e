#include "tools/demo/demo_stroke.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunder::tools {
namespace {

constexpr int kImageSize = 360;
constexpr int kBlades = 13;
constexpr double kMuchBetter = 1.4;   ///< By this factor of the score.
constexpr double kLeastScore = 0.03;  ///< Of a stroke on skin, in diagonals of the model.

/// A straight run of pixels of one mesh without a jump in depth.
struct Run {
  Vec2d begin = Vec2d::Zero(), end = Vec2d::Zero();
  double score = 0;
};

/// The parts of a model where a stroke may go.
class Allowed {
 public:
  /// @param least  `dead` allows everything.
  Allowed(const Character& character, const SurfaceKinds& kinds, SurfaceKind least) {
    for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
      std::vector<bool>& of_mesh = are_allowed_.emplace_back();
      for (const Submesh& submesh : character.meshes[m].submeshes) {
        of_mesh.push_back(kinds.of(m, submesh.material) <= least);
        (of_mesh.back() ? allows_any_ : forbids_any_) = true;
      }
    }
  }

  [[nodiscard]] bool allows_any() const { return allows_any_; }
  [[nodiscard]] bool forbids_any() const { return forbids_any_; }
  /// Whether a pixel shows such a part.
  [[nodiscard]] bool has(const DepthImage::Pixel& pixel) const {
    return pixel.mesh != kNone && are_allowed_[pixel.mesh][pixel.submesh];
  }

 private:
  std::vector<std::vector<bool>> are_allowed_;  ///< Per mesh and submesh.
  bool allows_any_ = false, forbids_any_ = false;
};

/// A view of a model in which strokes are looked for.
struct SearchedView {
  DepthImage image;
  ViewFrame frame;
};

/// Whether the surface continues from one pixel to its neighbour, and faces the viewer enough for a
/// tear to be visible.
bool goes_on(const DepthImage& image, const Allowed& allowed, const DepthImage::Pixel& from,
             const DepthImage::Pixel& to) {
  return to.mesh != kNone && to.mesh == from.mesh && to.facing > 0.4 && allowed.has(to) &&
         std::abs(to.depth - from.depth) < 2.5 * image.pixel_size();
}

/// A line through an image, and how much it is liked.
struct Line {
  Vec2d start, direction;
  double liking;
};

/// Keeps the best run of a line through the image.
void search_line(const DepthImage& image, const Allowed& allowed, const Line& line, double longest,
                 Run& best) {
  const int reach = image.width() + image.height();
  DepthImage::Pixel previous;
  int length = 0;
  double facing = 0;
  for (int step = -reach; step <= reach; ++step) {
    const Vec2d place = line.start + step * line.direction;
    const DepthImage::Pixel pixel = image.at(place.x(), place.y());
    const bool continues = length > 0 && goes_on(image, allowed, previous, pixel);
    if (!continues) length = 0, facing = 0;
    if (allowed.has(pixel) && (continues || pixel.facing > 0.4)) {
      ++length;
      facing += pixel.facing;
      const double mean_facing = facing / length;
      const double score =
          std::min<double>(length, longest) * line.liking * mean_facing * mean_facing;
      if (score > best.score) best = {place - (length - 1) * line.direction, place, score};
    }
    previous = pixel;
  }
}

Run longest_run(const DepthImage& image, const Allowed& allowed) {
  const double longest = 0.4 * std::hypot(image.width(), image.height());
  Run best;
  constexpr int kDirections = 12;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = std::numbers::pi * i / kDirections;
    const Vec2d direction(std::cos(angle), std::sin(angle)), across(-direction.y(), direction.x());
    const double liking = 1 + 0.35 * std::abs(std::sin(2 * angle));  // Prefers oblique strokes.
    const int reach = (image.width() + image.height()) / 2;
    for (int offset = -reach; offset <= reach; offset += 3)
      search_line(
          image, allowed,
          {Vec2d(image.width() / 2.0, image.height() / 2.0) + offset * across, direction, liking},
          longest, best);
  }
  return best;
}

/// Places along the middle part of the run, swinging to both sides by `swing` of its length. Empty
/// if they leave the surface.
std::vector<Vec2d> places_along(const DepthImage& image, const Allowed& allowed, const Run& run,
                                double swing) {
  const Vec2d along = run.end - run.begin, across(-along.y(), along.x());
  std::vector<Vec2d> places;
  for (int i = 0; i < kBlades; ++i) {
    const double t = static_cast<double>(i) / (kBlades - 1);
    places.push_back(run.begin + (0.1 + 0.8 * t) * along +
                     swing * std::sin(2 * std::numbers::pi * t) * across);
  }
  for (std::size_t i = 1; i < places.size(); ++i) {
    const int steps = std::max(1, static_cast<int>((places[i] - places[i - 1]).norm()));
    DepthImage::Pixel previous = image.at(places[i - 1].x(), places[i - 1].y());
    for (int step = 1; step <= steps; ++step) {
      const Vec2d place =
          places[i - 1] + static_cast<double>(step) / steps * (places[i] - places[i - 1]);
      const DepthImage::Pixel pixel = image.at(place.x(), place.y());
      if (!goes_on(image, allowed, previous, pixel)) return {};
      previous = pixel;
    }
  }
  return places;
}

/// The best stroke in a view.
SeenStroke find_stroke(const SearchedView& view, const Allowed& allowed, double diagonal) {
  const DepthImage& image = view.image;
  const Run run = longest_run(image, allowed);
  if ((run.end - run.begin).norm() < 4) return {{}, view.frame, 0};
  std::vector<Vec2d> places;
  for (const double swing : {0.07, 0.03, 0.0}) {
    places = places_along(image, allowed, run, swing);
    if (!places.empty()) break;
  }
  Stroke stroke;
  for (const Vec2d& place : places) {
    const Vec3d hit = image.position(place.x(), place.y());
    // From in front of everything visible to well below the surface. Only the nearest layer is
    // torn, however deep the blade reaches.
    const double clearance =
        image.nearest_depth() - image.at(place.x(), place.y()).depth + 0.05 * diagonal;
    stroke.push_back(
        {hit + clearance * view.frame.towards_eye, hit - 0.06 * diagonal * view.frame.towards_eye});
  }
  return {stroke, view.frame, run.score * image.pixel_size()};
}

SeenStroke find_stroke(const std::vector<SearchedView>& views, const Allowed& allowed,
                       double diagonal) {
  SeenStroke best = find_stroke(views.front(), allowed, diagonal);
  for (std::size_t i = 1; i < views.size(); ++i) {
    const SeenStroke other = find_stroke(views[i], allowed, diagonal);
    if (!other.stroke.empty() && other.score > kMuchBetter * best.score) best = other;
  }
  return best;
}

}  // namespace

SeenStroke choose_stroke(const Character& character, const SurfaceKinds& kinds,
                         const std::vector<DeformedMesh>& posed) {
  const Bounds bounds = bounds_of(character, posed);
  const double diagonal = bounds.size().norm();
  std::vector<SearchedView> views;
  for (const ViewFrame& frame : {choose_view(bounds), view_from({0.3, 0.12, 1}),
                                 view_from({1, 0.12, 0.3}), view_from({0.35, 1, 0.75})})
    views.push_back({DepthImage(character, posed, frame, kImageSize), frame});
  for (const SurfaceKind least : {SurfaceKind::skin, SurfaceKind::unnamed}) {
    const Allowed allowed(character, kinds, least);
    if (!allowed.allows_any() || !allowed.forbids_any()) continue;
    const SeenStroke found = find_stroke(views, allowed, diagonal);
    if (found.score > kLeastScore * diagonal && !found.stroke.empty()) return found;
  }
  return find_stroke(views, Allowed(character, kinds, SurfaceKind::dead), diagonal);
}

}  // namespace sunder::tools
