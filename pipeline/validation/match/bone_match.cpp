#include "pipeline/validation/match/bone_match.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "core/internal/bone_sides.h"

namespace sunder::validation {
namespace {

class Matching {
 public:
  Matching(const Skeleton& source, const Skeleton& target) : source_(source), target_(target) {
    match_.source_of_target.assign(target.bones.size(), kNone);
    match_.kind.assign(target.bones.size(), BoneMatchKind::none);
    match_.target_of_source.assign(source.bones.size(), kNone);
  }

  void join(Index target, Index source, BoneMatchKind kind) {
    match_.source_of_target[target] = source;
    match_.kind[target] = kind;
    if (match_.target_of_source[source] == kNone) match_.target_of_source[source] = target;
  }

  Status join_given(std::span<const BoneNames> mapping) {
    for (Index i = 0; i < mapping.size(); ++i) {
      const Index target = index_of(target_, mapping[i].target),
                  source = index_of(source_, mapping[i].source);
      if (target == kNone || source == kNone)
        return Status::failure(StatusCode::not_found, i, "pair %u: the %s has no bone '%.80s'", i,
                               target == kNone ? "target" : "source",
                               (target == kNone ? mapping[i].target : mapping[i].source).c_str());
      if (match_.source_of_target[target] != kNone)
        return Status::failure(StatusCode::invalid_argument, i,
                               "pair %u: bone '%.80s' of the target was given before", i,
                               mapping[i].target.c_str());
      join(target, source, BoneMatchKind::mapping);
    }
    return {};
  }

  /// Joins the free bones whose keys agree and are unique among the free bones of each side.
  void join_equal(const std::vector<std::string>& source_keys,
                  const std::vector<std::string>& target_keys, BoneMatchKind kind) {
    struct Holders {
      Index source = kNone, target = kNone;
      bool is_ambiguous = false;
    };
    std::map<std::string_view, Holders> holders;
    for (Index i = 0; i < source_keys.size(); ++i)
      if (match_.target_of_source[i] == kNone) {
        Holders& of_key = holders[source_keys[i]];
        of_key.is_ambiguous |= of_key.source != kNone;
        of_key.source = i;
      }
    for (Index i = 0; i < target_keys.size(); ++i)
      if (match_.source_of_target[i] == kNone) {
        Holders& of_key = holders[target_keys[i]];
        of_key.is_ambiguous |= of_key.target != kNone;
        of_key.target = i;
      }
    for (const auto& [key, of_key] : holders)
      if (!key.empty() && !of_key.is_ambiguous && of_key.source != kNone && of_key.target != kNone)
        join(of_key.target, of_key.source, kind);
  }

  BoneMatch finish() {
    for (Index i = 0; i < target_.bones.size(); ++i) {
      const Index parent = target_.bones[i].parent;
      Index driver = match_.source_of_target[i];
      if (driver == kNone) driver = parent == kNone ? 0 : match_.driver_of_target[parent];
      match_.driver_of_target.push_back(driver);
    }
    return std::move(match_);
  }

 private:
  static Index index_of(const Skeleton& skeleton, const std::string& name) {
    for (Index i = 0; i < skeleton.bones.size(); ++i)
      if (skeleton.bones[i].name == name) return i;
    return kNone;
  }

  const Skeleton& source_;
  const Skeleton& target_;
  BoneMatch match_;
};

std::vector<std::string> names_of(const Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const Bone& bone : skeleton.bones) names.push_back(bone.name);
  return names;
}

}  // namespace

Index BoneMatch::count(BoneMatchKind of_kind) const {
  return static_cast<Index>(std::ranges::count(kind, of_kind));
}

Result<BoneMatch> match_bones(const Skeleton& source, const Skeleton& target,
                              std::span<const BoneNames> mapping) {
  Matching matching(source, target);
  if (const Status status = matching.join_given(mapping); !status) return status;
  matching.join_equal(names_of(source), names_of(target), BoneMatchKind::exact);
  matching.join_equal(fuzzy_names(source), fuzzy_names(target), BoneMatchKind::fuzzy);
  return matching.finish();
}

}  // namespace sunder::validation
