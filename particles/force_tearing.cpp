#include <sunder/particles/force_tearing.h>
#include <sunder/tear/preview.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "core/internal/ordered.h"
#include "particles/body_state.h"
#include "particles/clusters/lip_border.h"
#include "particles/rupture/overstretch.h"
#include "particles/rupture/resistance.h"
#include "particles/rupture/short_tear.h"
#include "particles/rupture/tip_load.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace particles {
namespace {

/// Number of starts that are tried if the surface cannot be torn at the first.
constexpr int kMostAttempts = 8;

Tissue tissue_of(const SoftBody& body, const ParticleSet& set, const TornModel& model) {
  const BodyState& state = BodyStateOf::in(body);
  const Tension& tension = state.outer.tension;
  return {set,
          model,
          state.materials,
          state.motion,
          state.rests,
          state.graph,
          tension,
          tension.adds_pose_strain ? state.outer.of_pose.added() : std::span<const Mat3d>()};
}

/// Whether the speed of tearing allows a tear of this length in the last step: once each time in
/// which it covers the length.
bool may_tear_now(const SoftBody& body, double length, double metres_per_second) {
  const OuterForces& outer = BodyStateOf::in(body).outer;
  if (!std::isfinite(metres_per_second)) return true;
  const double rate = metres_per_second / length;
  return std::floor(outer.time * rate) > std::floor((outer.time - outer.step_seconds) * rate);
}

/// Whether any material tears by force.
bool can_tear(const SoftBody& body) {
  return std::ranges::any_of(body.materials(), [](const SoftMaterial& material) {
    return toughness_of(material) > 0 || material.strength > 0;
  });
}

/// Where the tissue gives way, the worst first: at tips whose toughness is exceeded, then where it
/// is stretched beyond its strength and no tip is near. A place is looked for when the one before
/// could not be torn.
class Starts {
 public:
  /// @param length  of a tear along a perforation, metres.
  /// @param greatest_release  raised to that of all tips in tissue that tears.
  Starts(const Tissue& tissue, std::vector<Overstretched> overstretched,
         std::span<const Index> tips, double length, double& greatest_release)
      : tissue_(tissue),
        overstretched_(std::move(overstretched)),
        loads_(tip_loads(tissue, tips)),
        length_(length) {
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      const TipLoad& load = loads_[i];
      const double toughness =
          toughness_between(tissue.material(load.left), tissue.material(load.right));
      if (!(toughness > 0)) continue;
      greatest_release = std::max(greatest_release, load.release);
      if (load.release >= toughness) running_.push_back({i, load.release / toughness});
      double ease = 0;
      const Course course = course_from(load.tip, ease);
      if (!course.empty() && ease > 1 && load.release * ease >= toughness)
        running_.push_back({i, load.release * ease / toughness, course});
    }
    std::stable_sort(running_.begin(), running_.end(),
                     [](const Running& a, const Running& b) { return a.over > b.over; });
  }

  /// @return without a point if there is none.
  TearStart next() {
    if (next_tip_ < running_.size()) {
      const Running& running = running_[next_tip_++];
      const TipLoad& load = loads_[running.load];
      return {load.tip, true, {load.left, load.right}, running.course};
    }
    while (next_place_ < overstretched_.size()) {
      const Overstretched& of = overstretched_[next_place_++];
      const Index seed = tissue_.set.seed(of.particle);
      const Vec3d place =
          of.course.empty()
              ? tissue_.position(seed)
              : tissue_.perforations.place(of.course.line, 0.5 * (of.course.begin + of.course.end));
      if (tissue_.model.surface().point_corner[seed] != kNone && !is_near_tip(place))
        return {seed, false, {of.particle, of.particle}, of.course};
    }
    return {};
  }

 private:
  struct Running {
    std::size_t load = 0;
    double over = 0;  ///< Release over toughness, along the course.
    Course course = {};
  };

  /// The course along a perforation that is easiest from a tip.
  [[nodiscard]] Course course_from(Index tip, double& ease) const {
    if (tissue_.perforations.empty()) return {};
    const LipBorder border(tissue_.model);
    const Vec3d at = tissue_.position(tip);
    const Vec3d forward =
        at - 0.5 * (tissue_.position(border.next(tip)) + tissue_.position(border.previous(tip)));
    return tissue_.perforations.from_tip(at, forward, length_, ease);
  }
  /// Whether a place is in the disc of a tip, whose load decides there.
  [[nodiscard]] bool is_near_tip(const Vec3d& place) const {
    return std::ranges::any_of(loads_, [&](const TipLoad& load) {
      return norm(Vec3d(place - tissue_.position(load.tip))) < load.radius;
    });
  }

  const Tissue& tissue_;
  std::vector<Overstretched> overstretched_;
  std::vector<TipLoad> loads_;
  double length_;
  std::vector<Running> running_;
  std::size_t next_tip_ = 0, next_place_ = 0;
};

Stroke stroke_of(const ShortTear& tear) {
  const auto blade = [&](const Vec3d& at, const Vec3d& normal) {
    const Vec3d depth = tear.length * normal;
    return Blade{at + depth, at - depth};
  };
  Stroke stroke = {blade(tear.from, tear.normal)};
  if (tear.path.empty())
    stroke.push_back(blade(tear.from + tear.length * tear.direction, tear.normal));
  Vec3d before = tear.from;
  for (const auto& [at, normal] : tear.path) {
    if (norm(Vec3d(at - before)) > 0)
      stroke.push_back(blade(at, normal.isZero(0) ? tear.normal : normal));
    before = at;
  }
  return stroke;
}

/// Tears, unless a piece that is too small would come off: then it reports a miss.
Result<TearReport> run_tear(TornModel& model, const ModelPose& pose, const ShortTear& tear,
                            double least_piece_area, ChangeRecord& change) {
  const Stroke stroke = stroke_of(tear);
  if (least_piece_area > 0) {
    const auto preview = preview_tear(model, pose, stroke);
    if (!preview) return preview.error();
    if (std::ranges::any_of(preview->piece_areas,
                            [&](double area) { return area < least_piece_area; }))
      return TearReport();
  }
  return model.tear(pose, stroke, {}, &change);
}

/// Tears at the first of the starts where the surface can be torn.
/// @param records  the record of the tear is appended, if there is one.
Status tear_first(const Tissue& tissue, Starts& starts, TornModel& model, const ModelPose& pose,
                  double length, double least_piece_area, ForceTearingReport& report,
                  std::vector<ChangeRecord>& records) {
  TearStart start = starts.next();
  if (start.point == kNone) return {};
  SurfacePose posed;
  posed.begin(model.character().skins, pose.morph_weights.size());
  if (Status status = posed.set(model.character().skins, pose); !status) return status;
  // Allocated before the tear, which must not fail because of its record.
  ChangeRecord& change = records.emplace_back();
  for (int i = 0; i < kMostAttempts && start.point != kNone; ++i, start = starts.next()) {
    const ShortTear tear = place_tear(tissue, posed, start, length);
    if (tear.normal.isZero(0)) continue;
    auto torn = run_tear(model, pose, tear, least_piece_area, change);
    if (!torn) return torn.error();
    if (torn->runs == 0) continue;
    report.has_torn = true;
    report.is_from_tip = start.is_tip;
    report.place = tear.from;
    report.direction = tear.direction;
    report.tear = std::move(*torn);
    break;
  }
  return {};
}

}  // namespace
}  // namespace particles

Result<ForceTearingReport> tear_overstretched(const SoftBody& body, ParticleSet& particles,
                                              TornModel& model, const ModelPose& pose,
                                              const ForceTearingOptions& options,
                                              std::vector<ChangeRecord>* changes) {
  if (!(options.length > 0) || options.length > 2)
    return Status::failure(
        StatusCode::invalid_argument, kNone,
        "the tear length is %g particle ranges per call; it must be above 0 and at most 2",
        options.length);
  if (!(options.metres > 0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the tear length is %g metres per call; it must be above 0",
                           options.metres);
  if (!(options.metres_per_second > 0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the speed of tearing is %g m/s; it must be above 0",
                           options.metres_per_second);
  if (!(options.least_piece_area >= 0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the least area of a piece is %g m^2; it must not be below 0",
                           options.least_piece_area);
  if (body.particle_count() != particles.particle_count())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the body has %u particles, the set has %u; step the body first",
                           body.particle_count(), particles.particle_count());
  ForceTearingReport report;
  std::vector<ChangeRecord> own;
  std::vector<ChangeRecord>& records = changes != nullptr ? *changes : own;
  const std::size_t record_count = records.size();
  Status status;
  try {
    const particles::Tissue tissue = particles::tissue_of(body, particles, model);
    const double length = std::min(options.length * particles.report().range, options.metres);
    auto overstretched = particles::find_overstretched(tissue, length, report.greatest_stretch);
    if (body.awake_count() == 0 || !particles::can_tear(body)) return report;
    if (const Status valid = particles.rest(pose, {}, {}); !valid) return valid;
    const auto tips = find_tips(particles, model);
    if (!tips) return tips.error();
    particles::Starts starts(tissue, std::move(overstretched), *tips, length,
                             report.greatest_release);
    if (!particles::may_tear_now(body, length, options.metres_per_second)) return report;
    status = particles::tear_first(tissue, starts, model, pose, length, options.least_piece_area,
                                   report, records);
    if (status && report.has_torn) status = particles.follow(model, std::span(&records.back(), 1));
  } catch (const std::bad_alloc&) {
    status = Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
  if (!report.has_torn && records.size() > record_count) records.pop_back();
  if (!status) return status;
  return report;
}

}  // namespace sunder
