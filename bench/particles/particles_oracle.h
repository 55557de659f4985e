#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sunder::bench {

/// The mean over orders of seeds, and the standard deviation of one.
struct MeanOf {
  double mean = 0, deviation = 0;
};

/// The membrane of particles with one range on one mesh, against QuadraticMembrane.
struct OracleFigures {
  double range = 0;           ///< Metres.
  std::uint32_t cells = 0;    ///< Of the mesh along each edge.
  double particles = 0;       ///< Mean.
  MeanOf width;               ///< Widest gap by the reference's.
  MeanOf gap, displacement;   ///< RMS, as MembraneDifference.
  double elements_width = 0;  ///< Of linear elements on the same mesh; 0 for two materials.
};

/// A surface, its mesh and its materials.
struct OracleCase {
  std::string name;
  double reference_error =
      0;  ///< Of the widest gap of the reference: the difference from a coarser.
  std::vector<OracleFigures> refined;  ///< Mesh and range refined together.
  double order = 0;  ///< The power of the range with which the displacement's error falls.
};

/// Slits of 0.4 m in flat and curved surfaces over a square of one metre, on even, stretched and
/// skewed meshes, of one and two materials. @param orders  of seeds, at least 2.
[[nodiscard]] std::vector<OracleCase> measure_against_oracle(std::uint64_t orders);

}  // namespace sunder::bench
