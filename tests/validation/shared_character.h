#pragma once

#include <sunder/core/character.h>

#include <memory>
#include <utility>

namespace sunder::test {

using Shared = std::shared_ptr<const Character>;

inline Shared share(Character character) {
  return std::make_shared<const Character>(std::move(character));
}

}  // namespace sunder::test
