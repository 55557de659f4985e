#include "io/operation_log/read_values.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/internal/find_named.h"
#include "core/operation/internal/field_ranges.h"
#include "core/operation/internal/view_sides.h"

namespace sunder::operation_log {
namespace {

constexpr const char* kMetresOrWidths = "metres, or {\"widths\": …}";

double read_widths(const Place& place, const NumberRange& range) {
  if (!place.value.is_object()) place.expected(kMetresOrWidths);
  place.check_fields({"widths"});
  return NumberIn{range}(place.at("widths"));
}

template <int N>
Eigen::Matrix<double, N, 1, Eigen::DontAlign> read_vector(const Place& place) {
  Eigen::Matrix<double, N, 1, Eigen::DontAlign> vector;
  read_numbers(place, {vector.data(), N});
  return vector;
}

Vec3d read_point(const Place& place) {
  Vec3d point;
  read_numbers(place, {point.data(), 3}, kFarthestMetres);
  return point;
}

Vec3d read_direction(const Place& place, const char* what) {
  const Vec3d direction = read_point(place);
  if (direction == Vec3d::Zero()) place.malformed(std::string(what) + " of zero length");
  return direction;
}

ViewSide read_side(const Place& place) {
  const std::string name = read_name(place);
  for (const NamedSide& known : kViewSides)
    if (name == known.name) return known.side;
  place.malformed("unknown side '" + name +
                  "'; expected front, back, left, right, top, bottom or a direction");
}

}  // namespace

void read_value(const Place& place, const Field& field, double& number, const NumberRange& range) {
  number = NumberIn{field::named(range, field.name)}(place);
}

void read_value(const Place& place, const Field& field, double& radians, const Degrees& kind) {
  radians = NumberIn{field::named(kind.range, field.name)}(place)*std::numbers::pi / 180;
}

void read_value(const Place& place, const Field&, double& tolerance, const ChordTolerance& kind) {
  tolerance = NumberIn{field::chord_tolerance(kind.radius)}(place);
}

void read_value(const Place& place, const Field& field, double& length,
                const TearLength<std::optional<double>>& kind) {
  if (place.value.is_number())
    read_value(place, field, length, kind.range);
  else
    *kind.in_widths = read_widths(place, field::kWidthsFromZero);
}

void read_value(const Place& place, const Field& field, double& length,
                const TearLength<const std::optional<double>>& kind) {
  read_value(place, field, length, kind.range);
}

void read_value(const Place& place, const Field& field, AimedLength& length,
                const NumberRange& range) {
  const bool is_number = place.value.is_number();
  length.unit = is_number ? AimedLength::Unit::metres : AimedLength::Unit::widths;
  if (is_number)
    read_value(place, field, length.value, range);
  else
    length.value = read_widths(place, field::kWidths);
}

void read_value(const Place& place, const Field&, bool& value) {
  if (!place.value.is_boolean()) place.expected("true or false");
  value = place.value.get<bool>();
}

void read_value(const Place& place, const Field&, std::uint32_t& number, const Integer& kind) {
  number = read_integer(place, kind.what, kind.least, kind.most);
}

void read_value(const Place& place, const Field&, std::uint32_t& index, const Material&) {
  if (!place.value.is_string()) {
    index = read_integer(place, "the name or index of a material");
    return;
  }
  const std::string name = read_name(place);
  if (place.model == nullptr)
    place.malformed("'" + name + "' needs a model to be found in; without one, expected an index");
  const Result<Index> material = find_material(*place.model, name);
  if (!material) place.fail(material.error().code(), std::string(material.error().text()));
  index = *material;
}

void read_value(const Place& place, const Field&, std::string& name, const Name& kind) {
  name = read_name(place);
  if (name.empty() && !kind.may_be_empty) place.malformed("a bone's name must not be empty");
}

void read_value(const Place& place, const Field&, Vec3d& point, const Point&) {
  point = read_point(place);
}

void read_value(const Place& place, const Field&, Vec3d& direction, const Direction& kind) {
  direction = read_direction(place, kind.what);
}

void read_value(const Place& place, const Field&, Vec3f& vector) {
  vector = read_vector<3>(place).cast<float>();
}

void read_value(const Place& place, const Field&, Quatf& rotation) {
  const Quatd read(Vec4d(read_vector<4>(place)));
  if (read.norm() < 1e-9) place.malformed("rotation of zero length");
  const Quatf as_floats = read.cast<float>();
  const bool is_unit =
      std::abs(read.norm() - 1.0) < 1e-6 && as_floats.cast<double>().coeffs() == read.coeffs();
  rotation = is_unit ? as_floats : Quatf(read.normalized().cast<float>());
}

void read_value(const Place& place, const Field&, std::array<double, 3>& barycentrics) {
  read_numbers(place, barycentrics);
  double sum = 0;
  for (const double part : barycentrics) {
    if (part < 0) place.malformed("negative");
    sum += part;
  }
  if (!(sum > 0)) place.malformed("all are zero");
}

void read_value(const Place& place, const Field&, View& view) {
  using Space = ViewDirection::Space;
  if (place.value.is_string()) {
    view = read_side(place);
  } else if (place.value.is_array()) {
    view = ViewDirection{read_direction(place, "direction"), Space::model};
  } else {
    if (!place.value.is_object()) place.expected("a side or a direction");
    place.check_fields({"bone"});
    view = ViewDirection{read_direction(place.at("bone"), "direction"), Space::bone};
  }
}

void read_value(const Place& place, const Field&, std::vector<Affine3d>& matrices, const List&) {
  const std::size_t count = read_array(place, "an array of matrices").size();
  matrices.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor | Eigen::DontAlign> rows;
    read_numbers(place.at(i), {rows.data(), 12}, kLargestMatrixEntry);
    Affine3d matrix;
    matrix.matrix() = rows;
    matrices.push_back(matrix);
  }
}

void read_value(const Place& place, const Field&, std::vector<float>& numbers, const List&) {
  std::vector<double> read(read_array(place, "an array of numbers").size());
  read_numbers(place, read);
  for (const double number : read) numbers.push_back(static_cast<float>(number));
}

std::size_t read_word(const Place& place, const Field& field, std::span<const char* const> words) {
  const std::string word = read_name(place);
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  std::string expected;
  for (std::size_t i = 0; i < words.size(); ++i)
    expected += std::string(i == 0 ? "'" : i + 1 < words.size() ? ", '" : " or '") + words[i] + "'";
  place.fail(StatusCode::unsupported_feature,
             std::string("unknown ") + field.name + " '" + word + "'; expected " + expected);
}

}  // namespace sunder::operation_log
