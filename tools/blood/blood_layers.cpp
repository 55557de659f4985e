#include "tools/blood/blood_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/internal/elementary.h"
#include "tools/blood/blood_look.h"
#include "tools/messages/printed.h"
#include "tools/render/texture.h"

namespace sunder::tools {
namespace {

constexpr double kReachOfSize = 0.02;    ///< Of blood, by the model's diagonal.
constexpr double kTexelsOfReach = 12;    ///< Least number that shows its border.
constexpr double kMostEnlarged = 2048;   ///< Texels a side of what is drawn finer than its source.
constexpr double kMostTexels = 8192;     ///< Texels a side.
constexpr double kInsideTexture = 1e-3;  ///< By which coordinates may be off the image.

/// Where the image of a texture is, and how large.
struct Frame {
  Eigen::Matrix<double, 2, 3> image_from_uv;
  /// From places in the new image to places in the source's.
  Eigen::Matrix<double, 2, 3> source_from_image = Eigen::Matrix<double, 2, 3>::Identity();
  std::uint32_t width = 0, height = 0;
  bool is_placed_anew = false;
};

struct UvBox {
  Vec2d low = Vec2d::Constant(std::numeric_limits<double>::infinity()), high = -low;

  void add(const Vec2d& at) {
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
};

/// The corners of a submesh of the source.
template <class Visit>
void for_each_triangle(const Mesh& mesh, std::uint32_t submesh, Visit visit) {
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    if (mesh.triangle_submesh[t] == submesh) visit(mesh.triangles[t]);
}

UvBox box_of(const Mesh& mesh, std::uint32_t submesh, std::uint32_t uv_set,
             const Eigen::Matrix<double, 2, 3>& image_from_uv) {
  UvBox box;
  for_each_triangle(mesh, submesh, [&](const Triangle& triangle) {
    for (const std::uint32_t v : triangle)
      box.add(image_from_uv * mesh.uv_sets[uv_set][v].cast<double>().homogeneous());
  });
  return box;
}

/// Metres of the surface per side of the texture, on the mean; 0 if it has no area.
double metres_of_texture(const Mesh& mesh, std::uint32_t submesh, std::uint32_t uv_set,
                         const Eigen::Matrix<double, 2, 3>& image_from_uv) {
  double surface = 0, texture = 0;
  const Eigen::Matrix2d linear = image_from_uv.leftCols<2>();
  for_each_triangle(mesh, submesh, [&](const Triangle& t) {
    const auto position = [&](std::size_t i) { return mesh.positions[t[i]].cast<double>().eval(); };
    const auto uv = [&](std::size_t i) {
      return (linear * mesh.uv_sets[uv_set][t[i]].cast<double>()).eval();
    };
    surface += (position(1) - position(0)).cross(position(2) - position(0)).norm();
    const Vec2d a = uv(1) - uv(0), b = uv(2) - uv(0);
    texture += std::abs(a.x() * b.y() - a.y() * b.x());
  });
  return texture > 0 ? std::sqrt(surface / texture) : 0;
}

/// The place of a texture, and a size that is fine enough for blood: that of the source, or a
/// multiple. None if it would be too large, or the coordinates are of no use.
std::optional<Frame> frame_of(const Mesh& mesh, std::uint32_t submesh, const BaseColour& colour,
                              const Image* image, double reach) {
  Frame frame;
  frame.image_from_uv = colour.image_from_uv.cast<double>();
  UvBox box = box_of(mesh, submesh, colour.uv_set, frame.image_from_uv);
  if (!box.low.allFinite() || !box.high.allFinite()) return std::nullopt;
  Vec2d share = Vec2d::Ones();
  if (box.low.minCoeff() < -kInsideTexture || box.high.maxCoeff() > 1 + kInsideTexture) {
    // The image repeats, or the surface is beside it: the new one shows all of the surface once.
    const Vec2d in_image = (box.high - box.low).cwiseMax(1e-6);
    frame.is_placed_anew = true;
    box = box_of(mesh, submesh, colour.uv_set, Eigen::Matrix<double, 2, 3>::Identity());
    const Vec2d size = (box.high - box.low).cwiseMax(1e-9);
    share = image == nullptr ? Vec2d(Vec2d::Ones()) : in_image;
    frame.image_from_uv << 1 / size.x(), 0, -box.low.x() / size.x(), 0, 1 / size.y(),
        -box.low.y() / size.y();
    Eigen::Matrix3d uv_from_image = Eigen::Matrix3d::Identity();
    uv_from_image.topRows<2>() << size.x(), 0, box.low.x(), 0, size.y(), box.low.y();
    frame.source_from_image = colour.image_from_uv.cast<double>() * uv_from_image;
  }
  const double metres = metres_of_texture(mesh, submesh, colour.uv_set, frame.image_from_uv);
  if (!(metres > 0)) return std::nullopt;
  Vec2d size = image == nullptr ? Vec2d(Vec2d::Ones()) : Vec2d(image->width, image->height);
  size = size.cwiseProduct(share).array().ceil();
  const double wanted = std::min(kMostEnlarged, kTexelsOfReach * metres / reach);
  while (size.maxCoeff() < wanted && 2 * size.maxCoeff() <= kMostEnlarged) size *= 2;
  if (size.maxCoeff() > kMostTexels) return std::nullopt;
  frame.width = static_cast<std::uint32_t>(size.x());
  frame.height = static_cast<std::uint32_t>(size.y());
  return frame;
}

std::uint8_t srgb_from_linear(float value) {
  const double c = std::clamp(double{value}, 0.0, 1.0);
  const double encoded =
      c <= 0.0031308 ? 12.92 * c : 1.055 * elementary::exp(elementary::log(c) / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

/// The base colour of a material in the frame of a new texture, with its factor but for alpha.
Image base_image(const Frame& frame, const RenderMaterial& material) {
  Image result;
  result.width = static_cast<int>(frame.width);
  result.height = static_cast<int>(frame.height);
  const Image* const image = material.image;
  const Vec3f factor = material.factor.head<3>();
  if (image != nullptr && !frame.is_placed_anew && image->width == result.width &&
      image->height == result.height && factor == Vec3f::Ones()) {
    result.rgba = image->rgba;
    return result;
  }
  result.rgba.resize(std::size_t{4} * frame.width * frame.height);
  std::uint8_t* pixel = result.rgba.data();
  for (std::uint32_t y = 0; y < frame.height; ++y)
    for (std::uint32_t x = 0; x < frame.width; ++x, pixel += 4) {
      const Vec2d at((x + 0.5) / frame.width, (y + 0.5) / frame.height);
      const Vec2d in_source = frame.source_from_image * at.homogeneous();
      Vec4f color = Vec4f::Ones();
      if (image != nullptr) color = sampled(*image, material, in_source.cast<float>());
      for (int i = 0; i < 3; ++i) pixel[i] = srgb_from_linear(factor[i] * color[i]);
      pixel[3] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(color.w(), 0.0f, 1.0f)));
    }
  return result;
}

Vec3d rest_place(const Mesh& source, const SourcePlace& place) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < 3; ++i)
    sum +=
        place.barycentric[i] * source.positions[source.triangles[place.triangle][i]].cast<double>();
  return sum;
}

/// Lays blood on the texels within its reach, and where it has run.
/// @param flow  WoundMask::flow(), or nothing. @return whether there is any blood
bool paint(const WoundMask& mask, std::span<const float> flow, const Mesh& source, Image& image) {
  const WoundMaskOptions& options = mask.options();
  const auto reach = static_cast<float>(options.reach);
  bool is_any = false;
  for (std::uint32_t y = 0; y < options.height; ++y)
    for (std::uint32_t x = 0; x < options.width; ++x) {
      const std::size_t texel = std::size_t{y} * options.width + x;
      const float distance = mask.distances()[texel];
      const double run = flow.empty() ? 0.0 : static_cast<double>(flow[texel]);
      if (std::abs(distance) >= reach && !(run > 0)) continue;
      const auto place = mask.place_of(x, y);
      if (!place) continue;
      is_any = true;
      std::uint8_t* const pixel = &image.rgba[4 * texel];
      const auto& linear = linear_from_srgb();
      const Vec3f color = bloodied({linear[pixel[0]], linear[pixel[1]], linear[pixel[2]]},
                                   {static_cast<double>(distance), options.reach, run,
                                    rest_place(source, *place) / options.reach});
      for (int i = 0; i < 3; ++i) pixel[i] = srgb_from_linear(color[i]);
    }
  return is_any;
}

}  // namespace

double bind_scale(const Mesh& mesh, const DeformedMesh& posed) {
  double bound = 0, now = 0;
  const auto twice_area = [](const std::vector<Vec3f>& at, const Triangle& t) {
    return static_cast<double>((at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]).norm());
  };
  for (const Triangle& triangle : mesh.triangles) {
    bound += twice_area(mesh.positions, triangle);
    now += twice_area(posed.positions, triangle);
  }
  return now > 0 ? std::sqrt(bound / now) : 0;
}

namespace {

/// Lays blood on one mesh.
class MeshBlood {
 public:
  /// @param reach  in bind space.
  MeshBlood(const TornModel& model, std::uint32_t mesh, const ModelLooks& looks, double reach,
            const ModelPose* flow_pose, std::uint64_t& pixels_left, BloodLayers& layers)
      : model_(model),
        mesh_(mesh),
        source_(model.source().meshes[mesh]),
        looks_(looks),
        reach_(reach),
        flow_pose_(flow_pose),
        pixels_left_(pixels_left),
        layers_(layers) {}

  [[nodiscard]] Status lay() {
    for (std::uint32_t s = 0; s < source_.submeshes.size(); ++s) {
      const Result<const char*> obstacle = lay_on_texture(s);
      if (!obstacle) return obstacle.error();
      if (*obstacle == nullptr) continue;
      if (const Status status = lay_on_vertices(s, *obstacle); !status) return status;
    }
    if (!tints_.empty()) layers_.tints.push_back({mesh_, std::move(tints_)});
    return {};
  }

 private:
  /// @return null, or why there is no room in a texture.
  [[nodiscard]] Result<const char*> lay_on_texture(std::uint32_t submesh);
  [[nodiscard]] Status lay_on_vertices(std::uint32_t submesh, const char* obstacle);
  /// By which the colour of a vertex of the torn mesh is multiplied to show blood.
  [[nodiscard]] Vec3f tint_of(std::uint32_t vertex, const ModelLooks::OfFile& looks,
                              const BloodPlace& at) const;
  /// The place of a vertex of the torn mesh; kNone: no triangle of the submesh has it.
  [[nodiscard]] SourcePlace place_of(std::uint32_t vertex,
                                     std::span<const std::uint32_t> corner_of_vertex) const;

  const TornModel& model_;
  const std::uint32_t mesh_;
  const Mesh& source_;
  const ModelLooks& looks_;
  const double reach_;
  const ModelPose* flow_pose_;
  std::uint64_t& pixels_left_;
  BloodLayers& layers_;
  std::optional<WoundMask> distances_;  ///< Without a texture.
  std::vector<Vec3f> tints_;
};

Result<const char*> MeshBlood::lay_on_texture(std::uint32_t submesh) {
  const std::uint32_t index = source_.submeshes[submesh].material;
  const ModelLooks::OfFile of = looks_.of_file(index);
  if (of.lacks_image) return "its image cannot be read";
  if (of.colour.uv_set >= source_.uv_sets.size()) return "it has no texture coordinates";
  const auto frame = frame_of(source_, submesh, of.colour, of.material.image, reach_);
  if (!frame) return "its texture coordinates have no area, or need too large a texture";
  const std::uint64_t pixels = std::uint64_t{frame->width} * frame->height;
  if (pixels > pixels_left_) return "the textures of the model are too large";
  WoundMaskOptions wanted;
  wanted.width = frame->width;
  wanted.height = frame->height;
  wanted.uv_set = of.colour.uv_set;
  wanted.submesh = submesh;
  wanted.reach = reach_;
  wanted.texture_from_uv = frame->image_from_uv;
  Result<WoundMask> mask = WoundMask::create(model_, mesh_, wanted);
  if (!mask) return mask.error();
  if (!mask->has_own_texels()) return "charts of its texture coordinates overlap at the wound";
  BloodTexture texture{mesh_,
                       submesh,
                       index,
                       {},
                       of.colour.uv_set,
                       frame->image_from_uv.cast<float>(),
                       frame->is_placed_anew};
  const bool is_any = std::ranges::any_of(
      mask->distances(), [&](float distance) { return distance < static_cast<float>(reach_); });
  if (!is_any) return nullptr;
  texture.image = base_image(*frame, of.material);
  Result<std::vector<float>> flow = std::vector<float>();
  if (flow_pose_ != nullptr) flow = mask->flow(model_, *flow_pose_, flow_within(reach_));
  if (!flow) return flow.error();
  if (!paint(*mask, *flow, source_, texture.image)) return nullptr;
  pixels_left_ -= pixels;
  layers_.textures.push_back(std::move(texture));
  return nullptr;
}

SourcePlace MeshBlood::place_of(std::uint32_t vertex,
                                std::span<const std::uint32_t> corner_of_vertex) const {
  if (vertex >= source_.vertex_count()) {
    const Birth birth = model_.birth(mesh_, vertex);
    return {birth.triangle, birth.barycentric};
  }
  const std::uint32_t corner = corner_of_vertex[vertex];
  if (corner == kNone) return {kNone, {}};
  SourcePlace place{corner / 3, {}};
  place.barycentric[corner % 3] = 1;
  return place;
}

Vec3f MeshBlood::tint_of(std::uint32_t vertex, const ModelLooks::OfFile& looks,
                         const BloodPlace& at) const {
  const Mesh& torn = model_.character().meshes[mesh_];
  const Vec3f own =
      torn.color_sets.empty() ? Vec3f(Vec3f::Ones()) : Vec3f(torn.color_sets[0][vertex].head<3>());
  Vec3f base = own.cwiseProduct(looks.material.factor.head<3>());
  if (looks.material.image != nullptr && looks.colour.uv_set < torn.uv_sets.size()) {
    const Vec2f uv = torn.uv_sets[looks.colour.uv_set][vertex];
    const Vec2f in_image = looks.colour.image_from_uv * uv.homogeneous();
    const Vec4f texel = sampled(*looks.material.image, looks.material, in_image);
    base = base.cwiseProduct(texel.head<3>());
  }
  // Factors above 1 turn a green surface red, as far as colours of vertices go, up to 1.
  const Vec3f wanted = bloodied(base, at);
  Vec3f tint;
  for (int i = 0; i < 3; ++i) {
    constexpr float kDarkest = 1e-4f;
    const float most = 1.0f / std::max(own[i], kDarkest);
    tint[i] = std::min(wanted[i] / std::max(base[i], kDarkest), most);
  }
  return tint;
}

Status MeshBlood::lay_on_vertices(std::uint32_t submesh, const char* obstacle) {
  if (!distances_) {
    WoundMaskOptions wanted;
    wanted.uv_set = kNone;
    wanted.reach = reach_;
    Result<WoundMask> mask = WoundMask::create(model_, mesh_, wanted);
    if (!mask) return mask.error();
    distances_ = std::move(*mask);
  }
  std::vector<std::uint32_t> corner_of_vertex(source_.vertex_count(), kNone);
  for (std::uint32_t c = 0; c < 3 * source_.triangle_count(); ++c)
    if (source_.triangle_submesh[c / 3] == submesh)
      corner_of_vertex[source_.triangles[c / 3][c % 3]] = c;
  const ModelLooks::OfFile of = looks_.of_file(source_.submeshes[submesh].material);
  const std::uint32_t count = model_.character().meshes[mesh_].vertex_count();
  bool is_any = false;
  for (std::uint32_t v = 0; v < count; ++v) {
    const SourcePlace place = place_of(v, corner_of_vertex);
    if (place.triangle >= source_.triangle_count() ||
        source_.triangle_submesh[place.triangle] != submesh)
      continue;
    const double distance = distances_->distance_at(place);
    if (!(std::abs(distance) < reach_)) continue;
    if (tints_.empty()) tints_.assign(count, Vec3f::Ones());
    is_any = true;
    tints_[v] = tint_of(v, of, {distance, reach_, 0, rest_place(source_, place) / reach_});
  }
  if (is_any)
    layers_.notes.push_back(
        printed("mesh '%.100s', submesh %u: %s, so blood is in the colours of vertices",
                source_.name.c_str(), submesh, obstacle));
  return {};
}

}  // namespace

BloodFlowOptions flow_within(double reach) {
  BloodFlowOptions options;
  options.length = 6 * reach;
  options.width = 0.32 * reach;
  options.spacing = 0.9 * reach;
  return options;
}

double blood_reach(double diagonal) { return kReachOfSize * diagonal; }

Result<BloodLayers> lay_blood(const TornModel& model, std::span<const DeformedMesh> source,
                              const ModelLooks& looks, const BloodOptions& options) {
  BloodLayers layers;
  std::uint64_t pixels_left = options.most_pixels;
  const std::vector<Mesh>& torn = model.character().meshes;
  for (std::uint32_t m = 0; m < torn.size(); ++m) {
    const Mesh& of_source = model.source().meshes[m];
    // A tear along a seam changes tear sides alone.
    if (torn[m].triangles == of_source.triangles &&
        torn[m].custom_attributes == of_source.custom_attributes)
      continue;
    const double reach = options.reach * bind_scale(of_source, source[m]);
    if (!(reach > 0) || !std::isfinite(static_cast<float>(reach))) continue;
    const Status status =
        MeshBlood(model, m, looks, reach, options.flow_pose, pixels_left, layers).lay();
    if (!status) return status;
  }
  return layers;
}

}  // namespace sunder::tools
