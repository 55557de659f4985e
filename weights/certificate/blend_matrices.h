#pragma once

#include <sunder/certificate/certificate.h>

#include <span>
#include <vector>

#include "weights/certificate/joint_tree.h"

namespace sunder::certificate {

/// The matrices at bind of a point's terms; empty if all are the identity.
[[nodiscard]] std::span<const Mat3d> at_bind_of(const SkinBlends& blends, std::size_t point);

/// Per term, its matrix at bind times the inverse of the blended matrix at bind. Empty if all are
/// the identity. @return false if a matrix cannot be inverted or mirrors the blended one.
[[nodiscard]] bool relative_to_bind(std::span<const SkinTerm> terms, std::span<const Mat3d> at_bind,
                                    std::vector<Mat3d>& relative);

/// The rows are valid, and there is no matrix or one per term, all finite.
[[nodiscard]] Status check_blends(const JointTree::State& tree, const SkinBlends& blends);

}  // namespace sunder::certificate
