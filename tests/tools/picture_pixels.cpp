#include "tools/picture_pixels.h"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <string_view>
#include <zlib.h>

#include "support/machine/temporary_folder.h"

namespace sunder::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::uint32_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes.first(4)) value = value << 8 | byte;
  return value;
}

void append_big_endian(Bytes& bytes, std::size_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(Bytes& png, std::string_view kind, const Bytes& content) {
  append_big_endian(png, content.size());
  const std::size_t start = png.size();
  png.insert(png.end(), kind.begin(), kind.end());
  png.insert(png.end(), content.begin(), content.end());
  append_big_endian(png, crc32(0, png.data() + start, static_cast<uInt>(png.size() - start)));
}

/// The prediction of a byte by filter 4.
int paeth(int left, int up, int corner) {
  const int estimate = left + up - corner;
  const int a = std::abs(estimate - left), b = std::abs(estimate - up),
            c = std::abs(estimate - corner);
  if (a <= b && a <= c) return left;
  return b <= c ? up : corner;
}

/// Reverts the filter of a row. @param before  the row above it, or zeros.
void unfilter(int filter, std::span<const std::uint8_t> before, std::span<std::uint8_t> row,
              std::size_t channels) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    const int left = i >= channels ? row[i - channels] : 0, up = before[i],
              corner = i >= channels ? before[i - channels] : 0;
    const std::array<int, 5> predicted = {0, left, up, (left + up) / 2, paeth(left, up, corner)};
    row[i] = static_cast<std::uint8_t>(row[i] + predicted[static_cast<std::size_t>(filter)]);
  }
}

/// The size, the number of channels and the compressed rows.
struct Chunks {
  std::size_t width = 0, height = 0, channels = 0;
  Bytes compressed;
};

std::optional<Chunks> read_chunks(std::span<const std::uint8_t> file) {
  Chunks chunks;
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::size_t length = big_endian(file.subspan(at));
    const std::string_view kind(reinterpret_cast<const char*>(&file[at + 4]), 4);
    if (at + 12 + length > file.size()) return std::nullopt;
    const std::span<const std::uint8_t> content = file.subspan(at + 8, length);
    if (kind == "IHDR" && length == 13) {
      chunks.width = big_endian(content);
      chunks.height = big_endian(content.subspan(4));
      if (content[8] != 8 || content[12] != 0) return std::nullopt;
      chunks.channels = content[9] == 2 ? 3 : content[9] == 6 ? 4 : 0;
    }
    if (kind == "IDAT")
      chunks.compressed.insert(chunks.compressed.end(), content.begin(), content.end());
    at += 12 + length;
  }
  if (chunks.width == 0 || chunks.height == 0 || chunks.channels == 0) return std::nullopt;
  return chunks;
}

}  // namespace

std::optional<Pixels> read_png(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_bytes(file);
  const std::optional<Chunks> chunks =
      read_chunks({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  if (!chunks) return std::nullopt;
  const std::size_t row_size = chunks->width * chunks->channels;
  Bytes rows((row_size + 1) * chunks->height);
  uLongf size = rows.size();
  if (uncompress(rows.data(), &size, chunks->compressed.data(), chunks->compressed.size()) !=
          Z_OK ||
      size != rows.size())
    return std::nullopt;
  Pixels pixels{static_cast<int>(chunks->width), static_cast<int>(chunks->height), {}};
  const Bytes zeros(row_size, 0);
  std::span<const std::uint8_t> before = zeros;
  for (std::size_t y = 0; y < chunks->height; ++y) {
    const std::span<std::uint8_t> row = std::span(rows).subspan(y * (row_size + 1) + 1, row_size);
    const int filter = rows[y * (row_size + 1)];
    if (filter > 4) return std::nullopt;
    unfilter(filter, before, row, chunks->channels);
    for (std::size_t x = 0; x < row_size; x += chunks->channels)
      pixels.colors.push_back({row[x], row[x + 1], row[x + 2]});
    before = row;
  }
  return pixels;
}

std::vector<std::byte> make_png(int width, int height,
                                const std::vector<std::array<std::uint8_t, 4>>& colors) {
  Bytes rows;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (i % static_cast<std::size_t>(width) == 0) rows.push_back(0);  // Filter: none.
    rows.insert(rows.end(), colors[i].begin(), colors[i].end());
  }
  Bytes compressed(compressBound(rows.size()));
  uLongf size = compressed.size();
  compress(compressed.data(), &size, rows.data(), rows.size());
  compressed.resize(size);

  Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  append_chunk(
      png, "IHDR",
      {0, 0, static_cast<std::uint8_t>(width >> 8), static_cast<std::uint8_t>(width), 0, 0,
       static_cast<std::uint8_t>(height >> 8), static_cast<std::uint8_t>(height), 8, 6, 0, 0, 0});
  append_chunk(png, "IDAT", compressed);
  append_chunk(png, "IEND", {});
  const auto* const first = reinterpret_cast<const std::byte*>(png.data());
  return {first, first + png.size()};
}

std::optional<PixelBox> box_of(const Pixels& pixels,
                               const std::function<bool(const Pixels::Color&)>& counts) {
  PixelBox box{pixels.width, pixels.height, -1, -1, 0};
  for (int y = 0; y < pixels.height; ++y)
    for (int x = 0; x < pixels.width; ++x) {
      if (!counts(pixels.at(x, y))) continue;
      box.left = std::min(box.left, x);
      box.right = std::max(box.right, x);
      box.top = std::min(box.top, y);
      box.bottom = std::max(box.bottom, y);
      ++box.count;
    }
  return box.count > 0 ? std::optional(box) : std::nullopt;
}

bool is_near(const Pixels::Color& a, const Pixels::Color& b, int tolerance) {
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(int{a[i]} - int{b[i]}) > tolerance) return false;
  return true;
}

}  // namespace sunder::test
