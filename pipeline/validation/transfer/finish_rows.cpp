#include "pipeline/validation/transfer/finish_rows.h"

#include <algorithm>

namespace sunder::validation {
namespace {

constexpr double kNegligible = 1e-4;
constexpr double kUnchanged = 1e-9;

/// Removes the weights for which `is_removed` holds. @return false if nothing would be left.
template <class IsRemoved>
bool remove(WeightRow& row, const IsRemoved& is_removed) {
  WeightRow kept;
  for (const BoneWeight& entry : row)
    if (!is_removed(entry)) kept.push_back(entry);
  if (!normalise(kept)) return false;
  row = std::move(kept);
  return true;
}

/// The chosen bones as in `row`, the others as in `own`, scaled to fill up one.
WeightRow with_own_bones(const WeightRow& row, const WeightRow& own,
                         const std::vector<bool>& is_chosen) {
  WeightRow chosen, others;
  for (const BoneWeight& entry : row)
    if (is_chosen[entry.bone]) chosen.push_back(entry);
  for (const BoneWeight& entry : own)
    if (!is_chosen[entry.bone]) others.push_back(entry);
  const double left = std::max(0.0, 1 - sum_of(chosen));
  if (normalise(others)) add(chosen, left, others);
  normalise(chosen);
  return chosen;
}

class Finish {
 public:
  Finish(UnfinishedRows unfinished, const FinishRules& rules)
      : in_(std::move(unfinished)), rules_(rules) {}

  FinishedRows run() {
    step("negative", [&](std::size_t, WeightRow& row) {
      return remove(row, [](const BoneWeight& entry) { return !(entry.weight > 0); });
    });
    step("sides", [&](std::size_t point, WeightRow& row) {
      return in_.side[point] == 0 || remove(row, [&](const BoneWeight& entry) {
               return rules_.side_of_bone[entry.bone] == -in_.side[point];
             });
    });
    step("bones", [&](std::size_t point, WeightRow& row) {
      row = with_own_bones(row, in_.own[point], rules_.is_chosen);
      return !row.empty();
    });
    step("mix", [&](std::size_t point, WeightRow& row) {
      if (rules_.mix == 1) return true;
      WeightRow mixed;
      add(mixed, rules_.mix, row);
      add(mixed, 1 - rules_.mix, in_.own[point]);
      return remove(row = mixed, [](const BoneWeight& entry) { return !(entry.weight > 0); });
    });
    step("small", [&](std::size_t point, WeightRow& row) {
      return !in_.is_filled[point] ||
             remove(row, [](const BoneWeight& entry) { return entry.weight < kNegligible; });
    });
    step("limit", [&](std::size_t, WeightRow& row) {
      if (rules_.maximum_influences > 0) limit(row, rules_.maximum_influences);
      return true;
    });
    return {std::move(in_.rows), std::move(steps_)};
  }

 private:
  /// Changes each row and measures by how much. Where nothing would be left, the fallback is used.
  template <class Change>
  void step(std::string_view name, const Change& change) {
    TransferStep& measured = steps_.emplace_back();
    measured.name = name;
    double sum = 0;
    for (std::size_t point = 0; point < in_.rows.size(); ++point) {
      if (in_.is_locked[point]) continue;
      const WeightRow before = in_.rows[point];
      if (!change(point, in_.rows[point])) in_.rows[point] = in_.fallback[point];
      const double moved = distance(before, in_.rows[point]);
      if (!(moved > kUnchanged)) continue;
      ++measured.points;
      sum += moved;
      measured.largest = std::max(measured.largest, moved);
    }
    if (measured.points > 0) measured.mean = sum / measured.points;
  }

  UnfinishedRows in_;
  const FinishRules& rules_;
  std::vector<TransferStep> steps_;
};

}  // namespace

FinishedRows finish_rows(UnfinishedRows unfinished, const FinishRules& rules) {
  return Finish(std::move(unfinished), rules).run();
}

}  // namespace sunder::validation
