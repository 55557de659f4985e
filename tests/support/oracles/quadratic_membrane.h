#pragma once

#include <sunder/core/math.h>

#include <functional>
#include <vector>

namespace sunder::test {

/// A surface z(x, y) over the unit square, with a straight slit along x seen from above.
struct GraphSurface {
  std::function<double(double x, double y)> height = [](double, double) { return 0.0; };
  std::function<Vec2d(double x, double y)> slope = [](double, double) {
    return Vec2d(0, 0);
  };  ///< The derivatives of the height by x and y.
  double slit_begin = 0.3, slit_end = 0.7, slit_y = 0.503;
};

/// Materials of a membrane on an elastic foundation: one up to a straight line, another beyond it.
struct TwoMembranes {
  struct Membrane {
    double stiffness = 1;   ///< S, N/m.
    double foundation = 1;  ///< F, N/m^3.
  };
  Membrane first, second;
  enum class Across : std::uint8_t { nothing, x, y } across = Across::nothing;
  double border = 0.5;  ///< The x or y where the second one begins.
};

/// The displacement of such a surface whose lips are pulled apart by an even tension, in balance:
/// S div grad u = F u by biquadratic finite elements (nine nodes, 4 x 4 Gauss points) on a grid of
/// its own, which is refined towards the tips, with the exact metric of the surface. It shares no
/// mesh, no operator and no source with the particles or with solve_membrane().
class QuadraticMembrane {
 public:
  /// @param cells  of each part of the grid between tips, slit, borders: at least 2.
  QuadraticMembrane(const GraphSurface& surface, const TwoMembranes& materials,
                    double newtons_per_metre, int cells);

  /// The displacement at a place, metres. O(log cells).
  /// @param is_above  on which lip a place of the slit is: that of greater y.
  [[nodiscard]] Vec3d displacement(double x, double y, bool is_above) const;
  /// How far the lips are from one another at a place of the slit.
  [[nodiscard]] double gap(double x) const;
  [[nodiscard]] double widest_gap() const;

 private:
  [[nodiscard]] std::size_t node(std::size_t i, std::size_t j, bool is_above) const;

  std::vector<double> x_, y_;  ///< Lines of the grid; there are nodes on them and between them.
  std::size_t slit_row_ = 0, slit_first_ = 0,
              slit_last_ = 0;  ///< Nodes of the slit, with its tips.
  std::vector<Vec3d> displacements_;
};

}  // namespace sunder::test
