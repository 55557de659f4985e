#include "pipeline/plan/settle_gape.h"

#include <sunder/particles/particle_set.h>
#include <sunder/particles/soft_body.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <vector>

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

/// A torn copy of soft tissue.
class SoftWound {
 public:
  SoftWound(TornModel& model, ParticleSet& set, SoftBody& body, const ModelPose& pose)
      : model_(model), set_(set), body_(body), pose_(pose) {}

  Status tear(const TearOperation& operation) {
    std::vector<ChangeRecord> changes;
    const Result<TearReport> torn = apply_operation(model_, operation, &changes);
    if (!torn) return torn.error();
    if (const Status status = set_.follow(model_, changes); !status) return status;
    while (set_.settle(model_, kSettledPoints)) continue;
    for (const ChangeRecord& change : changes)
      lips_.insert(lips_.end(), change.lips.begin(), change.lips.end());
    return {};
  }

  /// Pulls the lips until nothing moves any more. @return how wide they gape.
  Result<double> open(double tension) {
    if (const Status status = body_.set_tension({tension, {}}); !status) return status;
    Status status = body_.step(model_, pose_, kFirstStep);
    // Long steps end in the balance, which is all that counts here.
    for (int i = 0; i < kMostLongSteps && body_.awake_count() > 0 && status; ++i)
      status = body_.step(model_, pose_, kLongStep);
    if (!status) return status;
    double widest = 0;
    for (const LipPair& pair : lips_)
      widest = std::max(
          widest,
          (body_.point_displacement(pair.left) - body_.point_displacement(pair.right)).norm());
    return widest;
  }

 private:
  TornModel& model_;
  ParticleSet& set_;
  SoftBody& body_;
  const ModelPose& pose_;
  std::vector<LipPair> lips_;
};

}  // namespace

Result<PlannedGape> settle_gape(const std::shared_ptr<const Character>& character,
                                const TearOperation& tear, const ModelPose& pose, double length,
                                double gape, const SoftMaterial& material) {
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
  if (const Status status = wound.tear(plain); !status) return status;
  PlannedGape planned{*first, 0};
  for (int i = 0;; ++i) {
    const Result<double> widest = wound.open(planned.tension);
    if (!widest) return widest.error();
    planned.widest = *widest;
    const bool is_near = std::abs(planned.widest - gape) <= kNearGape * gape;
    if (is_near || i == kMostCorrections || !(planned.widest > 0)) return planned;
    planned.tension *= gape / planned.widest;
  }
}

}  // namespace sunder::plan
