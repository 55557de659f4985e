// A character plays a clip, is torn on the way, and is drawn: frame_loop MODEL

// README begins
#include <sunder/sunder.h>

#include <algorithm>
#include <cstdio>
#include <vector>

/// Stands in for an engine's vertex and index buffers.
struct DrawBuffers {
  std::vector<sunder::Vec3f> positions;
  std::vector<sunder::Triangle> triangles;

  void draw(const sunder::PosedMesh& mesh) {
    positions.resize(mesh.positions.size());
    triangles.resize(mesh.triangles.size());
    for (const auto& [first, count] : mesh.dirty_vertices)
      std::copy_n(&mesh.positions[first], count, &positions[first]);
    for (const auto& [first, count] : mesh.dirty_triangles)
      std::copy_n(&mesh.triangles[first], count, &triangles[first]);
  }
};

sunder::Status play(const char* model_file, const sunder::Stroke& stroke) {
  const auto loaded = sunder::load_character(model_file);
  if (!loaded) return loaded.error();
  const sunder::Character& model = *loaded->character;
  sunder::CharacterInstanceOptions options;
  options.soft.emplace();  // Soft tissue of the default material.
  auto instance = sunder::CharacterInstance::create(loaded->character, options);
  if (!instance) return instance.error();
  std::vector<DrawBuffers> buffers(model.meshes.size());
  auto pose = sunder::local_rest_pose(model);
  if (!pose) return pose.error();
  sunder::ModelPose model_pose;
  for (int frame = 0; frame < 120; ++frame) {
    sunder::Status status;
    if (!model.clips.empty()) status = sunder::sample_clip(model.clips[0], frame / 60.0, *pose);
    if (status) status = sunder::compute_model_pose(model.skeleton, *pose, model_pose);
    if (!status) return status;
    if (frame == 30) {
      const auto report = instance->tear(model_pose, stroke);
      if (!report) return report.error();
      std::printf("%u faces crossed, %.3f m torn\n", report->faces_crossed, report->length_posed);
    }
    if (status = instance->advance(model_pose, 1.0 / 60); !status) return status;
    for (std::uint32_t m = 0; m < buffers.size(); ++m) buffers[m].draw(instance->mesh(m));
  }
  return {};
}
// README ends

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const sunder::Status status =
      play(argv[1], {{{0, 1.5, 1}, {0, 1.5, -0.05}}, {{0, 1.1, 1}, {0, 1.1, -0.05}}});
  if (!status) std::fprintf(stderr, "%s\n", status.text().data());
  return status ? 0 : 1;
}
