#include "tools/tear/aimed_fields.h"

#include <algorithm>

#include "core/operation/internal/describe_aimed.h"
#include "core/operation/internal/names.h"

namespace sunder::tools {
namespace {

Quantity quantity_of(const NumberRange& range) {
  if (std::string_view(range.unit) == " m") return Quantity::length;
  return range.least == 0 && range.most == 1 ? Quantity::share : Quantity::number;
}

AimedField option_of(const Field& field, double, const NumberRange& range) {
  return {field.name, quantity_of(range)};
}
AimedField option_of(const Field& field, double, const Degrees&) {
  return {field.name, Quantity::angle};
}
AimedField option_of(const Field& field, std::uint32_t, const Material&) {
  return {.name = field.name, .is_material = true};
}
/// Lengths that may be in widths of the limb.
AimedField option_of(const Field& field, const auto&, const auto&) {
  return {field.name, Quantity::length, true};
}
AimedField option_of(const Field& field, const auto&) { return {field.name}; }

/// Collects the fields that one word can give.
struct AimedFieldList {
  AimedFields& of;

  void operator()(const Field& field, const auto& member, const auto&... kind) const {
    of.fields.push_back(option_of(field, member, kind...));
  }
  void operator()(const Field& field, const std::string&, const Name&) const {
    of.bone = field.name;
  }
  void operator()(const Field&, const PoseSpec&) const {}
  void operator()(const Field&, const std::optional<WeightOptions>&) const {}
};

template <class Operation>
AimedFields list_fields() {
  AimedFields fields;
  const AimedFieldList list{fields};
  const Operation of{};
  describe(list, of);
  return fields;
}

}  // namespace

const AimedField* AimedFields::find(std::string_view name) const {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const AimedField& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

const AimedFields& aimed_fields(std::string_view op) {
  static const AimedFields slash = list_fields<SlashOperation>(),
                           sever = list_fields<SeverOperation>(),
                           puncture = list_fields<PunctureOperation>();
  if (op == kOpName<SlashOperation>) return slash;
  return op == kOpName<SeverOperation> ? sever : puncture;
}

}  // namespace sunder::tools
