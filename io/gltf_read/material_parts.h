#pragma once

#include <sunder/core/math.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf/source_document.h"
#include "io/internal/base_colours.h"

namespace sunder::gltf {

// Materials are not checked when a file is loaded: what is missing or malformed is null, or has its
// default.

/// A member of an object, or null.
const Json& member(const Json& object, const char* key);

/// An entry of a list of the document, or null.
const Json& entry(const Json& document, const char* list, const Json& index);

float share_or(const Json& value, float otherwise);

/// A finite number of a list that is a member of an object.
float number_or(const Json& object, const char* key, std::size_t i, float otherwise);

BaseColour::Wrap wrap_of(const Json& sampler, const char* key);

/// KHR_texture_transform: scaled, then turned, then moved.
Eigen::Matrix<float, 2, 3> transform_of(const Json& transform);

/// Linear RGB, KHR_materials_emissive_strength included.
Vec3f emission_of(const Json& material);

/// The images of a document, each read when it is first asked for, all within a limit.
class DocumentImages {
 public:
  DocumentImages(const SourceDocument& source, std::uint64_t maximum_bytes)
      : source_(source), bytes_left_(maximum_bytes) {}

  /// The number in all() of the image of an entry of /textures; kNone if it is left out.
  std::uint32_t of_texture(const Json& texture);

  [[nodiscard]] std::vector<BaseColours::Image>& all() { return images_; }
  /// Images that are missing, of an unknown kind, or beyond the limit.
  [[nodiscard]] std::uint32_t left_out() const { return left_out_; }

 private:
  std::uint32_t image(const Json& index);
  [[nodiscard]] std::string place_of(const Json& image) const;
  [[nodiscard]] std::optional<std::vector<std::byte>> bytes_of(const Json& image) const;

  const SourceDocument& source_;
  std::uint64_t bytes_left_;
  std::vector<BaseColours::Image> images_;
  std::uint32_t left_out_ = 0;
  std::map<std::string, std::uint32_t> numbers_;  ///< By place_of().
};

}  // namespace sunder::gltf
