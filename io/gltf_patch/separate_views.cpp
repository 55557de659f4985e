#include "io/gltf_patch/separate_views.h"

#include <map>
#include <utility>
#include <vector>

#include "io/gltf_patch/accessor_layout.h"
#include "io/gltf_patch/references.h"

namespace sunder::gltf {
namespace {

/// Keys and sparse parts may share a view.
Use kind_of_view(Use use) {
  return use == Use::key_times || use == Use::sparse ? Use::key_values : use;
}

/// Gives each key of a referrer its own copy of a list's entry; the first one keeps the entry.
template <class Key>
class Copies {
 public:
  explicit Copies(Json& list) : list_(list) {}

  void refer(Json& reference, const Key& key) {
    const auto index = reference.get<std::size_t>();
    const auto [first, is_first] = first_.try_emplace(index, key);
    if (is_first || first->second == key) return;
    const auto [copy, is_new] = copies_.try_emplace({index, key}, list_.size());
    if (is_new) {
      Json entry = list_[index];
      list_.push_back(std::move(entry));
    }
    reference = copy->second;
  }

 private:
  Json& list_;
  std::map<std::size_t, Key> first_;
  std::map<std::pair<std::size_t, Key>, std::size_t> copies_;
};

class Separation {
 public:
  explicit Separation(Json& document) : document_(document) {}

  void run() {
    if (!document_.contains("accessors") || !document_.contains("bufferViews")) return;
    Copies<Use> accessors(document_["accessors"]);
    visit_accessors(document_, [&](Json& reference, Use use) {
      accessors.refer(reference, use);
      use_of_accessor_[reference.get<std::size_t>()] = use;
    });
    Copies<std::pair<Use, std::size_t>> views(document_["bufferViews"]);
    visit_views([&](Json& reference, Use use, std::size_t accessor) {
      views.refer(reference, {kind_of_view(use), part_of_view(reference, use, accessor)});
    });
    visit_views([&](Json& reference, Use use, std::size_t accessor) {
      describe(document_["bufferViews"][reference.get<std::size_t>()], use, accessor);
    });
  }

 private:
  /// Calls visit(reference, use, accessor) for every reference to a buffer view.
  template <class Visit>
  void visit_views(const Visit& visit) {
    Json& accessors = document_["accessors"];
    for (const auto& [index, use] : use_of_accessor_) {
      visit_views_of(accessors[index], [&, index = index, use = use](Json& view, bool is_sparse) {
        visit(view, is_sparse ? Use::sparse : use, index);
      });
    }
    if (!document_.contains("images")) return;
    for (Json& image : document_["images"])
      if (image.contains("bufferView")) visit(image["bufferView"], Use::image, 0);
  }

  /// Without a stride, only one vertex attribute may use a view.
  std::size_t part_of_view(const Json& reference, Use use, std::size_t accessor) const {
    const bool is_alone =
        use == Use::vertices &&
        !document_["bufferViews"][reference.get<std::size_t>()].contains("byteStride");
    return is_alone ? accessor + 1 : 0;
  }

  void describe(Json& view, Use use, std::size_t accessor) const {
    const int target = use == Use::vertices ? 34962 : use == Use::indices ? 34963 : 0;
    if (view.contains("target") && view["target"] != target) view.erase("target");
    // A stride that equals the element says nothing new. Another one makes the accessor unsound.
    if (use != Use::vertices && view.contains("byteStride") &&
        (use == Use::image || use == Use::sparse ||
         view["byteStride"] == element_bytes(document_["accessors"][accessor])))
      view.erase("byteStride");
  }

  Json& document_;
  std::map<std::size_t, Use> use_of_accessor_;
};

}  // namespace

void separate_views(Json& document) { Separation(document).run(); }

std::vector<bool> used_accessors(Json& document) {
  std::vector<bool> used(count_of(document, "accessors"), false);
  visit_accessors(document,
                  [&](Json& reference, Use) { used[reference.get<std::size_t>()] = true; });
  return used;
}

}  // namespace sunder::gltf
