#include "tools/picture/picture.h"

#include <sunder/io/character_file.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace sunder::tools {
namespace {

const Vec4f kTissue(0.75f, 0.05f, 0.05f, 1.0f);  // Linear RGBA.
const Vec4f kRim(1.0f, 0.16f, 0.12f, 1.0f);

/// A rigid mesh.
Mesh make_mesh(const std::string& name) {
  Mesh mesh;
  mesh.name = name;
  mesh.submeshes = {{name, kNone}};
  return mesh;
}

Index append_vertex(Mesh& mesh, const Vec3f& position, const Vec3f& normal) {
  const Influence all_of_root{0, 1.0f};
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal);
  mesh.weights.append({&all_of_root, 1});
  return mesh.vertex_count() - 1;
}

void append_triangle(Mesh& mesh, const Triangle& triangle) {
  mesh.triangles.push_back(triangle);
  mesh.triangle_submesh.push_back(0);
}

/// Renderers shade a surface by its normals and its winding. Where the two disagree, the normals
/// are used.
void wind_by_normals(Mesh& mesh) {
  for (Triangle& triangle : mesh.triangles) {
    const Vec3f& a = mesh.positions[triangle[0]];
    const Vec3f by_winding =
        (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
    const Vec3f by_normals =
        mesh.normals[triangle[0]] + mesh.normals[triangle[1]] + mesh.normals[triangle[2]];
    if (by_winding.dot(by_normals) < 0.0f) std::swap(triangle[1], triangle[2]);
  }
}

/// One posed submesh, with its colours if there are any.
Mesh make_outside(const Mesh& source, const DeformedMesh& posed, Index submesh,
                  std::span<const Vec4f> colors) {
  Mesh mesh = make_mesh(source.submeshes[submesh].name.empty() ? source.name
                                                               : source.submeshes[submesh].name);
  if (!colors.empty()) mesh.color_sets.resize(1);
  std::vector<Index> new_from_old(posed.positions.size(), kNone);
  for (Index t = 0; t < source.triangles.size(); ++t) {
    if (source.triangle_submesh[t] != submesh) continue;
    Triangle triangle = source.triangles[t];
    for (Index& vertex : triangle) {
      Index& copy = new_from_old[vertex];
      if (copy == kNone) {
        copy = append_vertex(mesh, posed.positions[vertex], posed.normals[vertex]);
        if (!colors.empty()) mesh.color_sets[0].push_back(colors[vertex]);
      }
      vertex = copy;
    }
    append_triangle(mesh, triangle);
  }
  return mesh;
}

/// +1 if the normals of the mesh point outwards, -1 if they point inwards, as in some files.
float outward_sign(const Mesh& mesh, const DeformedMesh& posed) {
  Vec3d centre = Vec3d::Zero();
  for (const Vec3f& position : posed.positions)
    centre += position.cast<double>() / static_cast<double>(posed.positions.size());
  double flux = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3d a = posed.positions[triangle[0]].cast<double>(),
                b = posed.positions[triangle[1]].cast<double>(),
                c = posed.positions[triangle[2]].cast<double>();
    const Vec3f normal =
        posed.normals[triangle[0]] + posed.normals[triangle[1]] + posed.normals[triangle[2]];
    flux += (b - a).cross(c - a).norm() * ((a + b + c) / 3 - centre).dot(normal.cast<double>());
  }
  return flux < 0 ? -1.0f : 1.0f;
}

/// The inside of the surface, visible through openings. It lies deeper by `thickness`, or by less
/// where the model is thin, so that it is never visible on the near side.
Mesh make_inside(const Mesh& source, const DeformedMesh& posed, const DeformedMesh& closed,
                 const DepthImage& image, const ViewFrame& frame, double thickness) {
  const float outwards = outward_sign(source, closed);
  std::vector<Vec3f> positions = posed.positions;
  std::vector<bool> is_behind(positions.size(), false);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3f normal = outwards * closed.normals[v];
    const double behind_front = image.depth_behind_front(closed.positions[v].cast<double>());
    const double depth = std::min(thickness, 0.3 * behind_front);
    is_behind[v] = static_cast<double>(normal.dot(frame.towards_eye.cast<float>())) < 0.1 &&
                   depth > 0.02 * thickness;
    positions[v] -= static_cast<float>(depth) * normal;
  }
  Mesh mesh = make_mesh("Inside");
  std::vector<Index> new_from_old(positions.size(), kNone);
  for (const Triangle& triangle : source.triangles) {
    if (!is_behind[triangle[0]] || !is_behind[triangle[1]] || !is_behind[triangle[2]]) continue;
    Triangle inner = triangle;
    for (Index& vertex : inner) {
      Index& copy = new_from_old[vertex];
      if (copy == kNone)
        copy = append_vertex(mesh, positions[vertex], -outwards * posed.normals[vertex]);
      vertex = copy;
    }
    append_triangle(mesh, inner);
  }
  mesh.color_sets.assign(1, std::vector<Vec4f>(mesh.positions.size(), kTissue));
  return mesh;
}

/// Strips from the rims to the inside: the section of the flesh.
Mesh make_rims(const Character& character, const std::vector<DeformedMesh>& posed,
               const std::vector<RimEdge>& rims, double thickness) {
  Mesh mesh = make_mesh("Rim");
  std::vector<float> depth;
  for (std::size_t i = 0; i < posed.size(); ++i)
    depth.push_back(static_cast<float>(thickness) * outward_sign(character.meshes[i], posed[i]));
  // Points away from the face; at a vertex, the mean of its two edges.
  std::map<std::array<Index, 2>, Vec3f> facing;
  for (const RimEdge& edge : rims) {
    const DeformedMesh& surface = posed[edge.mesh];
    const Vec3f along = surface.positions[edge.b] - surface.positions[edge.a];
    for (const Index vertex : {edge.a, edge.b})
      facing.try_emplace({edge.mesh, vertex}, Vec3f::Zero()).first->second +=
          along.cross(surface.normals[vertex]);
  }
  for (const RimEdge& edge : rims) {
    const DeformedMesh& surface = posed[edge.mesh];
    for (const Index vertex : {edge.a, edge.b}) {
      const Vec3f away = facing[{edge.mesh, vertex}];
      const Vec3f normal = away.norm() > 0.0f ? Vec3f(away.normalized()) : surface.normals[vertex];
      append_vertex(mesh, surface.positions[vertex], normal);
      append_vertex(mesh, surface.positions[vertex] - depth[edge.mesh] * surface.normals[vertex],
                    normal);
    }
    const Index last = mesh.vertex_count();
    append_triangle(mesh, {last - 4, last - 3, last - 2});
    append_triangle(mesh, {last - 3, last - 1, last - 2});
  }
  mesh.color_sets.assign(1, std::vector<Vec4f>(mesh.positions.size(), kRim));
  return mesh;
}

}  // namespace

Character make_still(const Character& character, const std::vector<DeformedMesh>& posed,
                     const std::vector<std::vector<Vec4f>>& colors) {
  Character still;
  still.name = character.name;
  still.skeleton.bones.push_back({"Still", kNone, {}});
  still.skins.push_back({"Still", {0}, {Affine3f::Identity()}});
  for (Index i = 0; i < posed.size(); ++i)
    for (Index submesh = 0; submesh < character.meshes[i].submeshes.size(); ++submesh)
      still.meshes.push_back(make_outside(
          character.meshes[i], posed[i], submesh,
          i < colors.size() ? std::span<const Vec4f>(colors[i]) : std::span<const Vec4f>()));
  for (Mesh& mesh : still.meshes) wind_by_normals(mesh);
  return still;
}

Character make_torn_still(const TornModel& torn, const std::vector<DeformedMesh>& posed,
                          const std::vector<DeformedMesh>& closed,
                          const std::vector<DeformedMesh>& untorn, const std::vector<RimEdge>& rims,
                          const ViewFrame& frame, double thickness) {
  constexpr int kImageSize = 700;
  const Character& character = torn.character();
  Character still = make_still(character, posed);
  auto outside = still.meshes.begin();
  for (Index i = 0; i < character.meshes.size(); ++i)
    for (Index submesh = 0; submesh < character.meshes[i].submeshes.size(); ++submesh, ++outside)
      if (submesh >= torn.source().meshes[i].submeshes.size())
        outside->color_sets.assign(1, std::vector<Vec4f>(outside->positions.size(), kRim));
  const DepthImage image(torn.source(), untorn, frame, kImageSize);
  std::set<Index> torn_meshes;
  for (const RimEdge& edge : rims) torn_meshes.insert(edge.mesh);
  for (const Index mesh : torn_meshes)
    still.meshes.push_back(
        make_inside(character.meshes[mesh], posed[mesh], closed[mesh], image, frame, thickness));
  still.meshes.push_back(make_rims(character, posed, rims, thickness));
  for (Mesh& mesh : still.meshes) wind_by_normals(mesh);
  return still;
}

void paint(Character& still, const Vec4f& color) {
  for (Mesh& mesh : still.meshes)
    if (mesh.color_sets.empty())
      mesh.color_sets.assign(1, std::vector<Vec4f>(mesh.positions.size(), color));
}

Status draw(const Character& still, const Camera& camera, int width, int height,
            const std::filesystem::path& png) {
  const std::filesystem::path scene = scene_file(png);
  if (const Status status = save_glb(scene, still); !status) return status;
  return render(scene, camera, {width, height}, png);
}

}  // namespace sunder::tools
