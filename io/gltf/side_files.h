#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sunder::gltf {

/// The other files to which a document refers by relative URIs: buffers and images.
class SideFiles {
 public:
  virtual ~SideFiles() = default;

  /// The bytes of the file that a URI names.
  /// @throws Refusal  if it may not be read, cannot be read, or has more than `maximum_bytes`;
  ///                  `place` is for the text.
  [[nodiscard]] virtual std::vector<std::byte> read(const std::string& uri,
                                                    const std::string& place,
                                                    std::uint64_t maximum_bytes) const = 0;
  /// Whether there is such a file. @throws Refusal  if it may not be read.
  [[nodiscard]] virtual bool exists(const std::string& uri, const std::string& place) const = 0;
};

/// Refuses a reference to another file, where a document may refer to none.
[[noreturn]] void refuse_side_file(const std::string& uri, const std::string& place);

}  // namespace sunder::gltf
