#include "pipeline/validation/checks/stored_checks.h"

#include <sunder/weights/influences.h>

#include <algorithm>
#include <cmath>

namespace sunder::validation {
namespace {

constexpr double kPrunable = 1e-3;

/// The entries of one vertex.
struct Entries {
  std::span<const Index> slots;
  std::span<const float> weights;
};

/// The faults of a vertex's entries, found in one pass.
struct VertexFaults {
  double sum = 0.0;
  double least = 0.0;
  std::uint32_t units = 0;
  Index used = 0, not_finite = 0, out_of_range = 0, duplicate = 0, zero_joint = 0;
  bool is_sorted = true;
};

VertexFaults judge(const Entries& entries, Index slot_count, WeightFormat format) {
  VertexFaults faults;
  float previous = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < entries.weights.size(); ++i) {
    const float weight = entries.weights[i];
    const Index slot = entries.slots[i];
    if (weight == 0.0f) {
      faults.zero_joint += slot != 0;
      previous = 0.0f;
      continue;
    }
    faults.out_of_range += slot >= slot_count;
    if (!std::isfinite(weight)) {
      ++faults.not_finite;
      continue;
    }
    ++faults.used;
    faults.sum += static_cast<double>(weight);
    faults.least = std::min(faults.least, static_cast<double>(weight));
    if (format != WeightFormat::float32) faults.units += units_of(weight, format);
    faults.is_sorted &= weight <= previous;
    previous = weight;
    for (std::size_t j = 0; j < i; ++j)
      if (entries.slots[j] == slot && entries.weights[j] != 0.0f) {
        ++faults.duplicate;
        break;
      }
  }
  return faults;
}

void judge_sum(const FindingPlace& at, const VertexFaults& faults, WeightFormat format,
               StoredFaults& found) {
  FindingPlace place = at;
  place.value = std::abs(faults.sum - 1.0);
  if (faults.used == 0 || faults.sum == 0.0) {
    found.unweighted.push_back(place);
  } else if (format == WeightFormat::float32) {
    if (place.value > 2e-7 * static_cast<double>(faults.used)) found.sum.push_back(place);
  } else if (faults.units != units_of_one(format)) {
    found.sum_integer.push_back(place);
  }
}

void judge_mesh(const Skinned& skin, Index mesh, StoredFaults& found) {
  const StoredInfluences& stored = skin.stored[mesh];
  const Mesh& of = skin.character.meshes[mesh];
  const auto slot_count = static_cast<Index>(skin.character.skins[of.skin].bones.size());
  for (Index v = 0; v < of.vertex_count(); ++v) {
    const std::size_t first = std::size_t{v} * stored.per_vertex;
    const Entries entries{{stored.slots.data() + first, stored.per_vertex},
                          {stored.weights.data() + first, stored.per_vertex}};
    const VertexFaults faults = judge(entries, slot_count, stored.format);
    const auto report = [&](Places& places, double value) {
      if (value > 0.0) places.push_back(skin.place(mesh, v, kNone, value));
    };
    report(found.not_finite, faults.not_finite);
    report(found.out_of_range, faults.out_of_range);
    report(found.duplicate, faults.duplicate);
    report(found.negative, -faults.least);
    report(found.zero_joint, faults.zero_joint);
    report(found.unsorted, faults.is_sorted ? 0.0 : 1.0);
    if (faults.not_finite == 0)
      judge_sum(skin.place(mesh, v, kNone, 0.0), faults, stored.format, found);
  }
}

}  // namespace

std::uint32_t units_of_one(WeightFormat format) {
  return format == WeightFormat::unorm8 ? 255 : 65535;
}

std::uint32_t units_of(float weight, WeightFormat format) {
  return static_cast<std::uint32_t>(
      std::lround(static_cast<double>(weight) * static_cast<double>(units_of_one(format))));
}

StoredFaults find_stored_faults(const Skinned& skin) {
  StoredFaults found;
  for (Index mesh = 0; mesh < skin.stored.size(); ++mesh) {
    if (skin.stored[mesh].per_vertex == 0) continue;
    found.is_tested = true;
    judge_mesh(skin, mesh, found);
  }
  return found;
}

InfluenceFigures count_influences(const Skinned& skin, std::size_t kept) {
  InfluenceFigures figures;
  std::vector<Influence> sorted;
  for (Index mesh = 0; mesh < skin.character.meshes.size(); ++mesh)
    for (Index v = 0; v < skin.character.meshes[mesh].vertex_count(); ++v) {
      const auto influences = skin.influences(mesh, v);
      if (figures.histogram.size() <= influences.size())
        figures.histogram.resize(influences.size() + 1, 0);
      ++figures.histogram[influences.size()];
      const auto least = std::min_element(
          influences.begin(), influences.end(),
          [](const Influence& a, const Influence& b) { return a.weight < b.weight; });
      if (static_cast<double>(least->weight) < kPrunable)
        figures.prunable.push_back(
            skin.place(mesh, v, skin.bone(mesh, least->slot), static_cast<double>(least->weight)));
      if (influences.size() <= kept) continue;
      sorted.assign(influences.begin(), influences.end());
      if (sort_influences(sorted))
        figures.many.push_back(skin.place(mesh, v, kNone, dropped_mass(sorted, kept)));
    }
  return figures;
}

}  // namespace sunder::validation
