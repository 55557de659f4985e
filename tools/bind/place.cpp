#include "tools/bind/place.h"

#include <cmath>
#include <sstream>
#include <vector>

#include "tools/model/quantity.h"

namespace sunder::tools {
namespace {

constexpr double kRadians = 0.017453292519943295;
/// Farther places are no metres, and products of coordinates stay finite.
constexpr double kMost = 1e9;

}  // namespace

std::optional<Affine3d> parse_place(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const Quantity quantity = numbers.size() < 3   ? Quantity::length
                              : numbers.size() < 6 ? Quantity::angle
                                                   : Quantity::number;
    const std::optional<double> number = quantity_in(part, quantity);
    if (!number || !(std::abs(*number) <= kMost)) return std::nullopt;
    numbers.push_back(*number);
  }
  if (numbers.size() != 3 && numbers.size() != 6 && numbers.size() != 7) return std::nullopt;
  if (text.ends_with(',')) return std::nullopt;
  const double scale = numbers.size() == 7 ? numbers[6] : 1.0;
  if (!(scale > 0)) return std::nullopt;
  numbers.resize(6, 0.0);
  Affine3d place = Affine3d::Identity();
  const Eigen::AngleAxisd roll(kRadians * numbers[3], Eigen::Vector3d::UnitX()),
      pitch(kRadians * numbers[4], Eigen::Vector3d::UnitY()),
      yaw(kRadians * numbers[5], Eigen::Vector3d::UnitZ());
  place.linear() = scale * (yaw * pitch * roll).toRotationMatrix();
  place.translation() = Vec3d(numbers[0], numbers[1], numbers[2]);
  return place;
}

}  // namespace sunder::tools
