#include "pipeline/validation/checks/profile_check.h"

#include <sunder/weights/influences.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "pipeline/validation/checks/deviation.h"

namespace sunder::validation {
namespace {

template <class Integer>
void round_to(std::span<Influence> kept) {
  std::vector<Integer> units(kept.size());
  if (!quantise_weights(kept, std::span<Integer>(units))) return;
  for (std::size_t i = 0; i < kept.size(); ++i)
    kept[i].weight =
        static_cast<float>(static_cast<double>(units[i]) / std::numeric_limits<Integer>::max());
}

/// The influences as the platform keeps them.
void limit(const ProfileLimits& limits, std::vector<Influence>& influences) {
  const std::size_t kept = prune_influences(influences, limits.influences);
  if (kept == 0) return;
  influences.resize(kept);
  if (limits.format == WeightFormat::unorm8) round_to<std::uint8_t>(influences);
  if (limits.format == WeightFormat::unorm16) round_to<std::uint16_t>(influences);
}

Places moved_places(const Skinned& target, std::span<const double> largest, double least) {
  Places places;
  for (Index v = 0; v < largest.size(); ++v)
    if (largest[v] > least) places.push_back(target.place(v, kNone, largest[v]));
  return places;
}

}  // namespace

ProfileLimits limits_of(TargetProfile profile) {
  switch (profile) {
    case TargetProfile::none: return {"none", 0, WeightFormat::float32};
    case TargetProfile::unity4: return {"unity4", 4, WeightFormat::float32};
    case TargetProfile::unreal8: return {"unreal8", 8, WeightFormat::unorm8};
    case TargetProfile::gltf4: return {"gltf4", 4, WeightFormat::unorm8};
    case TargetProfile::gltf8: return {"gltf8", 8, WeightFormat::unorm16};
    case TargetProfile::webxr: return {"webxr", 4, WeightFormat::unorm16};
  }
  return {"none", 0, WeightFormat::float32};
}

void check_profile(const RowReader& reader, const SkinPoints& points,
                   std::span<const PoseBatch> batches, TargetProfile profile,
                   FindingList& findings) {
  const ProfileLimits limits = limits_of(profile);
  if (limits.influences == 0) return findings.not_tested(Code::profile, "no profile was chosen");
  const Skinned& target = reader.target();
  SkinDifferences rows;
  TermSum sum = points.make_sum();
  std::vector<Influence> limited;
  for (Index mesh = 0; mesh < target.character.meshes.size(); ++mesh)
    for (Index v = 0; v < target.character.meshes[mesh].vertex_count(); ++v) {
      const auto influences = target.influences(mesh, v);
      limited.assign(influences.begin(), influences.end());
      limit(limits, limited);
      points.add_influences(mesh, v, limited, 1.0, sum);
      points.add_influences(mesh, v, influences, -1.0, sum);
      sum.finish(rows);
    }
  std::vector<double> largest(target.surface.vertex_count(), 0.0);
  for (const PoseBatch& batch : batches) raise_largest(rows, batch, largest);
  const double least = kind_of(Code::profile).threshold * reader.source().rest_diagonal;
  const double most = largest.empty() ? 0.0 : *std::ranges::max_element(largest);
  char text[160];
  std::snprintf(text, sizeof text,
                "Profile %.*s moves vertices by up to %.3g m (%.3g %% of the diagonal).",
                static_cast<int>(limits.name.size()), limits.name.data(), most,
                100.0 * most / std::max(reader.source().rest_diagonal, 1e-300));
  Places places = moved_places(target, largest, least);
  const Severity severity = places.empty() ? Severity::note : Severity::warning;
  findings.add_finding(Code::profile, severity, Evidence::sampled, text, std::move(places), most);
}

}  // namespace sunder::validation
