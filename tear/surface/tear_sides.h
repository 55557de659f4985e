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
    return character_.meshes[mesh].custom_attributes[attribute_[mesh]].values[vertex];
  }
  /// Gives a mesh the attribute, all zero.
  void add_to(Index mesh);
  /// Removes the attribute; its memory is kept for the next time. All values must be zero.
  void remove_from(Index mesh);
  /// Reserves room for the attribute with `vertices` more vertices per mesh.
  void reserve(std::size_t vertices);

 private:
  void add_for_operation(Index mesh);

  Character& character_;
  EditColumns& columns_;
  /// Per mesh: index in its custom attributes; kNone if there is none.
  std::vector<Index> attribute_;
  /// Per mesh: memory of an attribute that was removed, all zero.
  std::vector<std::vector<float>> spare_;
  Index next_ = 1;
};

}  // namespace sunder::tear
