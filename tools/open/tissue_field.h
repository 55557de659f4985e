#pragma once

#include <sunder/particles/authored_tissue.h>

#include <filesystem>
#include <string>

namespace sunder::tools {

/// A field of the tissue whose lips `sunder tear` opens: what `--tissue-field` names.
struct TissueField {
  std::string text;             ///< Of the option.
  std::string factor;           ///< "stiffness", "tension" or "thickness".
  FieldSource source;           ///< Of a TextureChannel without its texels.
  std::filesystem::path image;  ///< Of a TextureChannel.
};

/// Reads the value of `--tissue-field`: "stiffness=bone:LeftArm,at_one=3",
/// "tension=color:COLOR_0,channel=g", "thickness=attribute:_THICKNESS,component=0" or
/// "tension=texture:mask.png,uv=1,at_zero=0.5,at_one=2". If one of at_zero and at_one is given, the
/// other is 1; without them, factors are the values of the source.
/// @return invalid_argument: what is wrong.
[[nodiscard]] Result<TissueField> parse_tissue_field(const std::string& text);

/// Samples a field on all meshes. Those that lack the colours, the attribute or the texture
/// coordinates have the factor 1, unless none has them.
/// @param tissue  gets it.
/// @return the failures of sample_field(), find_bone(), validate_authored_tissue() and
///         decode_image(); file_unreadable. After a failure the tissue is as before.
[[nodiscard]] Status add_tissue_field(const Character& character, const TissueField& field,
                                      AuthoredTissue& tissue);

}  // namespace sunder::tools
