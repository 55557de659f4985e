#include <sunder/io/operation_log.h>

#include <exception>
#include <new>
#include <utility>

#include "io/internal/strict_json.h"
#include "io/operation_log/format.h"
#include "io/operation_log/read_operation.h"

namespace sunder {
namespace {

using operation_log::Fault;

/// The Status of the exception that is being handled.
Status status_of_current_exception() {
  try {
    throw;
  } catch (const Fault& fault) {
    return fault.status;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "out of memory while reading the operation log");
  } catch (const std::exception& error) {
    return Status::failure(StatusCode::internal_error, kNone, "operation log: %s", error.what());
  }
}

/// Throws Fault.
std::string write_text(std::span<const Operation> operations) {
  std::string text = "{\n  \"sunder_operations\": 1,\n  \"operations\": [";
  for (std::size_t i = 0; i < operations.size(); ++i) {
    text += i == 0 ? "\n    " : ",\n    ";
    operation_log::append_operation(text, operations[i]);
    if (text.size() > kMaximumJsonBytes)
      throw Fault{Status::failure(StatusCode::limit_exceeded, static_cast<std::uint32_t>(i),
                                  "the log of %zu operations has more than %zu bytes, which are "
                                  "the most that is read",
                                  operations.size(), kMaximumJsonBytes)};
  }
  text += operations.empty() ? "]\n}\n" : "\n  ]\n}\n";
  return text;
}

}  // namespace

Result<std::vector<Operation>> parse_operations(std::string_view json, const Character* model) {
  try {
    const Result<StrictJson> log = parse_strict_json(json);
    if (!log) return log.error();
    return operation_log::read_log(*log, model);
  } catch (...) {
    return status_of_current_exception();
  }
}

Result<std::vector<LoggedOperation>> parse_aimed_operations(std::string_view json,
                                                            const Character* model) {
  try {
    const Result<StrictJson> log = parse_strict_json(json);
    if (!log) return log.error();
    return operation_log::read_aimed_log(*log, model);
  } catch (...) {
    return status_of_current_exception();
  }
}

Result<std::string> format_operations(std::span<const Operation> operations) {
  try {
    return write_text(operations);
  } catch (...) {
    return status_of_current_exception();
  }
}

}  // namespace sunder
