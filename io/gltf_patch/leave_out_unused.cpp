#include "io/gltf_patch/leave_out_unused.h"

#include <sunder/core/index.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "io/gltf_patch/document_rules.h"
#include "io/gltf_patch/foreign_indices.h"
#include "io/gltf_patch/pack_bytes.h"
#include "io/gltf_patch/references.h"

namespace sunder::gltf {
namespace {

/// One flag per entry of a list: a node's member refers to it.
std::vector<bool> used_by_nodes(const Json& document, const char* list, const char* member) {
  std::vector<bool> used(count_of(document, list), false);
  const auto nodes = document.find("nodes");
  if (nodes == document.end() || !nodes->is_array()) return used;
  for (const Json& node : *nodes) {
    if (!node.is_object() || !node.contains(member)) continue;
    const Json& index = node[member];
    if (index.is_number_unsigned() && index.get<std::uint64_t>() < used.size())
      used[index.get<std::size_t>()] = true;
  }
  return used;
}

/// The new number of each entry of a list; kNone for those that are not used.
/// @param fixed  so many entries keep their number if they are used.
std::vector<std::uint32_t> new_from_old(const std::vector<bool>& used, std::size_t fixed) {
  std::vector<std::uint32_t> numbers(used.size(), kNone);
  std::uint32_t next = 0;
  const auto is_taken = [&](std::size_t number) { return number < fixed && used[number]; };
  for (std::uint32_t old = 0; old < used.size(); ++old) {
    if (!used[old]) continue;
    if (old < fixed) {
      numbers[old] = old;
      continue;
    }
    while (is_taken(next)) ++next;
    numbers[old] = next++;
  }
  return numbers;
}

/// Moves the entries of a list to their new numbers.
void renumber(Json& document, const char* list, const std::vector<std::uint32_t>& numbers) {
  if (numbers.empty()) return;
  Json& entries = document[list];
  std::size_t count = 0;
  for (const std::uint32_t number : numbers)
    if (number != kNone) count = std::max<std::size_t>(count, number + 1);
  std::vector<Json> moved(count, empty_entry(list));
  for (std::size_t old = 0; old < numbers.size(); ++old)
    if (numbers[old] != kNone) moved[numbers[old]] = std::move(entries[old]);
  if (moved.empty())
    document.erase(list);
  else
    entries = std::move(moved);
}

void refer_anew(Json& reference, const std::vector<std::uint32_t>& numbers) {
  const std::uint32_t number = numbers[reference.get<std::size_t>()];
  if (number != reference.get<std::uint64_t>()) reference = number;
}

class Omission {
 public:
  Omission(GlbDraft& draft, const SourceDocument& source)
      : json_(draft.json),
        draft_(draft),
        source_(source.json),
        foreign_(foreign_indices(draft.json)) {}

  void run() {
    leave_out_meshes();
    leave_out("skins", "skin");
    leave_out_accessors();
    leave_out_views();
    if (!foreign_.may_name_bytes) pack_bytes(draft_, whole_views_);
  }

 private:
  /// One flag per entry: nodes of the source use it, and no node does any more.
  [[nodiscard]] std::vector<bool> abandoned(const char* list, const char* member) const {
    const std::vector<bool> before = used_by_nodes(source_, list, member);
    std::vector<bool> entries = used_by_nodes(json_, list, member);
    for (std::size_t i = 0; i < entries.size(); ++i)
      entries[i] = !entries[i] && i < before.size() && before[i];
    return entries;
  }

  void leave_out(const char* list, const char* member) {
    std::vector<bool> used = abandoned(list, member);
    used.flip();
    if (foreign_.may_name_meshes || std::find(used.begin(), used.end(), false) == used.end())
      return;
    const std::vector<std::uint32_t> numbers = new_from_old(used, 0);
    for (Json& node : list_in(json_, "nodes"))
      if (node.contains(member)) refer_anew(node[member], numbers);
    renumber(json_, list, numbers);
  }

  /// A mesh to which an extension may refer becomes a point, with as many morph targets as before.
  void leave_out_meshes() {
    leave_out("meshes", "mesh");
    if (!foreign_.may_name_meshes) return;
    const std::vector<bool> empty = abandoned("meshes", "mesh");
    std::uint32_t zeros = kNone;
    for (std::size_t i = 0; i < empty.size(); ++i) {
      if (!empty[i]) continue;
      if (zeros == kNone) zeros = add_zeros();
      const Json position = {{"POSITION", zeros}};
      Json& primitives = json_["meshes"][i]["primitives"];
      Json point = {{"attributes", position}, {"mode", 0}};
      if (primitives.front().contains("targets"))
        point["targets"] = Json::array_t(primitives.front()["targets"].size(), position);
      primitives = Json::array({std::move(point)});
    }
  }

  std::uint32_t add_zeros() {
    Json& accessors = list_of(json_, "accessors");
    accessors.push_back({{"componentType", 5126},
                         {"count", 1},
                         {"type", "VEC3"},
                         {"min", {0.0, 0.0, 0.0}},
                         {"max", {0.0, 0.0, 0.0}}});
    return static_cast<std::uint32_t>(accessors.size() - 1);
  }

  [[nodiscard]] std::size_t fixed(const char* list) const {
    return foreign_.exist ? count_of(source_, list) : 0;
  }

  template <class Visit>
  void visit_all_accessors(const Visit& visit) {
    visit_accessors(json_, [&](Json& reference, Use) { visit(reference); });
    visit_instance_accessors(json_, visit);
    visit_record_accessors(json_, visit);
  }

  void leave_out_accessors() {
    std::vector<bool> used(count_of(json_, "accessors"), false);
    visit_all_accessors([&](Json& reference) { used[reference.get<std::size_t>()] = true; });
    for (const std::uint64_t number : foreign_.numbers)
      if (number < std::min(used.size(), count_of(source_, "accessors"))) {
        used[number] = true;
        visit_views_of(json_["accessors"][number],
                       [&](Json& view, bool) { whole_views_.insert(view.get<std::size_t>()); });
      }
    const std::vector<std::uint32_t> numbers = new_from_old(used, fixed("accessors"));
    visit_all_accessors([&](Json& reference) { refer_anew(reference, numbers); });
    renumber(json_, "accessors", numbers);
  }

  template <class Visit>
  void visit_all_views(const Visit& visit) {
    for (Json& accessor : list_in(json_, "accessors"))
      visit_views_of(accessor, [&](Json& reference, bool) { visit(reference); });
    for (Json& image : list_in(json_, "images"))
      if (image.contains("bufferView")) visit(image["bufferView"]);
  }

  void leave_out_views() {
    std::vector<bool> used(count_of(json_, "bufferViews"), false);
    visit_all_views([&](Json& reference) { used[reference.get<std::size_t>()] = true; });
    for (const std::uint64_t number : foreign_.numbers)
      if (number < std::min(used.size(), count_of(source_, "bufferViews")))
        whole_views_.insert(static_cast<std::size_t>(number));
    for (const std::size_t view : whole_views_) used[view] = true;
    const std::vector<std::uint32_t> numbers = new_from_old(used, fixed("bufferViews"));
    visit_all_views([&](Json& reference) { refer_anew(reference, numbers); });
    renumber(json_, "bufferViews", numbers);
    std::set<std::size_t> moved;
    for (const std::size_t view : whole_views_) moved.insert(numbers[view]);
    whole_views_ = std::move(moved);
  }

  Json& json_;
  GlbDraft& draft_;
  const Json& source_;
  const ForeignIndices foreign_;
  std::set<std::size_t> whole_views_;
};

}  // namespace

void leave_out_unused(GlbDraft& draft, const SourceDocument& source) {
  Omission(draft, source).run();
}

}  // namespace sunder::gltf
