#include "io/gltf_read/primitives.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

constexpr std::uint64_t kTriangles = 4, kStrip = 5, kFan = 6;
/// Bytes for a primitive's names and lists, apart from its data.
constexpr std::uint64_t kPrimitiveMemory = 500;

/// The accessors of a primitive's vertices; equal keys mean equal vertices.
using VertexKey = std::vector<std::map<std::string, std::uint64_t>>;

/// Other attributes are not allowed, and ignored.
bool is_attribute(std::string_view name) {
  if (name.starts_with('_') || name == "POSITION" || name == "NORMAL" || name == "TANGENT")
    return true;
  return name.starts_with("TEXCOORD_") || name.starts_with("COLOR_") ||
         name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
}

VertexKey vertex_key(const Cursor& primitive) {
  const auto accessors_of = [](const Cursor& attributes) {
    std::map<std::string, std::uint64_t> accessors;
    for (const auto& item : attributes.json().items())
      if (is_attribute(item.key()))
        accessors[item.key()] =
            Cursor(item.value(), attributes.pointer() + "/" + item.key()).to_unsigned();
    return accessors;
  };
  VertexKey key = {accessors_of(primitive.member("attributes"))};
  if (const auto targets = primitive.find("targets"))
    for (std::size_t i = 0; i < targets->size(); ++i)
      key.push_back(accessors_of(targets->element(i)));
  return key;
}

std::vector<std::uint32_t> read_indices(Reading& reading, const Cursor& primitive,
                                        std::uint32_t vertex_count) {
  if (const auto at = primitive.find("indices")) {
    const Accessor accessor = reading.accessors.open(*at);
    if (accessor.components != 1 || accessor.normalized)
      refuse(StatusCode::malformed_file, accessor.index, "%s: indices must be unsigned scalars",
             at->pointer().c_str());
    return reading.accessors.read_unsigned(accessor);
  }
  reading.accessors.charge(std::uint64_t{vertex_count} * sizeof(std::uint32_t),
                           primitive.pointer());
  std::vector<std::uint32_t> indices(vertex_count);
  std::iota(indices.begin(), indices.end(), 0u);
  return indices;
}

std::vector<Triangle> assemble(const std::vector<std::uint32_t>& indices, std::uint64_t mode) {
  std::vector<Triangle> triangles;
  if (mode == kTriangles) {
    triangles.resize(indices.size() / 3);
    if (!triangles.empty())
      std::memcpy(triangles.data(), indices.data(), triangles.size() * sizeof(Triangle));
    return triangles;
  }
  for (std::size_t i = 0; i + 3 <= indices.size(); ++i) {
    Triangle triangle = {indices[i + 1], indices[i + 2], indices[0]};
    if (mode == kStrip) triangle = {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]};
    const auto [a, b, c] = triangle;
    // A repeated index in a strip only connects it to its next part.
    if (a != b && b != c && c != a) triangles.push_back(triangle);
  }
  return triangles;
}

}  // namespace

std::vector<PrimitiveGroup> group_primitives(Reading& reading, const Cursor& mesh) {
  std::vector<PrimitiveGroup> groups;
  std::map<VertexKey, std::size_t> group_of_key;
  const Cursor primitives = mesh.member("primitives");
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    const Cursor primitive = primitives.element(i);
    const std::uint64_t mode = primitive.unsigned_or("mode", kTriangles);
    if (mode > kFan)
      refuse(StatusCode::malformed_file, i, "%s/mode: %llu; expected 0 to 6",
             primitive.pointer().c_str(), static_cast<unsigned long long>(mode));
    if (mode < kTriangles) {
      reading.notes.dropped(StatusCode::unsupported_feature, i, primitive.pointer(),
                            "points and lines are not loaded; they stay in the file");
      continue;
    }
    reading.accessors.charge(kPrimitiveMemory, primitive.pointer());
    const VertexKey key = vertex_key(primitive);
    if (key.front().count("POSITION") == 0) {
      reading.notes.dropped(StatusCode::malformed_file, i, primitive.pointer(),
                            "the primitive has no positions");
      continue;
    }
    const auto [found, is_new] = group_of_key.try_emplace(key, groups.size());
    if (is_new) groups.emplace_back();
    groups[found->second].primitives.push_back(i);
  }
  return groups;
}

ReadTriangles read_triangles(Reading& reading, const Cursor& primitive,
                             std::uint32_t vertex_count) {
  const std::uint64_t mode = primitive.unsigned_or("mode", kTriangles);
  const std::vector<std::uint32_t> indices = read_indices(reading, primitive, vertex_count);
  ReadTriangles result;
  if (mode == kTriangles && indices.size() % 3 != 0) {
    reading.notes.dropped(StatusCode::malformed_file, kNone, primitive.pointer(),
                          "the last triangle is incomplete");
    result.repaired = true;
  }
  const std::uint64_t most = mode == kTriangles ? indices.size() / 3 : indices.size();
  reading.accessors.charge(most * (2 * sizeof(Triangle) + sizeof(std::uint32_t)),
                           primitive.pointer());
  result.triangles = assemble(indices, mode);
  const auto out_of_range = [&](const Triangle& triangle) {
    return std::any_of(triangle.begin(), triangle.end(),
                       [&](std::uint32_t vertex) { return vertex >= vertex_count; });
  };
  const auto first_bad =
      std::find_if(result.triangles.begin(), result.triangles.end(), out_of_range);
  if (first_bad == result.triangles.end()) return result;
  const auto index = static_cast<std::uint32_t>(first_bad - result.triangles.begin());
  const std::size_t before = result.triangles.size();
  std::erase_if(result.triangles, out_of_range);
  reading.notes.dropped(StatusCode::index_out_of_range, index, primitive.pointer(),
                        "triangles refer to vertices that do not exist (first: triangle " +
                            std::to_string(index) + ")",
                        static_cast<std::uint32_t>(before - result.triangles.size()));
  result.repaired = true;
  return result;
}

}  // namespace sunder::gltf
