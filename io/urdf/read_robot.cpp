#include "io/urdf/read_robot.h"

#include <optional>
#include <utility>

#include "io/urdf/check_text.h"
#include "io/urdf/joint_checks.h"
#include "io/urdf/link_meshes.h"
#include "io/urdf/link_tree.h"
#include "io/urdf/make_robot.h"
#include "io/urdf/mimic_chains.h"
#include "io/urdf/parse_by_urdfdom.h"
#include "io/urdf/read_tags.h"
#include "io/urdf/robot_model.h"

namespace sunder::urdf {

Result<LoadedRobot> read_robot(std::string text, const std::filesystem::path& file,
                               const RobotLoadOptions& options, Findings& findings) {
  check_text(text, findings);
  if (const Status status = findings.status(); !status) return status;
  RobotTags tags = read_tags(text, findings);
  text = {};
  if (const Status status = findings.status(); !status) return status;
  const LinkTree tree = make_link_tree(tags, findings);
  repair_joints(tags, findings);
  const std::vector<MimicChain> chains = resolve_mimics(tags, findings);
  if (const Status status = findings.status(); !status) return status;
  const std::optional<ParsedRobot> parsed = parse_by_urdfdom(tags, findings);
  if (const Status status = findings.status(); !status) return status;

  LoadedRobot loaded;
  loaded.robot = make_robot(tags, *parsed, tree, chains);
  if (const Status status = validate_robot(loaded.robot); !status) return status;
  LinkMeshes meshes = read_link_meshes(file, options, tags, *parsed, tree, findings);
  if (const Status status = findings.status(); !status) return status;
  loaded.model_from_root = y_up_from_z_up();
  Result<LoadedCharacter> model =
      make_model(loaded.robot, std::move(meshes), loaded.model_from_root, options.meshes);
  if (!model) return model.error();
  loaded.model = std::move(*model);
  return loaded;
}

}  // namespace sunder::urdf
