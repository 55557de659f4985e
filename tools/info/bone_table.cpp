#include "tools/info/bone_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/messages/visible.h"

namespace sunder::tools {
namespace {

/// Columns that a text takes on a terminal: UTF-8 continuation bytes take none.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, width_of(text)), ' ');
}

/// Enough decimals for a ten-thousandth of the model.
int decimals_for(const Json& bounds) {
  double diagonal = 0;
  for (std::size_t i = 0; i < 3; ++i)
    diagonal =
        std::hypot(diagonal, bounds["max"][i].get<double>() - bounds["min"][i].get<double>());
  return diagonal > 0 ? std::clamp(static_cast<int>(std::ceil(4 - std::log10(diagonal))), 0, 9) : 4;
}

std::string rounded_number(const Json& value, int decimals) {
  std::array<char, 64> text{};
  double shown = value.get<double>();
  if (std::abs(shown) < 0.5 * std::pow(10.0, -decimals)) shown = 0;  // Not "-0.000".
  std::snprintf(text.data(), text.size(), "%.*f", decimals, shown);
  return text.data();
}

/// Two spaces per level; levels beyond the last that is indented are counted: "+3 ".
std::string indentation(std::size_t depth) {
  constexpr std::size_t kMostLevels = 16;  // So that long chains leave room for the columns.
  const std::string spaces(2 * std::min(depth, kMostLevels), ' ');
  return depth <= kMostLevels ? spaces : spaces + "+" + std::to_string(depth - kMostLevels) + " ";
}

using TableRow = std::vector<std::string>;

constexpr std::array<const char*, 10> kHeads = {
    "bone", "vertices", "x", "y", "z", "length", "leads to", "x of its surface", "y", "z"};

TableRow row_of(const Json& bone, const Json& bones, std::size_t depth, int decimals) {
  TableRow row = {indentation(depth) + visible(bone["name"].get<std::string>()),
                  std::to_string(bone["vertices"].get<std::size_t>())};
  for (const Json& value : bone["joint"]) row.push_back(rounded_number(value, decimals));
  row.push_back(rounded_number(bone["length"], decimals));
  row.push_back(
      bone["leads_to"].is_null()
          ? "-"
          : visible(bones[bone["leads_to"].get<std::size_t>()]["name"].get<std::string>()));
  for (std::size_t i = 0; i < 3; ++i)
    row.push_back(bone["bounds"].is_null()
                      ? "-"
                      : rounded_number(bone["bounds"]["min"][i], decimals) + " .. " +
                            rounded_number(bone["bounds"]["max"][i], decimals));
  return row;
}

void add_aligned(const std::vector<TableRow>& rows, Lines& lines) {
  std::vector<std::size_t> widths(kHeads.size(), 0);
  for (const TableRow& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  for (const TableRow& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool is_name = i == 0 || i == 6;
      const std::string gap(widths[i] - width_of(row[i]), ' ');
      line += is_name ? padded(row[i], widths[i]) : gap + row[i];
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    lines.add(line);
  }
}

}  // namespace

Json bone_tree_json(const Skeleton& skeleton, const std::vector<BoneExtent>& extents) {
  Json bones = Json::array();
  for (std::size_t i = 0; i < extents.size(); ++i) {
    const BoneExtent& extent = extents[i];
    Json bounds;
    if (extent.vertices > 0)
      bounds = {{"min", vector_json(extent.bounds.least)},
                {"max", vector_json(extent.bounds.greatest)}};
    bones.push_back({{"name", skeleton.bones[i].name},
                     {"index", i},
                     {"parent", index_json(skeleton.bones[i].parent)},
                     {"joint", vector_json(extent.joint)},
                     {"length", extent.length},
                     {"leads_to", index_json(extent.leads_to)},
                     {"vertices", extent.vertices},
                     {"vertices_of_branch", extent.vertices_of_branch},
                     {"bounds", std::move(bounds)}});
  }
  return bones;
}

Lines bone_tree_text(const Json& info) {
  const Json& bones = info["bone_tree"];
  const int decimals = decimals_for(info["bounds"]);
  std::vector<std::vector<std::size_t>> children(bones.size());
  std::vector<std::size_t> open;  // Bones to print, the next one last.
  for (std::size_t i = bones.size(); i-- > 0;) {
    if (bones[i]["parent"].is_null())
      open.push_back(i);
    else
      children[bones[i]["parent"].get<std::size_t>()].push_back(i);
  }
  std::vector<std::size_t> depth(bones.size(), 0);
  std::vector<TableRow> rows = {TableRow(kHeads.begin(), kHeads.end())};
  while (!open.empty()) {
    const std::size_t bone = open.back();
    open.pop_back();
    rows.push_back(row_of(bones[bone], bones, depth[bone], decimals));
    for (const std::size_t child : children[bone]) {
      depth[child] = depth[bone] + 1;
      open.push_back(child);
    }
  }
  Lines lines;
  lines.add("bones in pose " + info["pose"].get<std::string>() +
            ": joints and surfaces in model space, metres");
  add_aligned(rows, lines);
  return lines;
}

}  // namespace sunder::tools
