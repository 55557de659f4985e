#include "io/urdf/finding_kinds.h"

#include <algorithm>
#include <array>

namespace sunder::urdf {
namespace {

constexpr RobotSeverity kError = RobotSeverity::error;
constexpr RobotSeverity kWarning = RobotSeverity::warning;
constexpr RobotSeverity kInformation = RobotSeverity::information;

constexpr auto kKinds = std::to_array<FindingKind>({
    // The text of the file.
    {"xml_too_deep", kError, StatusCode::limit_exceeded},
    {"xml_too_large", kError, StatusCode::limit_exceeded},
    {"xml_malformed", kError, StatusCode::malformed_file},
    {"xml_entity", kError, StatusCode::unsupported_feature},
    {"xml_encoding", kInformation, StatusCode::malformed_file},
    {"not_urdf", kError, StatusCode::unsupported_format},
    {"xacro_not_expanded", kError, StatusCode::unsupported_feature},
    {"tag_ignored", kInformation, StatusCode::unsupported_feature},
    {"tag_repeated", kWarning, StatusCode::malformed_file},
    {"name_missing", kError, StatusCode::malformed_file},
    {"duplicate_name", kError, StatusCode::malformed_file},
    {"number_malformed", kError, StatusCode::malformed_file},
    {"number_not_finite", kError, StatusCode::non_finite_value},
    {"quaternion_ignored", kWarning, StatusCode::unsupported_feature},
    {"urdfdom_refused", kError, StatusCode::malformed_file},
    // The tree.
    {"no_link", kError, StatusCode::empty_input},
    {"joint_incomplete", kError, StatusCode::malformed_file},
    {"joint_type_unknown", kError, StatusCode::unsupported_feature},
    {"link_missing", kError, StatusCode::not_found},
    {"two_parents", kError, StatusCode::not_a_tree},
    {"several_roots", kError, StatusCode::not_a_tree},
    {"circle", kError, StatusCode::not_a_tree},
    // Joints.
    {"axis_zero", kError, StatusCode::invalid_argument},
    {"axis_not_unit", kWarning, StatusCode::invalid_argument},
    {"limits_missing", kWarning, StatusCode::invalid_argument},
    {"limits_inverted", kWarning, StatusCode::invalid_argument},
    {"limits_zero", kWarning, StatusCode::invalid_argument},
    {"limits_ignored", kInformation, StatusCode::invalid_argument},
    {"mimic_broken_reference", kWarning, StatusCode::not_found},
    {"mimic_self", kWarning, StatusCode::invalid_argument},
    {"mimic_chain", kWarning, StatusCode::invalid_argument},
    {"mimic_fixed_target", kWarning, StatusCode::invalid_argument},
    {"mimic_unsupported", kWarning, StatusCode::unsupported_feature},
    {"mimic_chain_resolved", kInformation, StatusCode::invalid_argument},
    // Shapes.
    {"geometry_missing", kWarning, StatusCode::malformed_file},
    {"geometry_unknown", kWarning, StatusCode::unsupported_feature},
    {"geometry_empty", kInformation, StatusCode::invalid_argument},
    {"geometry_size", kWarning, StatusCode::invalid_argument},
    {"package_unknown", kWarning, StatusCode::file_not_found},
    {"mesh_not_found", kWarning, StatusCode::file_not_found},
    {"mesh_path_not_allowed", kWarning, StatusCode::path_not_allowed},
    {"mesh_unreadable", kWarning, StatusCode::malformed_file},
    {"mesh_scale_zero", kWarning, StatusCode::invalid_argument},
    {"mesh_huge", kWarning, StatusCode::invalid_argument},
    {"mesh_repaired", kInformation, StatusCode::malformed_file},
    {"import_unfiltered", kInformation, StatusCode::unsupported_feature},
    {"collada_up_axis", kInformation, StatusCode::unsupported_feature},
    {"material_unknown", kInformation, StatusCode::not_found},
    {"shapes_too_large", kError, StatusCode::limit_exceeded},
});

}  // namespace

std::span<const FindingKind> finding_kinds() { return kKinds; }

const FindingKind& kind_of(std::string_view code) {
  const auto found = std::find_if(kKinds.begin(), kKinds.end(),
                                  [&](const FindingKind& kind) { return kind.code == code; });
  SUNDER_ASSERT(found != kKinds.end());
  return *found;
}

}  // namespace sunder::urdf
