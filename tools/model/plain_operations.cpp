#include "tools/model/plain_operations.h"

#include <sunder/aim/aim.h>
#include <sunder/io/operation_log.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "tools/model/coupled_refits.h"
#include "tools/model/named_poses.h"

namespace sunder::tools {
namespace {

Status at_operation(std::size_t number, const Status& status, const std::string& advice) {
  return Status::failure(status.code(), static_cast<std::uint32_t>(number), "/operations/%zu: %s%s",
                         number, std::string(status.text()).c_str(), advice.c_str());
}

}  // namespace

Result<std::vector<Operation>> load_plain_operations(
    const std::filesystem::path& file, const std::shared_ptr<const Character>& character,
    Budget& budget) {
  auto logged = load_aimed_operations(file, character.get());
  if (!logged) return logged.error();
  const auto last_aimed = std::find_if(
      logged->rbegin(), logged->rend(),
      [](const LoggedOperation& of) { return std::holds_alternative<AimedOperation>(of); });
  const auto to_apply = static_cast<std::size_t>(logged->rend() - last_aimed);
  std::vector<Operation> plain;
  if (to_apply == 0) {
    for (LoggedOperation& of : *logged) plain.push_back(std::move(std::get<Operation>(of)));
    return plain;
  }
  if (const Status status = provide_coupled_refits(*logged); !status) return status;
  auto model = TornModel::create(character, budget.capacity());
  if (!model) return model.error();
  for (std::size_t i = 0; i < logged->size(); ++i) {
    LoggedOperation& of = (*logged)[i];
    budget.begin(file.string() + ": /operations/" + std::to_string(i));
    if (const auto* const aimed = std::get_if<AimedOperation>(&of)) {
      auto resolved = resolve(*model, *aimed);
      if (!resolved) return at_operation(i, resolved.error(), advice_on_names(*aimed, *character));
      plain.push_back(std::move(*resolved));
    } else {
      plain.push_back(std::move(std::get<Operation>(of)));
    }
    if (i + 1 >= to_apply) continue;  // nothing is aimed at what this one leaves
    if (const auto applied = apply_operation(*model, plain.back()); !applied)
      return at_operation(i, applied.error(), advice_on_names(plain.back(), *character));
  }
  budget.begin(file.string());
  return plain;
}

}  // namespace sunder::tools
