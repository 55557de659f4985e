#include "support/oracles/membrane.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <Eigen/SparseCholesky>

#include "particles/internal/angular_frequency.h"
#include "support/machine/checked.h"
#include "support/models/rigs.h"
#include "tear/internal/surface.h"

namespace sunder::test {
namespace {

GapProfile gap_between(const SlitSheet& sheet, const std::vector<Vec3d>& displacements) {
  const std::span<const Vec3f> at = sheet.set->positions();
  std::vector<std::size_t> order(sheet.lips.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto x_of = [&](std::size_t i) { return double{at[sheet.lips[i].left].x()}; };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return x_of(a) < x_of(b); });
  Eigen::AlignedBox3f box;
  for (const Vec3f& place : at) box.extend(Eigen::Vector3f(place));
  GapProfile gap;
  gap.half_length = sheet.half_length;
  for (const std::size_t i : order) {
    gap.x.push_back(x_of(i) - double{box.center().x()});
    gap.width.push_back(
        (displacements[sheet.lips[i].left] - displacements[sheet.lips[i].right]).norm());
  }
  return gap;
}

/// The threads of a slit, each of which grips lips within a distance, most in its middle.
std::vector<GrippingThread> gripping_threads(const SlitSheet& sheet, double grip) {
  std::vector<GrippingThread> threads;
  const std::span<const Vec3f> at = sheet.set->positions();
  for (const SutureThread& of : threads_of(*sheet.model)) {
    GrippingThread& thread = threads.emplace_back(GrippingThread{of.stiffness, {}});
    double sum = 0;
    for (const LipPair& lip : sheet.lips) {
      const double away = double{std::abs(at[lip.left].x() - at[of.left].x())};
      const double weight = lip.left == of.left || lip.left == of.right ? 1.0 : 1 - away / grip;
      if (!(weight > 0)) continue;
      sum += weight;
      thread.points.push_back({lip.left, weight});
      thread.points.push_back({lip.right, -weight});
    }
    for (auto& [point, weight] : thread.points) weight /= sum;
  }
  return threads;
}

/// The width at a place: its square is linear between those that are known, as it is next to tips.
double width_at(const GapProfile& gap, double x) {
  const auto after = std::lower_bound(gap.x.begin(), gap.x.end(), x);
  const auto i = static_cast<std::size_t>(after - gap.x.begin());
  const bool is_first = i == 0, is_last = i == gap.x.size();
  const double x0 = is_first ? -gap.half_length : gap.x[i - 1],
               x1 = is_last ? gap.half_length : gap.x[i];
  const double w0 = is_first ? 0 : gap.width[i - 1], w1 = is_last ? 0 : gap.width[i];
  const double t = x1 > x0 ? std::clamp((x - x0) / (x1 - x0), 0.0, 1.0) : 1.0;
  return std::sqrt((1 - t) * w0 * w0 + t * w1 * w1);
}

}  // namespace

std::vector<Vec3d> solve_membrane(const TornModel& model, std::span<const Vec3f> positions,
                                  const SoftMaterial& material, std::span<const Vec3d> forces,
                                  const FactorsOfPlace& factors,
                                  std::span<const GrippingThread> threads) {
  const tear::Surface& surface = model.surface();
  const auto count = static_cast<Eigen::Index>(positions.size());
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<bool> has_face(positions.size(), false);
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    const tear::TriangleRef of = surface.triangle(t);
    if (surface.has_repeated_point(t) ||
        of.source_triangle >= model.source().meshes[of.mesh].triangles.size())
      continue;
    const std::uint32_t* points = &surface.corner_point[std::size_t{3} * t];
    std::array<Eigen::Vector3d, 3> at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = positions[points[k]].cast<double>();
    const double twice = (at[1] - at[0]).cross(at[2] - at[0]).norm();
    if (!(twice > 1e-12)) continue;
    FactorsAt factor;
    if (factors) factor = factors(Vec3d((at[0] + at[1] + at[2]) / 3));
    const double stiffness = material.membrane_stiffness * factor.stiffness * factor.thickness;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(points[i]);
      has_face[points[i]] = true;
      entries.emplace_back(row, row,
                           material.areal_density * factor.thickness *
                               particles::squared_frequency(material.return_frequency) * twice / 6);
      for (std::size_t j = 0; j < 3; ++j) {
        // The gradient of a corner's function is its opposite edge, turned, over twice the area.
        const Eigen::Vector3d mine = at[(i + 2) % 3] - at[(i + 1) % 3],
                              other = at[(j + 2) % 3] - at[(j + 1) % 3];
        entries.emplace_back(row, static_cast<Eigen::Index>(points[j]),
                             stiffness * mine.dot(other) / (2 * twice));
      }
    }
  }
  for (std::uint32_t p = 0; p < positions.size(); ++p)
    if (!has_face[p]) entries.emplace_back(p, p, 1.0);
  for (const GrippingThread& thread : threads)
    for (const auto& [row, of_row] : thread.points)
      for (const auto& [column, of_column] : thread.points)
        entries.emplace_back(row, column, thread.stiffness * of_row * of_column);
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success) std::abort();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, 3);
  for (std::uint32_t p = 0; p < positions.size(); ++p)
    if (has_face[p]) right.row(p) = forces[p].transpose();
  const Eigen::MatrixXd found = solver.solve(right);
  std::vector<Vec3d> displacements;
  for (Eigen::Index p = 0; p < count; ++p) displacements.emplace_back(found.row(p).transpose());
  return displacements;
}

AuthoredTissue authored(const Character& character, const FactorsOfPlace& factors) {
  AuthoredTissue tissue;
  if (!factors) return tissue;
  TissueFactors& of = tissue.meshes.emplace_back();
  for (const Vec3f& place : character.meshes[0].positions) {
    const FactorsAt at = factors(place.cast<double>());
    of.stiffness.push_back(static_cast<float>(at.stiffness));
    of.tension.push_back(static_cast<float>(at.tension));
    of.thickness.push_back(static_cast<float>(at.thickness));
  }
  return tissue;
}

TissuePlace place_on_sheet(const Character& character, const Vec3d& position) {
  const Mesh& mesh = character.meshes[0];
  TissuePlace best;
  double most = -1e30;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<Vec3d, 3> at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = mesh.positions[mesh.triangles[t][k]].cast<double>();
    const auto area = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
      return (b - a).cross(c - a).z();
    };
    const double whole = area(at[0], at[1], at[2]);
    const std::array<double, 3> parts = {area(position, at[1], at[2]) / whole,
                                         area(at[0], position, at[2]) / whole,
                                         area(at[0], at[1], position) / whole};
    const double least = std::min({parts[0], parts[1], parts[2]});
    if (least <= most) continue;
    most = least;
    best = {0, t, parts};
  }
  double sum = 0;
  for (double& part : best.barycentric) sum += part = std::max(part, 0.0);
  for (double& part : best.barycentric) part /= sum;
  return best;
}

std::vector<Vec3d> lip_forces(const ParticleSet& set, double newtons_per_metre,
                              const FactorsOfPlace& factors) {
  std::vector<Vec3d> forces(set.point_count(), Vec3d::Zero());
  const std::span<const Vec3f> at = set.positions();
  for (const LipEdge& lip : set.lips()) {
    const Vec3d middle = 0.5 * (at[lip.points[0]] + at[lip.points[1]]).cast<double>();
    const double factor = factors ? factors(middle).tension : 1.0;
    for (const std::uint32_t point : lip.points)
      forces[point] += 0.5 * factor * newtons_per_metre * lip.inward.cast<double>();
  }
  return forces;
}

SlitSheet::SlitSheet(std::uint32_t cells, double half, double range, const SoftMaterial& material,
                     double size, std::uint64_t seed_order, FactorsOfPlace fields)
    : half_length(size * half), factors(std::move(fields)) {
  character = std::make_shared<const Character>(make_sheet(cells, static_cast<float>(size)));
  model = std::make_unique<TornModel>(checked(TornModel::create(character)));
  pose = checked(bind_pose(*character));
  set = std::make_unique<ParticleSet>(checked(ParticleSet::create(
      *model, pose, {size * range, false, seed_order}, authored(*character, factors))));
  body = std::make_unique<SoftBody>(checked(SoftBody::create(*set, pose, {&material, 1})));
  const auto blade = [&](double x) {
    const double y = 0.503;
    return Blade{{size * x, size * y, size * 0.5}, {size * x, size * y, -0.5 * size}};
  };
  const Stroke stroke = {blade(0.5 - half), blade(0.5 + half)};
  ChangeRecord change;
  (void)checked(model->tear(pose, stroke, {}, &change));
  lips = change.lips;
  check(set->follow(*model, {&change, 1}));
  while (set->settle(*model, 100000)) continue;
}

void SlitSheet::sew(const Suture& suture) {
  ChangeRecord change;
  (void)checked(sunder::suture(*model, pose, suture, &change));
  check(set->follow(*model, {&change, 1}));
}

void pull_open(SoftBody& body, const TornModel& model, const ModelPose& pose,
               double newtons_per_metre) {
  check(body.set_tension({newtons_per_metre, {}}));
  check(body.step(model, pose, 1.0 / 60));
  // Long steps end in the balance, which is all that counts here.
  for (int i = 0; i < 400 && body.awake_count() > 0; ++i) check(body.step(model, pose, 0.1));
}

double GapProfile::widest() const { return *std::max_element(width.begin(), width.end()); }

GapProfile gap_of(const SlitSheet& sheet) {
  std::vector<Vec3d> displacements;
  for (std::uint32_t p = 0; p < sheet.set->point_count(); ++p)
    displacements.push_back(sheet.body->point_displacement(p));
  return gap_between(sheet, displacements);
}

GapProfile reference_gap(const SlitSheet& sheet, double newtons_per_metre, double grip) {
  return gap_between(
      sheet, solve_membrane(*sheet.model, sheet.set->positions(), sheet.body->materials()[0],
                            lip_forces(*sheet.set, newtons_per_metre, sheet.factors), sheet.factors,
                            gripping_threads(sheet, grip)));
}

double widest_between_threads(const SlitSheet& sheet, const GapProfile& gap) {
  std::vector<double> at;
  for (const SutureThread& thread : threads_of(*sheet.model))
    at.push_back(double{sheet.set->positions()[thread.left].x()} - 0.5);
  const auto [first, last] = std::minmax_element(at.begin(), at.end());
  double widest = 0;
  for (std::size_t i = 0; i < gap.x.size(); ++i)
    if (gap.x[i] > *first && gap.x[i] < *last) widest = std::max(widest, gap.width[i]);
  return widest;
}

double rms_difference(const GapProfile& found, const GapProfile& wanted) {
  double sum = 0;
  for (std::size_t i = 0; i < wanted.x.size(); ++i)
    sum += std::pow(width_at(found, wanted.x[i]) - wanted.width[i], 2);
  return std::sqrt(sum / static_cast<double>(wanted.x.size())) / wanted.widest();
}

Asymmetry asymmetry(const GapProfile& gap) {
  constexpr int kPlaces = 200;
  Asymmetry result;
  double squares = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double part = (i + 0.5) / kPlaces, x = part * gap.half_length;
    const double difference = std::abs(width_at(gap, x) - width_at(gap, -x)) / gap.widest();
    squares += difference * difference / kPlaces;
    if (part < 0.9) result.most = std::max(result.most, difference);
  }
  result.rms = std::sqrt(squares);
  return result;
}

double difference_from_ellipse(const GapProfile& gap, double half_length) {
  const auto ellipse = [&](double x) {
    return std::sqrt(std::max(0.0, 1 - x * x / (half_length * half_length)));
  };
  double product = 0, square = 0;
  for (std::size_t i = 0; i < gap.x.size(); ++i) {
    product += gap.width[i] * ellipse(gap.x[i]);
    square += ellipse(gap.x[i]) * ellipse(gap.x[i]);
  }
  const double height = product / square;
  double sum = 0;
  for (std::size_t i = 0; i < gap.x.size(); ++i)
    sum += std::pow(gap.width[i] - height * ellipse(gap.x[i]), 2);
  return std::sqrt(sum / static_cast<double>(gap.x.size())) / height;
}

}  // namespace sunder::test
