#include "bench/scene/engine_instance.h"

#include <algorithm>
#include <utility>

#include "bench/harness/cpu_seconds.h"
#include "bench/scene/scene_crowd.h"
#include "support/machine/allocation_count.h"

namespace sunder::bench {
namespace {

constexpr double kFrame = 1.0 / 90;
constexpr std::uint64_t kAttributeBytes = 32;  ///< Texture coordinates, four influences.

std::shared_ptr<const CharacterAsset> make_asset(const std::shared_ptr<const Character>& from) {
  CharacterAssetOptions options;
  options.soft.emplace();
  options.soft->tension = {1.2, {}};
  auto asset = CharacterAsset::create(from, options);
  require(asset.error(), "asset");
  return *asset;
}

Scene make_scene(DeferredWork& background, std::uint32_t background_updates) {
  SceneOptions options;
  options.threads = 1;
  options.background = background.hook();
  options.background_updates = background_updates;
  auto scene = Scene::create(options);
  require(scene.error(), "scene");
  return std::move(*scene);
}

std::array<float, 10> vertex_of(const PosedMesh& mesh, std::uint32_t v) {
  const Vec3f &p = mesh.positions[v], &n = mesh.normals[v];
  const Vec4f& t = mesh.tangents[v];
  return {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), t.x(), t.y(), t.z(), t.w()};
}

}  // namespace

BackgroundHook DeferredWork::hook() {
  const auto run = [](void* of, void (*task)(void*), void* data) {
    static_cast<DeferredWork*>(of)->waiting_.emplace_back([task, data] { task(data); });
  };
  return {run, this};
}

void DeferredWork::run() {
  for (const auto& work : std::exchange(waiting_, {})) work();
}

EngineInstance::EngineInstance(const std::shared_ptr<const Character>& character,
                               std::uint32_t background_updates)
    : asset_(make_asset(character)), scene_(make_scene(*background_, background_updates)) {
  const auto id = scene_.spawn(asset_);
  require(id.error(), "spawn");
  id_ = *id;
  require(instance().prepare_to_tear(), "prepare");
  require(scene_.play(id_, 0).error(), "play");
}

void EngineInstance::submit(SceneCommand command, bool in_background) {
  CommandOptions options;
  options.in_background = in_background;
  require(scene_.submit(id_, std::move(command), options).error(), "submit");
}

EngineFrame EngineInstance::frame() {
  EngineFrame cost;
  const std::uint64_t allocations = test::allocation_count();
  const double begin = thread_seconds();
  require(scene_.update(kFrame), "update");
  const PosedMesh mesh = scene_.mesh(id_, 0, seen_);
  cost.microseconds = 1e6 * (thread_seconds() - begin);
  cost.allocations = test::allocation_count() - allocations;
  for (const CommandResult& result : scene_.results()) require(result.status, "command");
  cost.uploaded_bytes = upload(mesh);
  return cost;
}

std::uint64_t EngineInstance::upload(const PosedMesh& mesh) {
  std::uint64_t bytes = 0;
  if (!mesh.initial_triangles.empty()) {
    indices_.assign(mesh.initial_triangles.begin(), mesh.initial_triangles.end());
    bytes += indices_.size() * sizeof(Triangle);
  }
  indices_.resize(mesh.triangle_capacity);
  for (const auto& [place, triangle] : mesh.triangle_writes) indices_[place] = triangle;
  bytes += mesh.triangle_writes.size() * sizeof(TriangleWrite);
  vertices_.resize(mesh.positions.size());
  for (const IndexRange& range : mesh.dirty_vertices) {
    for (std::uint32_t v = range.first; v < range.first + range.count; ++v)
      vertices_[v] = vertex_of(mesh, v);
    bytes += range.count * sizeof(Vertex);
  }
  for (const IndexRange& range : mesh.dirty_attributes) bytes += range.count * kAttributeBytes;
  seen_ = mesh.epoch;
  return bytes;
}

EngineInstance::SnapshotTimes EngineInstance::save_and_restore() {
  SnapshotTimes times;
  double begin = thread_seconds();
  const auto bytes = scene_.save();
  times.save = 1e3 * (thread_seconds() - begin);
  require(bytes.error(), "save");
  times.bytes = bytes->size();
  begin = thread_seconds();
  auto loaded = LoadedSnapshot::create(*bytes, std::span(&asset_, 1));
  require(loaded.error(), "load");
  times.load = 1e3 * (thread_seconds() - begin);
  begin = thread_seconds();
  require(scene_.restore(*loaded), "restore");
  times.exchange = 1e3 * (thread_seconds() - begin);
  seen_ = 0;
  return times;
}

std::uint64_t EngineInstance::wrong_elements() {
  const PosedMesh mesh = scene_.mesh(id_, 0, 0);  // everything
  std::uint64_t wrong = 0;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    if (v >= vertices_.size() || vertices_[v] != vertex_of(mesh, v)) ++wrong;
  std::vector<Triangle> indices(mesh.initial_triangles.begin(), mesh.initial_triangles.end());
  indices.resize(mesh.triangle_capacity);
  for (const auto& [place, triangle] : mesh.triangle_writes) indices[place] = triangle;
  for (const DrawRange& range : mesh.ranges)
    for (std::uint32_t t = 0; t < range.triangle_count; ++t)
      if (indices[range.first_triangle + t] != indices_[range.first_triangle + t]) ++wrong;
  return wrong;
}

}  // namespace sunder::bench
