#include "tools/render/image.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <jpeglib.h>
#include <png.h>

namespace sunder::tools {
namespace {

Status too_large(std::uint64_t width, std::uint64_t height, std::uint64_t most_pixels) {
  return Status::failure(
      StatusCode::limit_exceeded, kNone, "an image has %llu x %llu pixels; %llu are read at most",
      static_cast<unsigned long long>(width), static_cast<unsigned long long>(height),
      static_cast<unsigned long long>(most_pixels));
}

Result<Image> decode_png(std::span<const std::byte> file, std::uint64_t most_pixels,
                         std::uint64_t& begun) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  const auto fail = [&png] {
    const Status status =
        Status::failure(StatusCode::malformed_file, kNone, "a PNG: %.60s", png.message);
    png_image_free(&png);
    return status;
  };
  if (png_image_begin_read_from_memory(&png, file.data(), file.size()) == 0) return fail();
  if (std::uint64_t{png.width} * png.height > most_pixels) {
    const Status status = too_large(png.width, png.height, most_pixels);
    png_image_free(&png);
    return status;
  }
  begun = std::uint64_t{png.width} * png.height;
  png.format = PNG_FORMAT_RGBA;
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.rgba.resize(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr) == 0) return fail();
  return image;
}

/// libjpeg reports errors by a function that must not return.
struct JpegErrors {
  jpeg_error_mgr manager;  // First, because libjpeg knows only its address.
  std::jmp_buf place;
  char text[JMSG_LENGTH_MAX];
};

/// A progressive file of few bytes may pass over all its pixels thousands of times.
constexpr int kMostScans = 64;

[[noreturn]] void leave(j_common_ptr jpeg) {
  auto* const errors = reinterpret_cast<JpegErrors*>(jpeg->err);
  errors->manager.format_message(jpeg, errors->text);
  std::longjmp(errors->place, 1);
}

void stay_silent(j_common_ptr /*jpeg*/) {}

void count_scans(j_common_ptr jpeg) {
  if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= kMostScans) return;
  auto* const errors = reinterpret_cast<JpegErrors*>(jpeg->err);
  std::snprintf(errors->text, sizeof errors->text, "it has more than %d scans", kMostScans);
  std::longjmp(errors->place, 1);
}

void read_rows(jpeg_decompress_struct& jpeg, Image& image) {
  const int channels = jpeg.out_color_components;
  while (jpeg.output_scanline < jpeg.output_height) {
    std::uint8_t* const row = image.rgba.data() + std::size_t{4} *
                                                      static_cast<std::size_t>(image.width) *
                                                      jpeg.output_scanline;
    std::uint8_t* rows[] = {row};
    if (jpeg_read_scanlines(&jpeg, rows, 1) != 1) break;
    for (int x = image.width - 1; x >= 0; --x) {  // From the end, because they grow in place.
      std::uint8_t rgb[3];
      for (int i = 0; i < 3; ++i) rgb[i] = row[channels * x + (channels == 3 ? i : 0)];
      std::memcpy(row + std::ptrdiff_t{4} * x, rgb, 3);
      row[4 * x + 3] = 255;
    }
  }
}

/// @param most_pixels  that are read.
/// @param begun  gets the number of pixels that are read.
/// @param image  outside, so that no object lives in a frame that an error leaves.
/// @return nothing; the text of an error; "" if it is too large.
const char* decode_jpeg_into(std::span<const std::byte> file, std::uint64_t most_pixels,
                             jpeg_decompress_struct& jpeg, JpegErrors& errors, std::uint64_t& begun,
                             Image& image) {
  jpeg.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = leave;
  errors.manager.output_message = stay_silent;
  if (setjmp(errors.place) != 0) return errors.text;
  jpeg_create_decompress(&jpeg);
  jpeg_progress_mgr progress = {};
  progress.progress_monitor = count_scans;
  jpeg.progress = &progress;
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.data()),
               static_cast<unsigned long>(file.size()));
  (void)jpeg_read_header(&jpeg, TRUE);
  if (std::uint64_t{jpeg.image_width} * jpeg.image_height > most_pixels) return "";
  begun = std::uint64_t{jpeg.image_width} * jpeg.image_height;
  if (jpeg.jpeg_color_space != JCS_GRAYSCALE) jpeg.out_color_space = JCS_RGB;
  (void)jpeg_start_decompress(&jpeg);
  image.width = static_cast<int>(jpeg.output_width);
  image.height = static_cast<int>(jpeg.output_height);
  image.rgba.resize(std::size_t{4} * jpeg.output_width * jpeg.output_height);
  read_rows(jpeg, image);
  return nullptr;
}

Result<Image> decode_jpeg(std::span<const std::byte> file, std::uint64_t most_pixels,
                          std::uint64_t& begun) {
  jpeg_decompress_struct jpeg = {};
  JpegErrors errors = {};
  Image image;
  const char* const error = decode_jpeg_into(file, most_pixels, jpeg, errors, begun, image);
  Status status;
  if (error != nullptr)
    status = *error == 0
                 ? too_large(jpeg.image_width, jpeg.image_height, most_pixels)
                 : Status::failure(StatusCode::malformed_file, kNone, "a JPEG: %.100s", error);
  jpeg_destroy_decompress(&jpeg);
  if (!status) return status;
  return image;
}

}  // namespace

Result<Image> decode_image(std::span<const std::byte> file, std::uint64_t most_pixels,
                           std::uint64_t* begun) {
  std::uint64_t unused = 0;
  std::uint64_t& pixels = begun == nullptr ? unused : *begun;
  pixels = 0;
  const auto begins_with = [file](std::initializer_list<unsigned> bytes) {
    if (file.size() < bytes.size()) return false;
    std::size_t i = 0;
    for (const unsigned byte : bytes)
      if (static_cast<unsigned>(file[i++]) != byte) return false;
    return true;
  };
  if (begins_with({0x89, 'P', 'N', 'G'})) return decode_png(file, most_pixels, pixels);
  if (begins_with({0xff, 0xd8, 0xff})) return decode_jpeg(file, most_pixels, pixels);
  return Status::failure(StatusCode::unsupported_format, kNone, "an image is neither PNG nor JPEG");
}

}  // namespace sunder::tools
