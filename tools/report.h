#pragma once

#include <sunder/io/character_file.h>
#include <sunder/operation/operation.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <string>

#include <nlohmann/json.hpp>

namespace sunder::tools {

using Json = nlohmann::ordered_json;

/// What one operation did, with the surface's shape before and after it.
struct OperationOutcome {
  const char* op = "";    ///< As a log names it.
  const char* done = "";  ///< What became of the surface, if it was not missed.
  bool has_missed = false;
  TearReport tear;
  double seconds = 0;  ///< Of the operation alone.
  /// How far the points that it made stand from where the surface was, at most, in the poses in
  /// which it was done; metres.
  double weight_error_max = 0;
  TopologyCounts before, after;
};

/// Does an operation and says what it did.
/// @param before  the shape of the model.
[[nodiscard]] Result<OperationOutcome> play(const Operation& operation,
                                            const TopologyCounts& before, TornModel& model,
                                            std::vector<ChangeRecord>* changes = nullptr);

[[nodiscard]] Json to_json(const TopologyCounts& counts);
[[nodiscard]] Json to_json(const LoadReport& report);
/// @param character  after the operation: pieces name its meshes and bones.
[[nodiscard]] Json to_json(const OperationOutcome& outcome, const Character& character);

/// The result of all operations: `torn` by itself, with the source's shape to compare.
[[nodiscard]] Json result_json(const TornModel& torn, const TopologyCounts& source,
                               const TopologyCounts& result);

/// Numbers of a 2-, 3- or 4-vector.
template <class Vector>
[[nodiscard]] Json vector_json(const Vector& vector) {
  Json array = Json::array();
  for (int i = 0; i < Vector::RowsAtCompileTime; ++i)
    array.push_back(static_cast<double>(vector[i]));
  return array;
}

/// Text as UTF-8 with two spaces of indentation; what is not UTF-8 in a name is replaced.
[[nodiscard]] std::string dump(const Json& json);

/// A text file that appears under its name when it is committed, and else leaves nothing behind.
class StagedText {
 public:
  StagedText(std::filesystem::path file, const std::string& text);
  ~StagedText();
  StagedText(const StagedText&) = delete;
  StagedText& operator=(const StagedText&) = delete;

  [[nodiscard]] const Status& status() const { return status_; }
  [[nodiscard]] Status commit();

 private:
  std::filesystem::path file_, partial_;
  Status status_;
};

/// Writes `text` as a whole or not at all.
[[nodiscard]] Status write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace sunder::tools
