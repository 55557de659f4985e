#include "pipeline/plan/settle_gape.h"

#include <sunder/particles/particle_set.h>
#include <sunder/particles/soft_body.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "pipeline/plan/gape_profile.h"
#include "pipeline/plan/lip_shares.h"
#include "pipeline/plan/plan_setup.h"

namespace sunder::plan {
namespace {

/// Range of particles: share of the wound's length, within shares of the character's diagonal.
constexpr double kRangeOfWound = 0.125, kLeastRange = 0.01, kMostRange = 0.075;
constexpr double kFirstStep = 1.0 / 60, kLongStep = 0.1;  ///< Seconds.
constexpr int kMostLongSteps = 400;
constexpr int kMostCorrections = 4;
constexpr double kNearGape = 0.01;  ///< Share of the gape that is not corrected any more.
constexpr std::uint32_t kSettledPoints = 100'000;
constexpr int kMostProfiles = 8;       ///< That are tried.
constexpr double kNearProfile = 0.02;  ///< Share of the widest gape that is near enough.
constexpr double kMostCorrection = 2;  ///< Factor of what is aimed at, per trial.

/// A torn copy of soft tissue.
class SoftWound {
 public:
  SoftWound(TornModel& model, ParticleSet& set, SoftBody& body, const ModelPose& pose)
      : model_(model), set_(set), body_(body), pose_(pose) {}

  Status tear(const TearOperation& operation, const TargetPath& path) {
    std::vector<ChangeRecord> changes;
    const Result<TearReport> torn = apply_operation(model_, operation, &changes);
    if (!torn) return torn.error();
    if (const Status status = set_.follow(model_, changes); !status) return status;
    while (set_.settle(model_, kSettledPoints)) continue;
    for (const ChangeRecord& change : changes)
      lips_.insert(lips_.end(), change.lips.begin(), change.lips.end());
    Result<std::unordered_map<std::uint32_t, double>> shares =
        lip_shares(model_, changes, path, pose_);
    if (!shares) return shares.error();
    shares_ = std::move(*shares);
    return {};
  }

  /// Pulls the lips until nothing moves any more. @return how wide they gape.
  /// @param nodes  shares of the tension along the curve; empty: 1.
  Result<double> open(double tension, std::span<const double> nodes = {}) {
    Tension wanted;
    wanted.newtons_per_metre = tension;
    if (!nodes.empty()) wanted.shares = shares_of_points(shares_, nodes);
    if (const Status status = body_.set_tension(std::move(wanted)); !status) return status;
    Status status = body_.step(model_, pose_, kFirstStep);
    // Long steps end in the balance, which is all that counts here.
    for (int i = 0; i < kMostLongSteps && body_.awake_count() > 0 && status; ++i)
      status = body_.step(model_, pose_, kLongStep);
    if (!status) return status;
    double widest = 0;
    for (const LipPair& pair : lips_) widest = std::max(widest, gape_of(pair));
    return widest;
  }

  /// How wide lips gape at the nodes of a profile.
  [[nodiscard]] std::vector<double> profile() const {
    std::vector<ProfileSample> samples;
    for (const LipPair& pair : lips_)
      if (const auto found = shares_.find(pair.left); found != shares_.end())
        samples.push_back({found->second, gape_of(pair)});
    return profile_of(samples);
  }

 private:
  [[nodiscard]] double gape_of(const LipPair& pair) const {
    return (body_.point_displacement(pair.left) - body_.point_displacement(pair.right)).norm();
  }

  TornModel& model_;
  ParticleSet& set_;
  SoftBody& body_;
  const ModelPose& pose_;
  std::vector<LipPair> lips_;
  std::unordered_map<std::uint32_t, double> shares_;  ///< Of the curve, per point of lips.
};

/// The tension that gapes as wide as wanted where it is widest.
Result<PlannedGape> settle_widest(SoftWound& wound, double tension, double gape) {
  PlannedGape planned;
  planned.tension = tension;
  for (int i = 0;; ++i) {
    const Result<double> widest = wound.open(planned.tension);
    if (!widest) return widest.error();
    planned.widest = *widest;
    const bool is_near = std::abs(planned.widest - gape) <= kNearGape * gape;
    if (is_near || i == kMostCorrections || !(planned.widest > 0)) return planned;
    planned.tension *= gape / planned.widest;
  }
}

/// The tensions that gape as wide as wanted all along: those of a flat sheet for what is aimed at,
/// which is corrected by what the copy does.
/// @param even  the tension of a flat sheet for the widest gape.
Result<PlannedGape> settle_profile(SoftWound& wound, double even, const TargetPath& path) {
  std::vector<double> wanted;
  for (int i = 0; i <= kGapeSteps; ++i)
    wanted.push_back(path.gape_at(static_cast<double>(i) / kGapeSteps));
  const double gape = *std::max_element(wanted.begin(), wanted.end());
  std::vector<double> aim;
  for (const double of : wanted) aim.push_back(of / gape);
  PlannedGape best;
  for (int trial = 0; trial < kMostProfiles; ++trial) {
    PlannedGape planned;
    planned.wanted_along = wanted;
    planned.tension_shares = flat_tension(aim);
    const double most =
        *std::max_element(planned.tension_shares.begin(), planned.tension_shares.end());
    planned.tension = even * most;
    for (double& share : planned.tension_shares) share /= std::max(most, 1e-12);
    const Result<double> widest = wound.open(planned.tension, planned.tension_shares);
    if (!widest) return widest.error();
    planned.widest = *widest;
    planned.gape_along = wound.profile();
    for (std::size_t i = 0; i < wanted.size(); ++i)
      planned.most_error =
          std::max(planned.most_error, std::abs(planned.gape_along[i] - wanted[i]));
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (planned.gape_along[i] > 0)
        aim[i] *=
            std::clamp(wanted[i] / planned.gape_along[i], 1 / kMostCorrection, kMostCorrection);
    const bool is_better = trial == 0 || planned.most_error < best.most_error;
    if (is_better) best = std::move(planned);
    if (best.most_error <= kNearProfile * gape) break;
  }
  return best;
}

}  // namespace

Result<PlannedGape> settle_gape(const std::shared_ptr<const Character>& character,
                                const TearOperation& tear, const ModelPose& pose,
                                const TargetPath& path, const SoftMaterial& material) {
  const double length = path.length(), gape = path.widest_gape();
  const Result<double> first = tension_for_gap(material, length, gape);
  if (!first) return first.error();
  Result<TornModel> model = TornModel::create(character);
  if (!model) return model.error();
  const double diagonal = diagonal_of(*character, pose);
  DecompositionOptions options;
  options.is_fraction = false;
  options.range = std::clamp(kRangeOfWound * length, kLeastRange * diagonal, kMostRange * diagonal);
  Result<ParticleSet> set = ParticleSet::create(*model, pose, options);
  if (!set) return set.error();
  Result<SoftBody> body = SoftBody::create(*set, pose, {&material, 1});
  if (!body) return body.error();
  SoftWound wound(*model, *set, *body, pose);
  TearOperation plain = tear;
  plain.options.width = plain.options.wall_depth = 0;
  if (const Status status = wound.tear(plain, path); !status) return status;
  return path.has_gape_profile() ? settle_profile(wound, *first, path)
                                 : settle_widest(wound, *first, gape);
}

}  // namespace sunder::plan
