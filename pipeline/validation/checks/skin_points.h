#pragma once

#include <sunder/certificate/certificate.h>

#include <span>
#include <vector>

#include "pipeline/validation/checks/weight_rows.h"
#include "pipeline/validation/match/skin_terms.h"

namespace sunder::validation {

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
  [[nodiscard]] const DrivenSkins& skins() const { return skins_; }
  [[nodiscard]] const ModelPose& bind() const { return skins_.bind; }

 private:
  const RowReader& reader_;
  DrivenSkins skins_;
};

inline std::span<const SkinTerm> terms_of(const SkinDifferences& points, std::size_t index) {
  return {points.terms.data() + points.first[index], points.first[index + 1] - points.first[index]};
}

}  // namespace sunder::validation
