#include "particles/rupture/perforations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/internal/elementary.h"
#include "core/internal/ordered.h"
#include "particles/clusters/structure_of.h"

namespace sunder::particles {
namespace {

/// The angle at which a tear beside a line joins it: it moves on by this many times its distance.
constexpr double kJoinsWithin = 2.0;
/// A course shorter than this part of the wanted length is at the end of its line.
constexpr double kLeastCoursePart = 0.05;

Vec3d place_of(const Structure& structure, const TornModel& model, const TissuePlace& of) {
  const Mesh& mesh = model.character().meshes[of.mesh];
  const Triangle& triangle = model.source().meshes[of.mesh].triangles[of.triangle];
  Vec3d sum = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    sum += of.barycentric[k] *
           structure.character.decomposition_pose.place(mesh, triangle[k]).cast<double>();
  return sum;
}

double angle_between(const Vec3d& a, const Vec3d& b) {
  return elementary::atan2(norm(Vec3d(a.cross(b))), dot(a, b));
}

}  // namespace

double release_after_turn(double angle) {
  const double turn = angle / std::numbers::pi;
  if (!(turn < 1)) return 0;
  return elementary::exp(turn * elementary::log((1 - turn) / (1 + turn)));
}

Perforations::Perforations(const ParticleSet& set, const TornModel& model) {
  const Structure& structure = StructureOf::in(set);
  if (!structure.authored.tissue) return;
  for (const Perforation& perforation : structure.authored.tissue->perforations) {
    Line line;
    line.places = perforation.line;
    line.strength = perforation.strength;
    line.is_closed = perforation.line.front() == perforation.line.back();
    double arc = 0;
    for (const TissuePlace& of : perforation.line) {
      const Vec3d at = place_of(structure, model, of);
      if (!line.at.empty()) arc += norm(Vec3d(at - line.at.back()));
      line.at.push_back(at);
      line.arcs.push_back(arc);
    }
    if (arc > 0) lines_.push_back(std::move(line));
  }
}

Perforations::Nearest Perforations::nearest(const Line& line, const Vec3d& position) {
  Nearest found{0, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 1; i < line.at.size(); ++i) {
    const Vec3d along = line.at[i] - line.at[i - 1], to = position - line.at[i - 1];
    const double square = squared_norm(along);
    const double part = square > 0 ? std::clamp(dot(to, along) / square, 0.0, 1.0) : 0.0;
    const double distance = norm(Vec3d(to - part * along));
    if (distance < found.distance)
      found = {line.arcs[i - 1] + part * (line.arcs[i] - line.arcs[i - 1]), distance};
  }
  return found;
}

Perforations::Between Perforations::between(const Line& line, double arc) {
  if (line.is_closed) arc -= std::floor(arc / line.length()) * line.length();
  const auto after = std::lower_bound(line.arcs.begin() + 1, line.arcs.end() - 1, arc);
  const auto i = static_cast<std::size_t>(after - line.arcs.begin());
  const double width = line.arcs[i] - line.arcs[i - 1];
  return {i - 1, width > 0 ? std::clamp((arc - line.arcs[i - 1]) / width, 0.0, 1.0) : 0.0};
}

double Perforations::moved(const Line& line, double arc, double by) {
  return line.is_closed ? arc + by : std::clamp(arc + by, 0.0, line.length());
}

Vec3d Perforations::place(std::size_t line, double arc) const {
  const Line& of = lines_[line];
  const auto [first, part] = between(of, arc);
  return (1 - part) * of.at[first] + part * of.at[first + 1];
}

Course Perforations::from_tip(const Vec3d& tip, const Vec3d& forward, double length,
                              double& ease) const {
  Course best;
  ease = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    const auto [arc, distance] = nearest(line, tip);
    if (!(distance < length)) continue;
    for (const double way : {1.0, -1.0}) {
      Course course{i};
      course.begin = moved(line, arc, way * std::min(kJoinsWithin * distance, 0.5 * length));
      const double beside = norm(Vec3d(place(i, course.begin) - tip));
      if (!(beside < length)) continue;
      course.end = moved(line, course.begin, way * std::min(length - beside, line.length()));
      course.length = beside + std::abs(course.end - course.begin);
      if (course.length < kLeastCoursePart * length) continue;
      course.strength =
          (beside + line.strength * std::abs(course.end - course.begin)) / course.length;
      // Where the line bends, the first half of the course counts.
      const Vec3d to = place(i, moved(line, course.begin, 0.5 * (course.end - course.begin))) - tip;
      const double found = release_after_turn(angle_between(forward, to)) / course.strength;
      if (!(found > ease)) continue;
      ease = found;
      best = course;
    }
  }
  return best;
}

Course Perforations::around(const Vec3d& position, double within, double length,
                            Vec3d& along) const {
  Course best;
  double least = within;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    const auto [arc, distance] = nearest(line, position);
    if (!(distance < least)) continue;
    least = distance;
    const double half = 0.5 * std::min(length, line.length());  // a closed line is passed once
    best = {i, moved(line, arc, -half), moved(line, arc, half)};
    best.length = std::abs(best.end - best.begin);
    best.strength = line.strength;
    along = normalized(Vec3d(place(i, best.end) - place(i, best.begin)));
  }
  return best;
}

std::vector<std::pair<Vec3d, Vec3d>> Perforations::posed(const Course& course,
                                                         const TornModel& model,
                                                         const SurfacePose& pose) const {
  const Line& line = lines_[course.line];
  const auto at = [&](std::size_t i) {
    const TissuePlace& of = line.places[i];
    const Triangle& triangle = model.source().meshes[of.mesh].triangles[of.triangle];
    std::array<Vec3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = pose.place(model, VertexRef{of.mesh, triangle[k]});
    Vec3d place = Vec3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) place += of.barycentric[k] * corners[k];
    const Vec3d across = Vec3d(corners[1] - corners[0]).cross(Vec3d(corners[2] - corners[0]));
    return std::pair<Vec3d, Vec3d>(place, normalized(across));
  };
  std::vector<std::pair<Vec3d, Vec3d>> path;
  const auto add = [&](double arc) {
    const auto [first, part] = between(line, arc);
    const auto a = at(first), b = at(first + 1);
    path.emplace_back((1 - part) * a.first + part * b.first,
                      normalized(Vec3d((1 - part) * a.second + part * b.second)));
  };
  add(course.begin);
  // The places of the line in between, in the order of the course. A closed line is passed once.
  const bool is_up = course.end > course.begin;
  const double low = std::min(course.begin, course.end), high = std::max(course.begin, course.end);
  std::vector<double> arcs;
  for (const double turn : {-line.length(), 0.0, line.length()})
    for (const double arc : line.arcs)
      if ((turn == 0 || line.is_closed) && arc + turn > low && arc + turn < high)
        arcs.push_back(arc + turn);
  std::ranges::sort(arcs);
  arcs.erase(std::unique(arcs.begin(), arcs.end()), arcs.end());
  if (!is_up) std::ranges::reverse(arcs);
  for (const double arc : arcs) add(arc);
  add(course.end);
  return path;
}

}  // namespace sunder::particles
