#pragma once

#include <string>

namespace sunder::test {

/// The JSON schema of operation logs, docs/operation_log.schema.json, by the descriptions of the
/// operations.
[[nodiscard]] std::string operation_schema();

}  // namespace sunder::test
