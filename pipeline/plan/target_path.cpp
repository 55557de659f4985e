#include "pipeline/plan/target_path.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace sunder::plan {
namespace {

/// The curve is divided into about so many steps.
constexpr double kSteps = 240;
/// Chords that are still longer after so many more halvings than on a plane cross a gap.
constexpr int kMoreHalvings = 4;
constexpr std::ptrdiff_t kNormalWindow = 4;   ///< Anchors to each side whose normals are averaged.
constexpr std::ptrdiff_t kTangentWindow = 2;  ///< Anchors to each side that give the direction.
/// Share of the length in which the blade goes down, and in which it rises again. It moves along
/// the curve meanwhile: a blade that moves along itself sweeps no surface.
constexpr double kRamp = 0.03;
/// Share of the wanted depth by which the tip is above the surface at both ends of the curve.
constexpr double kAbove = 0.1;
constexpr std::uint32_t kMostPlaces = 100'000;

Status check_profile(const std::vector<double>& profile, std::size_t places, const char* name,
                     double below) {
  if (profile.size() != 1 && profile.size() != places)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "%s has %zu numbers; expected 1 or %zu, one per place", name,
                           profile.size(), places);
  for (std::size_t i = 0; i < profile.size(); ++i)
    if (!(profile[i] > 0) || !(profile[i] < below))
      return Status::failure(
          std::isfinite(profile[i]) ? StatusCode::invalid_argument : StatusCode::non_finite_value,
          static_cast<std::uint32_t>(i), "%s %zu is %g; it must be above 0 and below %g", name, i,
          profile[i], below);
  return {};
}

Status check_gape(const WoundTarget& target) {
  const std::vector<double>& gape = target.gape;
  if (gape.empty()) return {};
  if (gape.size() != 1 && gape.size() != target.places.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "gape has %zu numbers; expected 1 or %zu, one per place", gape.size(),
                           target.places.size());
  for (std::size_t i = 0; i < gape.size(); ++i)
    if (!(gape[i] >= 0) || !std::isfinite(gape[i]))
      return Status::failure(StatusCode::invalid_argument, static_cast<std::uint32_t>(i),
                             "gape %zu is %g; it must be at least 0", i, gape[i]);
  const double widest = *std::max_element(gape.begin(), gape.end());
  if (widest > 0 && target.is_closed)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the gape is %g, but a closed curve has none: its piece comes off",
                           widest);
  if (gape.size() > 1 && (gape.front() > 0 || gape.back() > 0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the gape is %g at the first and %g at the last place; a wound is "
                           "closed there: 0",
                           gape.front(), gape.back());
  return {};
}

Status check_target(const Character& character, const WoundTarget& target) {
  if (target.places.size() < 2)
    return Status::failure(StatusCode::empty_input, kNone, "the curve has %zu places; it needs two",
                           target.places.size());
  if (target.places.size() > kMostPlaces)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "the curve has %zu places; at most %u are allowed", target.places.size(),
                           kMostPlaces);
  for (std::size_t i = 0; i < target.places.size(); ++i)
    if (const Status status =
            check_place(character, target.places[i], static_cast<std::uint32_t>(i));
        !status)
      return status;
  if (const Status status = check_gape(target); !status) return status;
  if (const Status status = check_profile(target.depth, target.places.size(), "depth", 1e6);
      !status)
    return status;
  return check_profile(target.angle, target.places.size(), "angle", std::numbers::pi);
}

double profile_at(const std::vector<double>& profile, std::size_t place) {
  if (profile.empty()) return 0;
  return profile.size() == 1 ? profile[0] : profile[place % profile.size()];
}

/// A place of the curve, and the values of the profiles there.
struct LaidPlace {
  SurfaceAnchor anchor;
  Vec3d place;
  double depth, angle, gape;
};

/// Lays the chords between the given places on the surface.
class Layer {
 public:
  Layer(const WoundTarget& target, const std::vector<Vec3d>& posed, SurfaceQuery& query)
      : target_(target), posed_(posed), query_(query) {}

  Status run() {
    const std::size_t count = target_.places.size() + (target_.is_closed ? 1 : 0);
    double length = 0;
    for (std::size_t i = 1; i < count; ++i) length += (at(i) - at(i - 1)).norm();
    if (!(length > 1e-9))
      return Status::failure(StatusCode::empty_input, kNone,
                             "the curve has no length: all of its places are at one place");
    step_ = length / kSteps;
    add(0);
    for (std::size_t i = 1; i < count; ++i)
      if (const Status status = go_to(i); !status) return status;
    return {};
  }

  std::vector<LaidPlace> laid;

 private:
  [[nodiscard]] const Vec3d& at(std::size_t i) const { return posed_[i % posed_.size()]; }

  void add(std::size_t i) {
    laid.push_back({target_.places[i % posed_.size()], at(i), profile_at(target_.depth, i),
                    profile_at(target_.angle, i), profile_at(target_.gape, i)});
  }

  [[nodiscard]] Status jump(std::size_t i) const {
    return Status::failure(StatusCode::invalid_argument, static_cast<std::uint32_t>(i),
                           "places %zu and %zu: the surface below their chord is not connected, "
                           "or bends away from it; give places between them",
                           i - 1, i % posed_.size());
  }

  /// Adds what lies between neighbours i - 1 and i, and i itself.
  Status go_to(std::size_t i) {
    const double chord = (at(i) - at(i - 1)).norm();
    if (chord == 0) return {};
    const int halvings = static_cast<int>(std::ceil(std::log2(std::max(chord / step_, 1.0))));
    if (const Status status = halve(i, {at(i - 1), 0}, {at(i), 1}, halvings + kMoreHalvings);
        !status)
      return status;
    add(i);
    return {};
  }

  /// A place between two neighbours, and its share of the way.
  struct Between {
    Vec3d place;
    double share;
  };

  /// Adds places between `from` and `to`, which are on the surface: the one nearest to the middle
  /// of their chord, and then those between, until chords are short.
  Status halve(std::size_t i, const Between& from, const Between& to, int halvings) {
    const double chord = (to.place - from.place).norm();
    if (chord <= step_) return {};
    if (halvings == 0) return jump(i);
    const auto found = query_.find_nearest(Vec3d(0.5 * (from.place + to.place)), chord);
    if (!found) return found.error();
    if (!found->has_value()) return jump(i);
    const SurfaceContact& contact = **found;
    const Between middle{contact.place, 0.5 * (from.share + to.share)};
    if (const Status status = halve(i, from, middle, halvings - 1); !status) return status;
    const auto between = [&](const std::vector<double>& profile) {
      return (1 - middle.share) * profile_at(profile, i - 1) +
             middle.share * profile_at(profile, i);
    };
    laid.push_back({contact.anchor, contact.place, between(target_.depth), between(target_.angle),
                    between(target_.gape)});
    return halve(i, middle, to, halvings - 1);
  }

  const WoundTarget& target_;
  const std::vector<Vec3d>& posed_;
  SurfaceQuery& query_;
  double step_ = 0;
};

}  // namespace

Result<TargetPath> TargetPath::create(const std::shared_ptr<const Character>& character,
                                      const WoundTarget& target, const ModelPose& pose) {
  if (const Status status = check_target(*character, target); !status) return status;
  std::vector<Vec3d> posed(target.places.size());
  if (const Status status = PosedPlaces(*character, target.places).pose(pose, posed, {}); !status)
    return status;
  const Result<TornModel> model = TornModel::create(character);
  if (!model) return model.error();
  Result<SurfaceQuery> query = SurfaceQuery::create(*model);
  if (!query) return query.error();
  if (const Status status = query->set_pose(pose); !status) return status;
  Layer layer(target, posed, *query);
  if (const Status status = layer.run(); !status) return status;
  TargetPath path;
  path.character_ = character;
  path.is_closed_ = target.is_closed;
  for (std::size_t i = 0; i < layer.laid.size(); ++i) {
    const LaidPlace& laid = layer.laid[i];
    path.anchors_.push_back(laid.anchor);
    path.along_.push_back(
        i == 0 ? 0 : path.along_.back() + (laid.place - layer.laid[i - 1].place).norm());
    path.depth_.push_back(laid.depth);
    path.angle_.push_back(laid.angle);
    path.gape_.push_back(laid.gape);
  }
  for (const double along : path.along_) path.shares_.push_back(along / path.length());
  path.has_gape_profile_ = target.gape.size() > 1;
  if (!target.gape.empty())
    path.widest_gape_ = *std::max_element(target.gape.begin(), target.gape.end());
  path.places_.emplace(*character, path.anchors_);
  return path;
}

double TargetPath::gape_at(double share) const {
  const auto above = std::upper_bound(shares_.begin(), shares_.end() - 1, share) - shares_.begin();
  const auto next = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above, 1));
  const double step = shares_[next] - shares_[next - 1];
  const double part = step > 0 ? std::clamp((share - shares_[next - 1]) / step, 0.0, 1.0) : 0;
  return (1 - part) * gape_[next - 1] + part * gape_[next];
}

Vec3d direction_at(const Vec3d& before, const Vec3d& behind, const Vec3d& normal) {
  Vec3d along = behind - before;
  along -= along.dot(normal) * normal;
  return along.norm() > 1e-15 ? Vec3d(along.normalized()) : Vec3d::Zero();
}

void TargetPath::aim_beside(std::span<const Vec2d> offsets) {
  beside_.resize(anchors_.size(), Vec2d::Zero());
  for (std::size_t i = 0; i < beside_.size() && i < offsets.size(); ++i) beside_[i] += offsets[i];
}

Status TargetPath::pose(const ModelPose& pose, PosedPath& posed) const {
  posed.places.resize(anchors_.size());
  posed.normals.resize(anchors_.size());
  return places_->pose(pose, posed.places, posed.normals);
}

void TargetPath::sample(const PosedPath& posed, double standoff, TargetSample& sample) const {
  const std::vector<Vec3d>&places = posed.places, &normals = posed.normals;
  const double wanted = sample.share * length();
  const auto above = std::upper_bound(along_.begin(), along_.end() - 1, wanted) - along_.begin();
  const auto next = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above, 1));
  const double step = along_[next] - along_[next - 1];
  const double part = step > 0 ? std::clamp((wanted - along_[next - 1]) / step, 0.0, 1.0) : 0;
  const auto mixed = [&](const auto& of) { return (1 - part) * of[next - 1] + part * of[next]; };

  // The index of an anchor beyond an end: held, or counted around a closed curve.
  const auto count = static_cast<std::ptrdiff_t>(anchors_.size());
  const auto held = [&](std::ptrdiff_t i) {
    if (is_closed_) i = (i % (count - 1) + count - 1) % (count - 1);
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, count - 1));
  };
  const auto middle = static_cast<std::ptrdiff_t>(next);
  Vec3d normal = Vec3d::Zero();
  for (std::ptrdiff_t i = -kNormalWindow; i < kNormalWindow; ++i) {
    // A window that slides without jumps: its ends count by the part that is inside.
    const double weight = i == -kNormalWindow ? 1 - part : 1;
    normal += weight * normals[held(middle + i)];
  }
  normal += part * normals[held(middle + kNormalWindow)];
  const auto shifted = [&](std::ptrdiff_t by) -> Vec3d {
    return (1 - part) * places[held(middle - 1 + by)] + part * places[held(middle + by)];
  };
  sample.place = (1 - part) * places[next - 1] + part * places[next];
  sample.normal = normal.norm() > 1e-12 ? Vec3d(normal.normalized()) : Vec3d::UnitY();
  const Vec3d along =
      direction_at(shifted(-kTangentWindow), shifted(kTangentWindow), sample.normal);
  if (!beside_.empty()) {
    const Vec2d beside = mixed(beside_);
    sample.place += beside.x() * along + beside.y() * sample.normal.cross(along);
  }
  const double angle = mixed(angle_);
  sample.handle = (std::sin(angle) * sample.normal + std::cos(angle) * along).normalized();
  const double to_end = std::min(sample.share, 1 - sample.share);
  const double up = std::max(1 - to_end / kRamp, 0.0);
  sample.full_depth = mixed(depth_);
  const double depth = sample.full_depth * (1 - (1 + kAbove) * up * up);
  sample.depth = (1 - sample.lift) * depth - sample.lift * standoff;
  sample.is_full = sample.lift == 0 && up == 0;
}

Result<ModelPose> pose_at(const Character& character, const PlanTiming& timing, double time) {
  const auto* const clip = std::get_if<ClipPose>(&timing.pose);
  if (clip == nullptr || timing.clip_speed == 0) return make_pose(character, timing.pose);
  ClipPose later = *clip;
  later.time += timing.clip_speed * time;
  return make_pose(character, later);
}

Result<std::vector<TargetSample>> sample_target(const Character& character, const TargetPath& path,
                                                const PlanTiming& timing,
                                                std::span<const double> times) {
  const Timeline timeline(timing);
  std::vector<TargetSample> samples(times.size());
  PosedPath posed;
  for (std::size_t i = 0; i < times.size(); ++i) {
    TargetSample& sample = samples[i];
    sample.time = times[i];
    sample.share = timeline.share_at(sample.time);
    sample.lift = timeline.lift_at(sample.time);
    if (i == 0 || timing.clip_speed > 0) {
      const Result<ModelPose> pose = pose_at(character, timing, sample.time);
      if (!pose) return pose.error();
      if (const Status status = path.pose(*pose, posed); !status) return status;
    }
    path.sample(posed, timing.standoff, sample);
  }
  return samples;
}

Result<std::vector<TargetSample>> sample_target(const Character& character, const TargetPath& path,
                                                const PlanTiming& timing, std::uint32_t count) {
  std::vector<double> times;
  for (std::uint32_t i = 0; i <= count; ++i) times.push_back(Timeline(timing).end() * i / count);
  return sample_target(character, path, timing, times);
}

}  // namespace sunder::plan
