// Makes the table of formats in docs/method/io.md: each sample file is read, changed, saved and
// read again, and compared with what assimp itself or, for glTF, the code that generates the sample
// says that it holds. With SUNDER_WRITE_FORMATS=1 the test rewrites the rows of the samples that it
// found.

#include <sunder/io/character_file.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>

#include <assimp/GltfMaterial.h>
#include <assimp/Importer.hpp>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/compressed_gltf.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

/// The range of a stream over all vertices, which does not depend on their order or merging.
class Range {
 public:
  template <class Vector>
  void add(const Vector& value) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double number = i < static_cast<std::size_t>(value.size())
                                ? static_cast<double>(value[static_cast<Eigen::Index>(i)])
                                : 0;
      least_[i] = std::min(least_[i], number);
      largest_[i] = std::max(largest_[i], number);
    }
  }

  [[nodiscard]] bool is_like(const Range& other, double tolerance) const {
    double size = 1e-12;
    for (std::size_t i = 0; i < 4; ++i)
      size = std::max({size, std::abs(least_[i]), std::abs(largest_[i])});
    for (std::size_t i = 0; i < 4; ++i)
      if (!(std::abs(least_[i] - other.least_[i]) <= tolerance * size &&
            std::abs(largest_[i] - other.largest_[i]) <= tolerance * size))
        return false;
    return true;
  }

 private:
  std::array<double, 4> least_ = {1e300, 1e300, 1e300, 1e300},
                        largest_ = {-1e300, -1e300, -1e300, -1e300};
};

/// The parts of a model that a file holds.
struct Facts {
  std::uint64_t triangles = 0;
  Range positions, texture_coordinates, colours;
  std::size_t normals = 0, tangents = 0;  ///< Triangles that have some.
  std::size_t uv_sets = 0, color_sets = 0, influences = 0, morphs = 0, clips = 0, materials = 0,
              textures = 0;  ///< The largest number of a mesh; of the file.
};

/// Triangles whose corners are one point have no surface, and are not written.
template <class Point>
bool is_point(const Point& a, const Point& b, const Point& c) {
  return a == b && b == c;
}

std::size_t triangles_of(const Mesh& mesh) {
  return static_cast<std::size_t>(
      std::ranges::count_if(mesh.triangles, [&](const Triangle& triangle) {
        return !is_point(mesh.positions[triangle[0]], mesh.positions[triangle[1]],
                         mesh.positions[triangle[2]]);
      }));
}

Facts facts_of(const Character& character) {
  Facts facts;
  std::set<std::uint32_t> materials;
  for (const Mesh& mesh : character.meshes) {
    const std::size_t triangles = triangles_of(mesh);
    facts.triangles += triangles;
    if (!mesh.normals.empty()) facts.normals += triangles;
    if (!mesh.tangents.empty()) facts.tangents += triangles;
    for (const Vec3f& position : mesh.positions) facts.positions.add(position);
    for (const auto& uvs : mesh.uv_sets)
      for (const Vec2f& uv : uvs) facts.texture_coordinates.add(uv);
    for (const auto& colours : mesh.color_sets)
      for (const Vec4f& colour : colours) facts.colours.add(colour);
    facts.uv_sets = std::max(facts.uv_sets, mesh.uv_sets.size());
    facts.color_sets = std::max(facts.color_sets, mesh.color_sets.size());
    facts.morphs = std::max(facts.morphs, mesh.morph_targets.size());
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      facts.influences = std::max(facts.influences, mesh.weights.of(v).size());
    for (const Submesh& submesh : mesh.submeshes)
      if (submesh.material != kNone) materials.insert(submesh.material);
  }
  facts.materials = materials.size();
  facts.clips = character.clips.size();
  return facts;
}

/// Facts of an assimp scene, by its own data.
class SceneFacts {
 public:
  SceneFacts(const aiScene& scene, std::filesystem::path folder)
      : scene_(scene), folder_(std::move(folder)) {}

  Facts read() {
    visit(*scene_.mRootNode);
    facts_.materials = materials_.size();
    for (const unsigned material : materials_) add_textures(*scene_.mMaterials[material]);
    facts_.textures = textures_.size();
    for (unsigned i = 0; i < scene_.mNumAnimations; ++i)
      facts_.clips += moves_a_node(*scene_.mAnimations[i]);
    return facts_;
  }

 private:
  void visit(const aiNode& node) {
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene_.mMeshes[node.mMeshes[i]]);
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i]);
  }

  void add(const aiMesh& mesh) {
    std::size_t triangles = 0;
    std::vector<bool> is_used(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;
      const auto position = [&](unsigned corner) { return mesh.mVertices[face.mIndices[corner]]; };
      triangles += !is_point(position(0), position(1), position(2));
      for (unsigned k = 0; k < 3; ++k) is_used[face.mIndices[k]] = true;
    }
    if (triangles == 0) return;
    facts_.triangles += triangles;
    if (mesh.HasNormals()) facts_.normals += triangles;
    if (mesh.HasTangentsAndBitangents()) facts_.tangents += triangles;
    facts_.uv_sets = std::max<std::size_t>(facts_.uv_sets, mesh.GetNumUVChannels());
    facts_.color_sets = std::max<std::size_t>(facts_.color_sets, mesh.GetNumColorChannels());
    facts_.morphs = std::max<std::size_t>(facts_.morphs, mesh.mNumAnimMeshes);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
      if (is_used[v]) add_vertex(mesh, v);
    add_influences(mesh);
    materials_.insert(mesh.mMaterialIndex);
  }

  void add_vertex(const aiMesh& mesh, unsigned v) {
    facts_.positions.add(Vec3f(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z));
    for (unsigned set = 0; set < mesh.GetNumUVChannels(); ++set)  // assimp's v points up
      facts_.texture_coordinates.add(
          Vec2f(mesh.mTextureCoords[set][v].x, 1.0f - mesh.mTextureCoords[set][v].y));
    for (unsigned set = 0; set < mesh.GetNumColorChannels(); ++set) {
      const aiColor4D& colour = mesh.mColors[set][v];
      facts_.colours.add(Vec4f(colour.r, colour.g, colour.b, colour.a));
    }
  }

  void add_influences(const aiMesh& mesh) {
    std::vector<std::set<std::string>> bones(mesh.mNumVertices);
    for (unsigned b = 0; b < mesh.mNumBones; ++b)
      for (unsigned w = 0; w < mesh.mBones[b]->mNumWeights; ++w)
        if (mesh.mBones[b]->mWeights[w].mWeight > 0.0f)
          bones[mesh.mBones[b]->mWeights[w].mVertexId].insert(mesh.mBones[b]->mName.C_Str());
    for (const auto& of_vertex : bones)
      facts_.influences = std::max(facts_.influences, of_vertex.size());
  }

  void add_textures(const aiMaterial& material) {
    for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
      aiString path;
      if (material.GetTexture(type, 0, &path) != aiReturn_SUCCESS || path.length == 0) continue;
      std::string flat = path.C_Str();
      std::replace(flat.begin(), flat.end(), '\\', '/');
      const auto name = std::filesystem::path(flat).filename();
      if (scene_.GetEmbeddedTexture(path.C_Str()) != nullptr ||
          std::filesystem::exists(folder_ / flat) || std::filesystem::exists(folder_ / name))
        textures_.insert(flat);
      return;
    }
  }

  bool moves_a_node(const aiAnimation& clip) const {
    for (unsigned i = 0; i < clip.mNumChannels; ++i)
      if (scene_.mRootNode->FindNode(clip.mChannels[i]->mNodeName) != nullptr) return true;
    return clip.mNumMorphMeshChannels > 0;
  }

  const aiScene& scene_;
  std::filesystem::path folder_;
  Facts facts_;
  std::set<unsigned> materials_;
  std::set<std::string> textures_;
};

std::optional<Facts> facts_by_assimp(const std::filesystem::path& file) {
  Assimp::Importer importer;
  if (importer.ReadFile(file.string(), 0) == nullptr) return {};
  const aiScene* const scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr) return {};
  return SceneFacts(*scene, file.parent_path()).read();
}

/// Images in a GLB.
std::size_t image_count(const std::filesystem::path& glb) {
  const Json json = GltfBuilder::from_glb(read_bytes(glb)).json;
  if (!json.contains("images")) return 0;
  return static_cast<std::size_t>(std::ranges::count_if(
      json["images"], [](const Json& image) { return image.contains("bufferView"); }));
}

using Cells = std::vector<std::string>;

/// One cell per kind of content: kept, lost, part of it, or nothing to keep.
Cells compare(const Facts& expected, const Facts& read, const Facts& again) {
  const auto part = [](std::size_t wanted, std::size_t found) -> std::string {
    if (wanted == 0) return "–";
    if (found >= wanted) return "kept";
    return found == 0 ? "lost" : std::to_string(found) + " of " + std::to_string(wanted);
  };
  const auto count = [&](std::size_t Facts::*member) {
    return part(expected.*member, std::min(read.*member, again.*member));
  };
  const auto stream = [&](std::size_t Facts::*member, Range Facts::*range) {
    const std::string cell = count(member);
    if (cell != "kept") return cell;
    const bool is_same = (expected.*range).is_like(read.*range, 2e-5) &&
                         (expected.*range).is_like(again.*range, 2e-5);
    return is_same ? cell : std::string("changed");
  };
  const bool has_shape = expected.triangles == read.triangles &&
                         expected.triangles == again.triangles &&
                         expected.positions.is_like(read.positions, 2e-5) &&
                         expected.positions.is_like(again.positions, 2e-5);
  return {has_shape ? "kept" : "changed",
          count(&Facts::normals),
          count(&Facts::tangents),
          stream(&Facts::uv_sets, &Facts::texture_coordinates),
          stream(&Facts::color_sets, &Facts::colours),
          count(&Facts::influences),
          count(&Facts::morphs),
          count(&Facts::clips),
          count(&Facts::materials),
          count(&Facts::textures)};
}

/// Reads a file, saves it with every mesh changed, and reads it again.
Cells cells_of(const std::filesystem::path& file, const Facts& expected) {
  const auto loaded = load_character(file);
  EXPECT_TRUE(loaded.has_value()) << file << ": " << loaded.error().text();
  if (!loaded) return {};
  Character changed = *loaded->character;
  for (Mesh& mesh : changed.meshes)  // an attribute more, so that every mesh is written
    mesh.custom_attributes.push_back(
        {"_CHANGED", 1, true, std::vector<float>(mesh.vertex_count(), 1.0f)});
  const TemporaryFolder folder;
  const auto glb = folder.path() / "again.glb";
  const Status saved = save_glb(glb, changed, *loaded);
  EXPECT_TRUE(saved) << file << ": " << saved.text();
  const auto again = load_character(glb);
  EXPECT_TRUE(again.has_value()) << file << ": " << again.error().text();
  if (!again) return {};
  Facts read = facts_of(*loaded->character), reread = facts_of(*again->character);
  read.textures = reread.textures = image_count(glb);
  return compare(expected, read, reread);
}

/// A strip with one of everything that glTF holds, and what it holds.
GltfBuilder full_strip(Facts& facts) {
  GltfBuilder builder = skinned_strip();
  Json& attributes = strip_attributes(builder);
  std::vector<float> tangents, second_uvs, colours;
  for (std::size_t v = 0; v < kStripVertices; ++v) {
    const auto number = static_cast<float>(v);
    tangents.insert(tangents.end(), {1, 0, 0, -1});
    second_uvs.insert(second_uvs.end(), {0.125f * number, 2.0f});
    colours.insert(colours.end(), {0.0625f * number, 0.5f, 1.0f, 0.25f});
    facts.colours.add(Vec4f(0.0625f * number, 0.5f, 1.0f, 0.25f));
    facts.positions.add(Vec3f(static_cast<float>(v % 2), static_cast<float>(v / 2) * 0.5f, 0.0f));
    facts.texture_coordinates.add(Vec2f(0.125f * number, 2.0f));
    facts.texture_coordinates.add(
        Vec2f(static_cast<float>(v % 2), static_cast<float>(v / 2) * 0.25f));
  }
  attributes["TANGENT"] = builder.add(tangents, "VEC4");
  attributes["TEXCOORD_1"] = builder.add(second_uvs, "VEC2");
  attributes["COLOR_0"] = builder.add(colours, "VEC4");
  const std::size_t deltas = builder.add(std::vector<float>(3 * kStripVertices, 0.125f), "VEC3");
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["targets"] = Json::array({{{"POSITION", deltas}}, {{"NORMAL", deltas}}});
  const std::size_t times = builder.add(std::vector<float>{0, 1}, "SCALAR"),
                    values = builder.add(std::vector<float>{0, 0, 0, 0, 1, 0}, "VEC3");
  builder.json["animations"] = {
      {{"name", "up"},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", times}, {"output", values}}}}}};
  const std::string png("\x89PNG\r\n\x1A\n no pixels", 18);
  builder.json["images"] = {
      {{"mimeType", "image/png"},
       {"bufferView", builder.add_view(std::vector<char>(png.begin(), png.end()))}}};
  builder.json["textures"] = {{{"source", 0}}};
  builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  facts.triangles = facts.normals = facts.tangents = 8;
  facts.uv_sets = 2;
  facts.color_sets = 1;
  facts.influences = 2;
  facts.morphs = 2;
  facts.clips = facts.materials = facts.textures = 1;
  return builder;
}

struct Sample {
  std::string format, name;
  std::filesystem::path file;  ///< Empty: absent.
};

constexpr const char* kPackage = "assimp-testmodels: ";
constexpr const char* kShared = "shared: ";
constexpr const char* kOwn = "tests/data/rigged/";

/// The file that a name in the table means; empty if it is not installed.
std::filesystem::path file_named(const std::string& name) {
  const auto below = [&](const std::filesystem::path& folder, const char* prefix) {
    const auto file = folder / name.substr(std::string(prefix).size());
    return !folder.empty() && std::filesystem::exists(file) ? file : std::filesystem::path();
  };
  if (name.starts_with(kPackage)) return below(assimp_models(), kPackage);
  if (name.starts_with(kShared)) return below(shared_models(), kShared);
  return below(own_data() / "rigged", kOwn);
}

std::vector<Sample> samples() {
  const std::vector<std::pair<std::string, std::string>> listed = {
      {"FBX", "shared: rigged/vr_glove.fbx"},
      {"FBX", "shared: rigged/soft_tube_14bones.fbx"},
      {"FBX", "assimp-testmodels: FBX/animation_with_skeleton.fbx"},
      {"FBX", "assimp-testmodels: FBX/phong_cube.fbx"},
      {"COLLADA", "tests/data/rigged/sail.dae"},
      {"COLLADA", "shared: rigged/cesium_man.dae"},
      {"COLLADA", "assimp-testmodels: Collada/cube_with_2UVs.DAE"},
      {"COLLADA", "assimp-testmodels: Collada/kwxport_test_vcolors.dae"},
      {"COLLADA", "assimp-testmodels: Collada/duck.dae"},
      {"DirectX X", "tests/data/rigged/strip.x"},
      {"DirectX X", "shared: rigged/wuson.x"},
      {"DirectX X", "assimp-testmodels: X/test.x"},
      {"DirectX X", "assimp-testmodels: X/kwxport_test_cubewithvcolors.x"},
      {"Blitz 3D", "shared: rigged/minetest_character.b3d"},
      {"Blitz 3D", "assimp-testmodels: B3D/WusonBlitz.b3d"},
      {"Wavefront OBJ", "shared: static/spot.obj"},
      {"Wavefront OBJ", "assimp-testmodels: OBJ/spider.obj"},
      {"Wavefront OBJ", "assimp-testmodels: OBJ/cube_with_vertexcolors.obj"},
      {"PLY", "assimp-testmodels: PLY/cube_uv.ply"},
      {"PLY", "assimp-testmodels: PLY/float-color.ply"},
      {"OFF", "assimp-testmodels: OFF/Wuson.off"},
      {"STL", "assimp-testmodels: STL/Spider_binary.stl"},
      {"3DS", "assimp-testmodels: 3DS/cube_with_diffuse_texture.3DS"},
      {"Milkshape 3D", "assimp-testmodels: MS3D/jeep1.ms3d"},
      {"Doom 3 MD5", "assimp-testmodels: MD5/SimpleCube.md5mesh"},
      {"Valve SMD", "assimp-testmodels: SMD/WusonSMD.smd"},
      {"Inter-Quake IQM", "assimp-testmodels: IQM/mrfixit.iqm"},
      {"Half-Life 1 MDL", "assimp-testmodels: MDL/MDL (HL1)/man.mdl"},
      {"3ds Max ASE", "assimp-testmodels: ASE/ThreeCubesGreen.ASE"},
      {"Caligari COB", "assimp-testmodels: COB/spider_6_6_ascii.cob"}};
  std::vector<Sample> found;
  for (const auto& [format, name] : listed) found.push_back({format, name, file_named(name)});
  return found;
}

std::string row_of(const std::string& format, const std::string& sample, const Cells& cells) {
  std::string row = "| " + format + " | " + sample + " |";
  for (const std::string& cell : cells) row += " " + cell + " |";
  return row;
}

/// The rows of glTF, whose samples are generated.
std::map<std::string, std::string> rows_of_gltf() {
  Facts facts;
  const GltfBuilder full = full_strip(facts);
  Facts without_morphs = facts;
  without_morphs.morphs = 0;
  GltfBuilder without_targets = full;
  without_targets.json["meshes"][0]["primitives"][0].erase("targets");
  const TemporaryFolder folder;
  std::map<std::string, std::string> rows;
  const auto add = [&](const std::string& format, const std::filesystem::path& file,
                       const Facts& expected) {
    const std::string sample = "generated: " + file.filename().string();
    rows[sample] = row_of(format, sample, cells_of(file, expected));
  };
  add("glTF, binary", folder.write("strip.glb", full.glb()), facts);
  add("glTF, text", folder.write("strip.gltf", full.text()), facts);
  add("glTF, meshopt", folder.write("meshopt.glb", packed_by_meshopt(full).glb()), facts);
  add("glTF, Draco sequential", folder.write("draco.glb", packed_by_draco(full, {true, 0}).glb()),
      facts);
  add("glTF, Draco edgebreaker",
      folder.write("edgebreaker.glb", packed_by_draco(without_targets).glb()), without_morphs);
  return rows;
}

/// All rows whose samples are there, by sample.
std::map<std::string, std::string> computed_rows() {
  std::map<std::string, std::string> rows = rows_of_gltf();
  for (const Sample& sample : samples()) {
    if (sample.file.empty()) continue;
    const auto expected = facts_by_assimp(sample.file);
    EXPECT_TRUE(expected) << sample.name << ": assimp does not read it";
    if (expected)
      rows[sample.name] = row_of(sample.format, sample.name, cells_of(sample.file, *expected));
  }
  return rows;
}

constexpr const char* kBegin =
    "<!-- formats: written by tests/acceptance/formats_table_test.cpp -->";
constexpr const char* kEnd = "<!-- end of formats -->";

std::string sample_of_row(const std::string& row) {
  const std::size_t first = row.find('|', 1);
  const std::size_t second = row.find('|', first + 1);
  return second == std::string::npos ? std::string() : row.substr(first + 2, second - first - 3);
}

/// A page, divided at the table's rows.
struct Page {
  std::string before, after;  ///< With the markers and the head of the table.
  std::map<std::string, std::string> rows;

  explicit Page(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string* part = &before;
    for (std::string line; std::getline(stream, line);) {
      if (line == kEnd) part = &after;
      const bool is_row = part == &before && before.find(kBegin) != std::string::npos &&
                          line.starts_with("| ") && !line.starts_with("| format");
      if (is_row)
        rows[sample_of_row(line)] = line;
      else
        part->append(line).append("\n");
    }
  }
};

/// The samples in the order of the table.
std::vector<std::string> order_of_rows() {
  std::vector<std::string> order;
  for (const char* const name :
       {"strip.glb", "strip.gltf", "meshopt.glb", "draco.glb", "edgebreaker.glb"})
    order.push_back(std::string("generated: ") + name);
  for (const Sample& sample : samples()) order.push_back(sample.name);
  return order;
}

TEST(Formats, table_says_what_is_kept) {
  const std::filesystem::path file =
      std::filesystem::path(SUNDER_SOURCE_DIR) / "docs" / "method" / "io.md";
  Page page(file);
  ASSERT_FALSE(page.after.empty()) << "docs/method/io.md has no " << kEnd;
  const auto computed = computed_rows();
  if (std::getenv("SUNDER_WRITE_FORMATS") != nullptr) {
    for (const auto& [sample, row] : computed) page.rows[sample] = row;
    std::ofstream stream(file);
    stream << page.before;
    for (const std::string& sample : order_of_rows())
      if (const auto row = page.rows.find(sample); row != page.rows.end())
        stream << row->second << '\n';
    stream << page.after;
  }
  for (const auto& [sample, row] : computed) EXPECT_EQ(page.rows[sample], row);
  const std::vector<std::string> known = order_of_rows();
  for (const auto& [sample, row] : page.rows)
    EXPECT_NE(std::ranges::find(known, sample), known.end()) << "no sample of the test: " << row;
}

}  // namespace
}  // namespace sunder::test
