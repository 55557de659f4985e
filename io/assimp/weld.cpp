#include "io/assimp/weld.h"

#include <bit>
#include <cstring>

namespace sunder::assimp_import {
namespace {

class Vertices {
 public:
  explicit Vertices(const MeshPart& part) : part_(part) {}

  /// One per vertex. Each stream is visited once, in order.
  [[nodiscard]] std::vector<std::uint64_t> hashes() const {
    std::vector<std::uint64_t> states(part_.vertex_count(), 0xCBF2'9CE4'8422'2325u);
    for (const Stream& stream : part_.streams) {
      const float* value = stream.values.data();
      for (std::uint64_t& state : states)
        for (int i = 0; i < stream.components; ++i)
          mix(state, std::bit_cast<std::uint32_t>(*value++));
    }
    for (std::uint32_t vertex = 0; part_.weights.vertex_count() != 0 && vertex < states.size();
         ++vertex) {
      for (const Influence& influence : part_.weights.of(vertex)) {
        mix(states[vertex], influence.slot);
        mix(states[vertex], std::bit_cast<std::uint32_t>(influence.weight));
      }
    }
    return states;
  }

  [[nodiscard]] bool equal(std::uint32_t a, std::uint32_t b) const {
    for (const Stream& stream : part_.streams)
      if (std::memcmp(values(stream, a), values(stream, b),
                      sizeof(float) * static_cast<std::size_t>(stream.components)) != 0)
        return false;
    const auto of_a = influences(a), of_b = influences(b);
    return of_a.size() == of_b.size() &&
           (of_a.empty() || std::memcmp(of_a.data(), of_b.data(), of_a.size_bytes()) == 0);
  }

 private:
  static void mix(std::uint64_t& state, std::uint32_t word) {
    state = (state ^ word) * 0x9E37'79B9'7F4A'7C15u;
    state ^= state >> 32;
  }
  static const float* values(const Stream& stream, std::uint32_t vertex) {
    return stream.values.data() + std::size_t{vertex} * static_cast<std::size_t>(stream.components);
  }
  [[nodiscard]] std::span<const Influence> influences(std::uint32_t vertex) const {
    return part_.weights.vertex_count() == 0 ? std::span<const Influence>()
                                             : part_.weights.of(vertex);
  }

  const MeshPart& part_;
};

/// Finds the first of equal vertices. Open addressing: no allocation per vertex, and most
/// comparisons end at the hash.
class FirstVertices {
 public:
  FirstVertices(const Vertices& vertices, std::uint32_t count)
      : vertices_(vertices),
        hashes_(vertices.hashes()),
        places_(std::bit_ceil(std::size_t{count} * 2 + 1)) {}

  /// @return the vertex inserted before that equals this one, or `vertex`, which is inserted.
  std::uint32_t insert(std::uint32_t vertex) {
    const std::uint64_t hash = hashes_[vertex];
    const auto tag = static_cast<std::uint32_t>(hash >> 32);
    const std::size_t mask = places_.size() - 1;
    for (std::size_t at = static_cast<std::size_t>(hash) & mask;; at = (at + 1) & mask) {
      Place& place = places_[at];
      if (place.vertex == kNone) {
        place = {vertex, tag};
        return vertex;
      }
      if (place.tag == tag && vertices_.equal(place.vertex, vertex)) return place.vertex;
    }
  }

 private:
  struct Place {
    std::uint32_t vertex = kNone;
    std::uint32_t tag = 0;
  };
  const Vertices& vertices_;
  std::vector<std::uint64_t> hashes_;
  std::vector<Place> places_;
};

void keep(Stream& stream, const std::vector<std::uint32_t>& old_from_new) {
  const auto width = static_cast<std::size_t>(stream.components);
  for (std::size_t i = 0; i < old_from_new.size(); ++i)
    std::memmove(stream.values.data() + i * width, stream.values.data() + old_from_new[i] * width,
                 width * sizeof(float));
  stream.values.resize(old_from_new.size() * width);
}

}  // namespace

std::uint32_t weld_identical(MeshPart& part) {
  const std::uint32_t count = part.vertex_count();
  const Vertices vertices(part);
  FirstVertices kept(vertices, count);
  std::vector<std::uint32_t> new_from_old(count), old_from_new;
  for (std::uint32_t vertex = 0; vertex < count; ++vertex) {
    const std::uint32_t first = kept.insert(vertex);
    if (first == vertex) {
      new_from_old[vertex] = static_cast<std::uint32_t>(old_from_new.size());
      old_from_new.push_back(vertex);
    } else {
      new_from_old[vertex] = new_from_old[first];
    }
  }
  if (old_from_new.size() == count) return 0;

  for (Triangle& triangle : part.triangles)
    for (std::uint32_t& vertex : triangle) vertex = new_from_old[vertex];
  for (Stream& stream : part.streams) keep(stream, old_from_new);
  if (part.weights.vertex_count() != 0) {
    SkinWeights weights;
    for (const std::uint32_t vertex : old_from_new) weights.append(part.weights.of(vertex));
    part.weights = std::move(weights);
  }
  return count - static_cast<std::uint32_t>(old_from_new.size());
}

}  // namespace sunder::assimp_import
