#include "tools/model/surface_kinds.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "core/internal/nearest_names.h"
#include "io/internal/base_colours.h"

namespace sunder::tools {
namespace {

/// Above it a material is metal. Exporters write 0.4 and less for what is not.
constexpr float kMetal = 0.7f;

constexpr std::array kSkinWords = {"abdomen", "arm",    "belly",  "body",  "chest", "ear",  "face",
                                   "finger",  "flesh",  "foot",   "feet",  "hand",  "head", "leg",
                                   "limb",    "muscle", "muzzle", "neck",  "nose",  "paw",  "skin",
                                   "snout",   "tail",   "thigh",  "thumb", "toe",   "torso"};
constexpr std::array kDeadWords = {
    // Cloth.
    "apron", "bandana", "belt", "boot", "cap", "cape", "cloak", "cloth", "clothe", "clothing",
    "coat", "collar", "cotton", "denim", "dress", "fabric", "glove", "hat", "hood", "jacket",
    "jean", "lace", "leather", "linen", "overall", "pant", "ribbon", "robe", "sandal", "scarf",
    "shirt", "shoe", "short", "silk", "skirt", "sleeve", "sneaker", "sock", "strap", "suit",
    "sweater", "tie", "trouser", "tunic", "uniform", "vest", "wool",
    // Metal.
    "aluminium", "aluminum", "armor", "armour", "brass", "bronze", "chain", "chrome", "copper",
    "gold", "iron", "mail", "metal", "metallic", "silver", "steel", "titanium",
    // Things.
    "arrow", "axe", "backpack", "badge", "bag", "blade", "bottle", "bow", "buckle", "button",
    "controller", "crown", "dagger", "earring", "glass", "goggle", "gun", "hammer", "headphone",
    "headset", "helmet", "jewel", "joystick", "knife", "lamp", "lens", "mask", "necklace", "phone",
    "pistol", "plastic", "pot", "pouch", "prop", "quiver", "rifle", "ring", "rubber", "shield",
    "staff", "stick", "stone", "sword", "visor", "wand", "watch", "weapon", "wheel", "wood",
    // What grows on a body, without flesh.
    "beak", "beard", "brow", "claw", "eye", "eyeball", "eyebrow", "eyelash", "feather", "hair",
    "hoof", "hooves", "horn", "mane", "moustache", "nail", "spike", "teeth", "thorn", "tooth"};

/// Whether a word is one of a list, or its plural.
bool is_among(const std::string& word, std::span<const char* const> list) {
  return std::ranges::any_of(list, [&](const std::string_view of) {
    if (!word.starts_with(of)) return false;
    const std::string_view rest = std::string_view(word).substr(of.size());
    return rest.empty() || rest == "s" || rest == "es";
  });
}

}  // namespace

SurfaceKind kind_of_name(std::string_view name) {
  SurfaceKind kind = SurfaceKind::unnamed;
  for (const std::string& word : words_of(name)) {
    if (is_among(word, kSkinWords)) kind = SurfaceKind::skin;
    if (is_among(word, kDeadWords)) kind = SurfaceKind::dead;
  }
  return kind;
}

SurfaceKinds::SurfaceKinds(const Character& character) {
  for (const Mesh& mesh : character.meshes) meshes_.push_back(kind_of_name(mesh.name));
}

Result<SurfaceKinds> SurfaceKinds::create(const Character& character,
                                          const SourceDocument* source) {
  SurfaceKinds kinds(character);
  if (source == nullptr) return kinds;
  const Result<BaseColours> colours = read_base_colours(*source, 0);
  if (!colours) return colours.error();
  for (const BaseColour& material : colours->materials) {
    SurfaceKind kind = kind_of_name(material.name);
    if (kind == SurfaceKind::unnamed && material.metallic > kMetal) kind = SurfaceKind::dead;
    kinds.names_skin_ |= kind == SurfaceKind::skin;
    kinds.materials_.push_back(kind);
  }
  return kinds;
}

SurfaceKind SurfaceKinds::of(std::uint32_t mesh, std::uint32_t material) const {
  const SurfaceKind of_material =
      material < materials_.size() ? materials_[material] : SurfaceKind::unnamed;
  if (of_material != SurfaceKind::unnamed) return of_material;
  if (names_skin_ && meshes_[mesh] == SurfaceKind::skin) return SurfaceKind::unnamed;
  return meshes_[mesh];
}

}  // namespace sunder::tools
