#pragma once

#include "io/gltf/glb.h"

namespace sunder::gltf {

/// During its lifetime, a draft as a source document, so that its accessors can be read. The draft
/// itself must not be used meanwhile.
class DraftSource {
 public:
  explicit DraftSource(GlbDraft& draft);
  ~DraftSource();
  DraftSource(const DraftSource&) = delete;
  DraftSource& operator=(const DraftSource&) = delete;

  [[nodiscard]] SourceDocument& document() { return document_; }
  [[nodiscard]] Json& json() { return document_.json; }

 private:
  GlbDraft& draft_;
  SourceDocument document_;
};

}  // namespace sunder::gltf
