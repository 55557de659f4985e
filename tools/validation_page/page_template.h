#pragma once

#include <span>
#include <string_view>

namespace sunder::tools {

/// Where the data goes, once in the template.
inline constexpr std::string_view kPageDataMark = "SUNDER_PAGE_DATA";

/// The bundled page in pieces, to be joined; none if it was built without npm's packages.
[[nodiscard]] std::span<const std::string_view> page_template();

}  // namespace sunder::tools
