#include <sunder/weights/influences.h>

#include <cmath>
#include <limits>
#include <optional>

#include "weights/weight_sum.h"

namespace sunder {
namespace {

/// Priority of a weight for one of the remaining units.
struct Claim {
  double remainder = 0.0;
  float weight = 0.0f;
  std::size_t position = 0;

  [[nodiscard]] bool comes_before(const Claim& other) const {
    if (remainder != other.remainder) return remainder > other.remainder;
    if (weight != other.weight) return weight > other.weight;
    return position < other.position;
  }
};

template <class Integer>
bool quantise(std::span<const Influence> influences, std::span<Integer> quantised) {
  constexpr std::uint32_t kUnits = std::numeric_limits<Integer>::max();
  const double sum = sum_of_weights(influences);
  if (quantised.size() != influences.size() || !(sum > 0.0)) return false;
  // The product is exact, so this rounds once and preserves the order of two weights.
  const auto in_units = [&](std::size_t i) {
    return static_cast<double>(influences[i].weight) * double{kUnits} / sum;
  };
  std::uint32_t remaining = kUnits;
  for (std::size_t i = 0; i < influences.size(); ++i) {
    quantised[i] = static_cast<Integer>(in_units(i));
    remaining -= quantised[i];
  }
  // The next claim is the first that comes after the last one, so no list of claims has to be kept.
  std::optional<Claim> last;
  for (; remaining > 0; --remaining) {
    std::optional<Claim> next;
    for (std::size_t i = 0; i < influences.size(); ++i) {
      const double exact = in_units(i);
      const Claim claim{exact - std::floor(exact), influences[i].weight, i};
      if ((!last || last->comes_before(claim)) && (!next || claim.comes_before(*next)))
        next = claim;
    }
    if (!next) break;  // unreachable: fewer units remain than there are remainders
    ++quantised[next->position];
    last = next;
  }
  return true;
}

}  // namespace

bool quantise_weights(std::span<const Influence> influences, std::span<std::uint8_t> quantised) {
  return quantise(influences, quantised);
}

bool quantise_weights(std::span<const Influence> influences, std::span<std::uint16_t> quantised) {
  return quantise(influences, quantised);
}

}  // namespace sunder
