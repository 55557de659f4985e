#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <set>
#include <span>
#include <vector>

#include "tools/picture/open_lips.h"
#include "tools/picture/rims.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

/// The flesh in wounds: a trough from lip to lip, as deep as the wound gapes there, but less deep
/// than the body is thick, so that it is shut at the tips and nothing shows through.
class WoundFlesh {
 public:
  /// Measures how thick the body is below the lips.
  /// @param closed  with coincident lips, and normals.
  WoundFlesh(const TornModel& torn, std::span<const Wound> wounds,
             const std::vector<DeformedMesh>& closed);

  /// Adds the troughs, and the lips with the redness around them, to a scene of the torn model.
  /// @param closed, open  in the pose of the scene.
  /// @param flesh         the material.
  void add(const std::vector<DeformedMesh>& closed, const std::vector<DeformedMesh>& open,
           std::uint32_t flesh, RenderScene& scene) const;
  /// Whether an edge is a lip of one of the troughs.
  [[nodiscard]] bool has_lip(const RimEdge& edge) const;
  [[nodiscard]] bool is_empty() const { return spans_.empty(); }
  /// Length of the wounds in the pose in which they were measured, metres.
  [[nodiscard]] double length() const { return static_cast<double>(length_); }

  /// The places of the lips, left and right in turn.
  [[nodiscard]] std::vector<Vec3d> places(const std::vector<DeformedMesh>& posed) const;

 private:
  struct Vertex {
    std::uint32_t mesh = 0, vertex = 0;
  };
  /// Where the wound is cut across: two places that were one, equal at a tip.
  struct Section {
    Vertex left, right;
    float along = 0;      ///< From the first section, metres.
    float thickness = 0;  ///< Of the body, metres.
  };
  /// The ground of the wound at a section.
  struct Bed {
    Vec3f left, right, outwards;
    float depth = 0;
  };
  [[nodiscard]] std::vector<Bed> make_beds(const std::vector<DeformedMesh>& closed,
                                           const std::vector<DeformedMesh>& open,
                                           float& widest) const;
  void find_sections(const TornModel& torn, std::span<const Wound> wounds);
  void measure(const TornModel& torn, const std::vector<DeformedMesh>& closed);

  std::set<std::array<std::uint32_t, 2>> lip_vertices_;  ///< Mesh and vertex.
  std::vector<Section> sections_;
  std::vector<std::array<std::uint32_t, 2>> spans_;  ///< Sections that follow each other.
  float length_ = 0;                                 ///< Of all spans, metres.
};

}  // namespace sunder::tools
