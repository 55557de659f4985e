#include "tools/picture/operation_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <variant>

namespace sunder::tools {
namespace {

using Layer = Marks::Layer;

// Linear RGBA.
const Vec4f kStroke(0.90f, 0.02f, 0.02f, 1), kSwept(0.90f, 0.02f, 0.02f, 0.35f);
const Vec4f kBase(0.02f, 0.55f, 0.05f, 1), kTip(1.0f, 0.75f, 0.0f, 1), kEdge(0.02f, 0.0f, 0.0f, 1);
const Vec4f kPlane(0.02f, 0.12f, 0.85f, 1), kSection(0.05f, 0.20f, 0.95f, 0.30f);
const Vec4f kBore(0.42f, 0.02f, 0.60f, 1), kWall(0.42f, 0.02f, 0.60f, 0.30f);
constexpr double kLine = 2.5, kBladeLine = 1.8;  // Pixels.
constexpr double kBaseRadius = 9, kTipRadius = 4, kPlaceRadius = 5;
constexpr int kSides = 32;           // Of a circle.
constexpr std::size_t kMarked = 40;  // Longer strokes have marks at their ends alone.

/// The model's box, larger on each side by a share of its diagonal.
Bounds enlarged_box(const Bounds& model, double share) {
  Bounds box = model;
  box.least.array() -= share * model.size().norm();
  box.greatest.array() += share * model.size().norm();
  return box;
}

/// Sorts the corners of a convex polygon around its middle.
void sort_around(std::vector<Vec3d>& corners, const Vec3d& normal) {
  Vec3d middle = Vec3d::Zero();
  for (const Vec3d& corner : corners) middle += corner / static_cast<double>(corners.size());
  const Vec3d u = normal.unitOrthogonal(), v = normal.cross(u);
  std::sort(corners.begin(), corners.end(), [&](const Vec3d& a, const Vec3d& b) {
    return std::atan2((a - middle).dot(v), (a - middle).dot(u)) <
           std::atan2((b - middle).dot(v), (b - middle).dot(u));
  });
}

/// Where a plane meets the edges of a box.
std::vector<Vec3d> section_of(const Bounds& box, const Vec3d& point, const Vec3d& normal) {
  std::vector<Vec3d> corners;
  for (int axis = 0; axis < 3; ++axis)
    for (int edge = 0; edge < 4; ++edge) {
      Vec3d from = box.least;
      const int second = (axis + 1) % 3, third = (axis + 2) % 3;
      if ((edge & 1) != 0) from[second] = box.greatest[second];
      if ((edge & 2) != 0) from[third] = box.greatest[third];
      Vec3d to = from;
      to[axis] = box.greatest[axis];
      const double a = (from - point).dot(normal), b = (to - point).dot(normal);
      if ((a < 0) != (b < 0)) corners.emplace_back(from + a / (a - b) * (to - from));
    }
  if (!corners.empty()) sort_around(corners, normal);
  return corners;
}

/// The polygon in which a cut is drawn; empty if its plane passes the model by.
std::vector<Vec3d> outline_of(const PlaneCut& cut, const Bounds& model) {
  const Vec3d normal = cut.normal.normalized();
  if (cut.bounds.empty()) return section_of(enlarged_box(model, 0.06), cut.point, normal);
  std::vector<Vec3d> corners;
  for (const Vec3d& corner : cut.bounds)
    corners.emplace_back(corner - (corner - cut.point).dot(normal) * normal);
  return corners;
}

Vec3d middle_of(const std::vector<Vec3d>& corners) {
  Vec3d middle = Vec3d::Zero();
  for (const Vec3d& corner : corners) middle += corner / static_cast<double>(corners.size());
  return middle;
}

std::vector<Vec3d> rim_of(const Bore& bore, double distance) {
  const Vec3d axis = bore.direction.normalized();
  const Vec3d u = axis.unitOrthogonal(), v = axis.cross(u);
  std::vector<Vec3d> rim;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    rim.emplace_back(bore.origin + distance * axis +
                     bore.radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return rim;
}

void draw_loop(std::span<const Vec3d> corners, const Vec4f& color, Marks& marks) {
  for (std::size_t i = 0; i < corners.size(); ++i)
    marks.line(corners[i], corners[(i + 1) % corners.size()], kLine, color, Layer::on_top);
}

void draw_blade_ends(const Blade& blade, Marks& marks) {
  marks.disc(blade.base, kBaseRadius + 1.5, 4, kEdge, Layer::on_top);
  marks.disc(blade.base, kBaseRadius, 4, kBase, Layer::on_top);
  marks.disc(blade.tip, kTipRadius + 1.5, 20, kEdge, Layer::on_top);
  marks.disc(blade.tip, kTipRadius, 20, kTip, Layer::on_top);
}

struct Drawer {
  const Bounds& model;
  Marks& marks;

  /// @return where the index is written.
  Vec3d operator()(const TearOperation& tear) const {
    const Stroke& stroke = tear.stroke;
    for (std::size_t i = 1; i < stroke.size(); ++i) {
      const std::array<Vec3d, 4> swept = {stroke[i - 1].base, stroke[i - 1].tip, stroke[i].tip,
                                          stroke[i].base};
      // Two triangles, because a blade may turn between its positions.
      marks.polygon(std::span(swept).first(3), kSwept, Layer::in_scene);
      marks.polygon(std::array{swept[0], swept[2], swept[3]}, kSwept, Layer::in_scene);
      marks.line(stroke[i - 1].base, stroke[i].base, kLine, kStroke, Layer::on_top);
      marks.line(stroke[i - 1].tip, stroke[i].tip, kLine, kStroke, Layer::on_top);
    }
    for (const Blade& blade : stroke)
      marks.line(blade.base, blade.tip, kBladeLine, kStroke, Layer::on_top);
    for (std::size_t i = 0; i < stroke.size(); ++i)
      if (stroke.size() <= kMarked || i == 0 || i + 1 == stroke.size())
        draw_blade_ends(stroke[i], marks);
    return stroke.front().base;
  }
  Vec3d operator()(const CutOperation& operation) const {
    const PlaneCut& cut = operation.cut;
    const std::vector<Vec3d> outline = outline_of(cut, model);
    if (outline.empty()) return cut.point;
    marks.polygon(outline, kSection, Layer::in_scene);
    draw_loop(outline, kPlane, marks);
    // The arrow points to the left lip.
    const Vec3d middle = middle_of(outline);
    const Vec3d towards = middle + 0.1 * model.size().norm() * cut.normal.normalized();
    marks.line(middle, towards, kLine, kPlane, Layer::on_top);
    marks.disc(towards, kPlaceRadius, 3, kPlane, Layer::on_top);
    for (const Vec3d& place : cut.sections) {
      marks.disc(place, kPlaceRadius + 1.5, 20, kEdge, Layer::on_top);
      marks.disc(place, kPlaceRadius, 20, kTip, Layer::on_top);
    }
    return outline.front();
  }
  Vec3d operator()(const DrillOperation& operation) const {
    const Bore& bore = operation.bore;
    const std::vector<Vec3d> start = rim_of(bore, 0), end = rim_of(bore, bore.depth);
    for (std::size_t i = 0; i < start.size(); ++i) {
      const std::size_t next = (i + 1) % start.size();
      marks.polygon(std::array{start[i], end[i], end[next], start[next]}, kWall, Layer::in_scene);
      if (i % (kSides / 4) == 0) marks.line(start[i], end[i], 1.2, kBore, Layer::on_top);
    }
    draw_loop(start, kBore, marks);
    draw_loop(end, kBore, marks);
    marks.disc(bore.origin, kBaseRadius, 4, kBase, Layer::on_top);
    return bore.origin;
  }
  Vec3d operator()(const DetachOperation& operation) const {
    const auto* const near = std::get_if<PieceNear>(&operation.piece);
    if (near == nullptr) return model.centre();
    marks.disc(near->point, kPlaceRadius + 1.5, 20, kEdge, Layer::on_top);
    marks.disc(near->point, kPlaceRadius, 20, kTip, Layer::on_top);
    return near->point;
  }
  Vec3d operator()(const WeldOperation& operation) const {
    return mark_places(operation.weld.places);
  }
  Vec3d operator()(const SutureOperation& operation) const {
    return mark_places(operation.suture.places);
  }
  // Nothing of these is at a place.
  Vec3d operator()(const WeightsOperation&) const { return model.centre(); }
  Vec3d operator()(const UndoOperation&) const { return model.centre(); }
  Vec3d operator()(const RedoOperation&) const { return model.centre(); }

 private:
  [[nodiscard]] Vec3d mark_places(const std::vector<Vec3d>& places) const {
    for (const Vec3d& place : places) {
      marks.disc(place, kPlaceRadius + 1.5, 20, kEdge, Layer::on_top);
      marks.disc(place, kPlaceRadius, 20, kTip, Layer::on_top);
    }
    return places.empty() ? model.centre() : places.front();
  }
};

/// Whether an operation has a place that a picture can mark.
bool has_place(const Operation& operation) {
  const auto* const detached = std::get_if<DetachOperation>(&operation);
  if (detached != nullptr) return std::holds_alternative<PieceNear>(detached->piece);
  const auto* const weld = std::get_if<WeldOperation>(&operation);
  if (weld != nullptr) return !weld->weld.places.empty();
  const auto* const suture = std::get_if<SutureOperation>(&operation);
  if (suture != nullptr) return !suture->suture.places.empty();
  return !std::holds_alternative<WeightsOperation>(operation);
}

struct Extremes {
  const Bounds& model;

  std::vector<Vec3d> operator()(const TearOperation& tear) const {
    std::vector<Vec3d> places;
    for (const Blade& blade : tear.stroke) {
      places.push_back(blade.base);
      places.push_back(blade.tip);
    }
    return places;
  }
  std::vector<Vec3d> operator()(const CutOperation& cut) const {
    return outline_of(cut.cut, model);
  }
  std::vector<Vec3d> operator()(const DrillOperation& drill) const {
    std::vector<Vec3d> places = rim_of(drill.bore, 0);
    const std::vector<Vec3d> end = rim_of(drill.bore, drill.bore.depth);
    places.insert(places.end(), end.begin(), end.end());
    return places;
  }
  std::vector<Vec3d> operator()(const DetachOperation& operation) const {
    const auto* const near = std::get_if<PieceNear>(&operation.piece);
    return near == nullptr ? std::vector<Vec3d>() : std::vector<Vec3d>{near->point};
  }
  std::vector<Vec3d> operator()(const WeldOperation& weld) const { return weld.weld.places; }
  std::vector<Vec3d> operator()(const SutureOperation& sewn) const { return sewn.suture.places; }
  std::vector<Vec3d> operator()(const WeightsOperation&) const { return {}; }
  std::vector<Vec3d> operator()(const UndoOperation&) const { return {}; }
  std::vector<Vec3d> operator()(const RedoOperation&) const { return {}; }
};

}  // namespace

std::vector<Vec3d> places_of(const std::vector<NumberedOperation>& operations,
                             const Bounds& model) {
  const Bounds box = enlarged_box(model, 0.5);
  std::vector<Vec3d> places;
  for (const NumberedOperation& logged : operations)
    for (const Vec3d& place : std::visit(Extremes{model}, *logged.operation))
      if ((place.array() >= box.least.array()).all() &&
          (place.array() <= box.greatest.array()).all())
        places.push_back(place);
  return places;
}

std::vector<OperationLabel> draw_operations(const std::vector<NumberedOperation>& operations,
                                            const Bounds& model, Marks& marks) {
  std::vector<OperationLabel> labels;
  for (const NumberedOperation& logged : operations)
    if (has_place(*logged.operation))
      labels.push_back(
          {std::visit(Drawer{model, marks}, *logged.operation), std::to_string(logged.index)});
  return labels;
}

std::vector<std::string> missing_from_picture(const std::vector<NumberedOperation>& operations,
                                              const Bounds& model, const Viewport& viewport) {
  std::vector<std::string> missing;
  for (const NumberedOperation& logged : operations) {
    const std::string name = "operation " + std::to_string(logged.index);
    if (std::holds_alternative<WeightsOperation>(*logged.operation)) {
      missing.push_back(name + " has no place: it assigns weights");
      continue;
    }
    if (std::holds_alternative<WeldOperation>(*logged.operation) && !has_place(*logged.operation)) {
      missing.push_back(name + " has no place: it closes all wounds");
      continue;
    }
    if (std::holds_alternative<SutureOperation>(*logged.operation) &&
        !has_place(*logged.operation)) {
      missing.push_back(name + " has no place: it sews all wounds");
      continue;
    }
    if (!has_place(*logged.operation)) {
      missing.push_back(name + " has no place: it names a piece by a triangle");
      continue;
    }
    const std::vector<Vec3d> places = std::visit(Extremes{model}, *logged.operation);
    const auto outside = std::count_if(places.begin(), places.end(), [&](const Vec3d& place) {
      return viewport.depth(place) <= 0 || !viewport.is_inside(viewport.pixel(place));
    });
    if (places.empty())
      missing.push_back(name + " is not drawn: its plane does not meet the model");
    else if (outside > 0)
      missing.push_back(name + (outside == static_cast<std::ptrdiff_t>(places.size())
                                    ? " is outside the picture"
                                    : " is partly outside the picture"));
  }
  return missing;
}

}  // namespace sunder::tools
