#pragma once

#include "io/gltf/accessors.h"
#include "io/gltf/source_document.h"
#include "io/gltf_read/notes.h"

namespace sunder::gltf {

/// State shared by all parts of the reader: the document, its numbers, and the load report.
struct Reading {
  const SourceDocument& document;
  AccessorReader accessors;
  Notes notes;
  bool keep_stored_influences = false;

  [[nodiscard]] const Json& json() const { return document.json; }
};

}  // namespace sunder::gltf
