#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "tools/page_parts/data_arrays.h"
#include "tools/view_page/view_input.h"

namespace sunder::tools {

/// The images of all models of a page; equal ones are one.
class PageImages {
 public:
  explicit PageImages(DataArrays& arrays) : arrays_(arrays) {}

  /// @return its number.
  std::size_t add(const BaseColours::Image& image);
  [[nodiscard]] Json take() { return std::move(list_); }

 private:
  DataArrays& arrays_;
  Json list_ = Json::array();
  std::map<std::vector<std::byte>, std::size_t> numbers_;
};

/// Adds to the section of a model what colours its surface: materials, the material of each
/// triangle, and per vertex its texture coordinates and colour.
void add_base_colours(const ViewedModel& model, PageImages& images, DataArrays& arrays,
                      Json& section);

}  // namespace sunder::tools
