#pragma once

#include <sunder/tear/torn_model.h>

#include <memory>
#include <utility>

#include <gtest/gtest.h>

namespace sunder::test {

/// A model of a valid character.
inline TornModel make_model(Character character, const TornCapacity& capacity = {}) {
  auto model = TornModel::create(std::make_shared<const Character>(std::move(character)), capacity);
  EXPECT_TRUE(model) << model.error().text();
  return std::move(*model);
}

}  // namespace sunder::test
