#include "io/usd_write/layer.h"

#include <algorithm>
#include <utility>

#include "io/gltf/refusal.h"
#include "io/gltf_write/influence_sets.h"
#include "io/gltf_write/mesh_writer.h"
#include "io/usd_write/animations.h"
#include "io/usd_write/blend_shapes.h"
#include "io/usd_write/joints.h"
#include "io/usd_write/materials.h"
#include "io/usd_write/meshes.h"
#include "io/usd_write/sample_times.h"

namespace sunder::usd {
namespace {

void check_formats(const SaveOptions& options) {
  const auto is_float = [](WeightFormat format) { return format == WeightFormat::float32; };
  if (!is_float(options.weights) || !std::ranges::all_of(options.weights_of_mesh, is_float))
    gltf::refuse(StatusCode::invalid_argument, kNone,
                 "USD stores weights as floats; other formats are for GLB");
}

class LayerWriter {
 public:
  LayerWriter(const Character& character, const LoadedCharacter& loaded, const SaveOptions& options,
              const std::string& textures_folder)
      : character_(character),
        loaded_(loaded),
        options_(options),
        textures_folder_(textures_folder),
        root_(Identifiers().add(character.name, "Character")),
        rate_(time_codes_per_second(character.clips)),
        joints_(character),
        shapes_(blend_shape_names(character)) {
    name_clips();
  }

  UsdLayer write() {
    const std::string path = "/" + root_;
    // The names of its prims are found in the order in which they are needed.
    const std::string skeleton = children_.add("Skeleton", ""), clips = children_.add("Clips", ""),
                      materials_scope = children_.add("Materials", "");
    Materials materials(character_, loaded_.source.get(), options_, path + "/" + materials_scope,
                        textures_folder_);
    const AnimationWriter animations(character_, joints_, shapes_, rate_, clips_);
    write_stage();
    open_root();
    write_skeleton(path, skeleton, clips);
    write_clips(clips, animations);
    materials.write(text_);
    const MeshesWriter meshes(joints_, materials, shapes_, path + "/" + skeleton);
    for (std::uint32_t m = 0; m < character_.meshes.size(); ++m)
      if (const Mesh& mesh = character_.meshes[m]; gltf::MeshWriter::has_triangles(mesh))
        meshes.write(text_, mesh, path + "/" + children_.add(mesh.name, "Mesh"),
                     gltf::influence_form(options_, m, most_of_source()).maximum);
    if (clip_names_.size() > 1) write_variants(path, skeleton, clips);
    text_.close('}');
    return {text_.take(), materials.take_textures(), materials.left_out_images()};
  }

 private:
  /// Weights of blend shapes are those of an animation, so without clips one holds those at rest.
  void name_clips() {
    Identifiers taken;
    clips_ = character_.clips;
    const auto& weights = character_.rest_morph_weights;
    const bool is_any_weight =
        std::any_of(weights.begin(), weights.end(), [](float weight) { return weight != 0; });
    if (clips_.empty() && is_any_weight) {
      clips_.emplace_back();
      clips_[0].name = "Rest";
    }
    for (const Clip& clip : clips_) clip_names_.push_back(taken.add(clip.name, "Clip"));
  }

  [[nodiscard]] std::uint32_t most_of_source() const {
    return loaded_.character == nullptr ? 0 : gltf::most_influences(*loaded_.character);
  }

  void write_stage() {
    float duration = 0;
    for (const Clip& clip : character_.clips) duration = std::max(duration, clip.duration);
    const std::string rate = fixed_number(rate_);
    text_.line("#usda 1.0");
    text_.line("(");
    for (const std::string& entry :
         {"defaultPrim = " + literal(root_), std::string("doc = \"Written by Sunder\""),
          "endTimeCode = " + fixed_number(time_code(static_cast<double>(duration), rate_)),
          "framesPerSecond = " + rate, std::string("metersPerUnit = 1"),
          std::string("startTimeCode = 0"), "timeCodesPerSecond = " + rate,
          std::string("upAxis = \"Y\"")})
      text_.line("    " + entry);
    text_.line(")");
    text_.line("");
  }

  void open_root() {
    std::vector<std::string> metadata = display_name(character_.name, root_);
    metadata.emplace_back("kind = \"component\"");
    if (clip_names_.size() > 1) {
      metadata.emplace_back("variants = {");
      metadata.push_back("    string clip = " + literal(clip_names_[0]));
      metadata.emplace_back("}");
      metadata.emplace_back("prepend variantSets = \"clip\"");
    }
    text_.open_prim("SkelRoot", root_, metadata);
  }

  [[nodiscard]] static std::string animation_source(const std::string& animation) {
    return "rel skel:animationSource = <" + animation + ">";
  }

  void write_skeleton(const std::string& root, const std::string& name, const std::string& clips) {
    std::vector<std::string> paths, names;
    std::vector<Affine3d> bind, rest;
    bool is_any_other_name = false;
    for (const Joint& joint : joints_.all()) {
      is_any_other_name |= joint.name != joint.path.substr(joint.path.rfind('/') + 1);
      paths.push_back(joint.path);
      names.push_back(joint.name);
      bind.push_back(joint.model_from_bind);
      rest.push_back(joint.parent_from_joint);
    }
    const std::vector<std::string> api = {"prepend apiSchemas = [\"SkelBindingAPI\"]"};
    text_.open_prim("Skeleton", name, api);
    text_.line("uniform matrix4d[] bindTransforms = " + array_of(std::span<const Affine3d>(bind)));
    // Only where they differ: a reader takes them for the joints that meshes name.
    if (is_any_other_name)
      text_.line("uniform token[] jointNames = " + array_of(std::span<const std::string>(names)));
    text_.line("uniform token[] joints = " + array_of(std::span<const std::string>(paths)));
    text_.line("uniform matrix4d[] restTransforms = " + array_of(std::span<const Affine3d>(rest)));
    // Of several, a variant says which, and what stands here would be stronger.
    if (clip_names_.size() == 1)
      text_.line(animation_source(root + "/" + clips + "/" + clip_names_[0]));
    text_.close('}');
  }

  void write_clips(const std::string& scope, const AnimationWriter& animations) {
    if (clips_.empty()) return;
    text_.line("");
    text_.open_prim("Scope", scope);
    for (std::size_t i = 0; i < clips_.size(); ++i)
      animations.write(text_, clip_names_[i], display_name(clips_[i].name, clip_names_[i]), i);
    text_.close('}');
  }

  void write_variants(const std::string& root, const std::string& skeleton,
                      const std::string& clips) {
    text_.line("");
    text_.open("variantSet \"clip\" =", '{');
    for (const std::string& name : clip_names_) {
      text_.open(literal(name), '{');
      text_.open("over " + literal(skeleton), '{');
      text_.line(animation_source(root + "/" + clips + "/" + name));
      text_.close('}');
      text_.close('}');
    }
    text_.close('}');
  }

  const Character& character_;
  const LoadedCharacter& loaded_;
  const SaveOptions& options_;
  const std::string& textures_folder_;
  std::string root_;
  double rate_;
  Joints joints_;
  std::vector<std::string> shapes_;
  std::vector<Clip> clips_;
  std::vector<std::string> clip_names_;
  Identifiers children_;
  UsdText text_;
};

}  // namespace

UsdLayer layer_of(const Character& character, const LoadedCharacter& loaded,
                  const SaveOptions& options, const std::string& textures_folder) {
  if (const Status status = validate_character(character); !status) throw gltf::Refusal{status};
  gltf::check_options(options, character.meshes.size());
  check_formats(options);
  return LayerWriter(character, loaded, options, textures_folder).write();
}

}  // namespace sunder::usd
