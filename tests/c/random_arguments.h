#pragma once

#include <cstring>
#include <limits>
#include <string>
#include <sunder_c.h>
#include <type_traits>
#include <utility>
#include <vector>

namespace sunder::test {

template <class T>
concept HasStructSize = requires(T one) {
  one.struct_size;
};

/// Arguments for calls of all functions (see bindings/c/make_api.py --calls). Handles are those of
/// its pool, of any kind, also destroyed ones; pointers are null or lead to enough memory.
/// @tparam Bits  has `std::uint32_t index(std::uint32_t count)`.
template <class Bits>
class RandomArguments {
 public:
  explicit RandomArguments(Bits& bits) : bits_(bits), memory_(kBlocks) {
    for (auto& block : memory_) block.resize(kBlockBytes);
    clear();
  }

  RandomArguments(const RandomArguments&) = delete;
  RandomArguments& operator=(const RandomArguments&) = delete;
  ~RandomArguments() { destroy_all(); }

  /// Destroys and forgets all objects that were kept.
  void clear() {
    destroy_all();
    pool_ = {{"", 0}, {"", ~std::uint64_t{0}}};
  }

  /// Memory for the next call.
  void begin_call() { next_block_ = 0; }
  /// Keeps the handles that the call wrote.
  void end_call(sunder_status status) {
    if (status == SUNDER_OK)
      for (const auto& [kind, block] : outputs_) {
        std::uint64_t value = 0;
        const bool is_wide =
            kind == "sunder_instance" || kind == "sunder_layer" || kind == "sunder_command";
        std::memcpy(&value, memory_[block % kBlocks].data(), is_wide ? 8 : 4);
        keep(kind, value);
      }
    outputs_.clear();
  }
  void keep(const std::string& kind, std::uint64_t handle) {
    kept_.emplace_back(kind, handle);
    if (pool_.size() < 64)
      pool_.emplace_back(kind, handle);
    else
      pool_[2 + bits_.index(62)] = {kind, handle};
  }

  /// Mostly one of the right kind.
  template <class Handle>
  Handle handle(const std::string& kind) {
    for (int tries = 0; tries < 40; ++tries) {
      const auto& [of, value] = pool_[bits_.index(static_cast<std::uint32_t>(pool_.size()))];
      if (of == kind || bits_.index(60) == 0) return static_cast<Handle>(value);
    }
    return static_cast<Handle>(bits_.index(5));
  }
  template <class Handle>
  Handle* handle_out(const std::string& kind) {
    if (bits_.index(30) == 0) return nullptr;
    outputs_.emplace_back(kind, next_block_);
    return reinterpret_cast<Handle*>(block());
  }
  template <class Pointer>
  Pointer pointer() {
    if (bits_.index(12) == 0) return nullptr;
    std::byte* const memory = block();
    for (std::size_t i = 0; i < 64; ++i) memory[i] = static_cast<std::byte>(bits_.index(4) * 32);
    std::memset(memory + 64, 0, kBlockBytes - 64);
    return reinterpret_cast<Pointer>(memory);
  }
  /// Many copies of a struct, as for an array; now and then of a wrong size.
  template <class Struct>
  Struct* structure(Struct one) {
    if (bits_.index(12) == 0) return nullptr;
    if constexpr (HasStructSize<Struct>)
      if (bits_.index(20) == 0) one.struct_size = bits_.index(300);
    std::byte* const memory = block();
    for (std::size_t i = 0; (i + 1) * sizeof one <= kBlockBytes; ++i)
      std::memcpy(memory + i * sizeof one, &one, sizeof one);
    return reinterpret_cast<Struct*>(memory);
  }
  template <class Struct>
  Struct sized() {
    Struct one = {};
    if constexpr (HasStructSize<Struct>) one.struct_size = sizeof one;
    return one;
  }
  template <class Number>
  Number number(const std::string& name) {
    if (name.find("count") != std::string::npos || name.find("capacity") != std::string::npos ||
        name.find("size") != std::string::npos)
      return static_cast<Number>(bits_.index(9));
    if constexpr (std::is_floating_point_v<Number>) {
      constexpr double kHard[] = {0.0,   -1.0,   std::numeric_limits<double>::infinity(),
                                  1e300, 1e-300, -0.0};
      if (bits_.index(6) == 0) return static_cast<Number>(kHard[bits_.index(6)]);
      return static_cast<Number>(bits_.index(1000)) / 500;
    } else {
      if (bits_.index(12) == 0) return static_cast<Number>(~std::uint64_t{0} - bits_.index(3));
      return static_cast<Number>(bits_.index(4));
    }
  }

 private:
  static constexpr std::size_t kBlocks = 12, kBlockBytes = 64u << 10u;

  /// The random calls may have destroyed some of them.
  void destroy_all() {
    for (const auto& [kind, handle] : kept_) {
      const auto one = static_cast<std::uint32_t>(handle);
      if (kind == "sunder_bytes") sunder_destroy_bytes(one);
      if (kind == "sunder_character") sunder_destroy_character(one);
      if (kind == "sunder_asset") sunder_destroy_asset(one);
      if (kind == "sunder_scene") sunder_destroy_scene(one);
      if (kind == "sunder_piece") sunder_destroy_piece(one);
      if (kind == "sunder_ragdoll") sunder_destroy_ragdoll(one);
      if (kind == "sunder_report") sunder_destroy_report(one);
    }
    kept_.clear();
  }
  std::byte* block() { return memory_[next_block_++ % kBlocks].data(); }

  Bits& bits_;
  std::vector<std::vector<std::byte>> memory_;
  std::size_t next_block_ = 0;
  std::vector<std::pair<std::string, std::uint64_t>> pool_, kept_;
  std::vector<std::pair<std::string, std::size_t>> outputs_;
};

/// Objects that work together, in place of those that the arguments have had.
/// @return whether all could be made.
template <class Bits>
bool keep_new_objects(const sunder_character_data& data, RandomArguments<Bits>& arguments) {
  sunder_asset_options options = sunder_default_asset_options();
  options.is_soft = 1;
  sunder_character character = 0;
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance instance = 0;
  const bool are_made = sunder_create_character(&data, &character) == SUNDER_OK &&
                        sunder_create_asset(character, &options, &asset) == SUNDER_OK &&
                        sunder_create_scene(nullptr, &scene) == SUNDER_OK &&
                        sunder_spawn(scene, asset, nullptr, &instance) == SUNDER_OK &&
                        sunder_prepare_to_tear(scene, instance) == SUNDER_OK &&
                        sunder_update(scene, 0.1) == SUNDER_OK;
  arguments.clear();
  arguments.keep("sunder_character", character);
  arguments.keep("sunder_asset", asset);
  arguments.keep("sunder_scene", scene);
  arguments.keep("sunder_instance", instance);
  return are_made;
}

}  // namespace sunder::test
