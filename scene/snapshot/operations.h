#pragma once

#include <sunder/operation/operation.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <type_traits>
#include <vector>

#include "core/operation/internal/describe_operations.h"
#include "core/operation/internal/names.h"
#include "scene/snapshot/pose_memory.h"

namespace sunder::scene {

// The described members of everything that an operation consists of, in their order in memory.

template <>
inline constexpr WeightPolicy kLastEnumerator<WeightPolicy> = last_named<WeightPolicy>();
template <>
inline constexpr Layers kLastEnumerator<Layers> = last_named<Layers>();

/// Calls visit(member) for each member that a struct's description names.
template <class Visit>
struct MemberVisitor {
  const Visit& visit;

  void operator()(const Field&, auto& member, const auto&...) const { visit(member); }
  template <class PoseChanges>
  void operator()(const Field&, auto& stroke, const Blades<PoseChanges>& kind) const {
    visit(stroke);
    visit(*kind.pose_changes);
  }
  void object(const Field&, const auto& body) const { body(*this); }
};

template <class T, class Visit>
void for_each_member(T& of, const Visit& visit) {
  const MemberVisitor<Visit> visitor{visit};
  describe(visitor, of);
}

/// The members of a struct in the order of their addresses, as indices into its description.
template <class T>
const std::vector<std::size_t>& order_of_members() {
  static const std::vector<std::size_t> order = [] {
    const T of{};
    std::vector<const void*> places;
    for_each_member(of, [&](const auto& member) { places.push_back(&member); });
    std::vector<std::size_t> indices(places.size());
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    std::sort(indices.begin(), indices.end(),
              [&](std::size_t a, std::size_t b) { return std::less<>()(places[a], places[b]); });
    return indices;
  }();
  return order;
}

template <class Archive, Described T>
void transfer(Archive& archive, T& of) {
  for (const std::size_t next : order_of_members<T>()) {
    std::size_t index = 0;
    for_each_member(of, [&](auto& member) {
      if (index++ == next) archive(member);
    });
  }
}

template <class Archive>
void transfer(Archive&, RestPose&) {}
template <class Archive>
void transfer(Archive&, BindPose&) {}
template <class Archive>
void transfer(Archive& archive, BonesPose::Bone& of) {
  auto& [name, translation, rotation, scale] = of;
  archive(name, translation, rotation, scale);
}
template <class Archive>
void transfer(Archive& archive, BonesPose& of) {
  archive(of.bones);
}
template <class Archive>
void transfer(Archive& archive, ModelPose& of) {
  archive.poses->transfer_pose(archive, of);
}
template <class Archive>
void transfer(Archive& archive, TearOperation::PoseChange& of) {
  auto& [blade, pose] = of;
  archive(blade, pose);
}

}  // namespace sunder::scene
