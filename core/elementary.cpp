#include "core/internal/elementary.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sunder::elementary {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = 0x1.921fb54442d18p+1, kPiRest = 0x1.1a62633145c07p-53;  // their sum is pi

/// c_0 + c_1 x + c_2 x^2 + ...
template <std::size_t n>
double polynomial(const std::array<double, n>& coefficients, double x) {
  double sum = coefficients[n - 1];
  for (std::size_t i = n - 1; i > 0; --i) sum = sum * x + coefficients[i - 1];
  return sum;
}

/// An angle in [-pi/4, pi/4] and how often pi/2 was taken away, modulo 4.
struct Reduced {
  double rest = 0;
  int quarter = 0;
};

Reduced reduce(double x) {
  if (std::abs(x) > 1e6) x = std::fmod(x, 2 * kPi);  // exact
  const double quarters = std::floor(x * 0x1.45f306dc9c883p-1 + 0.5);
  // pi / 2 in three parts, so that the products are exact.
  const double rest = ((x - quarters * 0x1.921fb544p+0) - quarters * 0x1.0b4611a6p-34) -
                      quarters * 0x1.3198a2e037073p-69;
  return {rest, static_cast<int>(static_cast<std::int64_t>(quarters) & 3)};
}

/// Of an angle in [-pi/4, pi/4].
double sine_near_zero(double x) {
  constexpr std::array kSine = {
      -0x1.5555555555555p-3,  0x1.1111111111110p-7,  -0x1.a01a01a01992fp-13, 0x1.71de3a545f836p-19,
      -0x1.ae645410e937bp-26, 0x1.61217d9252c03p-33, -0x1.ab16f5caa198ap-41};
  const double square = x * x;
  return x + x * square * polynomial(kSine, square);
}

double cosine_near_zero(double x) {
  constexpr std::array kCosine = {
      0x1.5555555555555p-5,  -0x1.6c16c16c16c16p-10, 0x1.a01a01a019d06p-16, -0x1.27e4fb77125c5p-22,
      0x1.1eed8deac3dfep-29, -0x1.9394b8bd50ae1p-37, 0x1.ab779550c8d9bp-45};
  const double square = x * x, half = 0.5 * square, main = 1 - half;
  return main + ((1 - main - half) + square * square * polynomial(kCosine, square));
}

double sine_of(const Reduced& angle) {
  const double value =
      angle.quarter % 2 == 0 ? sine_near_zero(angle.rest) : cosine_near_zero(angle.rest);
  return angle.quarter < 2 ? value : -value;
}

/// A number as the sum of a double and what it lacks.
struct Sum {
  double high = 0, low = 0;
};

/// Of a number in [0, 1].
Sum arc_tangent(double x) {
  // The arc tangents of multiples of 1/8, each as a sum of two.
  constexpr std::array<std::array<double, 2>, 9> kEighths = {{
      {0, 0},
      {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
      {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
      {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
      {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
      {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
      {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
      {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
      {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
  }};
  constexpr std::array kArc = {-0x1.5555555555555p-2, 0x1.999999999994dp-3,  -0x1.249249245a9f8p-3,
                               0x1.c71c6fec5ab77p-4,  -0x1.745983b02a76bp-4, 0x1.37e4f32d0fd67p-4};
  const int eighths = static_cast<int>(x * 8 + 0.5);
  const double known = eighths * 0.125, rest = (x - known) / (1 + x * known);
  const double square = rest * rest;
  const auto& [high, low] = kEighths[static_cast<std::size_t>(eighths)];
  return {high, rest + (rest * square * polynomial(kArc, square) + low)};
}

/// e^x - 1 of |x| <= log(2) / 2.
double exponential_near_zero(double x) {
  constexpr std::array kExponential = {
      0x1.0000000000000p-1,  0x1.5555555555557p-3,  0x1.5555555555556p-5,  0x1.11111111100bep-7,
      0x1.6c16c16c162c3p-10, 0x1.a01a01abf85abp-13, 0x1.a01a01a6e1e2ap-16, 0x1.71de01fdbf9cap-19,
      0x1.27e4db46cddd1p-22, 0x1.af4e554377204p-26, 0x1.1f7340dbc337ep-29};
  return x + x * x * polynomial(kExponential, x);
}

// log(2) in two parts: products of the first by exponents are exact.
constexpr double kLog2 = 0x1.62e42feep-1, kLog2Rest = 0x1.a39ef35793c76p-33;

}  // namespace

double sin(double x) {
  if (!std::isfinite(x)) return kNoNumber;
  if (x == 0) return x;
  return sine_of(reduce(x));
}

double cos(double x) {
  if (!std::isfinite(x)) return kNoNumber;
  Reduced angle = reduce(x);
  angle.quarter = (angle.quarter + 1) & 3;
  return sine_of(angle);
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return kNoNumber;
  double across = std::abs(y), along = std::abs(x);
  if (along == kInfinity) {
    across = across == kInfinity ? 1 : 0;
    along = 1;
  } else if (across == kInfinity) {
    along = 0;
  }
  const bool is_steep = across > along, is_behind = std::signbit(x);
  const double quotient = is_steep ? along / across : along > 0 ? across / along : 0;
  const Sum arc = arc_tangent(quotient);
  // The angle is that of the quotient, added to or taken from 0, pi / 2 or pi.
  const double quarters = is_steep ? 0.5 : is_behind ? 1 : 0;
  const double sign = is_steep != is_behind ? -1 : 1;
  const double sum = quarters * kPi + sign * arc.high;
  const double lost = (quarters * kPi - sum) + sign * arc.high;
  const double angle = sum + (lost + (sign * arc.low + quarters * kPiRest));
  return std::copysign(angle, y);
}

double asin(double x) {
  if (!(std::abs(x) <= 1)) return kNoNumber;
  return x == 0 ? x : elementary::atan2(x, std::sqrt((1 - x) * (1 + x)));
}

double acos(double x) {
  if (!(std::abs(x) <= 1)) return kNoNumber;
  return elementary::atan2(std::sqrt((1 - x) * (1 + x)), x);
}

double exp(double x) {
  if (std::isnan(x)) return x;
  if (x > 710) return kInfinity;
  if (x < -746) return 0;
  const double power = std::floor(x * 0x1.71547652b82fep+0 + 0.5);
  const double rest = (x - power * kLog2) - power * kLog2Rest;
  return std::ldexp(1 + exponential_near_zero(rest), static_cast<int>(power));
}

double expm1(double x) {
  if (x == 0) return x;
  if (std::abs(x) <= 0.5 * kLog2) return exponential_near_zero(x);
  return elementary::exp(x) - 1;
}

double log(double x) {
  constexpr std::array kLogarithm = {
      0x1.5555555555555p-1, 0x1.9999999999a39p-2, 0x1.2492492476a1ap-2, 0x1.c71c7201a55d7p-3,
      0x1.745cf8e4bba1bp-3, 0x1.3b1c3c1c81c8fp-3, 0x1.0fbde0f4ad17bp-3, 0x1.0c0aff044a970p-3};
  if (std::isnan(x) || x == kInfinity) return x;
  if (x < 0) return kNoNumber;
  if (x == 0) return -kInfinity;
  int power = 0;
  double mantissa = std::frexp(x, &power);
  if (mantissa < 0x1.6a09e667f3bcdp-1) {
    mantissa *= 2;
    --power;
  }
  // log(1 + f) = 2 artanh(s), s = f / (2 + f), written so that f stands exactly in the sum.
  const double f = mantissa - 1, s = f / (2 + f), square = s * s, half = 0.5 * f * f;
  const double series = square * polynomial(kLogarithm, square);
  return power * kLog2 - ((half - (s * (half + series) + power * kLog2Rest)) - f);
}

}  // namespace sunder::elementary
