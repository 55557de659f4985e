#include "support/models/random_document.h"

#include <cmath>
#include <cstring>
#include <string>

namespace sunder::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kJoints = 3;

template <class T>
void append(Bytes& bytes, const T* values, std::size_t count) {
  const std::size_t before = bytes.size();
  bytes.resize(before + count * sizeof(T));
  std::memcpy(bytes.data() + before, values, count * sizeof(T));
}

/// A vertex attribute: packed elements of some bytes.
struct Attribute {
  std::string name;
  Json accessor;  ///< Without a view.
  std::size_t element = 0;
  Bytes bytes;
};

template <class T>
Attribute attribute(const std::string& name, const std::vector<T>& values, const char* type,
                    std::size_t components, int component_type, bool normalized = false) {
  Attribute made{name, {}, components * sizeof(T), {}};
  made.accessor = {
      {"componentType", component_type}, {"count", values.size() / components}, {"type", type}};
  if (normalized) made.accessor["normalized"] = true;
  append(made.bytes, values.data(), values.size());
  return made;
}

class Maker {
 public:
  explicit Maker(Random& random) : random_(random) {}

  RandomDocument make() {
    json()["nodes"] = Json::array();
    json()["meshes"] = Json::array();
    json()["scenes"] = {{{"nodes", Json::array()}}};
    json()["scene"] = 0;
    add_joints();
    const std::size_t meshes = 2 + random_.index(4);
    for (std::size_t i = 0; i < meshes; ++i) add_mesh(i);
    if (by_chance(2)) add_unused();
    if (by_chance(2)) add_image();
    add_animations();
    if (by_chance(3)) add_instances();
    finish_shared(packed_, 0);
    finish_shared(interleaved_, kStride);
    if (by_chance(2)) add_unused();
    if (by_chance(3)) add_foreign();
    if (by_chance(3)) add_vrm();
    return std::move(made_);
  }

 private:
  /// Data that several accessors share, until it becomes a view.
  struct Shared {
    Bytes bytes;
    std::vector<std::pair<std::size_t, std::size_t>> offset_of_accessor;
  };
  static constexpr std::size_t kStride = 60;

  Json& json() { return made_.builder.json; }
  bool by_chance(std::uint32_t of) { return random_.index(of) == 0; }
  float number() { return static_cast<float>(random_.uniform(-1, 1)); }

  void add_joints() {
    std::vector<float> binds;
    for (std::size_t i = 0; i < kJoints; ++i) {
      Json node = {{"name", "joint" + std::to_string(i)},
                   {"translation", {0.0, i == 0 ? 0 : 1, 0.0}}};
      if (i + 1 < kJoints) node["children"] = {i + 1};
      json()["nodes"].push_back(node);
      for (int k = 0; k < 16; ++k)
        binds.push_back(k % 5 == 0 ? 1.0f : k == 13 ? -static_cast<float>(i) : 0.0f);
    }
    json()["scenes"][0]["nodes"].push_back(0);
    json()["skins"] = Json::array();
    for (int i = 0; i < 2; ++i)
      json()["skins"].push_back(
          {{"joints", {0, 1, 2}}, {"inverseBindMatrices", made_.builder.add(binds, "MAT4")}});
  }

  std::vector<float> numbers(std::size_t count) {
    std::vector<float> values(count);
    for (float& value : values) value = number();
    return values;
  }

  std::vector<Attribute> attributes_of(std::size_t vertices, bool is_interleaved) {
    std::vector<float> positions = numbers(3 * vertices), normals, weights;
    std::vector<std::uint8_t> joints;
    for (std::size_t v = 0; v < vertices; ++v) {
      const Vec3d normal = random_.direction();
      for (int k = 0; k < 3; ++k) normals.push_back(static_cast<float>(normal[k]));
      const float share = static_cast<float>(1 + random_.index(7)) / 8;
      weights.insert(weights.end(), {share, 1 - share, 0, 0});
      joints.insert(joints.end(), {static_cast<std::uint8_t>(random_.index(2)), 2, 0, 0});
    }
    std::vector<Attribute> made = {attribute("POSITION", positions, "VEC3", 3, 5126),
                                   attribute("NORMAL", normals, "VEC3", 3, 5126),
                                   attribute("JOINTS_0", joints, "VEC4", 4, 5121),
                                   attribute("WEIGHTS_0", weights, "VEC4", 4, 5126)};
    set_bounds(made[0].accessor, positions);
    if (!is_interleaved && by_chance(2)) {
      std::vector<std::uint16_t> uvs(2 * vertices);
      for (std::uint16_t& uv : uvs) uv = static_cast<std::uint16_t>(random_.index(65536));
      made.push_back(attribute("TEXCOORD_0", uvs, "VEC2", 2, 5123, true));
    } else {
      made.push_back(attribute("TEXCOORD_0", numbers(2 * vertices), "VEC2", 2, 5126));
    }
    return made;
  }

  static void set_bounds(Json& accessor, const std::vector<float>& positions) {
    for (std::size_t c = 0; c < 3; ++c) {
      float least = positions[c], greatest = positions[c];
      for (std::size_t i = c; i < positions.size(); i += 3) {
        least = std::min(least, positions[i]);
        greatest = std::max(greatest, positions[i]);
      }
      accessor["min"].push_back(static_cast<double>(least));
      accessor["max"].push_back(static_cast<double>(greatest));
    }
  }

  std::size_t add_accessor(Json accessor) {
    json()["accessors"].push_back(std::move(accessor));
    return json()["accessors"].size() - 1;
  }

  std::size_t add_own(Attribute data) {
    data.accessor["bufferView"] = made_.builder.add_view(data.bytes);
    return add_accessor(std::move(data.accessor));
  }

  std::size_t add_packed(Attribute data) {
    packed_.bytes.resize((packed_.bytes.size() + 3) / 4 * 4);
    const std::size_t accessor = add_accessor(std::move(data.accessor));
    packed_.offset_of_accessor.emplace_back(accessor, packed_.bytes.size());
    packed_.bytes.insert(packed_.bytes.end(), data.bytes.begin(), data.bytes.end());
    return accessor;
  }

  Json add_interleaved(const std::vector<Attribute>& attributes, std::size_t vertices) {
    const std::size_t first = interleaved_.bytes.size();
    interleaved_.bytes.resize(first + vertices * kStride, 0xEE);
    Json references;
    std::size_t column = 0;
    for (const Attribute& data : attributes) {
      for (std::size_t v = 0; v < vertices; ++v)
        std::memcpy(interleaved_.bytes.data() + first + v * kStride + column,
                    data.bytes.data() + v * data.element, data.element);
      const std::size_t accessor = add_accessor(data.accessor);
      interleaved_.offset_of_accessor.emplace_back(accessor, first + column);
      references[data.name] = accessor;
      column += data.element;
    }
    return references;
  }

  void finish_shared(const Shared& shared, std::size_t stride) {
    if (shared.bytes.empty()) return;
    const std::size_t view = made_.builder.add_view(shared.bytes);
    if (stride != 0) json()["bufferViews"][view]["byteStride"] = stride;
    for (const auto& [accessor, offset] : shared.offset_of_accessor) {
      json()["accessors"][accessor]["bufferView"] = view;
      if (offset != 0) json()["accessors"][accessor]["byteOffset"] = offset;
    }
  }

  /// A few deltas in a base of zeros.
  std::size_t add_sparse(std::size_t vertices) {
    const std::vector<float> deltas = {0.25f, 0.5f, -0.25f, 0.125f, 0.0f, 1.0f};
    const std::vector<std::uint16_t> indices = {1, static_cast<std::uint16_t>(vertices - 1)};
    Json accessor = {{"componentType", 5126},
                     {"count", vertices},
                     {"type", "VEC3"},
                     {"min", {0, 0, -0.25}},
                     {"max", {0.25, 0.5, 1}}};
    accessor["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", made_.builder.add_view(indices)}, {"componentType", 5123}}},
        {"values", {{"bufferView", made_.builder.add_view(deltas)}}}};
    return add_accessor(std::move(accessor));
  }

  void add_mesh(std::size_t number) {
    // No two meshes have the same number of vertices, by which tests know them.
    const std::size_t rows = 2 + 5 * number + random_.index(5), vertices = 2 * rows;
    const std::uint32_t layout = random_.index(3);
    const std::vector<Attribute> data = attributes_of(vertices, layout == 2);
    Json attributes;
    if (layout == 2)
      attributes = add_interleaved(data, vertices);
    else
      for (const Attribute& one : data)
        attributes[one.name] = layout == 0 ? add_own(one) : add_packed(one);
    std::vector<std::uint16_t> indices;
    for (std::size_t row = 0; row + 1 < rows; ++row)
      for (const std::size_t offset : {0, 1, 2, 1, 3, 2})
        indices.push_back(static_cast<std::uint16_t>(2 * row + offset));
    Json primitive = {{"attributes", attributes}};
    Attribute corners = attribute("", indices, "SCALAR", 1, 5123);
    primitive["indices"] = by_chance(2) ? add_packed(corners) : add_own(corners);
    if (by_chance(2)) primitive["targets"] = {{{"POSITION", add_sparse(vertices)}}};
    json()["meshes"].push_back(
        {{"name", "mesh" + std::to_string(number)}, {"primitives", Json::array({primitive})}});
    const std::size_t users = 1 + (by_chance(4) ? 1 : 0);
    for (std::size_t i = 0; i < users; ++i) {
      json()["scenes"][0]["nodes"].push_back(json()["nodes"].size());
      made_.mesh_nodes.push_back(json()["nodes"].size());
      json()["nodes"].push_back({{"name", "body" + std::to_string(number) + std::to_string(i)},
                                 {"mesh", number},
                                 {"skin", random_.index(2)}});
    }
  }

  void add_unused() {
    add_own(attribute("", numbers(random_.index(9) + 1), "SCALAR", 1, 5126));
    made_.builder.add_view(Bytes(1 + random_.index(13), 0xDD));
  }

  void add_image() {
    constexpr std::uint8_t kPixel[] = {
        0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0,    0,    0,    0x0D, 0x49, 0x48,
        0x44, 0x52, 0,    0,    0,    1,    0,    0,    0,    1,    8,    0,    0,    0,
        0,    0x3A, 0x7E, 0x9B, 0x55, 0,    0,    0,    0x0A, 0x49, 0x44, 0x41, 0x54, 0x78,
        0x9C, 0x63, 0xF8, 0x0F, 0,    1,    1,    1,    0,    0x1B, 0xB6, 0xEE, 0x56, 0,
        0,    0,    0,    0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};
    json()["images"] = {
        {{"bufferView", made_.builder.add_view(Bytes(std::begin(kPixel), std::end(kPixel)))},
         {"mimeType", "image/png"}}};
    json()["textures"] = {{{"source", 0}}};
    json()["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    for (Json& mesh : json()["meshes"]) mesh["primitives"][0]["material"] = 0;
  }

  void add_animations() {
    const std::size_t count = random_.index(3);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t keys = 2 + random_.index(6);
      std::vector<float> times(keys);
      for (std::size_t k = 0; k < keys; ++k) times[k] = static_cast<float>(k) / 4;
      Attribute input = attribute("", times, "SCALAR", 1, 5126);
      input.accessor["min"] = {0.0};
      input.accessor["max"] = {static_cast<double>(times.back())};
      const std::size_t shared_times = by_chance(2) ? add_packed(input) : add_own(input);
      Json animation = {{"name", "clip" + std::to_string(i)},
                        {"samplers", Json::array()},
                        {"channels", Json::array()}};
      for (std::size_t joint = 0; joint < kJoints; ++joint) {
        Attribute output = attribute("", numbers(3 * keys), "VEC3", 3, 5126);
        animation["samplers"].push_back(
            {{"input", shared_times},
             {"output", by_chance(2) ? add_packed(output) : add_own(output)}});
        animation["channels"].push_back(
            {{"sampler", joint}, {"target", {{"node", joint}, {"path", "translation"}}}});
      }
      if (!json().contains("animations")) json()["animations"] = Json::array();
      json()["animations"].push_back(std::move(animation));
    }
  }

  void add_instances() {
    const std::size_t accessor = add_own(attribute("", numbers(12), "VEC3", 3, 5126));
    json()["nodes"][made_.mesh_nodes[0]]["extensions"]["EXT_mesh_gpu_instancing"] = {
        {"attributes", {{"TRANSLATION", accessor}}}};
    use_extension("EXT_mesh_gpu_instancing");
  }

  void use_extension(const char* name) { json()["extensionsUsed"].push_back(name); }

  void add_foreign() {
    const auto accessors = static_cast<std::uint32_t>(json()["accessors"].size()),
               views = static_cast<std::uint32_t>(json()["bufferViews"].size());
    made_.foreign_accessors = {random_.index(accessors), random_.index(accessors)};
    made_.foreign_views = {random_.index(views)};
    json()["extensions"]["ACME_sensors"] = {{"series", made_.foreign_accessors},
                                            {"blob", {{"bufferView", made_.foreign_views[0]}}}};
    use_extension("ACME_sensors");
  }

  void add_vrm() {
    made_.has_vrm = true;
    Json annotations = Json::array();
    for (std::size_t i = 0; i < json()["meshes"].size(); ++i)
      annotations.push_back({{"mesh", i}, {"firstPersonFlag", "Auto"}});
    json()["extensions"]["VRM"]["firstPerson"]["meshAnnotations"] = annotations;
    use_extension("VRM");
  }

  Random& random_;
  RandomDocument made_;
  Shared packed_, interleaved_;
};

}  // namespace

RandomDocument random_document(Random& random) { return Maker(random).make(); }

}  // namespace sunder::test
