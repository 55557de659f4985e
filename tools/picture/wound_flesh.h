#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <set>
#include <span>
#include <vector>

#include "tools/picture/open_lips.h"
#include "tools/picture/rims.h"
#include "tools/picture/smooth_along.h"
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

  /// Adds the troughs, and the lips with the blood around them, to a scene of the torn model.
  /// @param closed, open  in the pose of the scene.
  /// @param flesh         the material.
  void add(const std::vector<DeformedMesh>& closed, const std::vector<DeformedMesh>& open,
           std::uint32_t flesh, RenderScene& scene) const;

  struct Vertex {
    std::uint32_t mesh = 0, vertex = 0;

    bool operator==(const Vertex&) const = default;
  };
  /// Where the wound is cut across: two places that were one, equal at a tip.
  struct Section {
    Vertex left, right;
    float along = 0;      ///< From an end of the wound, metres.
    float thickness = 0;  ///< Of the body, metres.

    [[nodiscard]] bool is_tip() const { return left == right; }
  };
  /// An edge of the left lip.
  struct Span {
    std::uint32_t a = 0, b = 0;  ///< Sections at the ends of the edge.
    RimEdge edge;
  };
  [[nodiscard]] std::span<const Section> sections() const { return sections_; }
  [[nodiscard]] std::span<const Span> spans() const { return spans_; }

  /// A face of the ground, counter-clockwise from outside. A corner is a section and the place in
  /// its row; sections beyond the last are joints.
  struct Face {
    std::uint32_t span = 0;  ///< The span that it belongs to.
    std::array<std::array<std::uint32_t, 2>, 3> corners;
  };
  /// The ground of the troughs, and of the joints between wounds that cross or end on each other.
  struct Ground {
    std::size_t across = 0;  ///< Faces from lip to lip.
    std::size_t sections = 0;
    /// Per section `across` + 1 places, from the left lip to the right one; then one per joint.
    std::vector<Vec3f> closed, open;
    std::vector<Vec3f> normals;  ///< As many; of the open ground, out of the body, unit length.
    std::vector<Face> faces;     ///< Some have no area at tips.
    float widest = 0;            ///< Gap of a section.

    [[nodiscard]] std::size_t at(const std::array<std::uint32_t, 2>& corner) const {
      return corner[0] < sections ? corner[0] * (across + 1) + corner[1]
                                  : sections * across + corner[0];
    }
  };
  [[nodiscard]] Ground ground(const std::vector<DeformedMesh>& closed,
                              const std::vector<DeformedMesh>& open, std::size_t across) const;

  /// Whether an edge is a lip of one of the troughs.
  [[nodiscard]] bool has_lip(const RimEdge& edge) const;
  [[nodiscard]] bool is_empty() const { return spans_.empty(); }
  /// Length of the wounds in the pose in which they were measured, metres.
  [[nodiscard]] double length() const { return static_cast<double>(length_); }

  /// The places of the lips, left and right in turn.
  [[nodiscard]] std::vector<Vec3d> places(const std::vector<DeformedMesh>& posed) const;

 private:
  /// The ground of the wound at a section.
  struct Bed {
    Vec3f left, right, outwards;
    float depth = 0;
  };
  [[nodiscard]] std::vector<Bed> make_beds(const std::vector<DeformedMesh>& closed,
                                           const std::vector<DeformedMesh>& open,
                                           float& widest) const;
  void add_joints(Ground& ground) const;
  void find_joints(const TornModel& torn);
  void measure(const TornModel& torn, const std::vector<DeformedMesh>& closed);
  [[nodiscard]] std::vector<SmoothAlong::Edge> edges_along(
      const std::vector<DeformedMesh>& closed) const;
  void smooth_normals(const std::vector<DeformedMesh>& closed, const std::vector<Bed>& beds,
                      Ground& ground) const;
  void place_along(const std::vector<DeformedMesh>& closed);

  std::set<std::array<std::uint32_t, 2>> lip_vertices_;  ///< Mesh and vertex.
  std::vector<Section> sections_;
  std::vector<Span> spans_;
  /// Ends of spans, 0 or 1, where wounds meet, per place.
  std::vector<std::vector<std::array<std::uint32_t, 2>>> joints_;
  float length_ = 0;  ///< Of all spans, metres.
  bool is_sewn_ = false;
};

}  // namespace sunder::tools
