#pragma once

#include "io/gltf/accessors.h"
#include "io/gltf/notes.h"
#include "io/gltf/source_document.h"

namespace sunder::gltf {

/// What every part of the reader needs: the document, its numbers, and where to note what happened to them.
struct Reading {
  const SourceDocument& document;
  AccessorReader accessors;
  Notes notes;

  [[nodiscard]] const Json& json() const { return document.json; }
};

}  // namespace sunder::gltf
