#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/check_inputs.h"
#include "pipeline/plan/choose_tracks.h"
#include "pipeline/plan/clearance.h"
#include "pipeline/plan/confirm_causes.h"
#include "pipeline/plan/find_obstacles.h"
#include "pipeline/plan/fit_spline.h"
#include "pipeline/plan/inverse_kinematics.h"
#include "pipeline/plan/measure_wound.h"
#include "pipeline/plan/motion_measures.h"
#include "pipeline/plan/plan_setup.h"
#include "pipeline/plan/settle_gape.h"
#include "pipeline/plan/target_path.h"
#include "pipeline/plan/timeline.h"

namespace sunder {
namespace plan {
namespace {

constexpr std::size_t kSamplesPerInterval = 3;
constexpr double kFrame = 1.0 / 60;  ///< A blade at least so often while a clip runs, seconds.
constexpr int kMostRounds = 4;       ///< Of fits that add places to keep away from.
constexpr double kOverLimit = 1e-9;
constexpr std::size_t kTimesOfPairs = 257;  ///< At which links are looked at.
constexpr double kMeasuredClearance = 10;   ///< Times the wanted clearance.
constexpr int kMostDurations = 8;
constexpr double kLongest = 16;  ///< Times the cut's duration that it may grow to.

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

/// The durations of a plan that failed, without leave to grow more.
PlanTiming longest_tried(PlanTiming timing, const PlanReport& report) {
  const double factor = report.cut / timing.cut;
  timing.approach *= factor;
  timing.cut *= factor;
  timing.retreat *= factor;
  timing.may_take_longer = false;
  return timing;
}

/// One plan, step by step.
class Planner {
 public:
  Planner(const std::shared_ptr<const Character>& character, const PlanTiming& timing,
          const PlanTool& tool, const PlanOptions& options)
      : character_(character), timing_(timing), tool_(tool), options_(options) {}

  Result<PlannedMotion> run(const WoundTarget& target) {
    Result<PlanSetup> setup = PlanSetup::create(character_, target, timing_, tool_, options_);
    if (!setup) return setup.error();
    scales_ = setup->scales;
    limits_ = setup->limits;
    longest_ = kLongest * timing_.cut;
    planned_.report.curve_length = setup->path.length();
    planned_.report.tolerance = setup->tolerance;
    for (int i = 0;; ++i) {
      const Result<bool> is_done = fit(setup->path, setup->chain);
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
    return try_tracks(path, chain);
  }

  /// Follows tracks until one makes the curve: those that keep the angle, then one that leans.
  Result<bool> try_tracks(const TargetPath& path, BladeChain& chain) {
    const TrackSearch search{
        samples_,      scales_, limits_, *clearance_, options_.clearance, planned_.report.tolerance,
        options_.seeds};
    std::vector<Track> tracks = follow_tracks(chain, search);
    if (is_out_of_reach(chain, tracks[0])) return false;
    // What is told about the first track, unless a later one is followed.
    std::optional<PlannedMotion> first;
    double first_slowdown = 1;
    const auto makes_it = [&](const Track& track) -> Result<bool> {
      if (const Status status = follow(track, path, chain); !status) return status;
      if (!planned_.report.is_reachable && !first) {
        first = planned_;
        first_slowdown = slowdown_;
      }
      return planned_.report.is_reachable;
    };
    for (const Track& track : tracks) {
      if (!track.is_clean()) continue;
      const Result<bool> is_made = makes_it(track);
      if (!is_made || *is_made) return is_made;
    }
    for (std::uint64_t seed = 0; seed < kWalks; ++seed) {
      const std::vector<Track> walked = walk_freely(chain, search, {true, 1, seed});
      if (walked.empty()) break;
      for (const Track& track : walked) {
        const Result<bool> is_made = makes_it(track);
        if (!is_made || *is_made) return is_made;
      }
    }
    if (first && is_plain_reason(*first)) {
      planned_ = std::move(*first);
      slowdown_ = first_slowdown;
      return false;
    }
    name_cause(chain, search, tracks[0]);
    return false;
  }

  /// Whether no values within limits bring the blade to the first place that the best track misses:
  /// then no walk does. The report says why.
  bool is_out_of_reach(BladeChain& chain, const Track& best) {
    slowdown_ = 1;
    if (check_reach(chain, best.values)) return false;
    return !planned_.report.obstacles.empty();  // empty: other values reach it
  }

  /// Whether speeds and accelerations, or the tear, are all that is in the way.
  static bool is_plain_reason(const PlannedMotion& planned) {
    return !planned.report.obstacles.empty() &&
           std::all_of(planned.report.obstacles.begin(), planned.report.obstacles.end(),
                       [](const PlanObstacle& obstacle) {
                         return obstacle.kind != PlanObstacle::Kind::collision &&
                                obstacle.kind != PlanObstacle::Kind::self_collision &&
                                obstacle.kind != PlanObstacle::Kind::reach;
                       });
  }

  /// Names what, taken away, lets a walk through: the links that are in the way, or limits, or
  /// speeds.
  void name_cause(BladeChain& chain, const TrackSearch& search, const Track& best) {
    PlanReport& report = planned_.report;
    slowdown_ = 1;
    (void)check_reach(chain, best.values);  // for the part that is reached
    report.is_reachable = false;
    report.obstacles.clear();
    for (const Track& track : walk_freely(chain, search, {false, 1, 0})) {
      name_links(chain, track);
      if (!report.obstacles.empty()) return;
    }
    for (const Track& track : walk_freely(chain, search, {false, kFaster, 0})) {
      name_speeds(chain, track);
      if (!report.obstacles.empty()) return;
    }
    name_links(chain, best);
    if (report.obstacles.empty())
      report.obstacles.push_back({PlanObstacle::Kind::reach, "", report.last_share});
  }

  /// Names the joints that a track moves faster than their limits.
  void name_speeds(const BladeChain& chain, const Track& track) {
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const auto index = static_cast<Eigen::Index>(i);
      double most = 1, at = 0;
      for (std::size_t k = 1; k < samples_.size(); ++k) {
        const double seconds = samples_[k].time - samples_[k - 1].time;
        const double speed =
            std::abs(track.values[k][index] - track.values[k - 1][index]) / seconds;
        if (speed <= most * limits_.speed[index]) continue;
        most = speed / limits_.speed[index];
        at = samples_[k].share;
      }
      if (most <= 1) continue;
      planned_.report.obstacles.push_back(
          {PlanObstacle::Kind::joint_speed, chain.description(i).name, at});
      slowdown_ = std::max(slowdown_, most);
    }
  }

  /// Names the links that are inside of the character or of one another on a track.
  void name_links(BladeChain& chain, const Track& track) {
    PlanReport& report = planned_.report;
    report.is_reachable = false;
    report.obstacles.clear();
    const auto values_at = [&](double time) {  // of a sample
      const auto at =
          std::lower_bound(samples_.begin(), samples_.end() - 1, time,
                           [](const TargetSample& sample, double of) { return sample.time < of; });
      return track.values[static_cast<std::size_t>(at - samples_.begin())];
    };
    for (const NearPlace& near : clearance_->find(chain, values_at, 0.0)) {
      const std::string& name = tool_.robot.links[tool_.shapes[near.shape].bone].name;
      const bool is_known =
          std::any_of(report.obstacles.begin(), report.obstacles.end(),
                      [&](const PlanObstacle& known) { return known.value == name; });
      if (!is_known)
        report.obstacles.push_back(
            {PlanObstacle::Kind::collision, name, Timeline(timing_).share_at(near.time)});
    }
    name_pairs(chain, values_at, clearance_->instants());
  }

  /// Names the pairs of links that are inside of one another at even times.
  void name_pairs(BladeChain& chain, const std::function<Values(double)>& values_at,
                  std::size_t times) {
    std::vector<PlanObstacle>& obstacles = planned_.report.obstacles;
    const auto name_of = [&](std::size_t shape) {
      return tool_.robot.links[tool_.shapes[shape].bone].name;
    };
    BladePlace blade;
    for (std::size_t i = 0; i < times; ++i) {
      const double time =
          samples_.back().time * static_cast<double>(i) / static_cast<double>(times - 1);
      const Values values = values_at(time);
      chain.place({values.data(), chain.size()}, blade, false);
      for (const LinkPairs::Near& pair : clearance_->pairs().overlaps(chain.frames())) {
        const bool is_known =
            std::any_of(obstacles.begin(), obstacles.end(), [&](const PlanObstacle& known) {
              return known.value == name_of(pair.a) && known.other == name_of(pair.b);
            });
        if (!is_known)
          obstacles.push_back({PlanObstacle::Kind::self_collision, name_of(pair.a),
                               Timeline(timing_).share_at(time), name_of(pair.b)});
      }
    }
  }

  /// Measures the distance of links from one another, and names those that overlap.
  void check_pairs(const JointSpline& spline, BladeChain& chain) {
    const double most = kMeasuredClearance * options_.clearance;
    double& least = planned_.report.least_self_clearance;
    least = clearance_->pairs().is_empty() ? std::numeric_limits<double>::infinity() : most;
    if (clearance_->pairs().is_empty()) return;
    BladePlace blade;
    for (std::size_t i = 0; i < kTimesOfPairs; ++i) {
      const Values values = spline.at(samples_.back().time * static_cast<double>(i) /
                                      static_cast<double>(kTimesOfPairs - 1));
      chain.place({values.data(), chain.size()}, blade, false);
      least = clearance_->pairs().nearest(chain.frames(), least).distance;
    }
    if (least < 0)
      name_pairs(
          chain, [&](double time) { return spline.at(time); }, kTimesOfPairs);
  }

  /// Fits a spline to a track, and tears. The report says whether the curve is made. Where rates
  /// keep the blade off the curve, it leans more; where lips are a little beside the curve, the
  /// blade aims as much to the other side.
  Status follow(const Track& track, const TargetPath& path, BladeChain& chain) {
    aimed_ = samples_;
    aim_scales_ = scales_;
    if (const Status status = make(track, path, chain); !status) return status;
    if (is_too_fast() && !timing_.may_take_longer) {
      aim_scales_.angle *= kLeansMore;
      if (const Status status = make(track, path, chain); !status) return status;
    }
    TargetPath aim = path;
    for (int round = 0; round < kMostCorrections && is_a_little_beside(); ++round) {
      aim.aim_beside(missed_by_);
      Result<std::vector<TargetSample>> aimed =
          sample_target(*character_, aim, timing_, sample_times(Timeline(timing_).knots()));
      if (!aimed) return aimed.error();
      aimed_ = std::move(*aimed);
      if (const Status status = make(track, path, chain); !status) return status;
    }
    return {};
  }

  /// Whether a spline was fitted, but rates keep it off the curve.
  [[nodiscard]] bool is_too_fast() const {
    const std::vector<PlanObstacle>& obstacles = planned_.report.obstacles;
    return is_fitted_ && !obstacles.empty() &&
           std::all_of(obstacles.begin(), obstacles.end(), [](const PlanObstacle& obstacle) {
             return obstacle.kind == PlanObstacle::Kind::joint_speed ||
                    obstacle.kind == PlanObstacle::Kind::acceleration ||
                    obstacle.kind == PlanObstacle::Kind::reach;
           });
  }

  [[nodiscard]] bool is_a_little_beside() const {
    const PlanReport& report = planned_.report;
    return !report.is_reachable && !report.obstacles.empty() &&
           report.obstacles.front().kind == PlanObstacle::Kind::wound &&
           report.hausdorff < kALittle * report.tolerance;
  }

  /// Fits a spline to a track that aims at `aimed_`, and tears.
  Status make(const Track& track, const TargetPath& path, BladeChain& chain) {
    PlanReport& report = planned_.report;
    report.obstacles.clear();
    slowdown_ = 1;
    is_fitted_ = false;
    if (!check_reach(chain, track.values)) return {};
    Result<JointSpline> spline = fit(chain, track);
    if (!spline) return spline.error();
    is_fitted_ = true;
    planned_.trajectory = trajectory_of(*spline, chain, Timeline(timing_), limits_.values);
    check_rates(chain);
    check_pairs(*spline, chain);
    measure_errors(*spline, samples_, chain, report);
    report.is_reachable = report.obstacles.empty() && check_fit(*spline, chain);
    if (!report.is_reachable) return {};
    if (const Status status = tear(path); !status) return status;
    report.is_reachable = report.hausdorff <= report.tolerance;
    if (!report.is_reachable)
      report.obstacles.push_back({PlanObstacle::Kind::wound, "", wound_share_});
    return {};
  }

  /// Fits until the links keep their distance, or for some rounds.
  Result<JointSpline> fit(BladeChain& chain, const Track& track) {
    PlanReport& report = planned_.report;
    KeptAway kept_away{tool_.shapes, {}, options_.clearance};
    report.least_clearance = std::numeric_limits<double>::infinity();
    std::vector<TargetSample> wanted = aimed_;
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i].handle = track.handles[i];
    JointSpline spline =
        spline_through(track.values, wanted, Timeline(timing_).knots(), limits_.values);
    for (int round = 0;; ++round) {
      Result<JointSpline> fitted =
          fit_spline(chain, wanted, aim_scales_, limits_, kept_away, std::move(spline));
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

  /// The margins of the trajectory, and the speeds and accelerations that it exceeds.
  void check_rates(const BladeChain& chain) {
    PlanReport& report = planned_.report;
    report.values.clear();
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const PlacedMargin placed = margin_of(chain, i, planned_.trajectory, Timeline(timing_));
      const ValueMargin& margin = placed.margin;
      const double speed = margin.speed_limit > 0 ? margin.greatest_speed / margin.speed_limit : 0;
      const double acceleration = options_.maximum_acceleration > 0
                                      ? margin.greatest_acceleration / options_.maximum_acceleration
                                      : 0;
      if (speed > 1 + kOverLimit)
        report.obstacles.push_back(
            {PlanObstacle::Kind::joint_speed, margin.name, placed.fastest_share});
      if (acceleration > 1 + kOverLimit)
        report.obstacles.push_back(
            {PlanObstacle::Kind::acceleration, margin.name, placed.sharpest_share});
      slowdown_ = std::max({slowdown_, speed, std::sqrt(acceleration)});
      report.values.push_back(margin);
    }
  }

  /// @return whether the spline passes along all of the curve; otherwise the limits of speed or
  /// acceleration that it keeps to are the reason.
  bool check_fit(const JointSpline& spline, BladeChain& chain) {
    PlanReport& report = planned_.report;
    std::vector<Values> values;
    for (const TargetSample& sample : aimed_) values.push_back(spline.at(sample.time));
    const ReachedPart part = reached_part(chain, aimed_, values, report.tolerance);
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
    missed_by_ = measured->missed_by;
    if (path.widest_gape() > 0 && report.hausdorff <= report.tolerance) return settle(path);
    return {};
  }

  /// Lets the wound gape.
  Status settle(const TargetPath& path) {
    const Result<SoftMaterial> skin = find_material("skin");
    const Result<ModelPose> pose = pose_at(*character_, timing_, planned_.report.cut_ends);
    if (!skin) return skin.error();
    if (!pose) return pose.error();
    const Result<PlannedGape> gape =
        settle_gape(character_, planned_.tear, *pose, path, options_.material.value_or(*skin));
    if (!gape) return gape.error();
    planned_.report.gape = *gape;
    return {};
  }

  static constexpr double kNearLimit = 0.9;  ///< Share of a limit that is used up.
  static constexpr double kSlower = 1.15;
  static constexpr double kFaster = 10;  ///< What speeds are relaxed by.
  static constexpr double kLeansMore = 4;
  static constexpr std::uint64_t kWalks = 2;  ///< From other starts, if none makes the curve.
  static constexpr double kALittle = 4;       ///< Tolerances.
  static constexpr int kMostCorrections = 2;

  const std::shared_ptr<const Character>& character_;
  PlanTiming timing_;
  const PlanTool& tool_;
  const PlanOptions& options_;
  ErrorScales scales_;
  SplineLimits limits_;
  std::vector<TargetSample> samples_;
  std::vector<TargetSample> aimed_;  ///< Where the blade is sent: `samples_`, or beside them.
  ErrorScales aim_scales_;
  bool is_fitted_ = false;
  std::vector<Vec2d> missed_by_;  ///< WoundMeasures, of the last tear.
  std::optional<Clearance> clearance_;
  double longest_ = 0, slowdown_ = 1;
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
  if (const Status status = plan::check_timing(timing, options); !status) return status;
  return or_out_of_memory([&]() -> Result<PlannedMotion> {
    if (const Status status = validate_character(*character); !status) return status;
    Result<PlannedMotion> planned = plan::Planner(character, timing, tool, options).run(target);
    if (!planned || planned->report.is_reachable) return planned;
    const PlanTiming tried = plan::longest_tried(timing, planned->report);
    const Status status = plan::confirm_causes(
        tool, options,
        [&](const plan::FreedInputs& freed) {
          return plan::Planner(character, tried, freed.tool, freed.options).run(target);
        },
        planned->report);
    if (!status) return status;
    return planned;
  });
}

}  // namespace sunder
