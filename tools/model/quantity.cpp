#include "tools/model/quantity.h"

#include <charconv>
#include <cmath>
#include <span>
#include <string>

namespace sunder::tools {
namespace {

struct Unit {
  std::string_view name;
  double factor;  ///< Numbers with the unit are divided by it, so that "10mm" is 0.01 to the bit.
  bool multiplies = false;
};

constexpr Unit kLengths[] = {{"m", 1}, {"cm", 100}, {"mm", 1000}, {"um", 1e6}};
constexpr Unit kShares[] = {{"%", 100}};
constexpr Unit kTimes[] = {{"s", 1}, {"ms", 1000}, {"min", 60, true}};
constexpr Unit kAngles[] = {{"deg", 1}};

std::span<const Unit> table_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::length: return kLengths;
    case Quantity::share: return kShares;
    case Quantity::time: return kTimes;
    case Quantity::angle: return kAngles;
    case Quantity::number: break;
  }
  return {};
}

/// A number and the text behind it, without one blank between.
struct Parts {
  double number = 0;
  std::string_view unit;
};

std::optional<Parts> parts_of(std::string_view text) {
  Parts parts;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, parts.number);
  if (error != std::errc() || !std::isfinite(parts.number)) return {};
  parts.unit = std::string_view(rest, static_cast<std::size_t>(end - rest));
  if (parts.unit.size() > 1 && parts.unit.starts_with(' ')) parts.unit.remove_prefix(1);
  return parts;
}

std::optional<double> in_unit(const Parts& parts, Quantity quantity) {
  for (const Unit& unit : table_of(quantity))
    if (parts.unit == unit.name)
      return unit.multiplies ? parts.number * unit.factor : parts.number / unit.factor;
  return {};
}

}  // namespace

std::optional<double> quantity_in(std::string_view text, Quantity quantity) {
  const std::optional<Parts> parts = parts_of(text);
  if (!parts) return {};
  return parts->unit.empty() ? std::optional(parts->number) : in_unit(*parts, quantity);
}

std::optional<double> length_with_unit(std::string_view text) {
  const std::optional<Parts> parts = parts_of(text);
  if (!parts || std::signbit(parts->number)) return {};
  return in_unit(*parts, Quantity::length);
}

const char* units_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::length: return ", with m, cm, mm or um behind it, or metres";
    case Quantity::share: return ", or per cent: 50%";
    case Quantity::time: return ", with s, ms or min behind it, or seconds";
    case Quantity::angle: return ", with or without deg behind it";
    case Quantity::number: break;
  }
  return "";
}

}  // namespace sunder::tools
