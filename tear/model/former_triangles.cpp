#include "tear/internal/former_triangles.h"

#include "tear/model/model_access.h"

namespace sunder::tear {

std::vector<TriangleHistory> triangles_before_operations(const TornModel& model) {
  const auto& state = ModelAccess::state_of(model);
  const EditLog& log = state.editor.log;
  const auto& done = state.history.done();
  std::vector<TriangleHistory> histories;
  histories.reserve(done.size());
  for (std::size_t i = 0; i < done.size(); ++i) {
    const EditLog::Mark& begin = done[i]->begin;
    EditLog::Extent end = log.extent();
    if (i + 1 < done.size())
      end = {done[i + 1]->begin.triangles, done[i + 1]->begin.triangle_changes};
    TriangleHistory& history = histories.emplace_back();
    history.count = begin.triangles;
    log.for_each_first_change(begin, end, [&](const TriangleChange& change) {
      history.former.push_back({change.triangle, change.points, change.vertices});
    });
  }
  return histories;
}

}  // namespace sunder::tear
