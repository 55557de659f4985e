#include "bench/particles/particles_steps.h"

#include <sunder/particles/soft_body.h>
#include <sunder/skinning/skinned_mesh.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "bench/harness/measure.h"
#include "bench/particles/particles_decompose.h"
#include "bench/tear/tear_scene.h"
#include "particles/internal/angular_frequency.h"
#include "support/machine/random.h"

namespace sunder::bench {
namespace {

constexpr double kStep = 1.0 / 60;
constexpr int kFramesAPush = 10;

void require(const Status& status) {
  if (status) return;
  std::fprintf(stderr, "a soft body could not be stepped: %s\n",
               std::string(status.text()).c_str());
  std::exit(1);
}

/// Chooses the range for about the requested number of particles, which is roughly proportional to
/// 1 / range².
std::unique_ptr<ParticleSet> decompose_into(const Scene& scene, std::uint32_t wanted) {
  double range = kRange;
  std::unique_ptr<ParticleSet> set;
  for (int i = 0; i < 8; ++i) {
    set = decompose(scene.model(), scene.poses[0], range);
    const double ratio = static_cast<double>(set->particle_count()) / wanted;
    if (std::abs(ratio - 1) < 0.02) break;
    range *= std::sqrt(ratio);
  }
  return set;
}

SkinnedMesh make_mesh(const Scene& scene) {
  auto mesh = SkinnedMesh::create(source_of(scene.mesh()), scene.character->skins[0].bones.size());
  require(mesh.error());
  return std::move(*mesh);
}

/// Vertices posed as in a frame, with and without displacements.
class Frame {
 public:
  explicit Frame(const Scene& scene)
      : skin_(scene.character->skins[0]),
        mesh_(make_mesh(scene)),
        palette_(
            *BonePalette::create(skin_.bones.size(), scene.character->rest_morph_weights.size())) {}

  struct Seconds {
    double displaced = 0, plain = 0;
  };
  /// Measures both, one after the other, in alternating order.
  Seconds run(const TornModel& model, const ModelPose& pose, const ParticleSet& set,
              SoftBody& body) {
    require(palette_.set(skin_, pose));
    Seconds seconds;
    is_plain_first_ = !is_plain_first_;
    const auto plain = [&] {
      seconds.plain = seconds_of([&] { require(mesh_.deform(palette_, plain_.buffer)); });
    };
    if (is_plain_first_) plain();
    seconds.displaced = seconds_of([&] {
      const VertexDisplacements displacements = {set.vertex_points(0),
                                                 set.influences(),
                                                 body.displacements(),
                                                 body.moved_vertices(model, 0),
                                                 {},
                                                 {}};
      require(mesh_.deform(palette_, displaced_.buffer, {}, &displacements));
    });
    if (!is_plain_first_) plain();
    return seconds;
  }

 private:
  struct Arrays {
    explicit Arrays(std::uint32_t vertices)
        : positions(vertices),
          normals(vertices),
          buffer({vertices, {positions[0].data()}, {normals[0].data()}, {}}) {}
    std::vector<Vec3f> positions, normals;
    PosedBuffer buffer;
  };

  const Skin& skin_;
  SkinnedMesh mesh_;
  BonePalette palette_;
  Arrays plain_{mesh_.vertex_count()}, displaced_{mesh_.vertex_count()};
  bool is_plain_first_ = false;
};

std::uint32_t count(std::span<const IndexRange> ranges) {
  std::uint32_t sum = 0;
  for (const IndexRange& range : ranges) sum += range.count;
  return sum;
}

/// Pushes every particle in another direction, by a fraction of its range.
void push(const ParticleSet& set, const SoftMaterial& material, test::Random& random,
          SoftBody& body) {
  const double speed =
      0.2 * particles::angular_frequency(material.return_frequency);  // times the range
  for (std::uint32_t particle = 0; particle < set.particle_count(); ++particle)
    require(body.add_impulse(
        particle, body.mass(particle) * speed * set.range(particle) * random.direction()));
}

}  // namespace

StepFigures measure_steps(int divisions, std::uint32_t particles, int frames) {
  const Scene& scene = scene_of(divisions);
  const TornModel& model = scene.model();
  const std::unique_ptr<ParticleSet> set = decompose_into(scene, particles);
  const std::array<SoftMaterial, 1> materials = {};
  auto created = SoftBody::create(*set, scene.poses[0], materials);
  require(created.error());
  SoftBody& body = *created;

  StepFigures figures;
  figures.vertices = scene.mesh().vertex_count();
  figures.particles = set->particle_count();
  for (std::uint32_t particle = 0; particle < figures.particles; ++particle)
    figures.neighbours += static_cast<double>(set->neighbours(particle).size()) / figures.particles;

  test::Random random(1);
  Frame frame(scene);
  std::vector<double> steps, displacing, sums, plain;
  for (int i = -kFramesAPush; i < frames; ++i) {  // the first frames warm up
    if (i % kFramesAPush == 0) push(*set, materials[0], random, body);
    const ModelPose& pose = scene.next_pose();
    const double step = seconds_of([&] { require(body.step(model, pose, kStep)); });
    const Frame::Seconds seconds = frame.run(model, pose, *set, body);
    const std::uint32_t moved = count(body.moved_vertices(model, 0));
    if (body.awake_count() != figures.particles || moved != figures.vertices) {
      std::fprintf(stderr, "%u of %u particles are awake, and %u of %u vertices displaced\n",
                   body.awake_count(), figures.particles, moved, figures.vertices);
      std::exit(1);
    }
    if (i < 0) continue;
    steps.push_back(step);
    displacing.push_back(seconds.displaced - seconds.plain);
    sums.push_back(step + seconds.displaced - seconds.plain);
    plain.push_back(seconds.plain);
  }
  figures.step = median(steps);
  figures.displace = median(displacing);
  figures.frame = median(sums);
  figures.plain_deform = median(plain);

  const ModelPose& last = scene.next_pose();
  for (int i = 0; i < 3600 && body.awake_count() > 0; ++i) require(body.step(model, last, kStep));
  if (body.awake_count() > 0) {
    std::fprintf(stderr, "%u of %u particles do not fall asleep\n", body.awake_count(),
                 figures.particles);
    std::exit(1);
  }
  constexpr int kBatch = 1000;
  const auto step_asleep = [&](auto&& pose) {
    return median(sample({20, 1},
                         [&] {
                           return seconds_of([&] {
                             for (int i = 0; i < kBatch; ++i)
                               require(body.step(model, pose(), kStep));
                           });
                         })) /
           kBatch;
  };
  figures.asleep = step_asleep([&]() -> const ModelPose& { return last; });
  figures.asleep_moving = step_asleep([&]() -> const ModelPose& { return scene.next_pose(); });
  return figures;
}

}  // namespace sunder::bench
