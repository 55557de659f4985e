#include "tools/validation_page/page_template.h"

namespace sunder::tools {

std::span<const std::string_view> page_template() { return {}; }

}  // namespace sunder::tools
