#pragma once

#include "tear/weld/find_lips.h"

namespace sunder::tear {

/// Two lips, by their indices, that run in opposite directions over the same places. Where another
/// wound crosses one of them, a lip may lie on parts of several.
struct LipOverlap {
  Index a = kNone, b = kNone;
  bool is_whole = false;  ///< Whether they have the same ends.
};

/// The overlaps of lips, ascending; a < b.
[[nodiscard]] ScratchVector<LipOverlap> find_overlaps(std::span<const Lip> lips,
                                                      ScratchMemory& scratch);

/// The share of a lip at which a place on its line lies.
[[nodiscard]] double share_of(const std::array<double, 2>& place, const Lip& lip);

/// The shares of a lip at which places of another one lie strictly between its ends, descending
/// from `shares` on.
void add_shares_between(const Lip& lip, const Lip& other, ScratchVector<double>& shares);

}  // namespace sunder::tear
