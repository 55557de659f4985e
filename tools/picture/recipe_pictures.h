#pragma once

#include <string>

namespace sunder::tools {

/// Draws the pictures of docs/tissue_recipes.md whose things are torn by force, before and after,
/// with the very code of that page, and prints how far they tore. A failure ends the program.
void draw_recipes(const std::string& folder);

}  // namespace sunder::tools
