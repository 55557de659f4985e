#include "bench/particles/particles_surface.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "bench/tear/tear_scene.h"
#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

template <class T>
T checked(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", std::string(result.error().text()).c_str());
    std::exit(1);
  }
  return std::move(*result);
}

/// @param gap  wanted displacement of the lips, as a fraction of the range of a particle.
SurfaceFigures measure(const std::string& name, Character from, const Stroke& stroke, double depth,
                       double range, double gap) {
  test::add_tangents(from.meshes[0]);
  const auto source = std::make_shared<const Character>(std::move(from));
  TornModel model = checked(TornModel::create(source));
  const ModelPose pose = checked(bind_pose(*source));
  ParticleSet set =
      checked(ParticleSet::create(model, pose, {.range = range, .is_fraction = false}));
  const std::array<SoftMaterial, 1> material = {};
  SoftBody body = checked(SoftBody::create(set, pose, material));
  TearOptions options;
  options.wall_depth = depth;
  ChangeRecord change;
  (void)checked(model.tear(pose, stroke, options, &change));
  (void)set.follow(model, std::span(&change, 1));
  SurfaceFigures figures{name, gap, 0, {}};
  const auto largest = [&] {
    double most = 0;
    for (std::uint32_t p = 0; p < body.particle_count(); ++p)
      most = std::max(most, body.displacement(p).norm());
    return most;
  };
  // The tension that gives the wanted displacement: the motion is linear in it.
  double tension = 1e-3;
  for (int i = 0; i < 3; ++i) {
    (void)body.set_tension({tension, {}});
    for (int k = 0; k < 240; ++k) (void)body.step(model, pose, 1.0 / 60);
    tension *= gap * range / std::max(largest(), 1e-9);
  }
  figures.gap = largest() / range;
  figures.surface = test::measure_displaced(model, pose, set, body);
  return figures;
}

Stroke along_tube() {
  return {{{-0.2, 1.2, 0.8}, {-0.2, 1.2, 0.2}},
          {{0.05, 1.5, 0.8}, {0.05, 1.5, 0.2}},
          {{0.2, 1.8, 0.8}, {0.2, 1.8, 0.2}}};
}

}  // namespace

std::vector<SurfaceFigures> measure_surfaces() {
  std::vector<SurfaceFigures> figures;
  for (const double gap : {0.1, 0.3}) {
    figures.push_back(measure("sheet", test::make_sheet(64),
                              {test::down_at(0.3, 0.507), test::down_at(0.7, 0.507)}, 0.03, 0.1,
                              gap));
    figures.push_back(measure("tube", test::make_tube(60, 72, 3), along_tube(), 0.05, 0.2, gap));
    const Scene& scene = scene_of(3);
    const double diagonal = test::posed_diagonal(*scene.character, scene.poses[0]);
    figures.push_back(
        measure("bunny", *scene.character, scene.stroke, 0.01 * diagonal, 0.05 * diagonal, gap));
  }
  return figures;
}

}  // namespace sunder::bench
