#include "tools/view_page/view_data.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <map>
#include <utility>

#include "tools/page_parts/clip_section.h"
#include "tools/page_parts/model_section.h"
#include "tools/page_parts/page_file.h"
#include "tools/view_page/base_colour_section.h"
#include "tools/view_page/torn_section.h"

namespace sunder::tools {
namespace {

/// The bone of the model that moves each bone of the torn model: the one of its name.
std::vector<Index> bones_by_name(const Skeleton& model, const Skeleton& torn) {
  std::map<std::string, Index> named;
  for (Index bone = 0; bone < model.bones.size(); ++bone)
    named.emplace(model.bones[bone].name, bone);
  std::vector<Index> matches;
  for (const Bone& bone : torn.bones) {
    const auto match = named.find(bone.name);
    matches.push_back(match == named.end() ? kNone : match->second);
  }
  return matches;
}

Result<Json> torn_section(const ViewInput& input, PageImages& images, DataArrays& arrays) {
  if (input.torn.character == nullptr) return Json();
  const Character &model = *input.model.character, &torn = *input.torn.character;
  const std::vector<Index> bones = bones_by_name(model.skeleton, torn.skeleton);
  if (std::ranges::all_of(bones, [](Index bone) { return bone == kNone; }))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "no bone of '%.80s' has the name of a bone of '%.80s'",
                           input.torn.title.c_str(), input.model.title.c_str());
  auto section = model_section(torn, input.torn.title, bones, arrays);
  if (!section) return section;
  add_base_colours(input.torn, images, arrays, *section);
  const auto parts = find_torn_parts(model, torn);
  if (!parts) return parts.error();
  add_torn_parts(*parts, arrays, *section);
  return section;
}

/// The poses that the page offers in addition to those of clips; `spec` is their name in a log.
Result<Json> poses_section(const Character& model, DataArrays& arrays) {
  const Result<ModelPose> rest = rest_pose(model), bind = bind_pose(model);
  if (!rest) return rest.error();
  if (!bind) return bind.error();
  return Json::array({{{"name", "Rest"},
                       {"spec", "rest"},
                       {"matrices", matrices_json(rest->model_from_bone, arrays)}},
                      {{"name", "Bind"},
                       {"spec", "bind"},
                       {"matrices", matrices_json(bind->model_from_bone, arrays)}}});
}

}  // namespace

Result<std::vector<std::byte>> view_data(const ViewInput& input) {
  const Character& model = *input.model.character;
  DataArrays arrays;
  PageImages images(arrays);
  auto source = model_section(model, input.model.title, own_bones(model.skeleton), arrays);
  if (!source) return source.error();
  add_base_colours(input.model, images, arrays, *source);
  auto target = torn_section(input, images, arrays);
  if (!target) return target.error();
  auto poses = poses_section(model, arrays);
  if (!poses) return poses.error();
  const Json json = {{"source", std::move(*source)},
                     {"target", std::move(*target)},
                     {"skeleton", skeleton_section(model, arrays)},
                     {"clips", clips_section(model, arrays)},
                     {"poses", std::move(*poses)},
                     {"series", Json::array()},
                     {"images", images.take()},
                     {"operations", input.operations.empty() ? Json() : Json(input.operations)}};
  return page_bytes(json, arrays);
}

}  // namespace sunder::tools
