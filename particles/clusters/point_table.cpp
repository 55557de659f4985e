#include "particles/clusters/point_table.h"

namespace sunder::particles {

void PointTable::put_on_lip(Index point, Index tear, Side side) {
  LipPoint& lip = lip_points[point];
  if (lip.tear == kNone || lip.tear == tear) {
    lip.tear = tear;
    lip.side = side;
    return;
  }
  OnLip behind = lip;
  const bool is_newer = tear > lip.tear;
  if (!is_newer) behind = {tear, side, lip.older};
  older_lips.push_back(behind);
  lip.older = static_cast<Index>(older_lips.size() - 1);
  if (is_newer) {
    lip.tear = tear;
    lip.side = side;
  }
}

void PointTable::drop_undone() {
  memberships.shrink(ends.memberships);
  older_lips.resize(ends.older_lips);
}

void PointTable::make_room(std::size_t points) {
  for_each_column([&](auto& column) { reserve_eighth(column, points); }, *this);
}

}  // namespace sunder::particles
