#include "tools/render/png_file.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <zlib.h>

#include "tools/messages/text_file.h"
#include "tools/render/palette.h"

namespace sunder::tools {
namespace {

using Bytes = std::string;

void append_u16(Bytes& bytes, unsigned value) {
  bytes += static_cast<char>(value >> 8 & 255u);
  bytes += static_cast<char>(value & 255u);
}

void append_u32(Bytes& bytes, std::uint32_t value) {
  append_u16(bytes, value >> 16);
  append_u16(bytes, value & 0xffffu);
}

void append_chunk(Bytes& file, std::string_view kind, const Bytes& data) {
  append_u32(file, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = file.size();
  file += kind;
  file += data;
  append_u32(
      file, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(file.data() + begin),
                                             static_cast<uInt>(file.size() - begin))));
}

Bytes deflated(const Bytes& data) {
  uLongf size = compressBound(static_cast<uLong>(data.size()));
  Bytes result(size, '\0');
  (void)compress2(reinterpret_cast<Bytef*>(result.data()), &size,
                  reinterpret_cast<const Bytef*>(data.data()), static_cast<uLong>(data.size()),
                  Z_DEFAULT_COMPRESSION);
  result.resize(size);
  return result;
}

enum class PngColor : std::uint8_t { rgb = 2, indexed = 3, rgba = 6 };

Bytes header(int width, int height, PngColor color) {
  Bytes data;
  append_u32(data, static_cast<std::uint32_t>(width));
  append_u32(data, static_cast<std::uint32_t>(height));
  data += static_cast<char>(8);  // bits per channel
  data += static_cast<char>(color);
  data.append(3, '\0');  // deflate; filters per row; not interlaced
  Bytes file = "\x89PNG\r\n\x1a\n";
  append_chunk(file, "IHDR", data);
  return file;
}

/// Differences from the pixels above, which compress well.
Bytes filtered_rows(const Picture& picture) {
  Bytes rows;
  const auto width = static_cast<std::size_t>(picture.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
    rows += static_cast<char>(2);
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t i = 0; i < 3; ++i) {
        const int above = y == 0 ? 0 : picture.colors[(y - 1) * width + x][i];
        rows += static_cast<char>(picture.colors[y * width + x][i] - above);
      }
  }
  return rows;
}

Bytes filtered_rows(const Image& image, bool has_alpha) {
  Bytes rows;
  const auto width = static_cast<std::size_t>(image.width);
  const std::size_t channels = has_alpha ? 4 : 3;
  rows.reserve((channels * width + 1) * static_cast<std::size_t>(image.height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
    rows += static_cast<char>(2);
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t i = 0; i < channels; ++i) {
        const std::size_t at = 4 * (y * width + x) + i;
        rows += static_cast<char>(image.rgba[at] - (y == 0 ? 0 : image.rgba[at - 4 * width]));
      }
  }
  return rows;
}

struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;  ///< One past the last.
};

/// The pixels by which two pictures differ; one pixel if they are equal.
PixelBox difference(const Picture& before, const Picture& after) {
  PixelBox box{after.width, after.height, 0, 0};
  for (int y = 0; y < after.height; ++y)
    for (int x = 0; x < after.width; ++x) {
      const auto at = static_cast<std::size_t>(y * after.width + x);
      if (before.colors[at] == after.colors[at]) continue;
      box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x + 1),
             std::max(box.bottom, y + 1)};
    }
  return box.right == 0 ? PixelBox{0, 0, 1, 1} : box;
}

Bytes frame_control(std::uint32_t number, const PixelBox& box, int milliseconds) {
  Bytes data;
  append_u32(data, number);
  append_u32(data, static_cast<std::uint32_t>(box.right - box.left));
  append_u32(data, static_cast<std::uint32_t>(box.bottom - box.top));
  append_u32(data, static_cast<std::uint32_t>(box.left));
  append_u32(data, static_cast<std::uint32_t>(box.top));
  append_u16(data, static_cast<unsigned>(milliseconds));
  append_u16(data, 1000);
  data.append(2, '\0');  // What was shown stays, and the box replaces it.
  return data;
}

Bytes indexed_rows(const Picture& picture, const PixelBox& box, const Palette& palette) {
  Bytes rows;
  for (int y = box.top; y < box.bottom; ++y) {
    rows += '\0';
    for (int x = box.left; x < box.right; ++x)
      rows += static_cast<char>(
          palette.at(picture.colors[static_cast<std::size_t>(y * picture.width + x)]));
  }
  return rows;
}

}  // namespace

Status write_png(const std::filesystem::path& file, const Picture& picture) {
  Bytes bytes = header(picture.width, picture.height, PngColor::rgb);
  append_chunk(bytes, "IDAT", deflated(filtered_rows(picture)));
  append_chunk(bytes, "IEND", {});
  return write_text(file, bytes);
}

std::vector<std::byte> encode_png(const Image& image) {
  bool has_alpha = false;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) has_alpha |= image.rgba[i] != 255;
  Bytes bytes = header(image.width, image.height, has_alpha ? PngColor::rgba : PngColor::rgb);
  append_chunk(bytes, "IDAT", deflated(filtered_rows(image, has_alpha)));
  append_chunk(bytes, "IEND", {});
  const auto* const begin = reinterpret_cast<const std::byte*>(bytes.data());
  return {begin, begin + bytes.size()};
}

Status write_animated_png(const std::filesystem::path& file, const std::vector<Picture>& pictures,
                          int milliseconds) {
  const Palette palette(pictures);
  Bytes bytes = header(pictures.front().width, pictures.front().height, PngColor::indexed);
  Bytes control, colors;
  append_u32(control, static_cast<std::uint32_t>(pictures.size()));
  append_u32(control, 0);  // Runs for ever.
  append_chunk(bytes, "acTL", control);
  for (const Picture::Color& color : palette.colors())
    for (const std::uint8_t channel : color) colors += static_cast<char>(channel);
  append_chunk(bytes, "PLTE", colors);
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const Picture& picture = pictures[i];
    const PixelBox box = i == 0 ? PixelBox{0, 0, picture.width, picture.height}
                                : difference(pictures[i - 1], picture);
    append_chunk(bytes, "fcTL", frame_control(number++, box, milliseconds));
    const Bytes data = deflated(indexed_rows(picture, box, palette));
    if (i == 0) {
      append_chunk(bytes, "IDAT", data);
    } else {
      Bytes numbered;
      append_u32(numbered, number++);
      append_chunk(bytes, "fdAT", numbered + data);
    }
  }
  append_chunk(bytes, "IEND", {});
  return write_text(file, bytes);
}

}  // namespace sunder::tools
