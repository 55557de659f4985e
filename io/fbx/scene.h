#pragma once

#include <sunder/core/index.h>
#include <sunder/core/math.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/fbx/curve.h"

namespace sunder::fbx {

enum class Inherit : std::uint8_t {
  scale_by_axes,  ///< R r S s: the parent's scale along the node's own axes.
  all,            ///< R S r s: the product of the matrices.
  no_scale,       ///< R r s: without the parent's own scale.
};

/// The place of a node in its parent: T Roff Rp Rpre R Rpost⁻¹ Rp⁻¹ Soff Sp S Sp⁻¹.
struct Stack {
  Vec3d translation = Vec3d::Zero(), rotation = Vec3d::Zero(), scaling = Vec3d::Ones();
  Vec3d pre_rotation = Vec3d::Zero(), post_rotation = Vec3d::Zero();  ///< Degrees.
  Vec3d rotation_offset = Vec3d::Zero(), rotation_pivot = Vec3d::Zero();
  Vec3d scaling_offset = Vec3d::Zero(), scaling_pivot = Vec3d::Zero();
  int rotation_order = 0;  ///< 0 … 5: xyz, xzy, yzx, yxz, zxy, zyx; x of xyz turns first.
  Inherit inherit = Inherit::scale_by_axes;
};

struct Model {
  std::string name;
  Stack rest;
  std::uint32_t parent = kNone;         ///< Smaller than the model's own index.
  std::vector<std::uint32_t> children;  ///< In the order of the file's connections.
};

enum class Animated : std::uint8_t { translation, rotation, scaling };

/// The curves of one property of a model, in one layer.
struct CurveNode {
  std::uint32_t model = kNone;
  Animated animated = Animated::translation;
  std::array<std::optional<Curve>, 3> curves;
  std::array<std::optional<double>, 3> constants;  ///< Where a component has no curve.
};

struct Layer {
  double weight = 1.0;
  bool replaces = false;     ///< Otherwise it adds to the layers below.
  bool adds_angles = false;  ///< Of the rotation; otherwise rotations are multiplied.
  bool adds_scales = false;  ///< Of the scaling; otherwise scales are multiplied.
  std::vector<CurveNode> nodes;
};

struct Take {
  std::string name;
  double start = 0.0, stop = 0.0;  ///< Ticks. Both 0 if the file gives no span.
  std::vector<Layer> layers;       ///< The first one is the lowest.
};

/// The models of a file, parents first, and its animations.
struct Scene {
  std::vector<Model> models;
  std::vector<std::uint32_t> roots;  ///< In the order of the file's connections.
  std::vector<Take> takes;           ///< In the order of the file.
};

/// @throws std::runtime_error: models nested too deep, or too many.
[[nodiscard]] Scene read_scene(const Record& document);

}  // namespace sunder::fbx
