#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/clearance.h"
#include "pipeline/plan/find_obstacles.h"
#include "pipeline/plan/fit_spline.h"
#include "pipeline/plan/inverse_kinematics.h"
#include "pipeline/plan/measure_wound.h"
#include "pipeline/plan/target_path.h"
#include "pipeline/plan/timeline.h"

namespace sunder {
namespace plan {
namespace {

constexpr std::size_t kSamplesPerInterval = 3;
constexpr double kTolerance = 0.01;         ///< Of the curve's length.
constexpr double kLeastTolerance = 0.0005;  ///< Of the diagonal of the posed character.
/// Errors that count as one, as shares of the tolerance and the depth.
constexpr double kPlaceScale = 0.02, kDepthScale = 0.05;
constexpr double kRate = 240;        ///< Samples of the trajectory per second, or
constexpr double kLeastOfCut = 240;  ///< in the cut, if it takes less.
constexpr double kFrame = 1.0 / 60;  ///< A blade at least so often while a clip runs, seconds.
constexpr int kMostRounds = 4;       ///< Of fits that add places to keep away from.
constexpr double kOverLimit = 1e-9;
constexpr int kMostDurations = 8;
constexpr double kLongest = 16;  ///< Times the cut's duration that it may grow to.
constexpr double kMostSeconds = 3600;

Status check_seconds(double seconds, const char* name) {
  if (seconds > 0 && seconds <= kMostSeconds) return {};
  return Status::failure(StatusCode::invalid_argument, kNone,
                         "%s takes %g s; it must be above 0 and at most %g", name, seconds,
                         kMostSeconds);
}

Status check_inputs(const PlanTiming& timing, const PlanOptions& options) {
  if (const Status status = check_seconds(timing.approach, "the approach"); !status) return status;
  if (const Status status = check_seconds(timing.cut, "the cut"); !status) return status;
  if (const Status status = check_seconds(timing.retreat, "the retreat"); !status) return status;
  if (!(timing.standoff >= 0) || !std::isfinite(timing.standoff))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the standoff is %g; it must be at least 0", timing.standoff);
  if (!(timing.clip_speed >= 0) || !std::isfinite(timing.clip_speed))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the clip's speed is %g; it must be at least 0", timing.clip_speed);
  if (timing.clip_speed > 0 && !std::holds_alternative<ClipPose>(timing.pose))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "clip speed is %g, but the pose is none of a clip", timing.clip_speed);
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the tolerance is %g; it must be at least 0", options.tolerance);
  if (!(options.clearance > 0) || !std::isfinite(options.clearance))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the clearance is %g; it must be above 0", options.clearance);
  if (!(options.maximum_acceleration >= 0) || !std::isfinite(options.maximum_acceleration))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the greatest acceleration is %g; it must be at least 0",
                           options.maximum_acceleration);
  return {};
}

/// Diagonal of the box around all vertices in a pose.
double diagonal_of(const Character& character, const ModelPose& pose) {
  std::vector<SurfaceAnchor> places;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh)
    for (std::uint32_t i = 0; i < character.meshes[mesh].triangle_count(); ++i)
      places.push_back({mesh, {i, {1, 0, 0}}});
  std::vector<Vec3d> posed(places.size());
  if (places.empty() || !PosedPlaces(character, places).pose(pose, posed, {})) return 0;
  Vec3d low = posed[0], high = posed[0];
  for (const Vec3d& place : posed) {
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  return (high - low).norm();
}

/// Times between knots, and the knots.
std::vector<double> sample_times(const std::vector<double>& knots) {
  std::vector<double> times;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    for (std::size_t k = 0; k < kSamplesPerInterval; ++k)
      times.push_back(knots[i] + (knots[i + 1] - knots[i]) * static_cast<double>(k) /
                                     static_cast<double>(kSamplesPerInterval));
  times.push_back(knots.back());
  return times;
}

/// Even times in each of approach, cut and retreat.
std::vector<double> trajectory_times(const Timeline& timeline) {
  std::vector<double> times = {0};
  const auto add = [&](double begin, double end, double least) {
    const double steps = std::max(std::ceil((end - begin) * kRate), least);
    for (double k = 1; k <= steps; ++k) times.push_back(begin + (end - begin) * k / steps);
  };
  add(0, timeline.cut_begins(), 1);
  add(timeline.cut_begins(), timeline.cut_ends(), kLeastOfCut);
  add(timeline.cut_ends(), timeline.end(), 1);
  return times;
}

/// One plan, step by step.
class Planner {
 public:
  Planner(const std::shared_ptr<const Character>& character, const PlanTiming& timing,
          const PlanTool& tool, const PlanOptions& options)
      : character_(character), timing_(timing), tool_(tool), options_(options) {}

  Result<PlannedMotion> run(const WoundTarget& target) {
    Result<BladeChain> chain = BladeChain::create(tool_);
    if (!chain) return chain.error();
    const Result<ModelPose> pose = make_pose(*character_, timing_.pose);
    if (!pose) return pose.error();
    const Result<TargetPath> path = TargetPath::create(character_, target, *pose);
    if (!path) return path.error();
    if (const Status status = check_blade(target, *chain); !status) return status;
    if (const Status status = check_shapes(); !status) return status;
    prepare(target, *path, *pose, *chain);
    for (int i = 0;; ++i) {
      const Result<bool> is_done = fit(*path, *chain);
      if (!is_done) return is_done.error();
      if (*is_done || i == kMostDurations || !lengthen()) break;
    }
    const bool has_motion = planned_.report.is_reachable ||
                            planned_.report.obstacles.front().kind == PlanObstacle::Kind::wound;
    if (!has_motion) {
      planned_.trajectory = {};
      planned_.tear = {};
    }
    return std::move(planned_);
  }

 private:
  static Status check_blade(const WoundTarget& target, const BladeChain& chain) {
    const double depth = *std::max_element(target.depth.begin(), target.depth.end());
    if (chain.blade_length() > depth) return {};
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the blade is %g m long; it cannot reach %g m below the surface",
                           chain.blade_length(), depth);
  }

  [[nodiscard]] Status check_shapes() const {
    for (std::uint32_t i = 0; i < tool_.shapes.size(); ++i) {
      if (tool_.shapes[i].bone >= tool_.robot.links.size())
        return Status::failure(StatusCode::index_out_of_range, i,
                               "shape %u: link %u does not exist; the robot has %zu", i,
                               tool_.shapes[i].bone, tool_.robot.links.size());
      if (const Status status = validate_collider(tool_.shapes[i].collider); !status) return status;
    }
    return {};
  }

  void prepare(const WoundTarget& target, const TargetPath& path, const ModelPose& pose,
               const BladeChain& chain) {
    PlanReport& report = planned_.report;
    report.curve_length = path.length();
    report.tolerance = options_.tolerance > 0
                           ? options_.tolerance
                           : std::max(kTolerance * path.length(),
                                      kLeastTolerance * diagonal_of(*character_, pose));
    const double depth = *std::min_element(target.depth.begin(), target.depth.end());
    scales_.place = kPlaceScale * report.tolerance;
    scales_.depth = kDepthScale * depth;
    limits_.values = limits_of(chain);
    limits_.speed = limits_.acceleration = Values::Constant(
        static_cast<Eigen::Index>(chain.size()), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const auto index = static_cast<Eigen::Index>(i);
      if (chain.speed_limit(i) > 0) limits_.speed[index] = chain.speed_limit(i);
      if (options_.maximum_acceleration > 0)
        limits_.acceleration[index] = options_.maximum_acceleration;
    }
    longest_ = kLongest * timing_.cut;
  }

  /// @return whether a motion was found.
  Result<bool> fit(const TargetPath& path, BladeChain& chain) {
    PlanReport& report = planned_.report;
    const Timeline timeline(timing_);
    Result<std::vector<TargetSample>> samples =
        sample_target(*character_, path, timing_, sample_times(timeline.knots()));
    if (!samples) return samples.error();
    samples_ = std::move(*samples);
    report.cut = timing_.cut;
    report.cut_begins = timeline.cut_begins();
    report.cut_ends = timeline.cut_ends();
    Result<Clearance> clearance = Clearance::create(*character_, tool_, timing_, samples_);
    if (!clearance) return clearance.error();
    clearance_ = std::move(*clearance);
    const std::vector<std::vector<Values>> tracks = tracks_of(chain);
    // What is told about the best track, unless a later one is followed.
    PlannedMotion first;
    double first_slowdown = 1;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      if (const Status status = follow(tracks[i], path, chain); !status) return status;
      if (planned_.report.is_reachable) return true;
      if (i == 0) {
        first = planned_;
        first_slowdown = slowdown_;
      }
    }
    planned_ = std::move(first);
    slowdown_ = first_slowdown;
    return false;
  }

  /// Fits a spline to a track, and tears. The report says whether the curve is made.
  Status follow(const std::vector<Values>& start, const TargetPath& path, BladeChain& chain) {
    PlanReport& report = planned_.report;
    report.obstacles.clear();
    slowdown_ = 1;
    if (!check_reach(chain, start)) return {};
    Result<JointSpline> spline = fit(chain, start);
    if (!spline) return spline.error();
    write_trajectory(*spline, chain);
    check_rates(chain);
    measure_errors(*spline, chain);
    report.is_reachable = report.obstacles.empty() && check_fit(*spline, chain);
    if (!report.is_reachable) return {};
    if (const Status status = tear(path); !status) return status;
    report.is_reachable = report.hausdorff <= report.tolerance;
    if (!report.is_reachable)
      report.obstacles.push_back({PlanObstacle::Kind::wound, "", wound_share_});
    return {};
  }

  /// Fits until the links keep their distance, or for some rounds.
  Result<JointSpline> fit(BladeChain& chain, const std::vector<Values>& start) {
    PlanReport& report = planned_.report;
    KeptAway kept_away{tool_.shapes, {}, options_.clearance};
    report.least_clearance = std::numeric_limits<double>::infinity();
    JointSpline spline = spline_through(start, samples_, Timeline(timing_).knots(), limits_.values);
    for (int round = 0;; ++round) {
      Result<JointSpline> fitted =
          fit_spline(chain, samples_, scales_, limits_, kept_away, std::move(spline));
      if (!fitted || !clearance_->is_needed()) return fitted;
      spline = std::move(*fitted);
      const std::vector<NearPlace> near = clearance_->find(
          chain, [&](double time) { return spline.at(time); }, 2 * options_.clearance);
      const auto nearest =
          std::min_element(near.begin(), near.end(),
                           [](const auto& a, const auto& b) { return a.distance < b.distance; });
      if (nearest != near.end()) report.least_clearance = nearest->distance;
      const bool is_clear = nearest == near.end() || nearest->distance > 0.5 * options_.clearance;
      if (is_clear || round == kMostRounds) {
        if (!is_clear && nearest->distance <= 0)
          report.obstacles.push_back({PlanObstacle::Kind::collision,
                                      tool_.robot.links[tool_.shapes[nearest->shape].bone].name,
                                      Timeline(timing_).share_at(nearest->time)});
        return spline;
      }
      kept_away.places.insert(kept_away.places.end(), near.begin(), near.end());
    }
  }

  /// The tracks, those that keep the links out of the character first.
  std::vector<std::vector<Values>> tracks_of(BladeChain& chain) const {
    std::vector<std::vector<Values>> tracks =
        track_samples(chain, samples_, scales_, limits_, options_.seeds);
    if (!clearance_->is_needed()) return tracks;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      double inside = 0;
      for (const NearPlace& near : clearance_->find(
               chain,
               [&](double time) {  // of a sample
                 const auto at = std::lower_bound(
                     samples_.begin(), samples_.end() - 1, time,
                     [](const TargetSample& sample, double of) { return sample.time < of; });
                 return tracks[i][static_cast<std::size_t>(at - samples_.begin())];
               },
               0.0))
        inside -= near.distance;
      order.emplace_back(inside, i);
    }
    std::stable_sort(order.begin(), order.end());
    std::vector<std::vector<Values>> sorted;
    for (const auto& [inside, i] : order) sorted.push_back(std::move(tracks[i]));
    return sorted;
  }

  /// @return whether inverse kinematics reach all of the curve; otherwise the report says why not.
  bool check_reach(BladeChain& chain, const std::vector<Values>& values) {
    PlanReport& report = planned_.report;
    const ReachedPart part = reached_part(chain, samples_, values, report.tolerance);
    const bool has_part = part.end > part.first;
    report.first_share = has_part ? samples_[part.first].share : 0;
    report.last_share = has_part ? samples_[part.end - 1].share : 0;
    report.is_reachable = part.is_whole;
    if (part.is_whole) return true;
    std::size_t missed = 0;
    while (missed + 1 < samples_.size() && samples_[missed].share < 0.5) ++missed;
    if (has_part && part.first > 0 && samples_[part.first - 1].depth > 0) missed = part.first - 1;
    if (has_part && part.end < samples_.size() && samples_[part.end].depth > 0) missed = part.end;
    report.obstacles = find_obstacles(chain, samples_[missed], scales_, limits_.values,
                                      values[missed], report.tolerance);
    return false;
  }

  void write_trajectory(const JointSpline& spline, const BladeChain& chain) {
    RobotTrajectory& trajectory = planned_.trajectory;
    trajectory = {};
    for (std::size_t i = 0; i < chain.size(); ++i)
      trajectory.names.push_back(chain.description(i).name);
    for (const double time : trajectory_times(Timeline(timing_))) {
      trajectory.times.push_back(time);
      // Sums of control points within limits leave them by rounding only.
      const Values values =
          spline.at(time).cwiseMax(limits_.values.lower).cwiseMin(limits_.values.upper);
      trajectory.values.insert(trajectory.values.end(), values.data(),
                               values.data() + values.size());
    }
  }

  /// The margins of the trajectory, and the speeds and accelerations that it exceeds.
  void check_rates(const BladeChain& chain) {
    PlanReport& report = planned_.report;
    report.values.clear();
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const ValueMargin margin = margin_of(chain, i);
      const double speed = margin.speed_limit > 0 ? margin.greatest_speed / margin.speed_limit : 0;
      const double acceleration = options_.maximum_acceleration > 0
                                      ? margin.greatest_acceleration / options_.maximum_acceleration
                                      : 0;
      if (speed > 1 + kOverLimit)
        report.obstacles.push_back({PlanObstacle::Kind::joint_speed, margin.name, fastest_share_});
      if (acceleration > 1 + kOverLimit)
        report.obstacles.push_back(
            {PlanObstacle::Kind::acceleration, margin.name, sharpest_share_});
      slowdown_ = std::max({slowdown_, speed, std::sqrt(acceleration)});
      report.values.push_back(margin);
    }
  }

  ValueMargin margin_of(const BladeChain& chain, std::size_t i) {
    const RobotTrajectory& trajectory = planned_.trajectory;
    const std::size_t width = trajectory.names.size();
    const auto at = [&](std::size_t k) { return trajectory.values[k * width + i]; };
    const RobotValue& value = chain.description(i);
    ValueMargin margin{value.name, at(0), at(0), 0, 0, chain.speed_limit(i), 0};
    double before = 0, seconds_before = 0;
    for (std::size_t k = 0; k < trajectory.times.size(); ++k) {
      margin.least = std::min(margin.least, at(k));
      margin.greatest = std::max(margin.greatest, at(k));
      if (k == 0) continue;
      const double seconds = trajectory.times[k] - trajectory.times[k - 1];
      const double speed = (at(k) - at(k - 1)) / seconds;
      const double share = Timeline(timing_).share_at(trajectory.times[k]);
      if (std::abs(speed) > margin.greatest_speed) {
        margin.greatest_speed = std::abs(speed);
        fastest_share_ = share;
      }
      const double acceleration =
          k > 1 ? std::abs(speed - before) / (0.5 * (seconds + seconds_before)) : 0;
      if (acceleration > margin.greatest_acceleration) {
        margin.greatest_acceleration = acceleration;
        sharpest_share_ = share;
      }
      before = speed;
      seconds_before = seconds;
    }
    margin.to_limits = std::min(margin.least - value.lower, value.upper - margin.greatest);
    return margin;
  }

  void measure_errors(const JointSpline& spline, BladeChain& chain) {
    PlanReport& report = planned_.report;
    report.most_place_error = report.most_depth_error = report.most_angle_error = 0;
    double place_sum = 0, depth_sum = 0, angle_sum = 0, count = 0, full_count = 0;
    BladePlace place;
    for (const TargetSample& sample : samples_) {
      if (sample.lift > 0) continue;
      const Values values = spline.at(sample.time);
      chain.place({values.data(), chain.size()}, place, false);
      const PlainErrors errors = plain_errors(place, sample);
      report.most_place_error = std::max(report.most_place_error, errors.place);
      if (sample.is_full) report.most_depth_error = std::max(report.most_depth_error, errors.depth);
      report.most_angle_error = std::max(report.most_angle_error, errors.angle);
      place_sum += errors.place * errors.place;
      if (sample.is_full) depth_sum += errors.depth * errors.depth;
      angle_sum += errors.angle * errors.angle;
      count += 1;
      if (sample.is_full) full_count += 1;
    }
    report.mean_place_error = std::sqrt(place_sum / count);
    report.mean_depth_error = std::sqrt(depth_sum / full_count);
    report.mean_angle_error = std::sqrt(angle_sum / count);
  }

  /// @return whether the spline passes along all of the curve; otherwise the limits of speed or
  /// acceleration that it keeps to are the reason.
  bool check_fit(const JointSpline& spline, BladeChain& chain) {
    PlanReport& report = planned_.report;
    std::vector<Values> values;
    for (const TargetSample& sample : samples_) values.push_back(spline.at(sample.time));
    const ReachedPart part = reached_part(chain, samples_, values, report.tolerance);
    if (part.is_whole) return true;
    const bool has_part = part.end > part.first;
    report.first_share = has_part ? samples_[part.first].share : 0;
    report.last_share = has_part ? samples_[part.end - 1].share : 0;
    for (const ValueMargin& margin : report.values) {
      if (margin.speed_limit > 0 && margin.greatest_speed > kNearLimit * margin.speed_limit)
        report.obstacles.push_back(
            {PlanObstacle::Kind::joint_speed, margin.name, report.last_share});
      if (options_.maximum_acceleration > 0 &&
          margin.greatest_acceleration > kNearLimit * options_.maximum_acceleration)
        report.obstacles.push_back(
            {PlanObstacle::Kind::acceleration, margin.name, report.last_share});
    }
    if (report.obstacles.empty())
      report.obstacles.push_back({PlanObstacle::Kind::reach, "", report.last_share});
    slowdown_ = std::max(slowdown_, kSlower);
    return false;
  }

  /// @return whether the cut may take longer; then it does.
  bool lengthen() {
    if (!timing_.may_take_longer || slowdown_ <= 1 || timing_.cut >= longest_) return false;
    // Approach and retreat grow by as much as the cut.
    const double factor = std::min(slowdown_ * kSlower, longest_ / timing_.cut);
    timing_.cut *= factor;
    timing_.approach *= factor;
    timing_.retreat *= factor;
    return true;
  }

  Status tear(const TargetPath& path) {
    PlanReport& report = planned_.report;
    const Result<RobotMotion> motion = RobotMotion::create(tool_.robot, planned_.trajectory);
    if (!motion) return motion.error();
    SweepOptions options;
    options.spacing = options_.spacing;
    if (timing_.clip_speed > 0) options.seconds = kFrame;
    const Result<BladeSweep> sweep =
        sweep_blade(*motion, tool_.blade, tool_.world_from_root, options);
    if (!sweep) return sweep.error();
    Result<TearOperation> tear =
        tear_of_sweep(*sweep, timing_.pose, timing_.clip_speed, options_.tear);
    if (!tear) return tear.error();
    planned_.tear = std::move(*tear);
    const Result<ModelPose> pose = pose_at(*character_, timing_, report.cut_begins);
    if (!pose) return pose.error();
    const Result<WoundMeasures> measured = measure_wound(character_, path, planned_.tear, *pose);
    if (!measured) return measured.error();
    report.hausdorff = measured->hausdorff;
    report.mean_distance = measured->mean_distance;
    report.hausdorff_in_clips = measured->hausdorff_in_clips;
    report.torn = measured->torn;
    wound_share_ = measured->farthest_share;
    return {};
  }

  static constexpr double kNearLimit = 0.9;  ///< Share of a limit that is used up.
  static constexpr double kSlower = 1.15;

  const std::shared_ptr<const Character>& character_;
  PlanTiming timing_;
  const PlanTool& tool_;
  const PlanOptions& options_;
  ErrorScales scales_;
  SplineLimits limits_;
  std::vector<TargetSample> samples_;
  std::optional<Clearance> clearance_;
  double longest_ = 0, slowdown_ = 1;
  double fastest_share_ = 0, sharpest_share_ = 0;  ///< Of the value that was measured last.
  double wound_share_ = 0;  ///< Of the place of the curve that the lips are farthest from.
  PlannedMotion planned_;
};

}  // namespace
}  // namespace plan

Result<PlannedMotion> plan_motion(const std::shared_ptr<const Character>& character,
                                  const WoundTarget& target, const PlanTiming& timing,
                                  const PlanTool& tool, const PlanOptions& options) {
  if (character == nullptr)
    return Status::failure(StatusCode::empty_input, kNone, "there is no character");
  if (const Status status = plan::check_inputs(timing, options); !status) return status;
  return or_out_of_memory([&]() -> Result<PlannedMotion> {
    if (const Status status = validate_character(*character); !status) return status;
    return plan::Planner(character, timing, tool, options).run(target);
  });
}

}  // namespace sunder
