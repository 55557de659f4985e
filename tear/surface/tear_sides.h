#pragma once

#include "tear/surface/edit_columns.h"

namespace sunder::tear {

/// The vertex attribute _TEARSIDE: a number per point that keeps coincident points apart when a
/// file is loaded. Each new point gets a number of its own, so that no two points at one place are
/// merged, however tears cross and positions round.
class TearSides {
 public:
  TearSides(Character& character, EditColumns& columns);

  /// The first number that no point has.
  [[nodiscard]] Index next() const { return next_; }
  Index take_next() { return next_++; }
  void set_next(Index next) { next_ = next; }

  /// Writes a value and logs the previous one. Adds the attribute to the mesh if necessary.
  void write(Index mesh, Index vertex, Index side);
  /// The same for a vertex that a roll back removes together with the value; nothing is logged.
  void write_to_new(Index mesh, Index vertex, Index side);

  /// The value of a vertex, in a mesh that has the attribute.
  [[nodiscard]] float& at(Index mesh, Index vertex) {
    const Index attribute = columns_.meshes[mesh].tear_side;
    return character_.meshes[mesh].custom_attributes[attribute].values[vertex];
  }
  /// Gives a mesh the attribute, all zero. Where memory runs out, nothing changes.
  void add_to(Index mesh);
  /// Removes the attribute; its memory is kept for the next time. All values must be zero.
  void remove_from(Index mesh);
  /// Reserves memory, so that add_to() fails only for want of memory for the values, which Room
  /// makes room for.
  void reserve();

 private:
  void add_for_operation(Index mesh);

  Character& character_;
  EditColumns& columns_;
  Index next_ = 1;
};

}  // namespace sunder::tear
