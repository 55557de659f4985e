#include "io/fbx/tracks.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "io/fbx/evaluate.h"

namespace sunder::fbx {
namespace {

constexpr double kAngleTolerance = 1e-4;
constexpr double kPlaceTolerance = 1e-5;
constexpr double kScaleTolerance = 1e-5;
/// Largest shear that is rounding, relative to the scale.
constexpr double kShear = 1e-6;
constexpr int kMostHalvings = 8;
/// How many moments of a take decide on the parents.
constexpr std::size_t kMostMoments = 256;

struct Relative {
  Place place;
  double shear = 0.0;
};

/// Divides a linear map into a rotation and a scale along the axes; what is left is shear.
Relative divided(const Vec3d& translation, const Mat3d& linear, const Mat3d& near_rotation) {
  Relative result;
  result.place.translation = translation;
  Mat3d rotation = near_rotation;
  const Vec3d lengths = linear.colwise().norm().transpose();
  if (lengths.minCoeff() > 0.0) {
    rotation = linear * lengths.cwiseInverse().asDiagonal();
    if (rotation.determinant() < 0.0) rotation = -rotation;
  }
  result.place.rotation = Quatd(rotation).normalized();
  const Mat3d unit = result.place.rotation.toRotationMatrix();
  result.place.scale = (unit.transpose() * linear).diagonal();
  const double longest = std::max(lengths.maxCoeff(), 1e-300);
  result.shear = (unit * result.place.scale.asDiagonal() - linear).norm() / longest;
  return result;
}

/// Places of models relative to a tree's parents.
class Places {
 public:
  Places(const Scene& scene, const Take* take) : scene_(scene), evaluator_(scene, take) {}

  [[nodiscard]] Relative at(std::uint32_t model, std::uint32_t parent, double ticks) const {
    if (parent == scene_.models[model].parent && is_plain(model)) {
      const Local local = evaluator_.local(model, ticks);
      return {.place = {local.translation, Quatd(local.rotation).normalized(), local.scale}};
    }
    const Global here = evaluator_.global(model, ticks);
    if (parent == kNone)
      return divided(here.translation, here.rotation * here.shape, here.rotation);
    const Global above = evaluator_.global(parent, ticks);
    const Mat3d parent_from_scene = (above.rotation * above.shape).inverse();
    if (!parent_from_scene.allFinite()) return {.place = {}, .shear = HUGE_VAL};
    return divided(parent_from_scene * (here.translation - above.translation),
                   parent_from_scene * here.rotation * here.shape, here.rotation);
  }

  /// Whether the place in the model's own parent is its stack: if scales are inherited by the
  /// product, or there are none to inherit.
  [[nodiscard]] bool is_plain(std::uint32_t model) const {
    return scene_.models[model].rest.inherit == Inherit::all || !evaluator_.is_below_scale(model);
  }

  [[nodiscard]] const Evaluator& evaluator() const { return evaluator_; }

 private:
  const Scene& scene_;
  Evaluator evaluator_;
};

/// The moments between which all curves of a model and of its ancestors are smooth, within a span.
std::vector<double> moments_of(const Scene& scene, const Evaluator& evaluator, std::uint32_t model,
                               bool with_ancestors, const TakeSpan& span) {
  std::vector<double> ticks;
  for (std::uint32_t i = model; i != kNone; i = scene.models[i].parent) {
    evaluator.append_times(i, ticks);
    if (!with_ancestors) break;
  }
  if (ticks.empty()) return ticks;
  for (double& one : ticks) one = std::clamp(one, span.start, span.stop);
  ticks.push_back(span.start);
  ticks.push_back(span.stop);
  std::sort(ticks.begin(), ticks.end());
  ticks.erase(std::unique(ticks.begin(), ticks.end()), ticks.end());
  return ticks;
}

double largest_shear(const Scene& scene, const Places& rest, const std::vector<Places>& takes,
                     std::uint32_t model, std::uint32_t parent) {
  double largest = rest.at(model, parent, 0.0).shear;
  for (std::size_t t = 0; t < takes.size(); ++t) {
    if (parent == scene.models[model].parent && takes[t].is_plain(model)) continue;
    const auto moments =
        moments_of(scene, takes[t].evaluator(), model, true, span_of(scene.takes[t]));
    const std::size_t step = moments.size() / kMostMoments + 1;
    for (std::size_t i = 0; i < moments.size(); i += step)
      largest = std::max(largest, takes[t].at(model, parent, moments[i]).shear);
  }
  return largest;
}

Place between(const Place& a, const Place& b, double x) {
  return {a.translation + x * (b.translation - a.translation), a.rotation.slerp(x, b.rotation),
          a.scale + x * (b.scale - a.scale)};
}

class TrackMaker {
 public:
  TrackMaker(const Places& places, std::uint32_t parent, double size, const TakeSpan& span,
             Track& track)
      : places_(places), parent_(parent), size_(size), span_(span), track_(track) {}

  void add(const std::vector<double>& moments) {
    for (std::size_t i = 0; i < moments.size(); ++i) {
      const Place here = at(moments[i]);
      if (i > 0) halve(moments[i - 1], track_.places.back(), moments[i], here, kMostHalvings);
      push(moments[i], here);
    }
  }

 private:
  [[nodiscard]] Place at(double ticks) const {
    return places_.at(track_.model, parent_, ticks).place;
  }

  void push(double ticks, const Place& place) {
    track_.seconds.push_back((ticks - span_.start) / kTicksPerSecond);
    track_.places.push_back(place);
  }

  /// Adds keys between two until interpolation is close enough.
  void halve(double from, const Place& a, double to, const Place& b, int left) {
    if (left == 0 || to - from < 2.0) return;
    bool is_close = true;
    for (const double x : {0.25, 0.5, 0.75})
      is_close = is_close && differ_little(between(a, b, x), at(from + x * (to - from)));
    if (is_close) return;
    const double middle = 0.5 * (from + to);
    const Place here = at(middle);
    halve(from, a, middle, here, left - 1);
    push(middle, here);
    halve(middle, here, to, b, left - 1);
  }

  [[nodiscard]] bool differ_little(const Place& a, const Place& b) const {
    return (a.translation - b.translation).norm() <= kPlaceTolerance * size_ &&
           a.rotation.angularDistance(b.rotation) <= kAngleTolerance &&
           (a.scale - b.scale).norm() <= kScaleTolerance * b.scale.norm();
  }

  const Places& places_;
  std::uint32_t parent_;
  double size_;
  TakeSpan span_;
  Track& track_;
};

double size_of(const NodeTree& tree) {
  double size = 0.0;
  for (const Place& place : tree.rest) size = std::max(size, place.translation.norm());
  return size > 0.0 ? size : 1.0;
}

}  // namespace

TakeSpan span_of(const Take& take) {
  if (take.stop > take.start) return {take.start, take.stop};
  std::vector<double> ticks;
  for (const Layer& layer : take.layers)
    for (const CurveNode& node : layer.nodes)
      for (const auto& curve : node.curves)
        if (curve) curve->append_times(ticks);
  if (ticks.empty()) return {};
  const auto [first, last] = std::minmax_element(ticks.begin(), ticks.end());
  return {*first, *last};
}

NodeTree make_tree(const Scene& scene) {
  const Places rest(scene, nullptr);
  std::vector<Places> takes;
  takes.reserve(scene.takes.size());
  for (const Take& take : scene.takes) takes.emplace_back(scene, &take);
  NodeTree tree;
  for (std::uint32_t model = 0; model < scene.models.size(); ++model) {
    const std::uint32_t own = scene.models[model].parent;
    std::uint32_t parent = own;
    if (scene.models[model].rest.inherit != Inherit::all)
      while (parent != kNone && largest_shear(scene, rest, takes, model, parent) > kShear)
        parent = scene.models[parent].parent;
    const Relative place = rest.at(model, parent, 0.0);
    if (place.shear > kShear) ++tree.sheared;
    tree.parents.push_back(parent);
    tree.rest.push_back(place.place);
  }
  return tree;
}

std::vector<Track> make_tracks(const Scene& scene, const NodeTree& tree, const Take& take) {
  const Places places(scene, &take);
  const TakeSpan span = span_of(take);
  const double size = size_of(tree);
  std::vector<Track> tracks;
  for (std::uint32_t model = 0; model < scene.models.size(); ++model) {
    const Model& one = scene.models[model];
    // Scales of ancestors change the place in the parent, too, unless they multiply.
    const bool with_ancestors = tree.parents[model] != one.parent || !places.is_plain(model);
    const auto moments = moments_of(scene, places.evaluator(), model, with_ancestors, span);
    if (moments.empty()) continue;
    Track track{.model = model, .seconds = {}, .places = {}};
    TrackMaker(places, tree.parents[model], size, span, track).add(moments);
    tracks.push_back(std::move(track));
  }
  return tracks;
}

}  // namespace sunder::fbx
