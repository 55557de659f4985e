#include "support/oracles/scene_laws.h"

#include <algorithm>

#include "support/machine/say.h"
#include "support/oracles/particle_laws.h"

namespace sunder::test {
namespace {

constexpr double kFrame = 1.0 / 64;

/// A blade from above the box around a character's bind pose to below it.
Blade blade_through(const Character& character, Random& random) {
  Eigen::AlignedBox3f box;
  for (const Mesh& mesh : character.meshes)
    for (const Vec3f& at : mesh.positions) box.extend(Eigen::Vector3f(at));
  const Vec3d least = box.min().cast<double>(), size = box.sizes().cast<double>();
  const double reach = 0.5 * size.maxCoeff();
  const Vec3d at(least.x() + random.uniform(0, 1) * size.x(),
                 least.y() + random.uniform(0, 1) * size.y(), least.z() + 0.5 * size.z());
  return {at + Vec3d(0, 0, reach), at - Vec3d(0, 0, reach)};
}

SceneCommand command(const Character& character, int step, Random& random) {
  const Blade blade = blade_through(character, random);
  const Vec3d middle = 0.5 * (blade.base + blade.tip);
  PlaneCut cut;
  cut.point = middle;
  cut.normal = random.direction();
  switch (step) {
    case 0: return UndoCommand{};
    case 1: return RedoCommand{};
    case 2: return TearCommand{{blade, blade_through(character, random)}, {}};
    case 3: return cut;
    case 4: return DetachCommand{PieceNear{middle}, {}};
    default: return UndoCommand{};
  }
}

}  // namespace

std::vector<std::string> broken_scene(Scene& scene, bool checks_cells) {
  std::vector<std::string> faults;
  const std::vector<InstanceId> drawn(scene.drawn().begin(), scene.drawn().end());
  for (const InstanceId id : drawn) {
    const CharacterInstance& instance = *std::as_const(scene).find(id);
    for (std::uint32_t m = 0; m < instance.character().meshes.size(); ++m)
      for (const Vec3f& at : scene.mesh(id, m).positions)
        if (!at.allFinite()) {
          faults.push_back(say("instance ", id.slot, ", mesh ", m, ": a vertex is not finite"));
          break;
        }
    if (instance.particles() == nullptr || instance.particles()->is_broken()) continue;
    for (const std::string& fault :
         broken_particles(*instance.model(), *instance.particles(), checks_cells))
      faults.push_back(say("instance ", id.slot, ": ", fault));
  }
  return faults;
}

std::vector<std::string> play_on(Scene& scene, Random& random) {
  for (int step = -2; step < 7; ++step) {
    const std::vector<InstanceId> drawn(scene.drawn().begin(), scene.drawn().end());
    for (const InstanceId id : drawn)
      if (step >= 0)
        (void)scene.submit(id, command(std::as_const(scene).find(id)->character(), step, random));
    (void)scene.update(kFrame);
    if (std::vector<std::string> faults = broken_scene(scene, step < 0); !faults.empty())
      return faults;
  }
  return {};
}

}  // namespace sunder::test
