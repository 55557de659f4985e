#pragma once

#include <utility>

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/weight_rows.h"

namespace sunder::validation {

/// Takes out of `of_target` the places where the source has the same fault: at the same position or
/// at a corner of the matched triangle, with the same bone where a bone is named.
/// @return what was taken out.
[[nodiscard]] Places take_inherited(const RowReader& reader, Places& of_target,
                                    const Places& of_source);

/// The same for faults of weights, without a search on the source: it has the same fault where the
/// matched place has the same weight of the bone, or the same weights; so has a vertex of a wall or
/// cap with the weights that the operations give it.
[[nodiscard]] Places take_inherited_weights(const RowReader& reader, Places& of_target);

/// Runs a search on the target and, if it finds something, on the source, and adds what is new.
template <class Find>
void add_not_inherited(const RowReader& reader, Code code, const Find& find,
                       FindingList& findings) {
  Places of_target = find(reader.target());
  if (of_target.empty()) return findings.add(code, {});
  const Places inherited = take_inherited(reader, of_target, find(reader.source()));
  findings.add_new(code, std::move(of_target), inherited);
}

/// Adds places of wrong weights that are new.
void add_new_weights(const RowReader& reader, Code code, Places places, FindingList& findings);

}  // namespace sunder::validation
