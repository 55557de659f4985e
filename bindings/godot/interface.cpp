#include "bindings/godot/interface.h"

#include <type_traits>

namespace sunder::godot {

Host host = {};

const char* load_host(GetProcAddress get_proc_address) {
  const char* missing = nullptr;
  for_each_function(host, [&](const char* name, auto& function) {
    const AnyFunction found = get_proc_address(name);
    if (found == nullptr && missing == nullptr) missing = name;
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(found);
  });
  return missing;
}

}  // namespace sunder::godot
