#include "io/fbx/evaluate.h"

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace sunder::fbx {
namespace {

/// The axes of each rotation order, the one that turns first first.
constexpr std::array<std::array<int, 3>, 6> kAxes = {
    {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}}};

Quatd turn(const Vec3d& degrees, int order) {
  Quatd result = Quatd::Identity();
  for (const int axis : kAxes[static_cast<std::size_t>(order)])
    result = Quatd(Eigen::AngleAxisd(degrees[axis] * std::numbers::pi / 180.0, Vec3d::Unit(axis))) *
             result;
  return result;
}

/// The three angles of a rotation, in degrees, for an order.
Vec3d angles_of(const Quatd& rotation, int order) {
  const auto& axes = kAxes[static_cast<std::size_t>(order)];
  const Vec3d reversed = rotation.toRotationMatrix().eulerAngles(axes[2], axes[1], axes[0]);
  Vec3d degrees;
  for (int i = 0; i < 3; ++i)
    degrees[axes[static_cast<std::size_t>(2 - i)]] = reversed[i] * 180.0 / std::numbers::pi;
  return degrees;
}

Vec3d value_of(const CurveNode& node, const Vec3d& rest, double ticks) {
  Vec3d value = rest;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (node.curves[axis])
      value[static_cast<int>(axis)] = node.curves[axis]->at(ticks);
    else if (node.constants[axis])
      value[static_cast<int>(axis)] = *node.constants[axis];
  }
  return value;
}

/// The value of a property with one more layer on it. The lowest layer replaces the rest.
Vec3d blended(const Layer& layer, const CurveNode& node, bool is_lowest, const Vec3d& below,
              const Vec3d& value, int order) {
  const double weight = layer.weight;
  if (is_lowest || (layer.replaces && weight == 1.0)) return value;
  if (layer.replaces) {
    if (node.animated != Animated::rotation || layer.adds_angles)
      return below + weight * (value - below);
    return angles_of(turn(below, order).slerp(weight, turn(value, order)), order);
  }
  if (node.animated == Animated::scaling && !layer.adds_scales)
    return below.array() * value.array().sign() * value.array().abs().pow(weight);
  if (node.animated != Animated::rotation || layer.adds_angles) return below + weight * value;
  return angles_of(turn(below, order) * Quatd::Identity().slerp(weight, turn(value, order)), order);
}

Local local_of(const Stack& stack) {
  Local local;
  local.rotation = (turn(stack.pre_rotation, 0) * turn(stack.rotation, stack.rotation_order) *
                    turn(stack.post_rotation, 0).conjugate())
                       .toRotationMatrix();
  local.scale = stack.scaling;
  // The stack applied to the origin, from the right.
  const Vec3d scaled = -stack.scaling.cwiseProduct(stack.scaling_pivot) + stack.scaling_pivot +
                       stack.scaling_offset - stack.rotation_pivot;
  local.translation =
      local.rotation * scaled + stack.rotation_pivot + stack.rotation_offset + stack.translation;
  return local;
}

}  // namespace

Evaluator::Evaluator(const Scene& scene, const Take* take)
    : scene_(scene), nodes_of_(scene.models.size()), is_below_scale_(scene.models.size()) {
  if (take != nullptr && !take->layers.empty()) {
    lowest_ = &take->layers.front();
    for (const Layer& layer : take->layers)
      for (const CurveNode& node : layer.nodes) nodes_of_[node.model].push_back({&layer, &node});
  }
  for (std::uint32_t model = 0; model < scene.models.size(); ++model) {
    const std::uint32_t parent = scene.models[model].parent;
    is_below_scale_[model] = parent != kNone && (is_below_scale_[parent] || is_scaled(parent));
  }
}

bool Evaluator::is_scaled(std::uint32_t model) const {
  if (!scene_.models[model].rest.scaling.isOnes(1e-6)) return true;
  for (const Driven& driven : nodes_of_[model]) {
    if (driven.node->animated != Animated::scaling) continue;
    for (const auto& curve : driven.node->curves)
      if (curve && !curve->stays_at(1.0)) return true;
    for (const auto& constant : driven.node->constants)
      if (constant && std::abs(*constant - 1.0) > 1e-6) return true;
  }
  return false;
}

void Evaluator::append_times(std::uint32_t model, std::vector<double>& ticks) const {
  for (const Driven& driven : nodes_of_[model])
    for (const auto& curve : driven.node->curves)
      if (curve) curve->append_times(ticks);
}

Stack Evaluator::stack_at(std::uint32_t model, double ticks) const {
  Stack stack = scene_.models[model].rest;
  for (const Driven& driven : nodes_of_[model]) {
    const Animated animated = driven.node->animated;
    Vec3d& value = animated == Animated::translation ? stack.translation
                   : animated == Animated::rotation  ? stack.rotation
                                                     : stack.scaling;
    // Where a layer adds, a component without a curve adds nothing.
    const Vec3d neutral = animated == Animated::scaling && !driven.layer->adds_scales
                              ? Vec3d(Vec3d::Ones())
                              : Vec3d(Vec3d::Zero());
    const bool is_lowest = driven.layer == lowest_;
    const bool adds = !is_lowest && !driven.layer->replaces;
    value = blended(*driven.layer, *driven.node, is_lowest, value,
                    value_of(*driven.node, adds ? neutral : value, ticks), stack.rotation_order);
  }
  return stack;
}

Local Evaluator::local(std::uint32_t model, double ticks) const {
  return local_of(stack_at(model, ticks));
}

Global Evaluator::global(std::uint32_t model, double ticks) const {
  std::vector<std::uint32_t> path;
  for (std::uint32_t i = model; i != kNone; i = scene_.models[i].parent) path.push_back(i);
  Global global;
  Vec3d parent_scale = Vec3d::Ones();
  for (std::size_t i = path.size(); i-- > 0;) {
    const Local here = local(path[i], ticks);
    global.translation += global.rotation * (global.shape * here.translation);
    const Mat3d scale = here.scale.asDiagonal();
    switch (scene_.models[path[i]].rest.inherit) {
      case Inherit::scale_by_axes: global.shape = global.shape * scale; break;
      case Inherit::all:
        global.shape = here.rotation.transpose() * global.shape * here.rotation * scale;
        break;
      case Inherit::no_scale:
        global.shape = global.shape * Mat3d(parent_scale.cwiseInverse().asDiagonal()) * scale;
        break;
    }
    global.rotation = global.rotation * here.rotation;
    parent_scale = here.scale;
  }
  return global;
}

}  // namespace sunder::fbx
