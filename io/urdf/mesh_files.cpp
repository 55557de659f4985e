#include "io/urdf/mesh_files.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include "io/files/read_file.h"
#include "io/internal/base_colours.h"
#include "io/internal/lower_extension.h"
#include "io/urdf/merge_mesh.h"

namespace sunder::urdf {

namespace fs = std::filesystem;

namespace {

/// assimp's name for the material of a file that has none.
constexpr std::string_view kNoMaterial = "DefaultMaterial";
constexpr std::uint64_t kMaximumImageBytes = std::uint64_t{256} << 20;

/// The up axis of a COLLADA file, 'X', 'Y' or 'Z'; y is COLLADA's default.
char collada_up_axis(const fs::path& file) {
  const std::string head = files::read_head(file, std::size_t{256} << 10);
  constexpr std::string_view kTag = "<up_axis>";
  const std::size_t at = head.find(kTag);
  if (at == std::string::npos) return 'Y';
  const std::size_t letter = head.find_first_not_of(" \t\r\n", at + kTag.size());
  return letter != std::string::npos && (head[letter] == 'X' || head[letter] == 'Z') ? head[letter]
                                                                                     : 'Y';
}

/// From the space in which assimp gives a COLLADA file, whose y axis is up, to that of the file.
Mat3d file_from_y_up(char up_axis) {
  Mat3d turn = Mat3d::Identity();
  if (up_axis == 'Z') turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // y_up = (x, z, -y)
  if (up_axis == 'X') turn << 0, 1, 0, -1, 0, 0, 0, 0, 1;  // y_up = (-y, x, z)
  return turn;
}

Affine3d matrix_of(const BoneTransform& transform) {
  Affine3d matrix = Affine3d::Identity();
  matrix.linear() = transform.rotation.cast<double>().normalized().toRotationMatrix() *
                    transform.scale.cast<double>().asDiagonal();
  matrix.translation() = transform.translation.cast<double>();
  return matrix;
}

std::vector<Affine3d> rest_pose(const Skeleton& skeleton) {
  std::vector<Affine3d> model_from_bone;
  for (const Bone& bone : skeleton.bones) {
    const Affine3d own = matrix_of(bone.rest);
    model_from_bone.push_back(bone.parent == kNone ? own
                                                   : Affine3d(model_from_bone[bone.parent] * own));
  }
  return model_from_bone;
}

/// Some formats can store skinned meshes; a robot shows them in their rest pose.
Mesh posed(const Mesh& mesh, const Skin& skin, const std::vector<Affine3d>& model_from_bone) {
  std::vector<Affine3d> palette;
  for (std::size_t slot = 0; slot < skin.bones.size(); ++slot)
    palette.push_back(model_from_bone[skin.bones[slot]] * skin.bone_from_bind[slot].cast<double>());
  Mesh result = mesh;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    Vec3d position = Vec3d::Zero(), normal = Vec3d::Zero();
    for (const Influence& influence : mesh.weights.of(v)) {
      const Affine3d& matrix = palette[influence.slot];
      position += influence.weight * (matrix * mesh.positions[v].cast<double>());
      if (!mesh.normals.empty())
        normal += influence.weight * (matrix.linear() * mesh.normals[v].cast<double>());
    }
    result.positions[v] = position.cast<float>();
    if (!mesh.normals.empty() && normal.norm() > 0)
      result.normals[v] = normal.normalized().cast<float>();
  }
  return result;
}

/// A rigid mesh without its bone's transform, which append_mesh() applies exactly.
bool is_rigid(const Skin& skin) { return skin.bones.size() == 1; }

Mesh joined(const Character& character, const Affine3d& file_from_model) {
  const std::vector<Affine3d> model_from_bone = rest_pose(character.skeleton);
  Mesh all;
  for (const Mesh& mesh : character.meshes) {
    const Skin& skin = character.skins[mesh.skin];
    if (!is_rigid(skin)) {
      append_mesh(all, posed(mesh, skin, model_from_bone), file_from_model);
      continue;
    }
    const Affine3d file_from_bind =
        file_from_model * model_from_bone[skin.bones[0]] * skin.bone_from_bind[0].cast<double>();
    if (std::abs(file_from_bind.linear().determinant()) > 0) append_mesh(all, mesh, file_from_bind);
  }
  return all;
}

bool is_change(const LoadNote& note) {
  return note.kind == LoadNote::Kind::repaired || note.kind == LoadNote::Kind::dropped;
}

/// The first repair or loss that the importer reports, and the number of the others.
std::string repairs(const LoadReport& report) {
  std::string first;
  std::size_t count = 0;
  for (const LoadNote& note : report.notes)
    if (is_change(note) && count++ == 0) first = note.text;
  if (count > 1) first += ", and " + std::to_string(count - 1) + " more";
  return first;
}

std::vector<std::string> names_of_materials(const Character& character, std::size_t count) {
  std::vector<std::string> names(count);
  for (const Mesh& mesh : character.meshes)
    for (const Submesh& submesh : mesh.submeshes)
      if (submesh.material < count) names[submesh.material] = submesh.name;
  return names;
}

bool has_own_materials(const std::string& extension, const Character& character) {
  if (extension == ".stl") return false;
  for (const Mesh& mesh : character.meshes)
    for (const Submesh& submesh : mesh.submeshes)
      if (submesh.material != kNone && submesh.name != kNoMaterial) return true;
  return false;
}

}  // namespace

const MeshFile& MeshFiles::read(const fs::path& file, const Place& place, Findings& findings) {
  const auto known = files_.find(file);
  if (known != files_.end()) return known->second;
  return files_.emplace(file, load(file, place, findings)).first->second;
}

void MeshFiles::warn_of_filter(const LoadReport& report, const Place& place, Findings& findings) {
  for (const LoadNote& note : report.notes) {
    if (note.kind != LoadNote::Kind::warning || has_told_filter_) continue;
    findings.add("import_unfiltered", place, note.text);
    has_told_filter_ = true;
  }
}

MeshFile MeshFiles::load(const fs::path& file, const Place& place, Findings& findings) {
  const std::string name = "'" + file.filename().string() + "'";
  const std::string extension = lower_extension(file);
  const auto unreadable = [&](const std::string& why) {
    findings.add("mesh_unreadable", place,
                 "mesh " + name + " cannot be read: " + why + "; the link stays without it");
    return MeshFile{};
  };
  if (extension == ".urdf" || extension == ".xacro") return unreadable("it is a robot");
  LoadOptions options = options_.meshes;
  options.strict = options_.strict;
  options.keep_stored_influences = false;
  options.roots = paths_.folders();
  const Result<LoadedCharacter> loaded = load_character(file, options);
  if (!loaded) return unreadable(std::string(loaded.error().text()));
  std::error_code error;
  if (const auto size = fs::file_size(file, error); !error) bytes_ += size;
  warn_of_filter(loaded->report, place, findings);
  if (const std::string text = repairs(loaded->report); !text.empty())
    findings.add("mesh_repaired", place, "mesh " + name + ": " + text);

  Affine3d file_from_model = Affine3d::Identity();
  if (extension == ".dae") {
    const char up = collada_up_axis(file);
    if (!options_.applies_collada_up_axis) {
      file_from_model.linear() = file_from_y_up(up);
      if (up != 'Z' && !has_told_up_axis_) {
        findings.add("collada_up_axis", place,
                     "mesh " + name + " says that " + up +
                         " is up; as in RViz and Gazebo, the "
                         "axes of meshes are taken as they are");
        has_told_up_axis_ = true;
      }
    } else {
      file_from_model.linear() = file_from_y_up('Z');
    }
  }
  MeshFile read;
  read.mesh = joined(*loaded->character, file_from_model);
  read.has_own_materials = has_own_materials(extension, *loaded->character);
  std::uint32_t first = kNone;
  if (read.has_own_materials && loaded->source != nullptr)
    if (const auto colours = read_base_colours(*loaded->source, kMaximumImageBytes); colours)
      first = materials_.add(*colours,
                             names_of_materials(*loaded->character, colours->materials.size()));
  for (Submesh& submesh : read.mesh.submeshes)
    submesh.material =
        first == kNone || submesh.material == kNone ? kNone : first + submesh.material;
  read.has_own_materials = first != kNone;
  return read;
}

}  // namespace sunder::urdf
