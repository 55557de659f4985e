#include "core/internal/find_named.h"

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/internal/nearest_names.h"

namespace sunder {

std::optional<Index> find_clip(const Character& character, std::string_view name) {
  std::optional<Index> behind_namespace;
  bool is_ambiguous = false;
  for (Index i = 0; i < character.clips.size(); ++i) {
    if (character.clips[i].name == name) return i;
    if (without_namespace(character.clips[i].name) != name) continue;
    is_ambiguous = behind_namespace.has_value();
    behind_namespace = i;
  }
  return is_ambiguous ? std::nullopt : behind_namespace;
}

std::optional<Index> find_named_clip(const Character& character,
                                     const std::variant<std::string, Index>& clip) {
  if (const auto* const name = std::get_if<std::string>(&clip)) return find_clip(character, *name);
  const Index index = std::get<Index>(clip);
  return index < character.clips.size() ? std::optional(index) : std::nullopt;
}

Result<Index> find_material(const Character& character, std::string_view name) {
  const std::string wanted(name);
  std::map<std::string, std::set<Index>> indices;
  for (const Mesh& mesh : character.meshes)
    for (const Submesh& submesh : mesh.submeshes)
      if (submesh.material != kNone) indices[submesh.name].insert(submesh.material);
  const auto found = indices.find(wanted);
  if (found == indices.end()) {
    std::vector<std::string> names;
    for (const auto& [of, unused] : indices) names.push_back(of);
    const std::vector<std::string> near = nearest_names(wanted, names);
    const std::string advice = near.empty() ? listed_names(names) : listed_names(near);
    return Status::failure(StatusCode::not_found, kNone,
                           "the model has no material '%.60s'%s%.120s%s", wanted.c_str(),
                           names.empty()  ? ""
                           : near.empty() ? "; its materials: "
                                          : "; did you mean ",
                           advice.c_str(), near.empty() ? "" : "?");
  }
  if (found->second.size() > 1)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the materials %u and %u are named '%.60s'; give the index",
                           *found->second.begin(), *found->second.rbegin(), wanted.c_str());
  return *found->second.begin();
}

}  // namespace sunder
