// The engine's side of tearing: vertex and index buffers of fixed capacity that follow a torn model
// by its change records alone. Only changed elements are uploaded; undo shortens the buffers. In
// the end they hold the same bits as the model.

#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "samples/tube.h"

namespace {

/// One vertex as a shader reads it.
struct GpuVertex {
  std::array<float, 3> position = {}, normal = {};
  std::array<float, 2> uv = {};
  std::array<std::uint32_t, 4> joints = {};  ///< Slots of the mesh's skin.
  std::array<float, 4> weights = {};
};

GpuVertex pack(const sunder::Mesh& mesh, std::uint32_t v) {
  GpuVertex vertex;
  for (std::size_t i = 0; i < 3; ++i) {
    vertex.position[i] = mesh.positions[v][static_cast<Eigen::Index>(i)];
    vertex.normal[i] = mesh.normals[v][static_cast<Eigen::Index>(i)];
  }
  vertex.uv = {mesh.uv_sets[0][v].x(), mesh.uv_sets[0][v].y()};

  // A vertex on an edge has the influences of both ends. The shader takes the four largest,
  // normalised.
  const auto all = mesh.weights.of(v);
  std::vector<sunder::Influence> influences(all.begin(), all.end());
  std::stable_sort(influences.begin(), influences.end(),
                   [](const auto& a, const auto& b) { return a.weight > b.weight; });
  influences.resize(std::min<std::size_t>(influences.size(), 4));
  float sum = 0;
  for (const sunder::Influence& influence : influences) sum += influence.weight;
  for (std::size_t i = 0; i < influences.size(); ++i) {
    vertex.joints[i] = influences[i].slot;
    vertex.weights[i] = influences[i].weight / sum;
  }
  return vertex;
}

/// The buffers of one mesh. They are allocated once, as on a graphics card, and never grow.
class MeshBuffers {
 public:
  MeshBuffers(const sunder::Mesh& mesh, std::uint32_t vertex_capacity,
              std::uint32_t triangle_capacity)
      : vertices_(vertex_capacity), indices_(triangle_capacity), submeshes_(triangle_capacity) {
    vertex_count_ = mesh.vertex_count();
    triangle_count_ = mesh.triangle_count();
    upload_vertices({0, vertex_count_}, mesh);
    upload_triangles({0, triangle_count_}, mesh);
  }

  [[nodiscard]] bool has_room_for(const sunder::MeshChange& change) const {
    return change.first_vertex + change.vertex_count <= vertices_.size() &&
           change.first_triangle + change.triangle_count <= indices_.size();
  }

  /// The dirty ranges contain appended and rewritten elements, and retired triangles, which name
  /// one vertex three times and draw nothing. Elements removed by undo lie beyond the ends.
  void apply(const sunder::MeshChange& change, const sunder::Mesh& mesh) {
    vertex_count_ = change.first_vertex + change.vertex_count;
    triangle_count_ = change.first_triangle + change.triangle_count;
    for (const sunder::IndexRange& range : change.dirty_vertices) upload_vertices(range, mesh);
    for (const sunder::IndexRange& range : change.dirty_triangles) upload_triangles(range, mesh);
  }

  [[nodiscard]] bool is_as(const MeshBuffers& other) const {
    const auto same = [](const auto& a, const auto& b, std::size_t count) {
      return std::memcmp(a.data(), b.data(), count * sizeof(a[0])) == 0;
    };
    return vertex_count_ == other.vertex_count_ && triangle_count_ == other.triangle_count_ &&
           same(vertices_, other.vertices_, vertex_count_) &&
           same(indices_, other.indices_, triangle_count_) &&
           same(submeshes_, other.submeshes_, triangle_count_);
  }

  [[nodiscard]] std::uint32_t vertex_count() const { return vertex_count_; }
  [[nodiscard]] std::uint32_t triangle_count() const { return triangle_count_; }
  [[nodiscard]] std::size_t uploaded_bytes() const { return uploaded_bytes_; }

 private:
  void upload_vertices(const sunder::IndexRange& range, const sunder::Mesh& mesh) {
    for (std::uint32_t v = range.first; v < range.first + range.count; ++v)
      vertices_[v] = pack(mesh, v);
    uploaded_bytes_ += range.count * sizeof(GpuVertex);
  }
  void upload_triangles(const sunder::IndexRange& range, const sunder::Mesh& mesh) {
    for (std::uint32_t t = range.first; t < range.first + range.count; ++t) {
      indices_[t] = mesh.triangles[t];
      submeshes_[t] = mesh.triangle_submesh[t];
    }
    uploaded_bytes_ += range.count * (sizeof(sunder::Triangle) + sizeof(std::uint32_t));
  }

  std::vector<GpuVertex> vertices_;
  std::vector<sunder::Triangle> indices_;
  std::vector<std::uint32_t> submeshes_;  ///< Per triangle; walls and caps add new ones.
  std::uint32_t vertex_count_ = 0, triangle_count_ = 0;
  std::size_t uploaded_bytes_ = 0;
};

/// All buffers of a character.
class Mirror {
 public:
  /// @param growth  capacity in multiples of the current size.
  Mirror(const sunder::Character& character, std::uint32_t growth) {
    for (const sunder::Mesh& mesh : character.meshes)
      meshes_.emplace_back(mesh, growth * mesh.vertex_count(), growth * mesh.triangle_count());
  }

  /// @return false if a buffer is too small; nothing is uploaded then.
  [[nodiscard]] bool apply(const sunder::ChangeRecord& change, const sunder::Character& character) {
    for (const sunder::MeshChange& of_mesh : change.meshes)
      if (!meshes_[of_mesh.mesh].has_room_for(of_mesh)) return false;
    for (const sunder::MeshChange& of_mesh : change.meshes)
      meshes_[of_mesh.mesh].apply(of_mesh, character.meshes[of_mesh.mesh]);
    return true;
  }

  [[nodiscard]] bool is_as(const sunder::Character& character) const {
    const Mirror fresh(character, 1);
    for (std::size_t m = 0; m < meshes_.size(); ++m)
      if (!meshes_[m].is_as(fresh.meshes_[m])) return false;
    return meshes_.size() == fresh.meshes_.size();
  }

  [[nodiscard]] const MeshBuffers& mesh(std::size_t m) const { return meshes_[m]; }

 private:
  std::vector<MeshBuffers> meshes_;
};

/// A blade from outside to the axis of the tube, at an angle around it.
sunder::Blade blade_at(double angle, double height) {
  const sunder::Vec3d axis(0, height, 0), outwards(std::sin(angle), 0, std::cos(angle));
  return {axis + 0.5 * outwards, axis};
}

struct Step {
  const char* name;
  std::function<sunder::Status(sunder::TornModel&, sunder::ChangeRecord*)> play;
};

std::vector<Step> make_steps(const sunder::Character& character) {
  const auto tear = [&](float bend, sunder::Stroke stroke, sunder::TearOptions options) {
    return [pose = samples::bent(character, bend), stroke = std::move(stroke), options](
               sunder::TornModel& model, sunder::ChangeRecord* change) {
      return model.tear(pose, stroke, options, change).error();
    };
  };
  const auto undo = [](sunder::TornModel& model, sunder::ChangeRecord* change) {
    return model.undo(change);
  };
  const auto redo = [](sunder::TornModel& model, sunder::ChangeRecord* change) {
    return model.redo(change);
  };

  sunder::TearOptions gap, deep_gap;
  gap.width = 0.02;
  deep_gap.width = 0.01;
  deep_gap.wall_depth = 0.005;
  sunder::PlaneCut cut;
  cut.point = {0, 0.42, 0};
  cut.normal = {0, 1, 0.2};
  cut.caps = true;
  sunder::Bore bore;
  bore.origin = {0, 0.2, -0.5};
  bore.direction = {0, 0, 1};
  bore.radius = 0.03;
  bore.depth = 0.42;
  bore.wall = true;

  return {
      {"tear", tear(0.8f, {blade_at(0.1, 0.15), blade_at(0.2, 0.25), blade_at(0.15, 0.33)}, {})},
      {"tear with a gap", tear(0.2f, {blade_at(1.2, 0.10), blade_at(1.5, 0.25)}, gap)},
      {"tear with a walled gap",
       tear(0.5f, {blade_at(4.0, 0.30), blade_at(4.6, 0.12), blade_at(5.2, 0.28)}, deep_gap)},
      {"undo", undo},
      {"redo", redo},
      {"cut", [pose = samples::bent(character, 0.8f), cut](
                  auto& model, auto* change) { return model.cut(pose, cut, change).error(); }},
      {"drill", [pose = samples::bent(character, 0.1f), bore](
                    auto& model, auto* change) { return model.drill(pose, bore, change).error(); }},
      {"undo", undo},
      {"undo", undo},
      {"redo", redo},
      {"tear across all of it", tear(0.0f, {blade_at(0.6, 0.05), blade_at(0.6, 0.35)}, {})},
  };
}

int fail(const char* what, const sunder::Status& status) {
  std::printf("%s: %s\n", what, status.text().data());
  return 1;
}

/// Plays the steps and uploads the changes of each.
int play(const std::vector<Step>& steps, sunder::TornModel& model, Mirror& mirror) {
  for (const Step& step : steps) {
    sunder::ChangeRecord change;
    if (const sunder::Status status = step.play(model, &change); !status)
      return fail(step.name, status);
    const std::size_t uploaded_before = mirror.mesh(0).uploaded_bytes();
    if (!mirror.apply(change, model.character()))
      return std::printf("%s: the buffers are too small\n", step.name), 1;
    if (!mirror.is_as(model.character()))
      return std::printf("%s: the buffers are not as the model\n", step.name), 1;
    for (const sunder::MeshChange& of_mesh : change.meshes)
      std::printf(
          "%-24s %5u vertices %5u triangles, %4zu rewritten, %3zu of them retired, %6zu bytes "
          "uploaded\n",
          step.name, mirror.mesh(of_mesh.mesh).vertex_count(),
          mirror.mesh(of_mesh.mesh).triangle_count(), of_mesh.rewritten.size(),
          of_mesh.retired.size(), mirror.mesh(of_mesh.mesh).uploaded_bytes() - uploaded_before);
  }
  return 0;
}

/// Tears until the buffers are full. The tear that does not fit is undone, so that model and
/// buffers agree again.
int tear_until_full(const sunder::Character& character, sunder::TornModel& model, Mirror& mirror) {
  const sunder::ModelPose pose = samples::bent(character, 0.3f);
  for (int i = 0; i < 1000; ++i) {
    const double angle = 0.37 * i;
    const sunder::Stroke stroke = {blade_at(angle, 0.05), blade_at(angle + 0.5, 0.35)};
    sunder::ChangeRecord change;
    if (const auto report = model.tear(pose, stroke, {}, &change); !report)
      return fail("tear", report.error());
    if (mirror.apply(change, model.character())) continue;
    std::printf("after %d more tears the buffers are full; the last one is taken back\n", i);
    // Without a change record, because the buffers never had this tear.
    const sunder::Status status = model.undo();
    return status ? 0 : fail("undo", status);
  }
  return std::puts("the buffers were never full"), 1;
}

}  // namespace

int main() {
  const auto character = std::make_shared<const sunder::Character>(
      samples::make_tube({.around = 24, .along = 30, .has_uvs = true}));
  auto model = sunder::TornModel::create(character);
  if (!model) return fail("create", model.error());
  Mirror mirror(*character, 4);

  if (const int code = play(make_steps(*character), *model, mirror); code != 0) return code;
  if (const int code = tear_until_full(*character, *model, mirror); code != 0) return code;

  const bool same = mirror.is_as(model->character());
  std::puts(same ? "the buffers are as the model, bit for bit"
                 : "the buffers are NOT as the model");
  return same ? 0 : 1;
}
