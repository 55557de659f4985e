#include "bench/particles/particles_repair.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "bench/harness/measure.h"
#include "bench/particles/particles_decompose.h"

namespace sunder::bench {
namespace {

template <class Outcome>
void require(const Outcome& outcome) {
  if (outcome) return;
  std::fprintf(stderr, "particles could not follow\n");
  std::exit(1);
}

double median_without_first(const std::vector<double>& values) {
  return values.size() < 2 ? 0 : median(std::vector<double>(values.begin() + 1, values.end()));
}

}  // namespace

RepeatedRepair::RepeatedRepair(const Scene& scene, double range) : scene_(scene) {
  const std::uint64_t before = bytes_in_use();
  set_ = decompose(scene.model(), scene.poses[0], range);
  run();
  figures_.bytes = static_cast<double>(bytes_in_use() - before);
  figures_.points = set_->report().points;
  figures_.particles = set_->report().particles;
  figures_.members = static_cast<double>(set_->report().memberships) / figures_.particles;
}

double RepeatedRepair::run() {
  const auto follow = [&] {
    return seconds_of([&] { require(set_->follow(scene_.model(), {&change_, 1})); });
  };
  const auto report = scene_.model().tear(scene_.next_pose(), scene_.stroke, {}, &change_);
  require(report);
  figures_.faces_crossed = report->faces_crossed;
  const double seconds = follow_.emplace_back(follow());
  double settle = 0, longest = 0;
  int calls = 0;
  for (bool has_more = true; has_more; ++calls) {
    const double call = seconds_of([&] { has_more = set_->settle(scene_.model()); });
    settle += call;
    longest = std::max(longest, call);
  }
  settle_.push_back(settle);
  settle_calls_.push_back(calls);
  longest_settle_call_.push_back(longest);
  require(scene_.model().undo(&change_));
  undo_.push_back(follow());
  return seconds;
}

RepeatedRepair::Figures RepeatedRepair::figures() const {
  Figures result = figures_;
  result.follow = median_without_first(follow_);
  result.first = follow_.front();
  result.settle = median_without_first(settle_);
  result.undo = median_without_first(undo_);
  result.settle_calls = median_without_first(settle_calls_);
  result.longest_settle_call = median_without_first(longest_settle_call_);
  return result;
}

}  // namespace sunder::bench
