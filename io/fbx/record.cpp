#include "io/fbx/record.h"

#include <algorithm>
#include <array>

namespace sunder::fbx {
namespace {

constexpr std::string_view kBinaryMark = "Kaydara FBX Binary";

}  // namespace

const Record* Record::child(std::string_view wanted) const {
  const auto found = std::find_if(children.begin(), children.end(),
                                  [&](const Record& one) { return one.name == wanted; });
  return found == children.end() ? nullptr : &*found;
}

std::span<const double> Record::array(std::string_view wanted) const {
  const Record* const record = child(wanted);
  if (record == nullptr) return {};
  const Record* const inner = record->child("a");
  const std::vector<Value>& found = inner != nullptr ? inner->values : record->values;
  if (found.empty()) return {};
  return found.front().numbers;
}

Record read_records(std::span<const std::byte> file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  return text.starts_with(kBinaryMark) ? read_binary_records(file) : read_text_records(text);
}

bool is_needed(std::string_view section, std::string_view object) {
  constexpr std::array kObjects = {"Model", "AnimationStack", "AnimationLayer",
                                   "AnimationCurveNode", "AnimationCurve"};
  if (section == "Objects")
    return object.empty() || std::find(kObjects.begin(), kObjects.end(), object) != kObjects.end();
  return section == "Definitions" || section == "Connections";
}

}  // namespace sunder::fbx
