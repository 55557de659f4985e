#include "tools/page_parts/page_template.h"

namespace sunder::tools {

PageTemplate validation_page_template() { return {}; }

PageTemplate view_page_template() { return {}; }

}  // namespace sunder::tools
