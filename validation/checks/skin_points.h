#pragma once

#include <sunder/skinning/pose.h>
#include <sunder/certificate/certificate.h>

#include <algorithm>
#include <span>
#include <vector>

#include "core/internal/ordered.h"
#include "validation/checks/weight_rows.h"

namespace sunder::validation {

/// Sums terms of one skinned point by bone, without a search.
class TermSum {
 public:
  explicit TermSum(std::size_t bone_count) : sums_(bone_count, Vec4d::Zero()) {}

  void add(Index bone, double m, const Vec3d& x) {
    if (std::find(used_.begin(), used_.end(), bone) == used_.end()) used_.push_back(bone);
    sums_[bone].head<3>() += x;
    sums_[bone][3] += m;
  }
  /// Appends what is not zero and starts over.
  void finish(SkinDifferences& points);

 private:
  std::vector<Vec4d> sums_;
  std::vector<Index> used_;
};

/// Skinned points of both models in terms of the source's skeleton.
class SkinPoints {
 public:
  explicit SkinPoints(const RowReader& reader);

  /// Adds a vertex of the target.
  void add_target(Index mesh, Index vertex, double part, TermSum& sum) const;
  /// The same with other influences.
  void add_influences(Index mesh, Index vertex, std::span<const Influence> influences, double part,
                      TermSum& sum) const;
  /// Adds the point that the target's vertex ought to be: at its own place, with the weights of the
  /// place of the source that it was matched to.
  void add_expected(Index mesh, Index vertex, double part, TermSum& sum) const;
  [[nodiscard]] TermSum make_sum() const { return TermSum(reader_.source_bone_count()); }
  [[nodiscard]] const ModelPose& bind() const { return bind_; }

 private:
  struct Slot {
    Index bone = 0;
    Affine3d model_from_bind;
  };
  const RowReader& reader_;
  ModelPose bind_;
  std::vector<std::vector<Slot>> of_source_, of_target_;
};

/// A skinned point in a pose.
inline Vec3d posed(std::span<const SkinTerm> terms, const std::vector<Affine3d>& model_from_bind) {
  Vec3d sum = Vec3d::Zero();
  for (const SkinTerm& term : terms) {
    const auto& m = model_from_bind[term.bone].matrix();
    for (int row = 0; row < 3; ++row)
      sum[row] += m(row, 0) * term.x[0] + m(row, 1) * term.x[1] + m(row, 2) * term.x[2] +
                  m(row, 3) * term.m;
  }
  return sum;
}

inline std::span<const SkinTerm> terms_of(const SkinDifferences& points, std::size_t index) {
  return {points.terms.data() + points.first[index], points.first[index + 1] - points.first[index]};
}

}  // namespace sunder::validation
