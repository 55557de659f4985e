// Loads a model, tears it in the middle of its first clip, and saves it: tear_file MODEL OUT.glb
#include <sunder/io/character_file.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <cstdio>

sunder::Status tear_file(const char* model_file, const char* torn_file,
                         const sunder::Stroke& stroke) {
  const auto loaded = sunder::load_character(model_file);
  if (!loaded) return loaded.error();
  const sunder::Character& character = *loaded->character;

  auto pose = sunder::local_rest_pose(character);  // Or what your engine plays.
  if (!pose) return pose.error();
  if (!character.clips.empty())
    if (const auto status = sunder::sample_clip(character.clips[0], 0.8, *pose); !status)
      return status;
  sunder::ModelPose model_pose;
  if (const auto status = sunder::compute_model_pose(character.skeleton, *pose, model_pose);
      !status)
    return status;

  auto torn = sunder::TornModel::create(loaded->character);
  if (!torn) return torn.error();
  const auto report = torn->tear(model_pose, stroke);
  if (!report) return report.error();
  std::printf("%u faces crossed, %.3f m torn\n", report->faces_crossed, report->length_posed);
  return sunder::save_glb(torn_file, torn->character(), *loaded);
}

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: tear_file MODEL OUT.glb\n", stderr), 2;
  // From the front, across a model of human height that stands at the origin.
  const sunder::Stroke stroke = {{{-0.10, 1.15, 2.0}, {-0.10, 1.15, 0.0}},
                                 {{-0.12, 1.25, 2.0}, {-0.12, 1.25, 0.0}},
                                 {{-0.10, 1.40, 2.0}, {-0.10, 1.40, 0.0}}};
  const sunder::Status status = tear_file(argv[1], argv[2], stroke);
  if (!status) std::fprintf(stderr, "%s\n", status.text().data());
  return status ? 0 : 1;
}
