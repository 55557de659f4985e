#include "tear/path/faces_near_blades.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::tear {
namespace {

/// How far outside of a box a blade may hit what is inside, by rounding.
double margin_around(const Vec3d& low, const Vec3d& high) {
  const double largest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  return kNearBladeSizes * (high - low).maxCoeff() + kPosedCoordinates * largest;
}

std::array<ScratchVector<float>, 6> six_in(ScratchMemory& scratch) {
  using Numbers = ScratchVector<float>;
  return {Numbers(&scratch), Numbers(&scratch), Numbers(&scratch),
          Numbers(&scratch), Numbers(&scratch), Numbers(&scratch)};
}

}  // namespace

FacesNearBlades::FacesNearBlades(const Workpiece& work)
    : work_(work),
      frame_origin_(work.posed.frame_along(Mat3d::Identity(), work.editor).origin),
      faces_(&work.editor.scratch()),
      boxes_(six_in(work.editor.scratch())),
      is_near_(&work.editor.scratch()),
      places_(&work.editor.scratch()),
      known_(&work.editor.scratch()),
      selected_(&work.editor.scratch()),
      crossed_(&work.editor.scratch()) {
  clear();
}

void FacesNearBlades::clear() {
  faces_.clear();
  is_near_.clear();
  places_.clear();
  known_.clear();
  selected_.clear();
  for (ScratchVector<float>& numbers : boxes_) numbers.clear();
  low_ = Vec3d::Constant(std::numeric_limits<double>::infinity());
  high_ = -low_;
}

void FacesNearBlades::include(const Blade& blade) {
  low_ = low_.cwiseMin(blade.base).cwiseMin(blade.tip);
  high_ = high_.cwiseMax(blade.base).cwiseMax(blade.tip);
}

void FacesNearBlades::collect() {
  if (!(low_.x() <= high_.x())) return;
  origin_ = 0.5 * (low_ + high_);
  margin_ = margin_around(low_, high_);
  const Frame frame = {Mat3d::Identity(), frame_origin_};
  const Vec3d margin = Vec3d::Constant(margin_), low = low_ - margin - frame_origin_,
              high = high_ + margin - frame_origin_;
  const auto may_hold = [&](const FrameBox& tight) {
    const FrameBox box = tight.widened(frame.reach());
    for (int k = 0; k < 3; ++k)
      if (box.low[k] > high[k] || box.high[k] < low[k]) return false;
    return true;  // also if no bound is known
  };
  work_.posed.for_each_face(
      work_.editor, frame, may_hold, [&](Index face) { add_face(face); }, NewFillings::one_by_one);
  is_near_.resize(faces_.size());
  places_.assign(faces_.size(), kNone);
}

FacesNearBlades::Box FacesNearBlades::relative(const Vec3d& low, const Vec3d& high) const {
  const Vec3f from = Vec3d(low - origin_).cast<float>(), to = Vec3d(origin_ - high).cast<float>();
  return {from.x(), from.y(), from.z(), to.x(), to.y(), to.z()};
}

void FacesNearBlades::add_face(Index face) {
  const FaceCorners corners = posed_corners(work_.editor, work_.posed, face);
  const Vec3d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]),
              high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  // A face near the blades has no larger coordinates than they and its size.
  const Vec3d margin = Vec3d::Constant(margin_ + kNearBladeSizes * (high - low).maxCoeff());
  const Vec3d from = low - margin, to = high + margin;
  for (int k = 0; k < 3; ++k)
    if (from[k] > high_[k] || to[k] < low_[k]) return;
  faces_.push_back(face);
  const Box box = relative(from, to);
  for (std::size_t k = 0; k < 6; ++k) boxes_[k].push_back(box[k]);
}

void FacesNearBlades::compare(const Box& box) {
  const float x = -box[3], y = -box[4], z = -box[5], right = -box[0], top = -box[1],
              front = -box[2];
  const std::size_t count = faces_.size();
  unsigned char* const near = is_near_.data();
  const float *a = boxes_[0].data(), *b = boxes_[1].data(), *c = boxes_[2].data(),
              *d = boxes_[3].data(), *e = boxes_[4].data(), *f = boxes_[5].data();
  for (std::size_t i = 0; i < count; ++i)  // numbers that are not finite are near
    near[i] = static_cast<unsigned char>(
        !((a[i] > x) | (b[i] > y) | (c[i] > z) | (d[i] > right) | (e[i] > top) | (f[i] > front)));
}

std::size_t FacesNearBlades::next_near(std::size_t from) const {
  if (from >= is_near_.size()) return is_near_.size();
  const void* const found = std::memchr(&is_near_[from], 1, is_near_.size() - from);
  if (found == nullptr) return is_near_.size();
  return static_cast<std::size_t>(static_cast<const unsigned char*>(found) - is_near_.data());
}

void FacesNearBlades::select(std::span<const Blade> blades) {
  Vec3d low = blades[0].base, high = low;
  for (const Blade& blade : blades) {
    low = low.cwiseMin(blade.base).cwiseMin(blade.tip);
    high = high.cwiseMax(blade.base).cwiseMax(blade.tip);
  }
  compare(relative(low, high));
  selected_.clear();
  for (std::size_t at = next_near(0); at < faces_.size(); at = next_near(at + 1)) {
    if (places_[at] == kNone) {
      places_[at] = static_cast<Index>(known_.size());
      known_.push_back(know(faces_[at]));
    }
    selected_.push_back(places_[at]);
  }
}

FacesNearBlades::Known FacesNearBlades::know(Index face) const {
  Known known;
  known.face = face;
  known.corners = posed_corners(work_.editor, work_.posed, face);
  const Vec3d ab = known.corners[1] - known.corners[0], ac = known.corners[2] - known.corners[0];
  known.normal = ab.cross(ac);
  const double reach = (high_ - low_).maxCoeff() + ab.cwiseAbs().maxCoeff() +
                       ac.cwiseAbs().maxCoeff() + known.corners[0].cwiseAbs().maxCoeff();
  known.on_plane = kBoxSizes * reach * norm(known.normal);
  return known;
}

bool FacesNearBlades::Known::is_beside(const Blade& blade) const {
  const double at_base = dot(normal, Vec3d(blade.base - corners[0])),
               at_tip = dot(normal, Vec3d(blade.tip - corners[0]));
  return (at_base > on_plane && at_tip > on_plane) || (at_base < -on_plane && at_tip < -on_plane);
}

std::optional<SurfaceHit> FacesNearBlades::first_hit(const Blade& blade) {
  const Vec3d direction = blade.tip - blade.base;
  crossed_.clear();
  for (const Index place : selected_) {
    const Known& face = known_[place];
    if (face.is_beside(blade)) continue;
    const auto crossing = cross_triangle(blade.base, direction, face.corners);
    if (crossing && crossing->is_on_segment()) crossed_.push_back(place);
  }
  if (crossed_.empty()) return std::nullopt;
  const BladeSegment segment(blade, {axes_along(direction), frame_origin_});
  NearestHit nearest(segment);
  for (const Index place : crossed_) nearest.meet(known_[place].face, known_[place].corners);
  return nearest.hit();
}

}  // namespace sunder::tear
