#include "support/oracles/glb_contents.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>

namespace sunder::test {
namespace {

using Json = nlohmann::ordered_json;

std::size_t bytes_of(int type) { return type < 5122 ? 1 : type < 5124 ? 2 : 4; }

std::size_t components_of(const Json& accessor) {
  static const std::map<std::string, std::size_t> kComponents = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  return kComponents.at(accessor["type"].get<std::string>());
}

std::size_t number(const Json& object, const char* name) {
  return object.value(name, std::size_t{0});
}

}  // namespace

GlbContents::GlbContents(const std::vector<std::byte>& glb) {
  const auto length_at = [&](std::size_t place) {
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + place, sizeof length);
    return length;
  };
  const std::size_t text_bytes = length_at(12);
  const auto* const text = reinterpret_cast<const char*>(glb.data()) + 20;
  json = Json::parse(text, text + text_bytes);
  const std::size_t chunk = 20 + text_bytes;
  if (chunk < glb.size())
    binary.assign(glb.begin() + static_cast<std::ptrdiff_t>(chunk + 8),
                  glb.begin() + static_cast<std::ptrdiff_t>(chunk + 8 + length_at(chunk)));
}

double GlbContents::component(std::size_t place, int type) const {
  const auto read = [&](auto value) {
    std::memcpy(&value, binary.data() + place, sizeof value);
    return static_cast<double>(value);
  };
  if (place + bytes_of(type) > binary.size()) throw std::out_of_range("beyond the BIN chunk");
  switch (type) {
    case 5120: return read(std::int8_t{});
    case 5121: return read(std::uint8_t{});
    case 5122: return read(std::int16_t{});
    case 5123: return read(std::uint16_t{});
    case 5125: return read(std::uint32_t{});
    default: return read(float{});
  }
}

std::size_t GlbContents::element_bytes(std::size_t accessor) const {
  const Json& at = json["accessors"][accessor];
  return components_of(at) * bytes_of(at["componentType"]);
}

GlbContents::Layout GlbContents::layout(const Json& at, std::size_t element,
                                        std::size_t count) const {
  Layout found;
  found.view = at["bufferView"];
  const Json& view = json["bufferViews"][found.view];
  found.first = number(view, "byteOffset") + number(at, "byteOffset");
  found.has_stride = view.contains("byteStride");
  found.stride = found.has_stride ? number(view, "byteStride") : element;
  found.element = element;
  found.count = count;
  return found;
}

std::vector<double> GlbContents::numbers(std::size_t accessor) const {
  const Json& at = json["accessors"][accessor];
  const std::size_t components = components_of(at), count = at["count"];
  const int type = at["componentType"];
  std::vector<double> values(components * count, 0.0);
  const auto read = [&](const Layout& from, std::size_t element, std::size_t into) {
    for (std::size_t c = 0; c < components; ++c)
      values[into * components + c] =
          component(from.first + element * from.stride + c * bytes_of(type), type);
  };
  if (at.contains("bufferView")) {
    const Layout from = layout(at, element_bytes(accessor), count);
    for (std::size_t i = 0; i < count; ++i) read(from, i, i);
  }
  if (!at.contains("sparse")) return values;
  const Json& sparse = at["sparse"];
  const int index_type = sparse["indices"]["componentType"];
  const std::size_t replaced = sparse["count"];
  const Layout indices = layout(sparse["indices"], bytes_of(index_type), replaced),
               from = layout(sparse["values"], element_bytes(accessor), replaced);
  for (std::size_t i = 0; i < replaced; ++i)
    read(from, i,
         static_cast<std::size_t>(component(indices.first + i * indices.stride, index_type)));
  return values;
}

std::vector<std::byte> GlbContents::bytes_of_view(std::size_t view) const {
  const Json& at = json["bufferViews"][view];
  const auto first = binary.begin() + static_cast<std::ptrdiff_t>(number(at, "byteOffset"));
  return {first, first + static_cast<std::ptrdiff_t>(number(at, "byteLength"))};
}

std::set<std::size_t> GlbContents::referenced_accessors() const {
  std::set<std::size_t> found;
  const Json none = Json::array();
  const auto list = [&](const Json& object, const char* name) -> const Json& {
    return object.contains(name) ? object[name] : none;
  };
  const auto all_of = [&](const Json& attributes) {
    for (const Json& accessor : attributes) found.insert(accessor.get<std::size_t>());
  };
  for (const Json& mesh : list(json, "meshes"))
    for (const Json& primitive : mesh["primitives"]) {
      all_of(primitive["attributes"]);
      if (primitive.contains("indices")) found.insert(primitive["indices"].get<std::size_t>());
      for (const Json& target : list(primitive, "targets")) all_of(target);
    }
  for (const Json& skin : list(json, "skins"))
    if (skin.contains("inverseBindMatrices"))
      found.insert(skin["inverseBindMatrices"].get<std::size_t>());
  for (const Json& animation : list(json, "animations"))
    for (const Json& sampler : animation["samplers"])
      found.insert({sampler["input"].get<std::size_t>(), sampler["output"].get<std::size_t>()});
  const Json::json_pointer attributes("/extensions/EXT_mesh_gpu_instancing/attributes");
  for (const Json& node : list(json, "nodes"))
    if (node.contains(attributes)) all_of(node[attributes]);
  return found;
}

std::set<std::size_t> GlbContents::referenced_views() const {
  std::set<std::size_t> found;
  for (const std::size_t accessor : referenced_accessors()) {
    const Json& at = json["accessors"][accessor];
    if (at.contains("bufferView")) found.insert(at["bufferView"].get<std::size_t>());
    if (at.contains("sparse"))
      found.insert({at["sparse"]["indices"]["bufferView"].get<std::size_t>(),
                    at["sparse"]["values"]["bufferView"].get<std::size_t>()});
  }
  if (json.contains("images"))
    for (const Json& image : json["images"])
      if (image.contains("bufferView")) found.insert(image["bufferView"].get<std::size_t>());
  return found;
}

std::vector<bool> GlbContents::referenced_bytes() const {
  std::vector<bool> used(binary.size(), false);
  const auto mark = [&](std::size_t first, std::size_t length) {
    for (std::size_t i = first; i < std::min(first + length, used.size()); ++i) used[i] = true;
  };
  const auto mark_elements = [&](const Layout& at) {
    const Json& view = json["bufferViews"][at.view];
    const std::size_t begin = number(view, "byteOffset"), end = begin + number(view, "byteLength");
    for (std::size_t i = 0; i < at.count; ++i) {
      std::size_t first = at.first + i * at.stride, length = at.element;
      if (at.has_stride) {
        first -= (first - begin) % at.stride;
        length = std::min(at.stride, end - first);
      }
      mark(first, length);
    }
  };
  for (const std::size_t accessor : referenced_accessors()) {
    const Json& at = json["accessors"][accessor];
    const std::size_t element = element_bytes(accessor);
    if (at.contains("bufferView")) mark_elements(layout(at, element, at["count"]));
    if (!at.contains("sparse")) continue;
    const Json& sparse = at["sparse"];
    mark_elements(
        layout(sparse["indices"], bytes_of(sparse["indices"]["componentType"]), sparse["count"]));
    mark_elements(layout(sparse["values"], element, sparse["count"]));
  }
  if (json.contains("images"))
    for (const Json& image : json["images"])
      if (image.contains("bufferView")) {
        const Json& view = json["bufferViews"][image["bufferView"].get<std::size_t>()];
        mark(number(view, "byteOffset"), number(view, "byteLength"));
      }
  return used;
}

std::size_t GlbContents::longest_unreferenced_run(const std::set<std::size_t>& views) const {
  std::size_t longest = 0, run = 0;
  std::vector<bool> used = referenced_bytes();
  for (const std::size_t view : views) {
    const Json& at = json["bufferViews"][view];
    const std::size_t first = number(at, "byteOffset");
    for (std::size_t i = 0; i < number(at, "byteLength"); ++i) used[first + i] = true;
  }
  for (const bool is_used : used) {
    run = is_used ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  return longest;
}

}  // namespace sunder::test
