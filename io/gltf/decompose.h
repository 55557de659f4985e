#pragma once

#include <sunder/core/skeleton.h>

#include <optional>

namespace sunder::gltf {

/// A transform as T * R * S, or, where it has shear, as two of them: first * second.
struct Decomposition {
  BoneTransform first;
  std::optional<BoneTransform> second;
};

/// One transform where that reproduces the matrix within 1e-6 of its largest number; else its
/// singular value decomposition U S V^T, as T * U * S and V^T, which loses nothing.
[[nodiscard]] Decomposition decompose(const Affine3d& matrix);

}  // namespace sunder::gltf
