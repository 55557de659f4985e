#pragma once

#include <sunder/animation/clip_player.h>
#include <sunder/core/status.h>
#include <sunder/scene/character_instance.h>

#include <utility>

#include <gtest/gtest.h>

namespace sunder {

/// Seconds. Sums of it are exact.
constexpr double kFrame = 1.0 / 64;

/// The value of a call that must not fail.
template <class T>
T value_of(Result<T> result) {
  EXPECT_TRUE(result) << result.error().text();
  return std::move(*result);
}

inline LayerOptions layer(double start, PlayMode mode = PlayMode::loop) {
  LayerOptions options;
  options.time = start;
  options.mode = mode;
  return options;
}

}  // namespace sunder
