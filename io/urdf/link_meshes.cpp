#include "io/urdf/link_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "io/urdf/materials.h"
#include "io/urdf/merge_mesh.h"
#include "io/urdf/mesh_files.h"
#include "io/urdf/mesh_paths.h"
#include "io/urdf/solids.h"

namespace sunder::urdf {
namespace {

/// Few robots have a part of this size, and most meshes in millimetres have.
constexpr double kHuge = 10.0;

std::vector<std::filesystem::path> all_roots(const RobotLoadOptions& options) {
  std::vector<std::filesystem::path> roots = options.package_roots;
  roots.insert(roots.end(), options.meshes.roots.begin(), options.meshes.roots.end());
  return roots;
}

bool has_visuals(const RobotTags& tags) {
  return std::any_of(tags.links.begin(), tags.links.end(),
                     [](const LinkTag& link) { return !link.visuals.empty(); });
}

/// The larger of the sides of the box around a mesh.
double extent_of(const Mesh& mesh) {
  constexpr float kMost = std::numeric_limits<float>::max();
  Vec3f least = Vec3f::Constant(kMost), most = Vec3f::Constant(-kMost);
  for (const Vec3f& position : mesh.positions) {
    least = least.cwiseMin(position);
    most = most.cwiseMax(position);
  }
  return mesh.positions.empty() ? 0.0 : static_cast<double>(Vec3f(most - least).maxCoeff());
}

bool is_finite(const Mesh& mesh) {
  return std::all_of(mesh.positions.begin(), mesh.positions.end(),
                     [](const Vec3f& position) { return position.allFinite(); });
}

/// Bytes of a mesh in memory, for the limit.
std::uint64_t bytes_of(const Mesh& mesh) {
  const std::uint64_t per_vertex = 2 * sizeof(Vec3f) + mesh.uv_sets.size() * sizeof(Vec2f) +
                                   mesh.color_sets.size() * sizeof(Vec4f);
  return mesh.positions.size() * per_vertex + mesh.triangles.size() * sizeof(Triangle);
}

class ShapeReader {
 public:
  ShapeReader(const std::filesystem::path& file, const RobotLoadOptions& options,
              const RobotTags& tags, Findings& findings)
      : findings_(findings),
        paths_(file, all_roots(options)),
        materials_(tags),
        files_(paths_, options, materials_),
        options_(options.meshes) {
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    bytes_of_text_ = error ? 0 : size;
  }

  /// Appends a shape to the mesh of its link.
  void add(const ShapeTag& shape, const Affine3d& link_from_shape, const LinkTag& link,
           Mesh& into) {
    const Place place = {place_of(link).name, shape.line};
    Affine3d link_from_mesh = link_from_shape;
    std::optional<Mesh> made;
    const Mesh* mesh = nullptr;
    if (shape.mesh)
      mesh = mesh_of_file(shape, place, link_from_mesh);
    else if ((made = solid(shape, place)))
      mesh = &*made;
    if (mesh == nullptr || mesh->triangles.empty() || !has_room(bytes_of(*mesh), place)) return;
    Mesh moved;
    append_mesh(moved, *mesh, link_from_mesh);
    for (Submesh& submesh : moved.submeshes)
      if (submesh.material == kNone)
        submesh.material = materials_.of_shape(shape, place, findings_);
    if (!check(moved, shape, place)) return;
    append_mesh(into, moved, Affine3d::Identity());
  }

  [[nodiscard]] const gltf::NewMaterials& materials() const { return materials_.all(); }

 private:
  /// A small text can show one mesh very often, so what all shapes take is limited by the files.
  bool has_room(std::uint64_t bytes, const Place& place) {
    constexpr std::uint64_t kLeast = std::uint64_t{64} << 20, kTimes = 20;
    const std::uint64_t most = options_.maximum_memory != 0
                                   ? options_.maximum_memory
                                   : std::max(kLeast, kTimes * (bytes_of_text_ + files_.bytes()));
    if (bytes <= most - std::min(most, bytes_used_)) {
      bytes_used_ += bytes;
      return true;
    }
    findings_.add("shapes_too_large", place,
                  "the shapes of all links exceed " + std::to_string(most >> 20) +
                      " MiB (LoadOptions::maximum_memory)");
    return false;
  }

  const Mesh* mesh_of_file(const ShapeTag& shape, const Place& place, Affine3d& link_from_mesh) {
    const Numbers3& scale = shape.mesh->scale;
    if (scale[0] == 0 || scale[1] == 0 || scale[2] == 0) {
      findings_.add("mesh_scale_zero", place, "the scale of its mesh is zero; it is left out");
      return nullptr;
    }
    const auto file = paths_.find(shape.mesh->filename, place, findings_);
    if (!file) return nullptr;
    link_from_mesh.linear() *= Vec3d(scale[0], scale[1], scale[2]).asDiagonal();
    return &files_.read(*file, place, findings_).mesh;
  }

  std::optional<Mesh> solid(const ShapeTag& shape, const Place& place) {
    double least = 0;
    if (shape.box) least = *std::min_element(shape.box->size.begin(), shape.box->size.end());
    if (shape.cylinder) least = std::min(shape.cylinder->radius, shape.cylinder->length);
    if (shape.sphere) least = shape.sphere->radius;
    // Below the range of single precision, in which vertices are, all of them would be at one
    // place.
    if (std::abs(least) < static_cast<double>(std::numeric_limits<float>::min())) {
      findings_.add("geometry_empty", place, "a size of its geometry is 0; it is left out");
      return std::nullopt;
    }
    if (!(least > 0)) {
      findings_.add("geometry_size", place, "a size of its geometry is negative; it is left out");
      return std::nullopt;
    }
    if (shape.box) return box_mesh(*shape.box);
    if (shape.cylinder) return cylinder_mesh(*shape.cylinder);
    return sphere_mesh(*shape.sphere);
  }

  bool check(const Mesh& mesh, const ShapeTag& shape, const Place& place) {
    if (!is_finite(mesh)) {
      findings_.add("geometry_size", place,
                    "its geometry is beyond the range of numbers; it is left out");
      return false;
    }
    const double extent = extent_of(mesh);
    if (shape.mesh && extent > kHuge) {
      char metres[32];
      std::snprintf(metres, sizeof metres, "%.4g", extent);
      findings_.add("mesh_huge", place,
                    "mesh '" + shape.mesh->filename.substr(0, 120) + "' is " + metres +
                        " m long; if it is in millimetres, it needs scale=\"0.001 0.001 0.001\"");
    }
    return true;
  }

  Findings& findings_;
  MeshPaths paths_;
  Materials materials_;
  MeshFiles files_;
  const LoadOptions& options_;
  std::uint64_t bytes_of_text_ = 0, bytes_used_ = 0;
};

}  // namespace

LinkMeshes read_link_meshes(const std::filesystem::path& file, const RobotLoadOptions& options,
                            const RobotTags& tags, const ParsedRobot& parsed, const LinkTree& tree,
                            Findings& findings) {
  LinkMeshes result;
  result.of_link.resize(tree.links.size());
  if (options.shapes == RobotShapes::none) return result;
  const bool shows_collision =
      options.shapes == RobotShapes::collision ||
      (options.shapes == RobotShapes::visual_or_collision && !has_visuals(tags));
  ShapeReader reader(file, options, tags, findings);
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const LinkTag& link = tags.links[tree.links[i]];
    const ParsedRobot::Link& origins = parsed.links[tree.links[i]];
    const std::vector<ShapeTag>& shapes = shows_collision ? link.collisions : link.visuals;
    const std::vector<Affine3d>& link_from_shape =
        shows_collision ? origins.link_from_collision : origins.link_from_visual;
    for (std::size_t k = 0; k < shapes.size() && k < link_from_shape.size(); ++k)
      reader.add(shapes[k], link_from_shape[k], link, result.of_link[i]);
  }
  result.materials = reader.materials();
  return result;
}

}  // namespace sunder::urdf
