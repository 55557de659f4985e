#include "tools/validation_page/page_data.h"

#include <sunder/validation/validation.h>

#include "tools/page_parts/clip_section.h"
#include "tools/page_parts/data_arrays.h"
#include "tools/page_parts/model_section.h"
#include "tools/page_parts/page_file.h"

namespace sunder::tools {
namespace {

std::size_t vertex_count(const Character& character) {
  std::size_t count = 0;
  for (const Mesh& mesh : character.meshes) count += mesh.positions.size();
  return count;
}

Status size_fault(const char* what, const std::string& name, std::size_t found,
                  std::size_t expected) {
  return Status::failure(StatusCode::size_mismatch, kNone, "%s '%s': %zu entries, expected %zu",
                         what, name.c_str(), found, expected);
}

Status check(const PageInput& input) {
  const std::size_t source_bones = input.source->skeleton.bones.size();
  const std::size_t target_bones = input.target->skeleton.bones.size();
  if (input.source_bone_from_target.size() != target_bones)
    return size_fault("bones of", input.target_title, input.source_bone_from_target.size(),
                      target_bones);
  for (Index bone = 0; bone < target_bones; ++bone)
    if (const Index source = input.source_bone_from_target[bone];
        source != kNone && source >= source_bones)
      return Status::failure(StatusCode::index_out_of_range, bone,
                             "bone %u of the target: no bone %u in the source", bone, source);
  for (const PageArray& array : input.arrays)
    if (array.values.size() != vertex_count(*input.target))
      return size_fault("array", array.name, array.values.size(), vertex_count(*input.target));
  for (const PagePose& pose : input.poses)
    if (pose.model_from_bone.size() != source_bones)
      return size_fault("pose", pose.name, pose.model_from_bone.size(), source_bones);
  for (const PageSeries& series : input.series) {
    if (series.clip >= input.source->clips.size())
      return Status::failure(StatusCode::index_out_of_range, series.clip, "series '%s': no clip %u",
                             series.name.c_str(), series.clip);
    if (series.values.size() != series.times.size())
      return size_fault("series", series.name, series.values.size(), series.times.size());
  }
  return {};
}

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

const char* evidence_name(Evidence evidence) {
  switch (evidence) {
    case Evidence::exact: return "exact";
    case Evidence::certified: return "certified";
    case Evidence::sampled: return "sampled";
    case Evidence::not_tested: return "not_tested";
  }
  return "not_tested";
}

Json places_json(const Finding& finding) {
  Json places = Json::array();
  for (const FindingPlace& place : finding.places)
    places.push_back({{"mesh", index_json(place.mesh)},
                      {"vertex", index_json(place.vertex)},
                      {"bone", index_json(place.bone)},
                      {"position", {place.position.x(), place.position.y(), place.position.z()}},
                      {"value", place.value}});
  return places;
}

Json findings_json(std::span<const Finding> findings) {
  Json list = Json::array();
  for (const Finding& finding : findings)
    list.push_back({{"code", finding.code},
                    {"severity", severity_name(finding.severity)},
                    {"evidence", evidence_name(finding.evidence)},
                    {"text", finding.text},
                    {"advice", finding.advice},
                    {"gltf_code", finding.gltf_code},
                    {"value", finding.value},
                    {"threshold", finding.threshold},
                    {"unit", finding.unit},
                    {"count", finding.count},
                    {"places", places_json(finding)}});
  return list;
}

Json arrays_json(const PageInput& input, DataArrays& arrays) {
  Json list = Json::array();
  for (const PageArray& array : input.arrays)
    list.push_back({{"name", array.name},
                    {"unit", array.unit},
                    {"signed", array.is_signed},
                    {"threshold", optional_json(array.threshold)},
                    {"values", arrays.add(array.values)}});
  return list;
}

Json poses_json(const PageInput& input, DataArrays& arrays) {
  Json list = Json::array();
  for (const PagePose& pose : input.poses) {
    list.push_back(
        {{"name", pose.name}, {"matrices", matrices_json(pose.model_from_bone, arrays)}});
  }
  return list;
}

Json series_json(const PageInput& input, DataArrays& arrays) {
  Json list = Json::array();
  for (const PageSeries& series : input.series)
    list.push_back(
        {{"name", series.name},
         {"unit", series.unit},
         {"threshold", optional_json(series.threshold)},
         {"clip", series.clip},
         {"times", arrays.add(std::vector<float>(series.times.begin(), series.times.end()))},
         {"values", arrays.add(std::vector<float>(series.values.begin(), series.values.end()))}});
  return list;
}

}  // namespace

Result<std::vector<std::byte>> page_data(const PageInput& input) {
  if (Status status = check(input); !status) return status;
  DataArrays arrays;
  auto source =
      model_section(*input.source, input.source_title, own_bones(input.source->skeleton), arrays);
  if (!source) return source.error();
  auto target =
      model_section(*input.target, input.target_title, input.source_bone_from_target, arrays);
  if (!target) return target.error();
  const Json json = {{"source", std::move(*source)},
                     {"target", std::move(*target)},
                     {"skeleton", skeleton_section(*input.source, arrays)},
                     {"clips", clips_section(*input.source, arrays)},
                     {"poses", poses_json(input, arrays)},
                     {"arrays", arrays_json(input, arrays)},
                     {"series", series_json(input, arrays)},
                     {"findings", findings_json(input.findings)}};
  return page_bytes(json, arrays);
}

}  // namespace sunder::tools
