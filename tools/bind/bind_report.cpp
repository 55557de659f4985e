#include "tools/bind/bind_report.h"

#include <algorithm>

#include "tools/messages/printed.h"

namespace sunder::tools {
namespace {

/// Share of the points that see their nearest bone below which the model may not stand on the rig.
constexpr double kFewSee = 0.5;
/// Share of the weight of a vertex that the limit of influences may drop without a word.
constexpr double kMuchDropped = 0.25;
constexpr std::size_t kMostNames = 8;

double share(std::uint32_t part, std::uint32_t of) {
  return of == 0 ? 0.0 : static_cast<double>(part) / of;
}

/// "'a', 'b' and 3 more".
std::string some_of(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i)
    text += (i == 0 ? "'" : ", '") + names[i] + "'";
  if (names.size() > kMostNames) text += printed(" and %zu more", names.size() - kMostNames);
  return text;
}

Json pair_json(const BonePair& pair) { return {{"model", pair.model}, {"rig", pair.rig}}; }

Json figures(const MappedBinding& binding) {
  Json taken = Json::array();
  for (const BonePair& pair : binding.taken_by_ancestor) taken.push_back(pair_json(pair));
  return {{"method", "map"},
          {"mapped_bones", binding.mapped_bones},
          {"taken_by_ancestor", std::move(taken)},
          {"unused", binding.unused},
          {"farthest_pair", pair_json(binding.farthest_pair)},
          {"farthest_distance", binding.farthest_distance}};
}

Json figures(const HeatBinding& binding) {
  return {{"method", "heat"},
          {"points", binding.points},
          {"heated_points", binding.heated_points},
          {"components", binding.components},
          {"components_without_sight", binding.components_without_sight},
          {"lone_points", binding.lone_points},
          {"edges", binding.edges},
          {"clamped_edges", binding.clamped_edges},
          {"largest_dropped_weight", binding.largest_dropped_weight},
          {"bones_without_weight", binding.bones_without_weight}};
}

Lines table(const MappedBinding& binding) {
  Lines lines;
  lines.add(printed("by a map: %u bones with weight mapped, %zu taken by an ancestor",
                    binding.mapped_bones, binding.taken_by_ancestor.size()));
  for (const BonePair& pair : binding.taken_by_ancestor)
    lines.add("  '" + pair.model + "' goes to '" + pair.rig + "'");
  if (binding.mapped_bones > 0)
    lines.add(printed("  farthest joints: '%s' and '%s', %.4g m apart",
                      binding.farthest_pair.model.c_str(), binding.farthest_pair.rig.c_str(),
                      binding.farthest_distance));
  return lines;
}

Lines table(const HeatBinding& binding) {
  Lines lines;
  lines.add(printed(
      "by automatic weights: %u points, %.1f %% see their nearest bone; parts: %u, of which %u see "
      "none; points without a triangle: %u",
      binding.points, 100 * share(binding.heated_points, binding.points), binding.components,
      binding.components_without_sight, binding.lone_points));
  return lines;
}

std::vector<std::string> warnings(const MappedBinding& binding) {
  std::vector<std::string> lines;
  if (!binding.unused.empty())
    lines.push_back("bones of the map that move no vertex: " + some_of(binding.unused));
  if (!binding.taken_by_ancestor.empty())
    lines.push_back(printed("%zu bones with weight are not mapped; a mapped ancestor took it",
                            binding.taken_by_ancestor.size()));
  return lines;
}

std::vector<std::string> warnings(const HeatBinding& binding) {
  std::vector<std::string> lines;
  if (share(binding.heated_points, binding.points) < kFewSee)
    lines.push_back(
        printed("only %.0f %% of the points see their nearest bone; does the model stand on the "
                "rig? --place and --fit move it",
                100 * share(binding.heated_points, binding.points)));
  if (binding.largest_dropped_weight > kMuchDropped)
    lines.push_back(printed("the limit of influences drops up to %.0f %% of a vertex's weight",
                            100 * binding.largest_dropped_weight));
  if (!binding.bones_without_weight.empty())
    lines.push_back("bones without weight: " + some_of(binding.bones_without_weight));
  return lines;
}

}  // namespace

const Binding& common(const AnyBinding& binding) {
  return std::visit([](const auto& any) -> const Binding& { return any; }, binding);
}

Json bind_json(const BindRequest& request, const AnyBinding& binding, const BindingPlace& place) {
  Json json = {{"sunder_bind", 1},
               {"model", request.model.string()},
               {"skeleton", request.skeleton.string()},
               {"output", request.output.string()}};
  json.update(std::visit([](const auto& any) { return figures(any); }, binding));
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row)
    rows.push_back(vector_json(Vec4d(place.rig_from_model.matrix().row(row))));
  json["place"] = std::move(rows);
  json["largest_shape_error"] = common(binding).largest_shape_error;
  json["clips_left_out"] = common(binding).clips_left_out;
  return json;
}

Lines bind_table(const AnyBinding& binding) {
  Lines lines = std::visit([](const auto& any) { return table(any); }, binding);
  lines.add(printed("  farthest vertex from its place in the bind pose: %.3g m",
                    common(binding).largest_shape_error));
  return lines;
}

std::vector<std::string> bind_warnings(const AnyBinding& binding) {
  std::vector<std::string> lines =
      std::visit([](const auto& any) { return warnings(any); }, binding);
  if (common(binding).clips_left_out > 0)
    lines.push_back(printed("%u clips of the model are left out; they move its own skeleton",
                            common(binding).clips_left_out));
  return lines;
}

}  // namespace sunder::tools
