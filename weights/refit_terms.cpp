#include "weights/internal/refit_terms.h"

#include <algorithm>

#include "core/internal/ordered.h"

namespace sunder::weights {
namespace {

/// Smaller weights are not stored.
constexpr double kLeastWeight = 1e-5;

}  // namespace

void centre_terms(const AnimationPoint& point, const PoseMoments& moments,
                  std::vector<AnimationPoint::Term>& terms) {
  terms.assign(point.terms().begin(), point.terms().end());
  double sum = 0;
  for (const auto& term : terms) sum += term.q.w();
  for (auto& term : terms) {
    term.q /= sum;
    term.q.head<3>() -= term.q.w() * moments.centre();
  }
}

Restraint restraint_of(std::span<const AnimationPoint::Term> terms, const Eigen::Vector3d& position,
                       const PoseMoments& moments, std::size_t group) {
  double scale_square = 0, spread_square = 0;
  for (const auto& term : terms) {
    if (!(term.q.w() > 0)) continue;
    scale_square +=
        term.q.w() * trace(moments.of(term.slot, term.slot, group).topLeftCorner<3, 3>()) / 3;
    spread_square +=
        squared_norm(Eigen::Vector3d(term.q.head<3>()) - term.q.w() * position) / term.q.w();
  }
  scale_square /= static_cast<double>(std::max<std::size_t>(moments.pose_count(group), 1));
  return {kStiffness * scale_square, kInertia * scale_square * spread_square};
}

void weights_of_terms(std::span<const AnimationPoint::Term> terms,
                      std::span<const Influence> influences, std::vector<double>& of_terms) {
  of_terms.assign(terms.size(), 0.0);
  double sum = 0;
  for (const Influence& influence : influences) sum += static_cast<double>(influence.weight);
  for (const Influence& influence : influences)
    for (std::size_t i = 0; i < terms.size(); ++i)
      if (terms[i].slot == influence.slot)
        of_terms[i] = static_cast<double>(influence.weight) / sum;
}

void store_weights(std::span<const AnimationPoint::Term> terms, std::span<const double> of_terms,
                   std::vector<Influence>& influences) {
  influences.clear();
  double sum = 0;
  for (const double weight : of_terms) sum += weight >= kLeastWeight ? weight : 0.0;
  for (std::size_t i = 0; i < terms.size(); ++i)
    if (of_terms[i] >= kLeastWeight)
      influences.push_back({terms[i].slot, static_cast<float>(of_terms[i] / sum)});
  std::sort(influences.begin(), influences.end(), [](const Influence& a, const Influence& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.slot < b.slot;
  });
}

void differences(std::span<const AnimationPoint::Term> terms, std::span<const double> of_terms,
                 const Eigen::Vector3d& position, std::vector<AnimationPoint::Term>& difference) {
  difference.resize(terms.size());
  for (std::size_t i = 0; i < terms.size(); ++i) {
    difference[i].slot = terms[i].slot;
    difference[i].q = -terms[i].q;
    difference[i].q.head<3>() += of_terms[i] * position;
    difference[i].q.w() += of_terms[i];
  }
}

bool exceeds_bounds(const PointToRefit& point, const PoseMoments& moments,
                    std::span<const AnimationPoint::Term> difference, std::vector<double>& excess) {
  const std::size_t shared = point.allowed.size(), own = point.own_poses != nullptr ? 1 : 0;
  excess.resize(shared + own);
  moments.mean_squares(difference, std::span(excess).first(shared));
  for (std::size_t i = 0; i < shared; ++i) excess[i] /= point.allowed[i];
  if (own != 0) excess[shared] = point.own_poses->mean_square(difference) / point.own_allowed;
  return std::any_of(excess.begin(), excess.end(), [](double share) { return !(share <= 1); });
}

}  // namespace sunder::weights
