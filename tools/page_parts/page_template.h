#pragma once

#include <span>
#include <string_view>

namespace sunder::tools {

/// Where the data goes, once in each template.
inline constexpr std::string_view kPageDataMark = "SUNDER_PAGE_DATA";

/// A bundled page in pieces, to be joined; none if it was built without npm's packages.
using PageTemplate = std::span<const std::string_view>;

[[nodiscard]] PageTemplate validation_page_template();  ///< `sunder validate --html`.
[[nodiscard]] PageTemplate view_page_template();        ///< `sunder view`.

}  // namespace sunder::tools
