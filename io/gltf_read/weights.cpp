#include "io/gltf_read/weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace sunder::gltf {
namespace {

/// Counts the vertices or influences with a fault.
struct Tally {
  std::uint32_t count = 0;
  std::uint32_t first_vertex = kNone;

  void add(std::uint32_t vertex) {
    if (count++ == 0) first_vertex = vertex;
  }
};

struct Faults {
  Tally not_finite, negative, out_of_range, repeated, without_weight, not_normalized;
  double largest_deviation = 0.0;
  bool changed = false;  ///< True also for changes that are too small for a note.
};

/// Sums of weights that Draco compressed are off by up to 1e-4.
constexpr double kWorthNoting = 2e-4;

void collect(const InfluenceSet& set, std::uint32_t vertex, std::uint32_t slot_count,
             std::vector<Influence>& influences, Faults& faults) {
  for (std::size_t i = std::size_t{vertex} * 4; i < std::size_t{vertex} * 4 + 4; ++i) {
    const std::uint32_t slot = set.slots[i];
    const float weight = set.weights[i];
    if (weight == 0.0f) {
      faults.changed |= slot >= slot_count;
    } else if (!std::isfinite(weight)) {
      faults.not_finite.add(vertex);
    } else if (weight < 0.0f) {
      faults.negative.add(vertex);
    } else if (slot >= slot_count) {
      faults.out_of_range.add(vertex);
    } else if (const auto same =
                   std::find_if(influences.begin(), influences.end(),
                                [&](const Influence& other) { return other.slot == slot; });
               same != influences.end()) {
      same->weight = std::min(same->weight + weight, std::numeric_limits<float>::max());
      faults.repeated.add(vertex);
    } else {
      influences.push_back({slot, weight});
    }
  }
}

/// Whether rounding explains the deviation of a sum of weights from one.
bool is_rounding(double deviation, std::size_t influence_count) {
  return deviation <= 2e-7 * static_cast<double>(influence_count);
}

/// Appends the influences of a vertex if nothing is to be repaired: a short way for nearly all
/// vertices. @return whether it did.
bool append_valid(const InfluenceSet& set, std::uint32_t vertex, std::uint32_t slot_count,
                  SkinWeights& weights) {
  std::array<Influence, 4> used;
  std::size_t count = 0;
  double sum = 0.0;
  for (std::size_t i = std::size_t{vertex} * 4; i < std::size_t{vertex} * 4 + 4; ++i) {
    const Influence influence = {set.slots[i], set.weights[i]};
    if (influence.slot >= slot_count || !(influence.weight >= 0.0f && influence.weight <= 1.0f))
      return false;
    if (influence.weight == 0.0f) continue;
    for (std::size_t k = 0; k < count; ++k)
      if (used[k].slot == influence.slot) return false;
    used[count++] = influence;
    sum += static_cast<double>(influence.weight);
  }
  if (count == 0 || !is_rounding(std::abs(sum - 1.0), count)) return false;
  weights.append({used.data(), count});
  return true;
}

/// Normalises the sum if its deviation is larger than rounding.
void normalize(std::uint32_t vertex, bool is_already_noted, std::vector<Influence>& influences,
               Faults& faults) {
  double sum = 0.0;
  bool too_large = false;
  for (const Influence& influence : influences) {
    sum += static_cast<double>(influence.weight);
    too_large |= influence.weight > 1.0f;
  }
  const double deviation = std::abs(sum - 1.0);
  if (is_rounding(deviation, influences.size()) && !too_large) return;
  faults.changed = true;
  if (deviation > kWorthNoting && !is_already_noted) {
    faults.not_normalized.add(vertex);
    faults.largest_deviation = std::max(faults.largest_deviation, deviation);
  }
  for (Influence& influence : influences)
    influence.weight = static_cast<float>(static_cast<double>(influence.weight) / sum);
  std::erase_if(influences, [](const Influence& influence) { return influence.weight == 0.0f; });
}

void note(const Faults& faults, const std::string& place, Notes& notes) {
  const auto repaired = [&](const Tally& tally, StatusCode code, const char* text) {
    if (tally.count > 0)
      notes.repaired(code, tally.first_vertex, place,
                     text + (" (first: vertex " + std::to_string(tally.first_vertex) + ")"),
                     tally.count);
  };
  repaired(faults.not_finite, StatusCode::non_finite_value,
           "weights were not finite and became zero");
  repaired(faults.negative, StatusCode::weights_not_normalized,
           "weights were negative and became zero");
  if (faults.out_of_range.count > 0)
    notes.dropped(StatusCode::index_out_of_range, faults.out_of_range.first_vertex, place,
                  "influences referred to joints that the skin does not have (first: vertex " +
                      std::to_string(faults.out_of_range.first_vertex) + ")",
                  faults.out_of_range.count);
  repaired(faults.repeated, StatusCode::malformed_file, "repeated joints of a vertex were merged");
  repaired(faults.without_weight, StatusCode::weights_not_normalized,
           "vertices without weight were bound to the skin's root");
  char text[96];
  std::snprintf(text, sizeof text,
                "weights did not sum to one (off by up to %.3g) and were normalised",
                faults.largest_deviation);
  repaired(faults.not_normalized, StatusCode::weights_not_normalized, text);
}

}  // namespace

StoredInfluences stored_influences(const std::vector<InfluenceSet>& sets,
                                   std::uint32_t vertex_count, std::string place) {
  StoredInfluences stored;
  stored.place = std::move(place);
  stored.per_vertex = static_cast<std::uint32_t>(4 * sets.size());
  if (sets.empty()) return stored;
  stored.format = sets.front().format;
  for (const InfluenceSet& set : sets)  // integers of several sizes have no common exact sum
    if (set.format != stored.format) stored.format = WeightFormat::float32;
  stored.slots.reserve(std::size_t{vertex_count} * stored.per_vertex);
  stored.weights.reserve(stored.slots.capacity());
  for (std::size_t vertex = 0; vertex < vertex_count; ++vertex)
    for (const InfluenceSet& set : sets) {
      const auto first = static_cast<std::ptrdiff_t>(vertex * 4);
      stored.slots.insert(stored.slots.end(), set.slots.begin() + first,
                          set.slots.begin() + first + 4);
      stored.weights.insert(stored.weights.end(), set.weights.begin() + first,
                            set.weights.begin() + first + 4);
    }
  return stored;
}

ReadWeights make_weights(const std::vector<InfluenceSet>& sets, std::uint32_t vertex_count,
                         std::uint32_t slot_count, std::uint32_t root_slot,
                         const std::string& place, Notes& notes) {
  ReadWeights result;
  result.weights.first.reserve(std::size_t{vertex_count} + 1);
  std::size_t nonzero = 0;
  for (const InfluenceSet& set : sets)
    nonzero += set.weights.size() -
               static_cast<std::size_t>(std::count(set.weights.begin(), set.weights.end(), 0.0f));
  result.weights.influences.reserve(std::max<std::size_t>(nonzero, vertex_count));
  Faults faults;
  const auto noted = [&] {
    return faults.not_finite.count + faults.negative.count + faults.out_of_range.count;
  };
  std::vector<Influence> influences;
  for (std::uint32_t vertex = 0; vertex < vertex_count; ++vertex) {
    if (sets.size() == 1 && append_valid(sets.front(), vertex, slot_count, result.weights))
      continue;
    influences.clear();
    const std::uint32_t noted_before = noted();
    for (const InfluenceSet& set : sets) collect(set, vertex, slot_count, influences, faults);
    if (influences.empty()) {
      faults.without_weight.add(vertex);
      influences.push_back({root_slot, 1.0f});
    } else {
      normalize(vertex, noted() != noted_before, influences, faults);
    }
    result.weights.append(influences);
  }
  note(faults, place, notes);
  result.repaired =
      faults.changed || noted() + faults.repeated.count + faults.without_weight.count > 0;
  return result;
}

}  // namespace sunder::gltf
