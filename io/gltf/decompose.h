#pragma once

#include <sunder/core/skeleton.h>

#include <optional>

namespace sunder::gltf {

/// A transform as T * R * S or, if it has shear, as the product of two of them: first * second.
struct Decomposition {
  BoneTransform first;
  std::optional<BoneTransform> second;
};

/// One transform if it reproduces the matrix within 1e-6 of its largest entry. Otherwise the
/// singular value decomposition U S V^T gives T * U * S and V^T, which is exact.
[[nodiscard]] Decomposition decompose(const Affine3d& matrix);

}  // namespace sunder::gltf
