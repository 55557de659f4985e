#include "tear/operation/all_layers.h"

#include "tear/sheet/open_sheet.h"

namespace sunder::tear {

void tear_all_layers(const BladePlane& plane, const Workpiece& work, Outcome& outcome) {
  Sheet sheet{plane.left_of(0), ScratchVector<Sheet::Bound>(&work.editor.scratch())};
  for (const auto& reach : plane.reach()) sheet.bounds.push_back({plane.standing_on(reach), kNone});
  sheet.bounds.push_back({plane.standing_on(plane.from_progress(0)), kNone});
  const SheetOpening opening = open_sheet(sheet, faces_across(sheet, work.editor, work.posed),
                                          false, work, outcome.borders.lips);
  outcome.report.faces_crossed += opening.faces_crossed;
  outcome.report.blocked += opening.blocked;
  outcome.report.length_posed += opening.length_posed;
  outcome.report.runs += opening.runs;
  if (opening.edges.empty()) ++outcome.report.segments_missed;
}

}  // namespace sunder::tear
