#include "tools/validate/validate_page.h"

namespace sunder::tools {

PageInput page_input(const ValidatedPair& pair) {
  const ValidationReport& report = pair.report;
  PageInput input;
  input.source = pair.source.character.get();
  input.target = pair.target.character.get();
  input.source_title = pair.source_file.filename().string();
  input.target_title = pair.target_file.filename().string();
  input.source_bone_from_target = report.source_bone_of_target;
  input.findings = report.findings;
  const double threshold = ValidationOptions{}.maximum_deviation * report.diagonal;
  const auto add_array = [&](const char* name, const std::vector<float>& values) {
    if (!values.empty()) input.arrays.push_back({name, "m", false, threshold, values});
  };
  add_array("Largest deviation over the poses tried", report.vertex_deviation);
  add_array("Bound for all poses within the limits", report.vertex_bound);
  for (const ClipDeviation& clip : report.over_time) {
    input.series.push_back(
        {"Largest deviation", "m", threshold, clip.clip, clip.times, clip.maximum});
    input.series.push_back({"RMS", "m", {}, clip.clip, clip.times, clip.rms});
  }
  const auto add_pose = [&](const char* name, const ModelPose& pose) {
    if (!pose.model_from_bone.empty()) input.poses.push_back({name, pose.model_from_bone});
  };
  add_pose("Worst pose tried", report.worst_pose);
  add_pose("Worst pose searched", report.bracket.pose);
  return input;
}

}  // namespace sunder::tools
