#pragma once

#include <cstdint>

namespace sunder::bench {

/// Where cuts with caps and bores with a wall run.
enum class LoopMode {
  in_frame,       ///< In the update that takes them.
  in_background,  ///< On another thread; half a second later they are swapped in.
};

/// Twenty seconds at 90 Hz of one soft character that plays a clip: a stroke over 40 frames, a gap,
/// a cut with caps that takes off a part, a bore with a wall, and undo of the bore and of the cut.
/// Milliseconds of processor time of the thread that updates.
struct LoopTimes {
  std::uint32_t vertices = 0;  ///< Of the source.
  double untorn = 0;           ///< Median frame before any tear, with all vertices posed.
  double displaced = 0;        ///< The same while every vertex is displaced by tissue.
  double stroke = 0;           ///< Median frame of the stroke.
  double gaping = 0;           ///< Median frame while lips open.
  double gap = 0, undo = 0;    ///< The frames of these operations.
  double cut = 0, drill = 0;   ///< The worst frame until they have taken effect.
  double worst = 0;            ///< Worst frame.
};

/// Prints what the slowest frames of each operation and of the time after it are made of.
void print_loop_stages(std::uint32_t vertices, LoopMode mode, int repeats);

/// @param repeats  the loop runs so many times; the least time counts for each frame.
[[nodiscard]] LoopTimes time_loop(std::uint32_t vertices, LoopMode mode, int repeats);

}  // namespace sunder::bench
