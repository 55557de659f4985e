#pragma once

#include <sunder/binding/binding.h>

#include <string>
#include <variant>

#include "tools/messages/json.h"
#include "tools/messages/lines.h"
#include "tools/verbs.h"

namespace sunder::tools {

/// A binding as the verb made it: by a map, or by automatic weights.
using AnyBinding = std::variant<MappedBinding, HeatBinding>;

[[nodiscard]] const Binding& common(const AnyBinding& binding);

/// All figures of a binding and the options that led to them.
[[nodiscard]] Json bind_json(const BindRequest& request, const AnyBinding& binding,
                             const BindingPlace& place);

/// Lines for people: counts and distances.
[[nodiscard]] Lines bind_table(const AnyBinding& binding);

/// The warnings of a binding, one line each; empty if there is nothing.
[[nodiscard]] std::vector<std::string> bind_warnings(const AnyBinding& binding);

}  // namespace sunder::tools
