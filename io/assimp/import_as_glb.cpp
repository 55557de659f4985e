#include "io/assimp/import_as_glb.h"

#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "io/assimp/child_process.h"
#include "io/assimp/convert_scene.h"
#include "io/assimp/failure.h"
#include "io/assimp/read_scene.h"

namespace sunder::assimp_import {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

Status check_file(const fs::path& file, const LoadOptions& options) {
  if (!(options.import_seconds > 0.0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "LoadOptions::import_seconds must be above 0");
  const std::string name = file.filename().string();
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    return Status::failure(StatusCode::file_not_found, kNone, "no file '%s'", name.c_str());
  if (error || status.type() != fs::file_type::regular || !std::ifstream(file, std::ios::binary))
    return Status::failure(StatusCode::file_unreadable, kNone, "cannot read '%s'", name.c_str());
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error)
    return Status::failure(StatusCode::file_unreadable, kNone, "cannot read '%s'", name.c_str());
  if (bytes == 0)
    return Status::failure(StatusCode::empty_input, kNone, "%s: the file is empty", name.c_str());
  if (bytes > options.maximum_bytes)
    return Status::failure(StatusCode::limit_exceeded, kNone, "%s: %llu bytes, the limit is %llu",
                           name.c_str(), static_cast<unsigned long long>(bytes),
                           static_cast<unsigned long long>(options.maximum_bytes));
  const std::string extension = lower_extension(file);
  if (extension == "gltf" || extension == "glb" || extension == "vrm")
    return Status::failure(StatusCode::unsupported_format, kNone, "%s: glTF is not read by assimp",
                           name.c_str());
  return {};
}

std::string encode_head(const Status& status, const LoadReport& report) {
  json head = {{"code", status.code()}, {"index", status.index()}, {"text", status.text()}};
  head["format"] = report.format;
  head["space"] = report.space;
  head["notes"] = json::array();
  for (const LoadNote& note : report.notes)
    head["notes"].push_back({note.kind, note.place, note.text, note.count});
  return head.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// A malicious file may control the child, so its reply is checked like any other input. Throws
/// json::exception.
Status decode_head(const std::string& text, LoadReport& report) {
  const json head = json::parse(text);
  report.format = head.at("format").get<std::string>();
  report.space = head.at("space").get<std::string>();
  for (const json& note : head.at("notes")) {
    const int kind = note.at(0).get<int>();
    if (kind < 0 || kind > static_cast<int>(LoadNote::Kind::dropped))
      throw std::out_of_range("note kind");
    report.notes.push_back({static_cast<LoadNote::Kind>(kind), note.at(1).get<std::string>(),
                            note.at(2).get<std::string>(), note.at(3).get<std::uint32_t>()});
  }
  const int code = head.at("code").get<int>();
  if (code == static_cast<int>(StatusCode::ok)) return {};
  if (code < 0 || code > static_cast<int>(StatusCode::internal_error))
    throw std::out_of_range("status code");
  return Status::failure(static_cast<StatusCode>(code), head.at("index").get<std::uint32_t>(), "%s",
                         head.at("text").get<std::string>().c_str());
}

/// Runs in the child.
ChildReply answer(const fs::path& file, const LoadOptions& options) {
  const std::string name = file.filename().string();
  try {
    ImportedGlb imported = read_and_convert(file, options);
    return {encode_head({}, imported.report), std::move(imported.glb)};
  } catch (const ImportFailure& failure) {
    return {encode_head(failure.status, {}), {}};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::length_error&) {
    return {encode_head(
                Status::failure(StatusCode::malformed_file, kNone,
                                "%s: an array is declared with an impossible size", name.c_str()),
                {}),
            {}};
  } catch (const std::exception& error) {
    return {encode_head(Status::failure(StatusCode::malformed_file, kNone, "%s: %s", name.c_str(),
                                        error.what()),
                        {}),
            {}};
  }
}

}  // namespace

Result<ImportedGlb> import_as_glb(const fs::path& file, const LoadOptions& options) {
  try {
    if (const Status checked = check_file(file, options); !checked) return checked;
    const fs::path whole = fs::canonical(file);
    const ChildLimits limits{.seconds = options.import_seconds,
                             .maximum_reply = options.maximum_bytes};
    Result<ChildReply> reply =
        run_in_child([&] { return answer(whole, options); }, limits, file.filename().string());
    if (!reply) return reply.error();

    ImportedGlb imported;
    if (const Status status = decode_head(reply->head, imported.report); !status) return status;
    imported.glb = std::move(reply->body);
    return imported;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "%s: out of memory",
                           file.filename().c_str());
  } catch (const std::exception& error) {
    return Status::failure(StatusCode::internal_error, kNone, "%s: %s", file.filename().c_str(),
                           error.what());
  }
}

}  // namespace sunder::assimp_import
