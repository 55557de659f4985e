// Queries of the posed surface: rays, blades, capsules and points against a test of every face and,
// where it is installed, Embree with a refit per pose, in turns in one run.

#include <sunder/skinning/bone_palette.h>
#include <sunder/skinning/skinned_mesh.h>
#include <sunder/tear/contact.h>
#include <sunder/tear/preview.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "bench/harness/cpu_seconds.h"
#include "bench/harness/measure.h"
#include "bench/tear/tear_scene.h"
#include "support/machine/random.h"

#if SUNDER_BENCH_EMBREE
#include "bench/peers/embree_peer.h"
#endif

namespace sunder::bench {
namespace {

constexpr int kQueries = 256, kRounds = 9;
constexpr int kPerFrame = 16;  ///< Queries per pose: 1 kHz at 60 frames per second.

/// The queries of a scene: rays from around it towards places on it, short blades and capsules at
/// these places, in the first pose.
struct Queries {
  std::vector<Ray> rays;
  std::vector<Blade> blades;
  std::vector<Capsule> capsules;
  std::vector<Vec3d> points;
};

Queries make_queries(const Scene& scene, double size) {
  Queries queries;
  test::Random random(1);
  const auto positions = posed_positions(scene, scene.poses[0]);
  for (int i = 0; i < kQueries; ++i) {
    const Vec3d target = positions[random.index(static_cast<std::uint32_t>(positions.size()))] +
                         0.01 * size * random.direction();
    const Vec3d away = random.direction();
    queries.rays.push_back({target + size * away, -away});
    queries.blades.push_back({target + 0.1 * size * away, target - 0.05 * size * away});
    queries.capsules.push_back({target + 0.1 * size * away, target, 0.02 * size});
    queries.points.push_back(target + 0.02 * size * away);
  }
  return queries;
}

/// Poses all vertices, as a program without the tree has to.
class PosedMesh {
 public:
  PosedMesh(const Scene& scene, std::span<Vec3f> positions)
      : skinned_(
            *SkinnedMesh::create(source_of(scene.mesh()), scene.character->skins[0].bones.size())),
        palette_(*BonePalette::create(scene.character->skins[0].bones.size(), 0)),
        skin_(scene.character->skins[0]),
        buffer_(target_of(positions)) {}

  void pose(const ModelPose& pose) {
    if (!palette_.set(skin_, pose) || !skinned_.deform(palette_, buffer_)) std::abort();
  }

 private:
  static VertexTarget target_of(std::span<Vec3f> positions) {
    VertexTarget target;
    target.vertex_count = static_cast<std::uint32_t>(positions.size());
    target.positions = {positions[0].data()};
    return target;
  }

  SkinnedMesh skinned_;
  BonePalette palette_;
  const Skin& skin_;
  PosedBuffer buffer_;
};

/// The first hit among all faces, in float.
float first_by_scan(const Mesh& mesh, std::span<const Vec3f> positions, const Vec3f& origin,
                    const Vec3f& way) {
  float first = std::numeric_limits<float>::infinity();
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3f a = positions[triangle[0]], ab = positions[triangle[1]] - a,
                ac = positions[triangle[2]] - a;
    const Vec3f h = way.cross(ac);
    const float scale = 1 / ab.dot(h);
    const Vec3f from = origin - a;
    const float u = from.dot(h) * scale;
    if (!(u >= 0 && u <= 1)) continue;
    const Vec3f q = from.cross(ab);
    const float v = way.dot(q) * scale, along = ac.dot(q) * scale;
    if (v >= 0 && u + v <= 1 && along >= 0 && along < first) first = along;
  }
  return first;
}

/// Times by name, in the order in which they were first measured.
using Samples = std::vector<std::pair<std::string, std::vector<double>>>;

/// Microseconds of this process per call; others do not count.
template <class Work>
void add_time(Samples& samples, const char* name, int calls, Work work) {
  const double seconds = cpu_seconds_of([&] {
    for (int i = 0; i < calls; ++i) work(i);
  });
  auto found = std::find_if(samples.begin(), samples.end(),
                            [&](const auto& sample) { return sample.first == name; });
  if (found == samples.end()) found = samples.insert(found, {name, {}});
  found->second.push_back(1e6 * seconds / calls);
}

/// One size of the model.
struct Column {
  std::string size;
  Samples samples;
  double megabytes = 0;  ///< Of the trees and the cache of a query.
};

void measure_queries(const Scene& scene, const Queries& queries, SurfaceQuery& query,
                     Samples& samples) {
  std::vector<SurfaceContact> contacts;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const auto ray = [&](int i) { (void)query.cast_ray(queries.rays[at(i)]); };
  const auto blade = [&](int i) {
    (void)query.find_blade_contacts(queries.blades[at(i)], contacts);
  };
  const auto capsule = [&](int i) { (void)query.find_capsule_contact(queries.capsules[at(i)]); };
  const auto point = [&](int i) { (void)query.find_nearest(queries.points[at(i)]); };
  const auto stand = [&] {
    if (!query.set_pose(scene.next_pose())) std::abort();
  };
  stand();
  for (int i = 0; i < kQueries; ++i) ray(i), blade(i), capsule(i), point(i);
  add_time(samples, "ray, in a pose", kQueries, ray);
  add_time(samples, "blade through all layers, in a pose", kQueries, blade);
  add_time(samples, "nearest point at 2 % of the model's size, in a pose", kQueries, point);
  add_time(samples, "capsule of 10 % of the size, radius 2 %", kQueries, capsule);
  add_time(samples, "first ray in a new pose", 64, [&](int i) {
    stand();
    ray(i);
  });
  // A new pose per frame, then the queries of that frame, close together as those of a hand are.
  add_time(samples, "a frame of 16 rays", 16, [&](int frame) {
    stand();
    for (int i = 0; i < kPerFrame; ++i) ray(frame);
  });
  add_time(samples, "a frame of 16 blades", 16, [&](int frame) {
    stand();
    for (int i = 0; i < kPerFrame; ++i) blade(frame);
  });
}

Column measure(int divisions) {
  const Scene& scene = scene_of(divisions);
  double size = 0;
  {
    Eigen::AlignedBox3d box;
    for (const Vec3d& position : posed_positions(scene, scene.poses[0]))
      box.extend(Eigen::Vector3d(position));
    size = box.diagonal().norm();
  }
  const Queries queries = make_queries(scene, size);
  SurfaceQuery query = *SurfaceQuery::create(scene.model());
  Column column = {size_name(divisions), {}, 0};
  Samples& samples = column.samples;
  std::vector<Vec3f> positions(scene.mesh().vertex_count());
  PosedMesh posed(scene, positions);
#if SUNDER_BENCH_EMBREE
  EmbreePeer embree(scene.mesh());
  PosedMesh posed_for_embree(scene, embree.positions());
#endif
  const int scanned = divisions > 5 ? 2 : 16;
  for (int round = 0; round < kRounds; ++round) {
    measure_queries(scene, queries, query, samples);
    add_time(samples, "preview of a stroke across 100 faces", 4, [&](int) {
      if (!preview_tear(scene.model(), scene.next_pose(), scene.stroke)) std::abort();
    });
    add_time(samples, "*posing all vertices*", 2, [&](int) { posed.pose(scene.next_pose()); });
    float sum = 0;
    add_time(samples, "*one ray, every face tested, on posed vertices*", scanned, [&](int i) {
      const Ray& ray = queries.rays[static_cast<std::size_t>(i)];
      sum += first_by_scan(scene.mesh(), positions, ray.origin.cast<float>(),
                           ray.direction.cast<float>());
    });
#if SUNDER_BENCH_EMBREE
    const auto ray = [&](int i) {
      const Ray& of = queries.rays[static_cast<std::size_t>(i)];
      sum += embree.cast_ray(of.origin.cast<float>(), of.direction.cast<float>()).value_or(0);
    };
    add_time(samples, "*Embree: skinning and refit*", 2, [&](int) {
      posed_for_embree.pose(scene.next_pose());
      embree.refit();
    });
    for (int i = 0; i < kQueries; ++i) ray(i);
    add_time(samples, "*Embree: one ray, after a refit*", kQueries, ray);
    add_time(samples, "*Embree: a frame of 16 rays, with skinning and refit*", 2, [&](int frame) {
      posed_for_embree.pose(scene.next_pose());
      embree.refit();
      for (int i = 0; i < kPerFrame; ++i) ray(frame);
    });
#endif
    if (std::isnan(sum)) std::abort();
  }
  column.megabytes = 1e-6 * static_cast<double>(query.memory_bytes());
  return column;
}

void print_table(const std::vector<Column>& columns) {
  std::string head = "| µs |", dashes = "\n|---|";
  for (const Column& column : columns) {
    head += " " + column.size + " vertices |";
    dashes += "---|";
  }
  std::printf("%s%s\n", head.c_str(), dashes.c_str());
  for (std::size_t row = 0; row < columns.front().samples.size(); ++row) {
    std::printf("| %s |", columns.front().samples[row].first.c_str());
    for (const Column& column : columns) std::printf(" %.3g |", median(column.samples[row].second));
    std::printf("\n");
  }
  std::printf("| trees and cache of a query, MB |");
  for (const Column& column : columns) std::printf(" %.2g |", column.megabytes);
  std::printf("\n");
}

}  // namespace
}  // namespace sunder::bench

/// bench_contact [DIVISIONS ...]: by default 1 2 5 16.
int main(int argc, char** argv) {
  std::vector<int> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::atoi(argv[i]));
  if (sizes.empty()) sizes = {1, 2, 5, 16};
  std::vector<sunder::bench::Column> columns;
  for (const int divisions : sizes) {
    if (divisions < 1) return 2;
    columns.push_back(sunder::bench::measure(divisions));
  }
  sunder::bench::print_table(columns);
  return 0;
}
