// Fewer influences and fewer bits, with a certificate of what they change.

#include <sunder/certificate/certificate.h>
#include <sunder/weights/influences.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "weights/certificate/point_bound.h"
#include "weights/certificate/pose_search.h"
#include "weights/certificate/skin_rows.h"

namespace sunder {
namespace certificate {
namespace {

/// Weights for a vertex, and the certificate of their difference from the original.
struct Choice {
  double bound = std::numeric_limits<double>::infinity();
  std::uint8_t bits = 32;
  std::vector<Influence> influences;
};

template <class Integer>
void round_to(std::vector<Influence>& influences) {
  std::vector<Integer> units(influences.size());
  if (!quantise_weights(influences, std::span<Integer>(units))) return;
  for (std::size_t i = 0; i < units.size(); ++i)
    influences[i].weight =
        static_cast<float>(static_cast<double>(units[i]) / std::numeric_limits<Integer>::max());
  std::erase_if(influences, [](const Influence& influence) { return influence.weight == 0; });
}

class InfluenceChooser {
 public:
  InfluenceChooser(const Character& character, const ModelPose& bind, const JointTree::State& tree,
                   std::uint32_t mesh, const InfluenceBudget& budget)
      : mesh_(character.meshes[mesh]),
        skin_(character.skins[mesh_.skin]),
        bind_(bind),
        budget_(budget),
        tree_(tree),
        bits_(budget.bits),
        bound_of_(tree, 2 * most_influences(), kDividedSumTolerance) {
    std::sort(bits_.begin(), bits_.end());
  }

  [[nodiscard]] Choice choose(std::uint32_t vertex) {
    const auto original = mesh_.weights.of(vertex);
    std::size_t most = original.size();
    if (budget_.most_influences != 0) most = std::min<std::size_t>(most, budget_.most_influences);
    Choice best;
    handed_.clear();
    for (std::size_t kept = 1; kept <= most; ++kept)
      for (const std::uint32_t bits : bits_)
        for (const bool is_handed : {false, true}) {
          if (is_handed && kept == original.size()) continue;
          if (is_handed && handed_.empty()) hand_over(vertex);
          Choice choice = make(vertex, is_handed ? handed_[kept - 1] : largest(vertex, kept), bits);
          if (choice.bound <= budget_.maximum_error) return choice;
          if (best.influences.empty() || choice.bound < best.bound) best = std::move(choice);
        }
    return best;
  }

 private:
  [[nodiscard]] std::size_t most_influences() const {
    std::size_t most = 0;
    for (std::uint32_t vertex = 0; vertex < mesh_.vertex_count(); ++vertex)
      most = std::max(most, mesh_.weights.of(vertex).size());
    return most;
  }

  [[nodiscard]] std::vector<Influence> largest(std::uint32_t vertex, std::size_t kept) const {
    const auto original = mesh_.weights.of(vertex);
    std::vector<Influence> influences(original.begin(), original.end());
    influences.resize(prune_influences(influences, kept));
    return influences;
  }

  /// Fills handed_: one influence after another gives its weight to the one that moves most like
  /// it, each time the one of which the bound is the least.
  void hand_over(std::uint32_t vertex) {
    std::vector<Influence> influences = largest(vertex, mesh_.weights.of(vertex).size());
    handed_.assign(influences.size(), {});
    while (influences.size() > 1) {
      std::vector<Influence> best;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t given = 0; given < influences.size(); ++given) {
        std::vector<Influence> fewer = influences;
        fewer[most_alike(influences, given)].weight += influences[given].weight;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(given));
        const double bound = coarse_bound(vertex, fewer);
        if (!best.empty() && !(bound < least)) continue;
        least = bound;
        best = std::move(fewer);
      }
      influences = std::move(best);
      (void)sort_influences(influences);
      handed_[influences.size() - 1] = influences;
    }
  }

  /// The influence whose bone turns least against that of another one; of equal ones the first,
  /// which is the largest.
  [[nodiscard]] std::size_t most_alike(std::span<const Influence> influences,
                                       std::size_t other) const {
    const auto node = [&](std::size_t i) {
      return tree_.node_of_bone[skin_.bones[influences[i].slot]];
    };
    std::size_t best = other == 0 ? 1 : 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < influences.size(); ++i) {
      if (i == other) continue;
      const Way way = way_between(tree_, node(i), node(other));
      if (!(way.angle + way.strain < least)) continue;
      least = way.angle + way.strain;
      best = i;
    }
    return best;
  }

  [[nodiscard]] Choice make(std::uint32_t vertex, std::vector<Influence> influences,
                            std::uint32_t bits) {
    Choice choice;
    choice.bits = static_cast<std::uint8_t>(bits);
    choice.influences = std::move(influences);
    if (bits == 8) round_to<std::uint8_t>(choice.influences);
    if (bits == 16) round_to<std::uint16_t>(choice.influences);
    choice.bound = coarse_bound(vertex, choice.influences);
    if (choice.bound > budget_.maximum_error && std::isfinite(choice.bound) && may_be_refined())
      choice.bound = std::min(choice.bound, refined_bound(tree_, terms_));
    return choice;
  }

  /// The bound of the change to other influences, of which the terms stay in terms_.
  [[nodiscard]] double coarse_bound(std::uint32_t vertex, std::span<const Influence> influences) {
    const Vec3d position = mesh_.positions[vertex].cast<double>();
    terms_.clear();
    add_point(skin_, bind_, position, influences, 1.0, terms_);
    add_point(skin_, bind_, position, mesh_.weights.of(vertex), -1.0, terms_);
    merge_terms(terms_);
    return bound_of_.of(terms_);
  }

  /// Whether no pose was found that the budget forbids: else refining the bound is of no use.
  [[nodiscard]] bool may_be_refined() const {
    PoseSearch search(tree_, terms_, PoseSearch::Goal::longest);
    return search.improve() * search.growth() <= budget_.maximum_error;
  }

  const Mesh& mesh_;
  const Skin& skin_;
  const ModelPose& bind_;
  const InfluenceBudget& budget_;
  const JointTree::State& tree_;
  std::vector<std::uint32_t> bits_;  // ascending
  PointBound bound_of_;
  std::vector<SkinTerm> terms_;
  std::vector<std::vector<Influence>> handed_;  // by their number less one; the last one is empty
};

Status check_budget(const InfluenceBudget& budget) {
  if (!(budget.maximum_error >= 0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the maximum error is %g m; it must not be negative",
                           budget.maximum_error);
  if (budget.bits.empty())
    return Status::failure(StatusCode::invalid_argument, kNone, "no number of bits is allowed");
  for (const std::uint32_t bits : budget.bits)
    if (bits != 8 && bits != 16 && bits != 32)
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "weights of %u bits; 8, 16 and 32 exist", bits);
  return {};
}

Status check_vertices(const Character& character, const ModelPose& bind, const JointTree& tree,
                      std::uint32_t mesh) {
  if (tree.state().parents.size() != character.skeleton.bones.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the joint tree has %zu bones, the skeleton %zu",
                           tree.state().parents.size(), character.skeleton.bones.size());
  if (const Status status = check_mesh(character, bind, mesh); !status) return status;
  for (std::uint32_t vertex = 0; vertex < character.meshes[mesh].vertex_count(); ++vertex)
    if (const Status status = check_vertex(character, mesh, vertex); !status) return status;
  return {};
}

}  // namespace
}  // namespace certificate

Result<CertifiedInfluences> certified_influences(const Character& character, const ModelPose& bind,
                                                 const JointTree& tree, std::uint32_t mesh,
                                                 const InfluenceBudget& budget) {
  using namespace certificate;
  try {
    if (const Status status = check_budget(budget); !status) return status;
    if (const Status status = check_vertices(character, bind, tree, mesh); !status) return status;
    InfluenceChooser chooser(character, bind, tree.state(), mesh, budget);
    CertifiedInfluences result;
    for (std::uint32_t vertex = 0; vertex < character.meshes[mesh].vertex_count(); ++vertex) {
      const Choice choice = chooser.choose(vertex);
      result.weights.append(choice.influences);
      result.bits.push_back(choice.bits);
      result.bound.push_back(choice.bound);
      result.maximum = std::max(result.maximum, choice.bound);
      if (choice.bound > budget.maximum_error) ++result.above_maximum_error;
    }
    return result;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

}  // namespace sunder
