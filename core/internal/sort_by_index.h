#pragma once

#include <sunder/core/index.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace sunder {

/// Sorts items by key_of(item), an index. Items with the same key stay in order. It sorts byte by
/// byte: comparisons of random indices cannot be predicted, which costs more than the rest.
/// @param make_room  called if the items are not in order; returns a span of as many items, whose
///         values do not matter.
template <class Item, class KeyOf, class MakeRoom>
void sort_by_index(std::span<Item> items, KeyOf key_of, MakeRoom make_room) {
  constexpr std::size_t kValues = 256;
  const auto is_before = [&](const Item& a, const Item& b) { return key_of(a) < key_of(b); };
  if (std::is_sorted(items.begin(), items.end(), is_before)) return;
  Index differing = 0;  // the bits in which any two keys differ
  for (const Item& item : items) differing |= key_of(item) ^ key_of(items.front());
  const std::span<Item> room = make_room();
  Item *from = items.data(), *to = room.data();
  for (int shift = 0; shift < 32; shift += 8) {
    if ((differing >> shift & (kValues - 1)) == 0) continue;
    const auto place_of = [&](const Item& item) { return key_of(item) >> shift & (kValues - 1); };
    std::array<std::uint32_t, kValues> places = {};
    for (std::size_t i = 0; i < items.size(); ++i) ++places[place_of(from[i])];
    std::uint32_t first = 0;
    for (std::uint32_t& place : places) {
      const std::uint32_t count = place;
      place = first;
      first += count;
    }
    for (std::size_t i = 0; i < items.size(); ++i) to[places[place_of(from[i])]++] = from[i];
    std::swap(from, to);
  }
  if (from != items.data()) std::copy(from, from + items.size(), items.begin());
}

}  // namespace sunder
