#include "io/gltf_patch/draft_source.h"

#include <limits>
#include <utility>

namespace sunder::gltf {

DraftSource::DraftSource(GlbDraft& draft) : draft_(draft) {
  document_.json = std::move(draft.json);
  document_.buffers.assign(count_of(document_.json, "buffers"), draft.bytes());
  document_.maximum_bytes = std::numeric_limits<std::uint64_t>::max();
  // Each number is decoded a few times, to at most four times its size. More than this much is
  // decoded only if many accessors lie on the same bytes.
  constexpr std::uint64_t kSmallest = std::uint64_t{1} << 30, kTimes = 64;
  document_.maximum_memory = kSmallest + kTimes * draft.bytes().size();
}

DraftSource::~DraftSource() { draft_.json = std::move(document_.json); }

}  // namespace sunder::gltf
