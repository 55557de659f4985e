#pragma once

#include <sunder/core/character.h>
#include <sunder/core/status.h>
#include <sunder/operation/aimed_operation.h>
#include <sunder/operation/operation.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sunder {

/// Reads an operation log (docs/operation_log.md). Unknown fields, wrong types, other versions and
/// values that are not finite are refused; the error names the place as a JSON pointer
/// ("/operations/0/stroke/1/tip").
/// @param model  whose materials the log may name, as `sunder info` prints them; null: indices
/// only.
/// @return malformed_file, unsupported_feature, limit_exceeded; not_found for a material.
[[nodiscard]] SUNDER_API Result<std::vector<Operation>> parse_operations(
    std::string_view json, const Character* model = nullptr);

/// Parses the content of a file. @return as parse_operations(); file_not_found, file_unreadable.
[[nodiscard]] SUNDER_API Result<std::vector<Operation>> load_operations(
    const std::filesystem::path& file, const Character* model = nullptr);

/// Reads a log that may also hold operations that name bones or places of the surface: slash,
/// sever, puncture and incision, which parse_operations() refuses. resolve() of <sunder/aim/aim.h>
/// turns them into plain ones, for a model. @return as parse_operations().
[[nodiscard]] SUNDER_API Result<std::vector<LoggedOperation>> parse_aimed_operations(
    std::string_view json, const Character* model = nullptr);

/// Parses the content of a file. @return as load_operations().
[[nodiscard]] SUNDER_API Result<std::vector<LoggedOperation>> load_aimed_operations(
    const std::filesystem::path& file, const Character* model = nullptr);

/// The log as text; parse_operations() gives back operations with the same bits.
/// @return limit_exceeded: out of memory, or more than 64 MiB, which are the most that is read.
[[nodiscard]] SUNDER_API Result<std::string> format_operations(
    std::span<const Operation> operations);

/// Writes format_operations() to a file. A failing call leaves an existing file as it was.
/// @return file_unreadable; as format_operations().
[[nodiscard]] SUNDER_API Status save_operations(const std::filesystem::path& file,
                                                std::span<const Operation> operations);

}  // namespace sunder
