#pragma once

#include <sunder/particles/soft_body.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace sunder::test {

/// The factors of tissue at a place, as those of TissueFactors; for an oracle that samples fields
/// at places of its own.
struct FactorsAt {
  double stiffness = 1, tension = 1, thickness = 1;
};
using FactorsOfPlace = std::function<FactorsAt(const Vec3d&)>;

/// These fields at the vertices of a character of one mesh, whose bind pose they are given in.
AuthoredTissue authored(const Character& character, const FactorsOfPlace& factors);

/// The place on the surface of a character of one flat mesh in the plane z = 0 that is nearest to a
/// position, in its bind pose. O(triangles).
TissuePlace place_on_sheet(const Character& character, const Vec3d& position);

/// A spring that pulls a weighted sum of displacements to zero.
struct GrippingThread {
  double stiffness = 0;                                  ///< Newtons per metre.
  std::vector<std::pair<std::uint32_t, double>> points;  ///< With their weights.
};

/// The displacement of every point of a torn surface in balance: a membrane on an elastic
/// foundation, by finite elements with one unknown per point, linear on each face (cotangent
/// weights), and a sparse Cholesky factorisation. Walls and caps are no part of it. Independent of
/// any particles.
///
/// @param positions  per point.
/// @param material   its membrane_stiffness, areal_density and return_frequency count.
/// @param forces     per point, newtons.
/// @param factors    of the material, taken at the centroid of each face; empty: all 1.
/// @param threads    springs between sums of points.
/// @return metres; 0 at points without a face.
std::vector<Vec3d> solve_membrane(const TornModel& model, std::span<const Vec3f> positions,
                                  const SoftMaterial& material, std::span<const Vec3d> forces,
                                  const FactorsOfPlace& factors = {},
                                  std::span<const GrippingThread> threads = {});

/// The forces of a tension at lips: half of each edge's at each of its ends.
/// @param factors  taken at the middle of each edge; empty: all 1.
std::vector<Vec3d> lip_forces(const ParticleSet& set, double newtons_per_metre,
                              const FactorsOfPlace& factors = {});

/// Pulls the lips of a body apart until nothing moves any more.
void pull_open(SoftBody& body, const TornModel& model, const ModelPose& pose,
               double newtons_per_metre);

/// A flat sheet of one metre in the plane z = 0, with a slit along x in its middle.
struct SlitSheet {
  std::shared_ptr<const Character> character;
  std::unique_ptr<TornModel> model;
  ModelPose pose;
  std::unique_ptr<ParticleSet> set;
  std::unique_ptr<SoftBody> body;
  std::vector<LipPair> lips;
  double half_length = 0;  ///< Metres.
  FactorsOfPlace factors;

  /// @param cells  along each edge of the sheet.
  /// @param half_length  of the slit, metres.
  /// @param range  of the particles, metres.
  /// @param size  by which all lengths are multiplied.
  /// @param seed_order  of the particles' seeds.
  /// @param factors  of the material; empty: all 1.
  SlitSheet(std::uint32_t cells, double half_length, double range, const SoftMaterial& material,
            double size = 1, std::uint64_t seed_order = 0, FactorsOfPlace factors = {});

  void open(double newtons_per_metre) { pull_open(*body, *model, pose, newtons_per_metre); }
  void sew(const Suture& suture);
};

/// The distance of the lips along a slit, in the order of x.
struct GapProfile {
  std::vector<double> x, width;  ///< Metres; x from the middle of the slit.
  double half_length = 0;        ///< Metres: the lips meet at x = -half_length and half_length.

  [[nodiscard]] double widest() const;
};

/// The gap by the particles, and that of the reference under the same tension and with threads of
/// the same stiffness. Each of these grips the lips within a distance, most in its middle: a thread
/// that grips a point holds less and less as elements become finer.
GapProfile gap_of(const SlitSheet& sheet);
GapProfile reference_gap(const SlitSheet& sheet, double newtons_per_metre, double grip = 0);

/// The widest gap between the outermost threads.
double widest_between_threads(const SlitSheet& sheet, const GapProfile& gap);

/// Root of the mean squared difference along the slit, relative to the widest gap of the second.
double rms_difference(const GapProfile& found, const GapProfile& wanted);
/// The difference of the widths at x and -x, relative to the widest.
struct Asymmetry {
  double rms = 0;   ///< Root of the mean square along the slit.
  double most = 0;  ///< Largest, over the middle nine tenths of the slit.
};
Asymmetry asymmetry(const GapProfile& gap);
/// Root mean square of the difference from a sqrt(1 - (x / half_length)^2) with the best a,
/// relative to a.
double difference_from_ellipse(const GapProfile& gap, double half_length);

}  // namespace sunder::test
