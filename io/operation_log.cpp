#include <sunder/io/operation_log.h>

#include <exception>
#include <fstream>
#include <new>
#include <system_error>

#include "io/internal/staged_file.h"
#include "io/operation_log/format.h"
#include "io/operation_log/parse_json.h"
#include "io/operation_log/read_operation.h"

namespace sunder {
namespace {

using operation_log::Fault;
using operation_log::kMaximumBytes;

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

std::string read_text(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw Fault{Status::failure(StatusCode::file_not_found, kNone, "no file '%s'", name.c_str())};
  const Fault unreadable{
      Status::failure(StatusCode::file_unreadable, kNone, "cannot read '%s'", name.c_str())};
  std::ifstream stream(file, std::ios::binary);
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (status.type() != std::filesystem::file_type::regular || error || !stream) throw unreadable;
  if (size > kMaximumBytes)
    throw Fault{Status::failure(StatusCode::limit_exceeded, kNone,
                                "%s: %ju bytes; the limit is %zu", name.c_str(), size,
                                kMaximumBytes)};
  std::string text(static_cast<std::size_t>(size), '\0');
  if (!stream.read(text.data(), static_cast<std::streamsize>(size))) throw unreadable;
  return text;
}

std::string write_text(std::span<const Operation> operations) {
  std::string text = "{\n  \"sunder_operations\": 1,\n  \"operations\": [";
  for (std::size_t i = 0; i < operations.size(); ++i) {
    text += i == 0 ? "\n    " : ",\n    ";
    operation_log::append_operation(text, operations[i]);
  }
  text += operations.empty() ? "]\n}\n" : "\n  ]\n}\n";
  return text;
}

}  // namespace

Result<std::vector<Operation>> parse_operations(std::string_view json) {
  try {
    return operation_log::read_log(operation_log::parse_json(json));
  } catch (...) {
    return status_of_current_exception();
  }
}

Result<std::vector<Operation>> load_operations(const std::filesystem::path& file) {
  try {
    return parse_operations(read_text(file));
  } catch (...) {
    return status_of_current_exception();
  }
}

Result<std::vector<LoggedOperation>> parse_aimed_operations(std::string_view json) {
  try {
    return operation_log::read_aimed_log(operation_log::parse_json(json));
  } catch (...) {
    return status_of_current_exception();
  }
}

Result<std::vector<LoggedOperation>> load_aimed_operations(const std::filesystem::path& file) {
  try {
    return parse_aimed_operations(read_text(file));
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

Status save_operations(const std::filesystem::path& file, std::span<const Operation> operations) {
  try {
    const std::string text = write_text(operations);
    return write_file(file, std::as_bytes(std::span<const char>(text)));
  } catch (...) {
    return status_of_current_exception();
  }
}

}  // namespace sunder
