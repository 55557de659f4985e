#include "io/gltf/accessors.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

#include "io/gltf/buffers.h"
#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

using Place = unsigned long long;

std::size_t size_of(ComponentType type) {
  switch (type) {
    case ComponentType::i8:
    case ComponentType::u8: return 1;
    case ComponentType::i16:
    case ComponentType::u16: return 2;
    case ComponentType::u32:
    case ComponentType::f32: return 4;
  }
  return 4;
}

ComponentType read_component_type(const Cursor& at) {
  const std::uint64_t type = at.to_unsigned();
  if (type < 5120 || type > 5126 || type == 5124)
    refuse(StatusCode::malformed_file, kNone, "%.120s: unknown component type %llu",
           at.pointer().c_str(), static_cast<Place>(type));
  return static_cast<ComponentType>(type);
}

struct ElementType {
  std::string_view name;
  std::uint32_t components;
  bool is_matrix;
};
constexpr std::array<ElementType, 7> kElementTypes = {{{"SCALAR", 1, false},
                                                       {"VEC2", 2, false},
                                                       {"VEC3", 3, false},
                                                       {"VEC4", 4, false},
                                                       {"MAT2", 4, true},
                                                       {"MAT3", 9, true},
                                                       {"MAT4", 16, true}}};

const ElementType& read_element_type(const Cursor& at) {
  for (const ElementType& type : kElementTypes)
    if (type.name == at.to_string()) return type;
  refuse(StatusCode::malformed_file, kNone, "%.120s: unknown accessor type '%.40s'",
         at.pointer().c_str(), at.to_string().c_str());
}

/// Refuses unless `count` elements of `size` bytes, `stride` bytes apart, fit in `available` bytes
/// from `offset` on.
void check_extent(const Cursor& at, std::uint64_t offset, std::uint64_t stride, std::uint64_t count,
                  std::uint64_t size, std::uint64_t available) {
  // offset, stride < 2^53 and count < 2^32. The comparison divides, so nothing can overflow.
  const bool fits = offset <= available && size <= available - offset &&
                    (count == 1 || stride <= (available - offset - size) / (count - 1));
  if (!fits)
    refuse(StatusCode::index_out_of_range, kNone,
           "%.120s: %llu elements of %llu bytes at offset %llu do not fit in %llu bytes",
           at.pointer().c_str(), static_cast<Place>(count), static_cast<Place>(size),
           static_cast<Place>(offset), static_cast<Place>(available));
}

const std::byte* open_packed(const SourceDocument& document, const Cursor& at, std::uint64_t count,
                             std::size_t size) {
  const std::uint32_t view =
      at.member("bufferView").to_index(count_of(document.json, "bufferViews"), "buffer view");
  const auto bytes = bytes_of_view(document, view);
  const std::uint64_t offset = at.unsigned_or("byteOffset", 0);
  check_extent(at, offset, size, count, size, bytes.size());
  return bytes.data() + offset;
}

template <class T>
T load(const std::byte* from) {  // Files need not be aligned.
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

std::uint32_t sparse_index_at(const Accessor& accessor, std::size_t i) {
  const std::size_t size = size_of(accessor.sparse_index_type);
  const std::byte* const at = accessor.sparse_indices + i * size;
  if (size == 1) return load<std::uint8_t>(at);
  return size == 2 ? load<std::uint16_t>(at) : load<std::uint32_t>(at);
}

/// Decodes the elements that are not sparse. Numbers without gaps are one array.
template <class T, class Out, class Convert>
void decode_dense(const Accessor& accessor, std::span<Out> out, const Convert& convert) {
  const std::size_t components = accessor.components, element_size = components * sizeof(T);
  if (accessor.data == nullptr) {
    std::fill(out.begin(), out.end(), Out{0});
  } else if (accessor.stride == element_size && std::is_same_v<T, Out>) {
    std::memcpy(out.data(), accessor.data, out.size_bytes());
  } else if (accessor.stride == element_size) {
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = convert(load<T>(accessor.data + i * sizeof(T)));
  } else {
    const std::byte* from = accessor.data;
    for (std::size_t to = 0; to < out.size(); to += components, from += accessor.stride)
      for (std::size_t c = 0; c < components; ++c)
        out[to + c] = convert(load<T>(from + c * sizeof(T)));
  }
}

/// Visits all elements' numbers, sparse ones last; `convert` converts a T of the file to an Out,
/// and leaves a T that is an Out as it is.
template <class T, class Out, class Convert>
void decode_elements(const Accessor& accessor, std::span<Out> out, const Convert& convert) {
  const std::size_t components = accessor.components;
  const auto element = [&](const std::byte* from, std::size_t to) {
    for (std::size_t c = 0; c < components; ++c)
      out[to * components + c] = convert(load<T>(from + c * sizeof(T)));
  };
  decode_dense<T>(accessor, out, convert);
  for (std::size_t i = 0; i < accessor.sparse_count; ++i) {
    const std::uint32_t index = sparse_index_at(accessor, i);
    if (index >= accessor.count)
      refuse(StatusCode::index_out_of_range, index,
             "/accessors/%u/sparse: index %u; the accessor has %u elements", accessor.index, index,
             accessor.count);
    element(accessor.sparse_values + i * components * sizeof(T), index);
  }
}

template <class T>
void decode_floats(const Accessor& accessor, std::span<float> out) {
  decode_elements<T>(accessor, out, [normalized = accessor.normalized](T value) {
    const auto number = static_cast<float>(value);
    if (std::is_floating_point_v<T> || !normalized) return number;
    return std::max(number / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
  });
}

template <class T>
void decode_unsigned(const Accessor& accessor, std::span<std::uint32_t> out) {
  decode_elements<T>(accessor, out, [](T value) { return static_cast<std::uint32_t>(value); });
}

void open_sparse(const SourceDocument& document, const Cursor& sparse, Accessor& accessor) {
  const std::uint64_t count = sparse.member("count").to_unsigned();
  if (count == 0 || count > accessor.count)
    refuse(StatusCode::malformed_file, accessor.index,
           "%s/count: %llu; the accessor has %u elements", sparse.pointer().c_str(),
           static_cast<Place>(count), accessor.count);
  const Cursor indices = sparse.member("indices");
  accessor.sparse_count = static_cast<std::uint32_t>(count);
  accessor.sparse_index_type = read_component_type(indices.member("componentType"));
  if (accessor.sparse_index_type != ComponentType::u8 &&
      accessor.sparse_index_type != ComponentType::u16 &&
      accessor.sparse_index_type != ComponentType::u32)
    refuse(StatusCode::malformed_file, accessor.index,
           "%s/componentType: not an unsigned integer type", indices.pointer().c_str());
  accessor.sparse_indices =
      open_packed(document, indices, count, size_of(accessor.sparse_index_type));
  accessor.sparse_values = open_packed(document, sparse.member("values"), count,
                                       accessor.components * size_of(accessor.component_type));
}

}  // namespace

AccessorReader::AccessorReader(const SourceDocument& document)
    : document_(document), bytes_left_(std::min(document.maximum_bytes, document.maximum_memory)) {
  file_bytes_ = document.content.size();
  for (const auto& file : document.other_files) file_bytes_ += file.size();
  // A draft has its bytes in its buffers alone.
  if (!document.buffers.empty())
    file_bytes_ = std::max<std::uint64_t>(file_bytes_, document.buffers[0].size());
}

Accessor AccessorReader::open(const Cursor& reference) {
  const std::uint64_t known = reference.to_unsigned();
  if (known >= opened_.size()) opened_.resize(count_of(document_.json, "accessors"));
  const std::uint32_t index = reference.to_index(opened_.size(), "accessor");
  if (!opened_[index]) opened_[index] = open_new(index);
  return *opened_[index];
}

Accessor AccessorReader::open_new(std::uint32_t index) const {
  const Cursor at = entry(document_.json, "accessors", index);
  Accessor accessor;
  accessor.index = index;
  accessor.component_type = read_component_type(at.member("componentType"));
  const ElementType& type = read_element_type(at.member("type"));
  accessor.components = type.components;
  accessor.is_matrix = type.is_matrix;
  accessor.normalized = at.bool_or("normalized", false);
  const std::uint64_t count = at.unsigned_of("count");
  if (count == 0 || count >= kNone)
    refuse(count == 0 ? StatusCode::malformed_file : StatusCode::limit_exceeded, index,
           "%s/count: %llu; expected 1 to 4294967294", at.pointer().c_str(),
           static_cast<Place>(count));
  accessor.count = static_cast<std::uint32_t>(count);

  const std::size_t element_size = accessor.components * size_of(accessor.component_type);
  if (const auto view_at = at.find("bufferView")) {
    const std::uint32_t view =
        view_at->to_index(count_of(document_.json, "bufferViews"), "buffer view");
    const auto bytes = bytes_of_view(document_, view);
    const std::uint64_t stride =
        entry(document_.json, "bufferViews", view).unsigned_or("byteStride", element_size);
    if (stride < element_size)
      refuse(StatusCode::malformed_file, view,
             "/bufferViews/%u/byteStride: %llu, but elements have %zu bytes", view,
             static_cast<Place>(stride), element_size);
    const std::uint64_t offset = at.unsigned_or("byteOffset", 0);
    check_extent(at, offset, stride, count, element_size, bytes.size());
    accessor.data = bytes.data() + offset;
    accessor.stride = stride;
  } else if (count > file_bytes_) {
    // All elements are zero and none is stored, so only the declared count limits the memory.
    // Accept no more elements than the file has bytes.
    refuse(StatusCode::limit_exceeded, index,
           "%s/count: %llu elements without data in a file of %llu bytes", at.pointer().c_str(),
           static_cast<Place>(count), static_cast<Place>(file_bytes_));
  }
  if (const auto sparse = at.find("sparse")) open_sparse(document_, *sparse, accessor);
  return accessor;
}

void AccessorReader::charge(const Accessor& accessor) {
  charge(std::uint64_t{accessor.count} * accessor.components * sizeof(float), place(accessor));
}

void AccessorReader::charge(std::uint64_t bytes, const std::string& place) {
  if (bytes > bytes_left_)
    refuse(
        StatusCode::limit_exceeded, kNone,
        "%.80s: in memory, the model exceeds %llu bytes (LoadOptions::%s)", place.c_str(),
        static_cast<Place>(std::min(document_.maximum_bytes, document_.maximum_memory)),
        document_.maximum_memory <= document_.maximum_bytes ? "maximum_memory" : "maximum_bytes");
  bytes_left_ -= bytes;
}

void AccessorReader::read_floats(const Accessor& accessor, std::span<float> out) const {
  switch (accessor.component_type) {
    case ComponentType::i8: return decode_floats<std::int8_t>(accessor, out);
    case ComponentType::u8: return decode_floats<std::uint8_t>(accessor, out);
    case ComponentType::i16: return decode_floats<std::int16_t>(accessor, out);
    case ComponentType::u16: return decode_floats<std::uint16_t>(accessor, out);
    case ComponentType::u32: return decode_floats<std::uint32_t>(accessor, out);
    case ComponentType::f32: return decode_floats<float>(accessor, out);
  }
}

std::uint32_t AccessorReader::sparse_index(const Accessor& accessor, std::uint32_t i) {
  return sparse_index_at(accessor, i);
}

std::vector<float> AccessorReader::read_floats(const Accessor& accessor) {
  charge(accessor);
  std::vector<float> values(std::size_t{accessor.count} * accessor.components);
  read_floats(accessor, values);
  return values;
}

std::vector<std::uint32_t> AccessorReader::read_unsigned(const Accessor& accessor) {
  charge(accessor);
  std::vector<std::uint32_t> values(std::size_t{accessor.count} * accessor.components);
  switch (accessor.component_type) {
    case ComponentType::u8: decode_unsigned<std::uint8_t>(accessor, values); break;
    case ComponentType::u16: decode_unsigned<std::uint16_t>(accessor, values); break;
    case ComponentType::u32: decode_unsigned<std::uint32_t>(accessor, values); break;
    default:
      refuse(StatusCode::malformed_file, accessor.index, "%s: expected unsigned integers",
             place(accessor).c_str());
  }
  return values;
}

}  // namespace sunder::gltf
