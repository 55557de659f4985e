#pragma once

#include <sunder/core/character.h>
#include <sunder/validation/finding.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sunder::tools {

/// One number per vertex of the target, which the page draws as a heat map with a histogram.
struct PageArray {
  std::string name;        ///< "Largest deviation over the clips".
  std::string unit;        ///< "m", "share", "count".
  bool is_signed = false;  ///< Diverging colours with zero in the middle; otherwise sequential.
  std::optional<double> threshold;  ///< Drawn as an isoline; for signed arrays also its negative.
  std::vector<float> values;        ///< All meshes of the target, back to back. NaN: no value.
};

/// A pose that the page offers as a button, as the worst one that was found.
struct PagePose {
  std::string name;
  std::vector<Affine3d> model_from_bone;  ///< One per bone of the source.
};

/// A number over the time of a clip, drawn behind the time line.
struct PageSeries {
  std::string name;  ///< "Largest deviation".
  std::string unit;
  std::optional<double> threshold;
  Index clip = 0;              ///< Of the source.
  std::vector<double> times;   ///< Seconds, ascending.
  std::vector<double> values;  ///< One per time.
};

/// What the page of `sunder validate` shows. The poses are those of the source.
struct PageInput {
  const Character* source = nullptr;       ///< Never null; satisfies validate_character().
  const Character* target = nullptr;       ///< As `source`.
  std::string source_title, target_title;  ///< File names, as a reader knows the models.
  /// The bone of the source that moves each bone of the target; kNone: it follows its parent.
  std::vector<Index> source_bone_from_target;
  std::span<const Finding> findings;
  std::vector<PageArray> arrays;  ///< The first one is shown first.
  std::vector<PagePose> poses;
  std::vector<PageSeries> series;  ///< The first one of a clip is drawn with its threshold.
};

}  // namespace sunder::tools
