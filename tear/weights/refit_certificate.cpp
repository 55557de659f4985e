#include "tear/weights/refit_certificate.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"

namespace sunder::tear {

RefitCertificate::RefitCertificate(const Character& character)
    : character_(character), bind_(or_throw(bind_pose(character))) {
  const auto limits = free_joint_limits(character, bind_);
  if (!limits) return;
  auto tree = JointTree::create(character.skeleton, bind_, *limits);
  if (tree) tree_ = std::move(*tree);
}

void RefitCertificate::add(const AnimationPoint& exact, std::span<const Influence> influences,
                           const Vec3d& position, std::uint32_t skin) {
  const Skin& of = character_.skins[skin];
  double sum = 0, exact_sum = 0;
  for (const Influence& influence : influences) sum += static_cast<double>(influence.weight);
  for (const AnimationPoint::Term& term : exact.terms()) exact_sum += term.q.w();
  const auto first = static_cast<std::ptrdiff_t>(rows_.terms.size());
  for (const AnimationPoint::Term& term : exact.terms()) {
    double weight = 0;
    for (const Influence& influence : influences)
      if (influence.slot == term.slot) weight = static_cast<double>(influence.weight) / sum;
    const Vec4d q = term.q / exact_sum;
    SkinTerm difference;
    difference.bone = of.bones[term.slot];
    difference.m = weight - q.w();
    const Affine3d model_from_bind = multiply(bind_.model_from_bone[difference.bone],
                                              of.bone_from_bind[term.slot].cast<double>());
    const Eigen::Vector3d in_bind = weight * position - q.head<3>();
    difference.x = multiply(model_from_bind.linear(), in_bind) +
                   difference.m * Eigen::Vector3d(model_from_bind.translation());
    rows_.terms.push_back(difference);
  }
  const auto terms = rows_.terms.begin() + first;
  std::sort(terms, rows_.terms.end(),
            [](const SkinTerm& a, const SkinTerm& b) { return a.bone < b.bone; });
  auto kept = terms;
  for (auto term = terms; term != rows_.terms.end(); ++term) {
    if (kept != terms && std::prev(kept)->bone == term->bone) {  // two slots of one bone
      std::prev(kept)->m += term->m;
      std::prev(kept)->x += term->x;
    } else {
      *kept++ = *term;
    }
  }
  rows_.terms.erase(kept, rows_.terms.end());
  rows_.first.push_back(static_cast<std::uint32_t>(rows_.terms.size()));
}

std::vector<double> RefitCertificate::take_bounds() {
  const SkinDifferences rows = std::exchange(rows_, {});
  std::vector<double> bounds(rows.first.size() - 1, std::numeric_limits<double>::infinity());
  if (!tree_) return bounds;
  auto certificate = certify_deviation(*tree_, rows);
  if (certificate.error().code() == StatusCode::limit_exceeded) throw std::bad_alloc();
  if (!certificate) return bounds;
  return std::move(certificate->bound);
}

}  // namespace sunder::tear
