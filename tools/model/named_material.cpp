#include "tools/model/named_material.h"

#include <variant>

#include "core/operation/internal/describe_aimed.h"
#include "io/internal/base_colours.h"

namespace sunder::tools {
namespace {

/// Calls use(name, material) for the described fields that are materials.
template <class Use>
struct MaterialVisitor {
  const Use& use;

  void operator()(const Field& field, auto& material, const Material&) const {
    use(field.name, material);
  }
  void operator()(const Field&, const auto&...) const {}
  void object(const Field&, const auto&) const {}
};

template <class Operation, class Use>
void for_material(Operation& of, const Use& use) {
  const MaterialVisitor<Use> visitor{use};
  describe(visitor, of);
}

}  // namespace

MaterialField material_field(const LoggedOperation& operation) {
  MaterialField field;
  const auto read = [&](const auto& of) {
    for_material(of, [&](const char* name, std::uint32_t material) { field = {name, material}; });
  };
  std::visit([&](const auto& plain_or_aimed) { std::visit(read, plain_or_aimed); }, operation);
  return field;
}

void set_material(AimedOperation& operation, std::uint32_t material) {
  std::visit(
      [&](auto& of) {
        for_material(of, [&](const char*, std::uint32_t& field) { field = material; });
      },
      operation);
}

Status check_material(const LoggedOperation& operation, const SourceDocument* source) {
  const MaterialField field = material_field(operation);
  if (field.material == kNone || source == nullptr) return {};
  const Result<BaseColours> colours = read_base_colours(*source, 0);
  if (!colours) return colours.error();
  const std::size_t count = colours->materials.size();
  if (field.material < count) return {};
  if (count == 0)
    return Status::failure(StatusCode::index_out_of_range, field.material,
                           "%s is %u; the model has no materials", field.name, field.material);
  return Status::failure(StatusCode::index_out_of_range, field.material,
                         "%s is %u; it must be from 0 to %zu, an index that `sunder info` lists",
                         field.name, field.material, count - 1);
}

}  // namespace sunder::tools
