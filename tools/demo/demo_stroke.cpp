#include "tools/demo/demo_stroke.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunder::tools {
namespace {

constexpr int kImageSize = 360;
constexpr int kBlades = 13;
constexpr double kMuchBetter = 1.4;  ///< By this factor of the score.

/// A straight run of pixels of one mesh without a jump in depth.
struct Run {
  Vec2d begin = Vec2d::Zero(), end = Vec2d::Zero();
  double score = 0;
};

/// Whether the surface continues from one pixel to its neighbour, and faces the viewer enough for a
/// tear to be visible.
bool goes_on(const DepthImage& image, const DepthImage::Pixel& from, const DepthImage::Pixel& to) {
  return to.mesh != kNone && to.mesh == from.mesh && to.facing > 0.4 &&
         std::abs(to.depth - from.depth) < 2.5 * image.pixel_size();
}

/// Keeps the best run of a line through the image.
void search_line(const DepthImage& image, const Vec2d& start, const Vec2d& direction, double liking,
                 double longest, Run& best) {
  const int reach = image.width() + image.height();
  DepthImage::Pixel previous;
  int length = 0;
  double facing = 0;
  for (int step = -reach; step <= reach; ++step) {
    const Vec2d place = start + step * direction;
    const DepthImage::Pixel pixel = image.at(place.x(), place.y());
    const bool continues = length > 0 && goes_on(image, previous, pixel);
    if (!continues) length = 0, facing = 0;
    if (pixel.mesh != kNone && (continues || pixel.facing > 0.4)) {
      ++length;
      facing += pixel.facing;
      const double mean_facing = facing / length;
      const double score = std::min<double>(length, longest) * liking * mean_facing * mean_facing;
      if (score > best.score) best = {place - (length - 1) * direction, place, score};
    }
    previous = pixel;
  }
}

Run longest_run(const DepthImage& image) {
  const double longest = 0.4 * std::hypot(image.width(), image.height());
  Run best;
  constexpr int kDirections = 12;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = std::numbers::pi * i / kDirections;
    const Vec2d direction(std::cos(angle), std::sin(angle)), across(-direction.y(), direction.x());
    const double liking = 1 + 0.35 * std::abs(std::sin(2 * angle));  // Prefers oblique strokes.
    const int reach = (image.width() + image.height()) / 2;
    for (int offset = -reach; offset <= reach; offset += 3)
      search_line(image, Vec2d(image.width() / 2.0, image.height() / 2.0) + offset * across,
                  direction, liking, longest, best);
  }
  return best;
}

/// Places along the middle part of the run, swinging to both sides by `swing` of its length. Empty
/// if they leave the surface.
std::vector<Vec2d> places_along(const DepthImage& image, const Run& run, double swing) {
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
      if (!goes_on(image, previous, pixel)) return {};
      previous = pixel;
    }
  }
  return places;
}

}  // namespace

SeenStroke choose_stroke(const Character& character, const std::vector<DeformedMesh>& posed,
                         const ViewFrame& frame) {
  const DepthImage image(character, posed, frame, kImageSize);
  const Run run = longest_run(image);
  if ((run.end - run.begin).norm() < 4) return {{}, frame, 0};
  std::vector<Vec2d> places;
  for (const double swing : {0.07, 0.03, 0.0}) {
    places = places_along(image, run, swing);
    if (!places.empty()) break;
  }
  const double diagonal = bounds_of(character, posed).size().norm();
  Stroke stroke;
  for (const Vec2d& place : places) {
    const Vec3d hit = image.position(place.x(), place.y());
    // From in front of everything visible to well below the surface. Only the nearest layer is
    // torn, however deep the blade reaches.
    const double clearance =
        image.nearest_depth() - image.at(place.x(), place.y()).depth + 0.05 * diagonal;
    stroke.push_back(
        {hit + clearance * frame.towards_eye, hit - 0.06 * diagonal * frame.towards_eye});
  }
  return {stroke, frame, run.score * image.pixel_size()};
}

SeenStroke choose_stroke(const Character& character, const std::vector<DeformedMesh>& posed) {
  SeenStroke best = choose_stroke(character, posed, choose_view(bounds_of(character, posed)));
  for (const Vec3d& side : {Vec3d(0.3, 0.12, 1), Vec3d(1, 0.12, 0.3), Vec3d(0.35, 1, 0.75)}) {
    const SeenStroke other = choose_stroke(character, posed, view_from(side));
    if (!other.stroke.empty() && other.score > kMuchBetter * best.score) best = other;
  }
  return best;
}

}  // namespace sunder::tools
