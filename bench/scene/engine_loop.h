#pragma once

#include <cstdint>
#include <vector>

#include "bench/scene/engine_instance.h"

namespace sunder::bench {

/// Twenty seconds at 90 Hz of an EngineInstance that plays a clip: a stroke over 40 frames with
/// walls, a gap of 16 cm with walls, a cut with caps, the part that it severs detached, a bore with
/// a wall and undo of it, a refit, tissue that moves everywhere, and a snapshot.
struct EngineRun {
  std::uint32_t vertices = 0;  ///< Of the source.
  std::vector<EngineFrame> frames;
  EngineInstance::SnapshotTimes snapshot;
  std::uint64_t wrong_elements = 0;  ///< Of the engine's buffers; checked in the first frame after
                                     ///< each event, and at the end.
};

/// @param divisions  of make_engine_model(): 2 and 8 for 13 and 214 thousand vertices.
/// @param in_background  whether the cut, the detachment and the bore run in the background, as
/// docs/frame.md
///                       advises. The refit always does.
/// @param repeats  the loop runs so many times; the least time counts for each frame.
[[nodiscard]] EngineRun run_engine(int divisions, bool in_background, int repeats);

/// Median and worst time of all frames but the first, microseconds.
struct EngineFigures {
  double median = 0, worst = 0;
};
[[nodiscard]] EngineFigures figures_of(const EngineRun& run);

/// Prints a row per phase and event.
void print_engine_table(const EngineRun& run);

}  // namespace sunder::bench
