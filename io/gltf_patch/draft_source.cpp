#include "io/gltf_patch/draft_source.h"

#include <limits>
#include <utility>

namespace sunder::gltf {

DraftSource::DraftSource(GlbDraft& draft) : draft_(draft) {
  document_.json = std::move(draft.json);
  document_.buffers.assign(count_of(document_.json, "buffers"), draft.bytes());
  document_.maximum_bytes = std::numeric_limits<std::uint64_t>::max();
  document_.maximum_memory = document_.maximum_bytes;
}

DraftSource::~DraftSource() { draft_.json = std::move(document_.json); }

}  // namespace sunder::gltf
