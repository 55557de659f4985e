#include "io/usd_write/identifiers.h"

#include "io/usd_write/usd_text.h"

namespace sunder::usd {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
/// A byte of UTF-8 that is not the first one of its character.
bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u; }

}  // namespace

std::string Identifiers::add(std::string_view name, std::string_view kind) {
  std::string identifier;
  for (const char c : name.empty() ? kind : name)
    if (is_letter(c) || is_digit(c))
      identifier += c;
    else if (!continues(c))
      identifier += '_';
  if (identifier.empty() || is_digit(identifier[0])) identifier.insert(0, "_");
  std::string unique = identifier;
  std::uint32_t& next = next_number_.try_emplace(identifier, 2).first->second;
  while (!taken_.insert(unique).second) unique = identifier + "_" + std::to_string(next++);
  return unique;
}

std::vector<std::string> display_name(std::string_view name, std::string_view identifier) {
  if (name.empty() || name == identifier) return {};
  return {"displayName = " + literal(name)};
}

}  // namespace sunder::usd
