#include "core/internal/sha256.h"

#include <random>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace sunder {
namespace {

std::string sha256(std::string_view text) {
  Sha256 digest;
  digest.add(std::as_bytes(std::span(text)));
  return digest.finish();
}

// FIPS 180-4 names these; `sha256sum` gives the others.
TEST(Sha256, is_that_of_the_standard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, does_not_depend_on_the_parts) {
  std::mt19937 random(7);
  for (std::size_t size = 0; size < 300; ++size) {
    std::vector<std::byte> bytes(size);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    Sha256 whole, parts;
    whole.add(bytes);
    for (std::size_t at = 0; at < size;) {
      const std::size_t length = std::min<std::size_t>(random() % 90, size - at);
      parts.add(std::span(bytes).subspan(at, length));
      at += length;
    }
    EXPECT_EQ(parts.finish(), whole.finish()) << size << " bytes";
  }
}

}  // namespace
}  // namespace sunder
