#include "bench/particles/particles_decompose.h"

#include <sunder/skinning/pose.h>

#include <cstdio>
#include <cstdlib>

#include "bench/harness/in_turns.h"
#include "bench/particles/radius_clusters.h"

#if SUNDER_BENCH_IO
#include <sunder/io/character_file.h>

#include <filesystem>
#endif
#if SUNDER_BENCH_NANOFLANN
#include "bench/peers/nanoflann_peer.h"
#endif

namespace sunder::bench {
namespace {

/// The points that faces use.
std::vector<Vec3f> points_of(const ParticleSet& set) {
  std::vector<Vec3f> points;
  for (std::uint32_t point = 0; point < set.point_count(); ++point)
    if (!set.memberships(point).empty()) points.push_back(set.positions()[point]);
  return points;
}

void count(const RadiusClusters& clusters, DecompositionFigures::Peer& peer) {
  peer.clusters = clusters.centres.size();
  peer.memberships = clusters.members.size();
}

}  // namespace

std::unique_ptr<ParticleSet> decompose(const TornModel& model, const ModelPose& pose,
                                       double range) {
  DecompositionOptions options;
  options.range = range;
  auto set = ParticleSet::create(model, pose, options);
  if (!set) {
    std::fprintf(stderr, "%s\n", std::string(set.error().text()).c_str());
    std::exit(1);
  }
  return std::make_unique<ParticleSet>(std::move(*set));
}

std::optional<double> DecompositionFigures::vs_nanoflann() const {
  return nanoflann ? std::optional(seconds / (nanoflann->build + nanoflann->search)) : std::nullopt;
}

DecompositionFigures measure_decomposition(const std::string& name, const TornModel& model,
                                           const ModelPose& pose, int runs) {
  DecompositionFigures figures;
  figures.name = name;
  const std::uint64_t before = bytes_in_use();
  std::unique_ptr<ParticleSet> set = decompose(model, pose, kRange);
  figures.bytes = static_cast<double>(bytes_in_use() - before);
  figures.report = set->report();
  const std::vector<Vec3f> points = points_of(*set);
  const auto range = static_cast<float>(figures.report.range);

  std::vector<Candidate> candidates;
  const auto add = [&](auto run) { candidates.push_back({run, {1, 0, 1}, runs, 0}); };
  add([&] {
    set.reset();
    return seconds_of([&] { set = decompose(model, pose, kRange); });
  });
  add([&] {
    RadiusClusters clusters;
    const double seconds = seconds_of([&] { clusters = cluster_by_scan(points, range); });
    count(clusters, figures.scan);
    return seconds;
  });
#if SUNDER_BENCH_NANOFLANN
  figures.nanoflann.emplace();
  std::vector<double> build, search;
  add([&] {
    const NanoflannClusters found = cluster_by_nanoflann(points, range);
    count(found.clusters, *figures.nanoflann);
    build.push_back(found.build);
    search.push_back(found.search);
    return found.build + found.search;
  });
#endif
  for (Candidate& candidate : candidates) candidate.run();  // warms up
  measure_in_turns(candidates);
  figures.seconds = median(candidates[0].seconds);
  figures.scan.search = median(candidates[1].seconds);
#if SUNDER_BENCH_NANOFLANN
  figures.nanoflann->build = median(build);
  figures.nanoflann->search = median(search);
#endif
  return figures;
}

std::optional<DecompositionFigures> measure_cactus(int runs) {
#if SUNDER_BENCH_IO
  const std::filesystem::path file = SUNDER_SHARED_MODELS "/rigged/cactoro.glb";
  if (!std::filesystem::exists(file)) {
    std::fprintf(stderr, "%s is not there, and left out\n", file.string().c_str());
    return std::nullopt;
  }
  const auto loaded = load_character(file);
  if (!loaded) {
    std::fprintf(stderr, "cactoro: %s\n", std::string(loaded.error().text()).c_str());
    std::exit(1);
  }
  const auto model = TornModel::create(loaded->character);
  const auto pose = make_pose(*loaded->character, RestPose{});
  if (!model || !pose) std::abort();
  return measure_decomposition("cactoro", *model, *pose, runs);
#else
  std::fprintf(stderr, "built without SUNDER_IO: without cactoro.glb (%d runs)\n", runs);
  return std::nullopt;
#endif
}

}  // namespace sunder::bench
