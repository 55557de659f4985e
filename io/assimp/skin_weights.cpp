#include "io/assimp/skin_weights.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace sunder::assimp_import {
namespace {

/// Smaller deviations are rounding and are not noted.
constexpr double kRounding = 1e-5;

struct Counts {
  std::uint32_t out_of_range = 0, not_finite = 0, negative = 0, not_normalized = 0, unweighted = 0;
  double largest_deviation = 0.0;
};

double sum_of(std::span<const Influence> influences) {
  double sum = 0.0;
  for (const Influence& influence : influences) sum += static_cast<double>(influence.weight);
  return sum;
}

/// Up to the spacing of floats below 1, because readers tolerate different sums.
bool is_normalized(std::span<const Influence> influences) {
  return std::abs(sum_of(influences) - 1.0) <= 6e-8;
}

/// A stable sort of a few elements; std::stable_sort() allocates.
template <class Before>
void insertion_sort(std::vector<Influence>& influences, Before before) {
  for (std::size_t i = 1; i < influences.size(); ++i) {
    const Influence moved = influences[i];
    std::size_t at = i;
    for (; at > 0 && before(moved, influences[at - 1]); --at) influences[at] = influences[at - 1];
    influences[at] = moved;
  }
}

template <class Before>
void sort_stably(std::vector<Influence>& influences, Before before) {
  if (influences.size() <= 32)
    insertion_sort(influences, before);
  else
    std::stable_sort(influences.begin(), influences.end(), before);
}

/// Merges influences of the same slot, sorts, and scales to a sum of one.
void normalize(std::vector<Influence>& influences, Counts& counts) {
  sort_stably(influences, [](const Influence& a, const Influence& b) { return a.slot < b.slot; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < influences.size(); ++i) {
    if (kept > 0 && influences[kept - 1].slot == influences[i].slot)
      influences[kept - 1].weight += influences[i].weight;
    else
      influences[kept++] = influences[i];
  }
  influences.resize(kept);
  sort_stably(influences,
              [](const Influence& a, const Influence& b) { return a.weight > b.weight; });

  const double sum = sum_of(influences);
  const double deviation = std::abs(sum - 1.0);
  if (deviation > kRounding) {
    ++counts.not_normalized;
    counts.largest_deviation = std::max(counts.largest_deviation, deviation);
  }
  if (is_normalized(influences)) return;
  for (Influence& influence : influences)
    influence.weight = static_cast<float>(static_cast<double>(influence.weight) / sum);
  std::erase_if(influences, [](const Influence& influence) { return !(influence.weight > 0.0f); });
  // The largest weight takes the rounding remainder, where it matters least.
  influences[0].weight =
      static_cast<float>(static_cast<double>(influences[0].weight) + (1.0 - sum_of(influences)));
}

void report(const Counts& counts, const std::string& place, Notes& notes) {
  notes.dropped(StatusCode::index_out_of_range, place, "weights of vertices that do not exist",
                counts.out_of_range);
  notes.dropped(StatusCode::non_finite_value, place, "weights that are not finite",
                counts.not_finite);
  notes.dropped(StatusCode::weights_not_normalized, place, "negative weights", counts.negative);
  char text[96];
  std::snprintf(text, sizeof text,
                "weights did not sum to one (off by up to %.2g) and were normalised",
                counts.largest_deviation);
  notes.repaired(StatusCode::weights_not_normalized, place, text, counts.not_normalized);
  notes.repaired(StatusCode::weights_not_normalized, place,
                 "vertices without weights; bound to the skin's first bone", counts.unweighted);
}

/// Calls use(vertex, influence) for each weight above zero, and counts the bad ones.
template <class Use>
void for_each_weight(const aiMesh& mesh, std::span<const std::uint32_t> slot_of_bone, Counts& bad,
                     Use use) {
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone* const bone = mesh.mBones[b];
    if (bone == nullptr || slot_of_bone[b] == kNone || bone->mWeights == nullptr) continue;
    for (const aiVertexWeight& weight : std::span(bone->mWeights, bone->mNumWeights)) {
      if (weight.mVertexId >= mesh.mNumVertices)
        ++bad.out_of_range;
      else if (!std::isfinite(weight.mWeight))
        ++bad.not_finite;
      else if (weight.mWeight < 0.0f)
        ++bad.negative;
      else if (weight.mWeight > 0.0f)
        use(weight.mVertexId,
            Influence{slot_of_bone[b], std::min(weight.mWeight, 1e30f)});  // Sums stay finite.
    }
  }
}

}  // namespace

SkinWeights read_weights(const aiMesh& mesh, std::span<const std::uint32_t> slot_of_bone,
                         const std::string& place, Notes& notes) {
  Counts counts;
  std::vector<std::uint32_t> first(std::size_t{mesh.mNumVertices} + 1, 0);
  // Two passes over the bones: count, then fill. A bad weight is counted in the first only.
  for_each_weight(mesh, slot_of_bone, counts,
                  [&](unsigned vertex, const Influence&) { ++first[vertex + 1]; });
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  std::vector<Influence> all(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  Counts counted_before;
  for_each_weight(
      mesh, slot_of_bone, counted_before,
      [&](unsigned vertex, const Influence& influence) { all[next[vertex]++] = influence; });

  SkinWeights weights;
  weights.first.reserve(first.size());
  weights.influences.reserve(all.size());
  std::vector<Influence> of_vertex;
  for (unsigned vertex = 0; vertex < mesh.mNumVertices; ++vertex) {
    of_vertex.assign(all.begin() + first[vertex], all.begin() + first[vertex + 1]);
    if (of_vertex.empty()) {
      of_vertex.push_back({0, 1.0f});
      ++counts.unweighted;
    } else {
      normalize(of_vertex, counts);
    }
    weights.append(of_vertex);
  }
  report(counts, place, notes);
  return weights;
}

}  // namespace sunder::assimp_import
