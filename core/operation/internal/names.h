#pragma once

#include <sunder/operation/aimed_operation.h>

#include <array>
#include <cstddef>

namespace sunder {

// The words of logs and of the command for enumerators and kinds.

/// By enumerator, in its order.
template <class Enum>
inline constexpr std::array<const char*, 0> kNames{};
template <>
inline constexpr std::array kNames<Layers> = {"nearest", "all"};
template <>
inline constexpr std::array kNames<WeightPolicy> = [] {
  std::array<const char*, static_cast<std::size_t>(WeightPolicy::exact) + 1> names{};
  for (std::size_t i = 0; i < names.size(); ++i)
    names[i] = weight_policy_name(static_cast<WeightPolicy>(i));
  return names;
}();

template <class Enum>
constexpr const char* name_of(Enum value) {
  const auto i = static_cast<std::size_t>(value);
  return i < kNames<Enum>.size() ? kNames<Enum>[i] : "unknown";
}

template <class Enum>
constexpr Enum last_named() {
  return static_cast<Enum>(kNames<Enum>.size() - 1);
}

/// The `op` of an operation.
template <class Operation>
inline constexpr const char* kOpName = nullptr;
template <>
inline constexpr const char* kOpName<TearOperation> = "tear";
template <>
inline constexpr const char* kOpName<CutOperation> = "cut";
template <>
inline constexpr const char* kOpName<DrillOperation> = "drill";
template <>
inline constexpr const char* kOpName<DetachOperation> = "detach";
template <>
inline constexpr const char* kOpName<WeldOperation> = "weld";
template <>
inline constexpr const char* kOpName<SutureOperation> = "suture";
template <>
inline constexpr const char* kOpName<WeightsOperation> = "weights";
template <>
inline constexpr const char* kOpName<UndoOperation> = "undo";
template <>
inline constexpr const char* kOpName<RedoOperation> = "redo";
template <>
inline constexpr const char* kOpName<SlashOperation> = "slash";
template <>
inline constexpr const char* kOpName<SeverOperation> = "sever";
template <>
inline constexpr const char* kOpName<PunctureOperation> = "puncture";
template <>
inline constexpr const char* kOpName<IncisionOperation> = "incision";

/// A pose that is a word.
template <class Pose>
inline constexpr const char* kPoseName = nullptr;
template <>
inline constexpr const char* kPoseName<RestPose> = "rest";
template <>
inline constexpr const char* kPoseName<BindPose> = "bind";

}  // namespace sunder
