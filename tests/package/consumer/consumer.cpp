#include <sunder/sunder.h>

#include <cstdio>
#include <fstream>
#include <memory>

#ifdef CONSUMER_IO
/// Reads a file of another format than glTF by the installed helper executable.
static bool imports(const char* helper) {
  std::ofstream("triangle.off") << "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  sunder::LoadOptions options;
  options.import_helper = helper;
  const auto loaded = sunder::load_character("triangle.off", options);
  if (!loaded) std::printf("%s\n", loaded.error().text().data());
  return loaded.has_value();
}
#endif

int main([[maybe_unused]] int count, [[maybe_unused]] char** arguments) {
  sunder::Character sheet;
  sheet.skeleton.bones.push_back({"root", sunder::kNone, {}});
  sheet.skins.push_back({"skin", {0}, {sunder::Affine3f::Identity()}});
  sunder::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.triangle_submesh = {0, 0};
  mesh.submeshes.resize(1);
  const sunder::Influence all_of_root{0, 1.0f};
  for (int v = 0; v < 4; ++v) mesh.weights.append({&all_of_root, 1});
  sheet.meshes.push_back(mesh);

  const sunder::ModelPose pose = *sunder::bind_pose(sheet);
  auto torn = sunder::CharacterInstance::create(std::make_shared<const sunder::Character>(sheet));
  if (!torn) return std::printf("%s\n", torn.error().text().data()), 1;
  const auto report = torn->tear(
      pose, sunder::Stroke{{{0.6, 0.2, 1}, {0.6, 0.2, -1}}, {{0.4, 0.8, 1}, {0.4, 0.8, -1}}});
  if (!report) return std::printf("%s\n", report.error().text().data()), 1;
  const sunder::Character& character = torn->character();
  if (report->runs != 1 || sunder::count_topology(character)->boundary_loops != 2) return 1;
  if (!torn->advance(pose, 0.0) || !torn->draw()) return 1;
  if (torn->mesh(0).positions.size() != character.meshes[0].positions.size()) return 1;

#ifdef CONSUMER_IO
  if (sunder::load_character("no such file.glb").error().code() !=
      sunder::StatusCode::file_not_found)
    return 1;
  if (count != 2 || !imports(arguments[1])) return 1;
#endif
  return 0;
}
