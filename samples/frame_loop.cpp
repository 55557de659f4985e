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
  std::uint64_t seen = 0;  // The state of the scene that they hold.

  void upload(const sunder::PosedMesh& mesh) {
    positions.resize(mesh.positions.size());
    for (const auto& [first, count] : mesh.dirty_vertices)
      std::copy_n(&mesh.positions[first], count, &positions[first]);
    if (!mesh.initial_triangles.empty())
      triangles.assign(mesh.initial_triangles.begin(), mesh.initial_triangles.end());
    triangles.resize(mesh.triangle_capacity);
    for (const auto& [place, triangle] : mesh.triangle_writes) triangles[place] = triangle;
    seen = mesh.epoch;
  }
};

sunder::Status play(const char* model_file, const sunder::Stroke& stroke) {
  const auto loaded = sunder::load_character(model_file);
  if (!loaded) return loaded.error();
  sunder::CharacterAssetOptions options;
  options.soft.emplace();  // Soft tissue of the default material.
  const auto asset = sunder::CharacterAsset::create(loaded->character, options);
  if (!asset) return asset.error();
  auto scene = sunder::Scene::create();
  if (!scene) return scene.error();
  const auto id = scene->spawn(*asset);
  if (!id) return id.error();
  if (!loaded->character->clips.empty())
    if (const auto layer = scene->play(*id, 0); !layer) return layer.error();

  std::vector<DrawBuffers> buffers(loaded->character->meshes.size());
  for (int frame = 0; frame < 120; ++frame) {
    if (frame == 30)
      if (const auto sent = scene->submit(*id, sunder::TearCommand{stroke, {}}); !sent)
        return sent.error();
    if (const auto status = scene->update(1.0 / 60); !status) return status;
    for (const auto& result : scene->results())
      std::printf("%u faces crossed, %.3f m torn\n", result.report.faces_crossed,
                  result.report.length_posed);
    for (std::uint32_t m = 0; m < buffers.size(); ++m)
      buffers[m].upload(scene->mesh(*id, m, buffers[m].seen));
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
