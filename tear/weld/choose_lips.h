#pragma once

#include <sunder/core/status.h>

#include <span>

#include "tear/posed/workpiece.h"
#include "tear/weld/lip_partners.h"

namespace sunder::tear {

/// The wounds that an operation closes: Weld, Suture.
struct ChosenWounds {
  std::span<const Vec3d> places;  ///< None: all wounds.
  double reach;

  /// @param what  "weld".
  [[nodiscard]] Status validate(const char* what) const;
};

/// Marks the lips of these wounds, of those that have others on them. One entry per lip.
[[nodiscard]] ScratchVector<bool> choose_lips(const ChosenWounds& wounds, std::span<const Lip> lips,
                                              std::span<const LipOverlap> overlaps,
                                              const Workpiece& work);

}  // namespace sunder::tear
