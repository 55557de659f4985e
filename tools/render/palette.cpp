#include "tools/render/palette.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace sunder::tools {
namespace {

constexpr std::size_t kMostColors = 256;
constexpr unsigned kBits = 6;  ///< Per channel of a cell.

std::size_t cell_of(const Picture::Color& color) {
  std::size_t cell = 0;
  for (const std::uint8_t channel : color)
    cell = (cell << kBits) | static_cast<std::size_t>(channel >> (8 - kBits));
  return cell;
}

/// A cell that occurs: the sum of its pixels' colours.
struct Cell {
  std::size_t index = 0;
  std::uint64_t count = 0;
  std::array<std::uint64_t, 3> sum = {};

  [[nodiscard]] double mean(std::size_t channel) const {
    return static_cast<double>(sum[channel]) / static_cast<double>(count);
  }
};

/// Cells between two places of a list, and how much error one colour for all would make.
struct Box {
  std::size_t begin = 0, end = 0, channel = 0;
  double error = 0;
};

Box box_of(const std::vector<Cell>& cells, std::size_t begin, std::size_t end) {
  Box box{begin, end, 0, 0};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    double count = 0, sum = 0, square = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double weight = static_cast<double>(cells[i].count), value = cells[i].mean(channel);
      count += weight;
      sum += weight * value;
      square += weight * value * value;
    }
    const double error = square - sum * sum / count;
    if (error > box.error) {
      box.error = error;
      box.channel = channel;
    }
  }
  if (end - begin < 2) box.error = 0;
  return box;
}

/// Cuts a box at the mean of the channel with the largest error.
std::pair<Box, Box> cut(std::vector<Cell>& cells, const Box& box) {
  const auto first = cells.begin() + static_cast<std::ptrdiff_t>(box.begin),
             last = cells.begin() + static_cast<std::ptrdiff_t>(box.end);
  std::sort(first, last, [&](const Cell& a, const Cell& b) {
    const double x = a.mean(box.channel), y = b.mean(box.channel);
    return x != y ? x < y : a.index < b.index;
  });
  std::uint64_t count = 0;
  double sum = 0;
  for (auto cell = first; cell != last; ++cell) {
    count += cell->count;
    sum += static_cast<double>(cell->sum[box.channel]);
  }
  const double mean = sum / static_cast<double>(count);
  std::size_t middle = box.begin;
  while (middle < box.end && cells[middle].mean(box.channel) < mean) ++middle;
  middle = std::clamp(middle, box.begin + 1, box.end - 1);
  return {box_of(cells, box.begin, middle), box_of(cells, middle, box.end)};
}

std::vector<Cell> cells_of(std::span<const Picture> pictures) {
  std::vector<Cell> all(std::size_t{1} << (3 * kBits));
  for (const Picture& picture : pictures)
    for (const Picture::Color& color : picture.colors) {
      Cell& cell = all[cell_of(color)];
      ++cell.count;
      for (std::size_t i = 0; i < 3; ++i) cell.sum[i] += color[i];
    }
  for (std::size_t i = 0; i < all.size(); ++i) all[i].index = i;
  std::erase_if(all, [](const Cell& cell) { return cell.count == 0; });
  return all;
}

}  // namespace

Palette::Palette(std::span<const Picture> pictures)
    : of_cell_(std::size_t{1} << (3 * kBits), std::uint8_t{0}) {
  std::vector<Cell> cells = cells_of(pictures);
  if (cells.empty()) return;
  std::vector<Box> boxes = {box_of(cells, 0, cells.size())};
  while (boxes.size() < kMostColors) {
    const auto worst = std::ranges::max_element(boxes, {}, &Box::error);
    if (worst->error <= 0) break;
    const auto [left, right] = cut(cells, *worst);
    *worst = left;
    boxes.push_back(right);
  }
  for (const Box& box : boxes) {
    std::array<std::uint64_t, 3> sum = {};
    std::uint64_t count = 0;
    for (std::size_t i = box.begin; i < box.end; ++i) {
      of_cell_[cells[i].index] = static_cast<std::uint8_t>(colors_.size());
      count += cells[i].count;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += cells[i].sum[k];
    }
    Picture::Color color;
    for (std::size_t k = 0; k < 3; ++k)
      color[k] = static_cast<std::uint8_t>((sum[k] + count / 2) / count);
    colors_.push_back(color);
  }
}

std::uint8_t Palette::at(const Picture::Color& color) const { return of_cell_[cell_of(color)]; }

}  // namespace sunder::tools
