#pragma once

#include <cstdint>

namespace sunder {

/// Figures of an update of a Scene: the work that was done, and the work that was left out and why.
struct FrameStats {
  std::uint64_t frame = 0;      ///< Number of the update, from 1.
  std::uint32_t instances = 0;  ///< All that exist.

  // ---- Done: numbers of instances.
  std::uint32_t sampled = 0;   ///< Clips were sampled.
  std::uint32_t advanced = 0;  ///< The pose was set, or tissue stepped.
  std::uint32_t drawn = 0;     ///< Vertices were posed.
  std::uint64_t vertices = 0;  ///< Vertices that were posed.
  std::uint32_t commands = 0;  ///< Commands that were applied, with or without success.
  std::uint32_t failed = 0;    ///< Those that failed.

  // ---- Optional work that was done, in the units of FrameBudget.
  std::uint32_t settled_points = 0;  ///< At most: an instance may have needed fewer.
  std::uint32_t model_work = 0;

  // ---- Left out: numbers of instances.
  std::uint32_t idle = 0;           ///< Nothing plays, moves or was asked for: not even looked at.
  std::uint32_t unseen = 0;         ///< Active, but not visible: neither sampled nor drawn.
  std::uint32_t waiting = 0;        ///< Updated at a lower rate, and not in this frame.
  std::uint32_t in_background = 0;  ///< Commands that run on another thread.
  std::uint32_t unchanged = 0;      ///< Looked at, but nothing had changed.
  std::uint32_t unsettled = 0;      ///< Lips whose particles are not all separated yet.

  // ---- Time in microseconds, summed over all threads; `total` is that of the call.
  double total = 0, animation = 0, operations = 0, settling = 0, tissue = 0, drawing = 0;
};

}  // namespace sunder
