#include "tools/command_line/options.h"

namespace sunder::tools {

CLI::App* add_info(CLI::App& app, InfoRequest& request) {
  CLI::App* const verb = app.add_subcommand(
      "info", "Describe a model: meshes, bones, clips, topology, and faults that loading repaired");
  verb->add_option(
          "MODEL", request.model,
          "Model file: glTF, GLB, FBX, COLLADA, X, B3D, OBJ, PLY, OFF ..., or a robot: URDF")
      ->type_name("FILE")
      ->required();
  verb->add_flag("--json", request.as_json, "Print one JSON object instead of text");
  CLI::Option* const bones = verb->add_flag(
      "--bones", request.with_bones,
      "List the bones as a tree: joint, length, and the surface that each one moves predominantly");
  verb->add_option("--pose", request.pose,
                   "Pose of bones and bounds: rest, bind, or CLIP@TIME with a time in seconds")
      ->type_name("POSE")
      ->capture_default_str()
      ->needs(bones);
  verb->add_option("--report", request.report, "File for the JSON object, beside the text")
      ->type_name("FILE");
  add_model_reading(*verb, request.reading);
  add_budget(*verb, request.budget);
  verb->footer(
      "Exit code 1 if loading repaired or dropped something, or found faults of a "
      "robot.\n\nExample: sunder info fox.glb "
      "--bones --pose Walk@0.4");
  return verb;
}

}  // namespace sunder::tools
