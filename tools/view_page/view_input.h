#pragma once

#include <sunder/core/character.h>

#include <string>

#include "io/internal/base_colours.h"

namespace sunder::tools {

/// A model as the page of `sunder view` shows it.
struct ViewedModel {
  const Character* character = nullptr;  ///< Satisfies validate_character().
  std::string title;                     ///< File name, as a reader knows the model.
  BaseColours colours;                   ///< Of the file's materials.
};

/// The content of the page of `sunder view`.
struct ViewInput {
  ViewedModel model;
  ViewedModel torn;        ///< Without a character: there is none.
  std::string operations;  ///< An operation log that io reads, or empty.
};

}  // namespace sunder::tools
