// An engine that skins on the graphics card: the scene moves, tears and simulates; the engine keeps
// the bind data of vertices, and uploads the palette and the displacements of particles each frame.
// A function stands in for the vertex shader. Its result is compared with that of the CPU.

#include <sunder/scene/scene.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include "samples/tube.h"

namespace {

using sunder::Vec3f;
using sunder::Vec4f;

constexpr double kFrame = 1.0 / 60;

/// One vertex in bind space, as the shader reads it.
struct GpuVertex {
  Vec3f position = Vec3f::Zero();
  std::array<std::uint32_t, 4> bones = {};  ///< Slots of the skin.
  std::array<float, 4> weights = {};
  std::array<std::uint32_t, 4> particles = {};
  std::array<float, 4> particle_weights = {};
};

/// The buffers of one instance of a character with one mesh.
struct GpuBuffers {
  std::vector<GpuVertex> vertices;
  std::vector<sunder::Triangle> triangles;
  std::vector<sunder::Affine3f> palette;  ///< Per slot.
  std::vector<Vec4f> displacements;       ///< Per particle.
  std::uint64_t seen = 0;
  std::uint64_t particles_seen = 0;
};

void upload_weights(const sunder::Mesh& mesh, const sunder::IndexRange& range,
                    std::vector<GpuVertex>& vertices) {
  for (std::uint32_t v = range.first; v < range.first + range.count; ++v) {
    vertices[v].position = mesh.positions[v];
    const auto influences = mesh.weights.of(v);
    for (std::size_t i = 0; i < 4; ++i) {
      const bool is_used = i < influences.size();
      vertices[v].bones[i] = is_used ? influences[i].slot : 0;
      vertices[v].weights[i] = is_used ? influences[i].weight : 0.0f;
    }
  }
}

/// Influences of particles change where a tear separates them.
void upload_particles(const sunder::CharacterInstance& instance, GpuBuffers& to) {
  const sunder::ParticleSet* const particles = instance.particles();
  if (particles == nullptr) return;
  const auto points = particles->vertex_points(0);
  if (to.particles_seen != particles->revision()) {
    to.particles_seen = particles->revision();
    for (std::uint32_t v = 0; v < points.size(); ++v) {
      if (points[v] == sunder::kNone) continue;
      to.vertices[v].particles = particles->influences()[points[v]].particles;
      to.vertices[v].particle_weights = particles->influences()[points[v]].weights;
    }
  }
}

void upload(sunder::CharacterInstance& instance, GpuBuffers& to) {
  const sunder::Character& character = instance.character();
  const sunder::Mesh& mesh = character.meshes[0];
  const sunder::PosedMesh changes = instance.mesh(0, to.seen);
  to.vertices.resize(mesh.vertex_count());
  if (!changes.initial_triangles.empty()) {  // the first frame
    to.triangles.assign(changes.initial_triangles.begin(), changes.initial_triangles.end());
    upload_weights(mesh, {0, mesh.vertex_count()}, to.vertices);
  }
  for (const sunder::IndexRange& range : changes.dirty_attributes)
    upload_weights(mesh, range, to.vertices);
  to.triangles.resize(changes.triangle_capacity);
  for (const auto& [place, triangle] : changes.triangle_writes) to.triangles[place] = triangle;
  to.seen = changes.epoch;

  const sunder::Skin& skin = character.skins[mesh.skin];
  to.palette.resize(skin.bones.size());
  for (std::size_t slot = 0; slot < skin.bones.size(); ++slot)
    to.palette[slot] = (instance.pose().model_from_bone[skin.bones[slot]] *
                        skin.bone_from_bind[slot].cast<double>())
                           .cast<float>();
  upload_particles(instance, to);
  if (sunder::SoftBody* const body = instance.body()) {
    const auto displacements = body->displacements();
    to.displacements.assign(displacements.begin(), displacements.end());
  }
}

/// The vertex shader.
Vec3f skin_vertex(const GpuBuffers& buffers, const GpuVertex& vertex) {
  Vec3f place = Vec3f::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    place += vertex.weights[i] * (buffers.palette[vertex.bones[i]] * vertex.position);
  if (buffers.displacements.empty()) return place;
  for (std::size_t i = 0; i < 4; ++i)
    place += vertex.particle_weights[i] * buffers.displacements[vertex.particles[i]].head<3>();
  return place;
}

std::shared_ptr<const sunder::CharacterAsset> make_asset(bool poses_vertices) {
  sunder::CharacterAssetOptions options;
  options.poses_vertices = poses_vertices;
  options.soft.emplace();
  options.soft->tension = {2.0, {}};
  const auto asset = sunder::CharacterAsset::create(
      std::make_shared<const sunder::Character>(samples::make_tube({32, 60})), options);
  return asset ? *asset : nullptr;
}

sunder::Status run(double& farthest, std::uint32_t& torn_vertices) {
  auto scene = sunder::Scene::create();
  if (!scene) return scene.error();
  const auto on_gpu = scene->spawn(make_asset(false)), on_cpu = scene->spawn(make_asset(true));
  if (!on_gpu) return on_gpu.error();
  if (!on_cpu) return on_cpu.error();
  const sunder::Character source = scene->find(*on_gpu)->character();
  GpuBuffers buffers;
  for (int frame = 0; frame < 90; ++frame) {
    for (const sunder::InstanceId id : {*on_gpu, *on_cpu}) {
      const sunder::ModelPose pose = samples::bent(source, 0.01 * frame);
      if (const auto status = scene->set_pose(id, pose); !status) return status;
      if (frame != 30) continue;
      const sunder::TearCommand tear = {
          {{{-0.1, 0.3, 0.5}, {-0.1, 0.3, 0.05}}, {{0.1, 0.35, 0.5}, {0.1, 0.35, 0.05}}}, {}};
      if (const auto sent = scene->submit(id, tear); !sent) return sent.error();
    }
    if (const auto status = scene->update(kFrame); !status) return status;
    upload(*scene->find(*on_gpu), buffers);
    const auto drawn = scene->mesh(*on_cpu, 0).positions;
    if (drawn.size() != buffers.vertices.size())
      return sunder::Status::failure(sunder::StatusCode::internal_error, 0, "buffers differ");
    for (std::size_t v = 0; v < drawn.size(); ++v)
      farthest =
          std::max(farthest, double{(skin_vertex(buffers, buffers.vertices[v]) - drawn[v]).norm()});
  }
  torn_vertices =
      static_cast<std::uint32_t>(buffers.vertices.size()) - source.meshes[0].vertex_count();
  return {};
}

}  // namespace

int main() {
  double farthest = 0;
  std::uint32_t torn_vertices = 0;
  if (const sunder::Status status = run(farthest, torn_vertices); !status) {
    std::fprintf(stderr, "%s\n", status.text().data());
    return 1;
  }
  std::printf("%u vertices were torn; shader and CPU differ by %.1e m at most\n", torn_vertices,
              farthest);
  return torn_vertices > 0 && farthest < 1e-5 ? 0 : 1;
}
