// The table of presets in docs/particles.md: each of its numbers against the presets, and those
// against the properties of real tissue from which they are derived.

#include <sunder/particles/material.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "particles/internal/angular_frequency.h"

namespace sunder {
namespace {

/// The cells of the table's rows, by the name of the preset.
std::map<std::string, std::vector<std::string>> read_table() {
  std::ifstream file(SUNDER_SOURCE_DIR "/docs/particles.md");
  EXPECT_TRUE(file.is_open());
  std::map<std::string, std::vector<std::string>> rows;
  std::string line;
  while (std::getline(file, line) && !line.starts_with("| preset |")) continue;
  std::getline(file, line);                            // the rule below the head
  const std::regex mark(R"(\[\d+\]|\*|,(?=\d\d\d))");  // sources, italics, thousands
  while (std::getline(file, line) && line.starts_with("|")) {
    std::istringstream parts(std::regex_replace(line.substr(1), mark, ""));
    std::vector<std::string> cells;
    for (std::string cell; std::getline(parts, cell, '|');) {
      const std::size_t begin = cell.find_first_not_of(' ');
      cells.push_back(begin == std::string::npos
                          ? std::string()
                          : cell.substr(begin, cell.find_last_not_of(' ') - begin + 1));
    }
    rows[cells[0]] = cells;
  }
  return rows;
}

/// The numbers of a cell, each times its unit.
std::vector<double> numbers_of(const std::string& cell) {
  std::vector<double> numbers;
  const std::regex number(R"(([0-9.]+)( MPa| kPa| mm)?)");
  for (auto it = std::sregex_iterator(cell.begin(), cell.end(), number);
       it != std::sregex_iterator(); ++it) {
    const std::string unit = (*it)[2];
    numbers.push_back(std::stod((*it)[1]) * (unit == " MPa"   ? 1e6
                                             : unit == " kPa" ? 1e3
                                             : unit == " mm"  ? 1e-3
                                                              : 1));
  }
  return numbers;
}

/// Whether a number is another one, rounded to the digits that are written.
void expect_rounded(const std::string& cell, double value, const std::string& of) {
  const double written = numbers_of(cell).at(0);
  const std::string text = std::regex_replace(cell, std::regex(R"([^0-9.].*)"), "");
  const std::size_t point = text.find('.');
  const double digits =
      point == std::string::npos ? 0.0 : static_cast<double>(text.size() - point - 1);
  EXPECT_LE(std::abs(written - value), 0.501 * std::pow(10, -digits)) << of << ": " << cell;
}

enum Column : std::uint8_t {
  kName,
  kFrequency,
  kDamping,
  kStiffness,
  kMembraneDamping,
  kDensity,
  kReach,
  kModulus,
  kTearing,
  kRatio,
  kToughness,
  kStrength
};

TEST(preset_table, has_the_values_of_the_presets) {
  const auto rows = read_table();
  ASSERT_EQ(rows.size(), material_presets().size());
  for (const SoftMaterial& of : material_presets()) {
    ASSERT_TRUE(rows.contains(of.name)) << of.name;
    const std::vector<std::string>& row = rows.at(of.name);
    ASSERT_EQ(row.size(), std::size_t{kStrength} + 1) << of.name;
    EXPECT_EQ(numbers_of(row[kFrequency]).at(0), of.return_frequency) << of.name;
    EXPECT_EQ(numbers_of(row[kDamping]).at(0), of.damping_ratio) << of.name;
    EXPECT_EQ(numbers_of(row[kStiffness]).at(0), of.membrane_stiffness) << of.name;
    EXPECT_EQ(numbers_of(row[kMembraneDamping]).at(0), of.membrane_damping) << of.name;
    EXPECT_EQ(numbers_of(row[kStrength]).at(0), of.strength) << of.name;
    expect_rounded(row[kDensity], of.areal_density, of.name);
    expect_rounded(row[kToughness], of.toughness, of.name);
    expect_rounded(
        row[kReach],
        std::sqrt(of.membrane_stiffness /
                  (of.areal_density * particles::squared_frequency(of.return_frequency))),
        of.name);
  }
}

TEST(preset_table, derives_them_from_density_modulus_and_toughness) {
  for (const auto& [name, row] : read_table()) {
    const SoftMaterial of = *find_material(name);
    if (row[kDensity].find('=') != std::string::npos) {
      const std::string real = row[kDensity].substr(row[kDensity].find('=') + 1);
      const std::vector<double> layer = numbers_of(real);
      ASSERT_EQ(layer.size(), 2u) << name << real;
      EXPECT_NEAR(of.areal_density / (layer[0] * layer[1]), 1, 1e-9) << name;
    }
    const double ratio = numbers_of(row[kRatio]).at(0);
    EXPECT_NEAR(of.toughness / (2 * of.membrane_stiffness * ratio), 1, 0.025) << name;
    if (row[kModulus].empty() || name == "fat") continue;  // their ratio is chosen
    const double modulus = numbers_of(row[kModulus]).at(0),
                 tearing = numbers_of(row[kTearing]).at(0);
    expect_rounded(row[kRatio], tearing / modulus, name);
    EXPECT_NEAR(of.toughness / (2 * of.membrane_stiffness * tearing / modulus), 1, 1e-9) << name;

    // A slit of the half length a in a sheet under plane stress, evenly stretched by e, opens by
    // 4 e a and releases the energy E h e^2 pi a per tip and length; so it runs on when it gapes by
    // 4 sqrt(toughness a / (pi E)). The preset's runs on at the same gap, on a soft foundation.
    constexpr double kHalfLength = 0.1;
    SoftMaterial free = of;
    free.return_frequency = 0;
    const double tension =
        std::sqrt(2 * of.toughness * of.membrane_stiffness / (std::numbers::pi * kHalfLength));
    EXPECT_NEAR(*gap_under_tension(free, 2 * kHalfLength, tension) /
                    (4 * std::sqrt(tearing * kHalfLength / (std::numbers::pi * modulus))),
                1, 1e-6)
        << name;
  }
}

}  // namespace
}  // namespace sunder
