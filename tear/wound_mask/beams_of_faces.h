#pragma once

#include <vector>

#include "tear/wound_mask/spread.h"

namespace sunder::tear {

/// All beams that faces see, by the face that sees and by the triangle whose lips are seen.
class BeamsOfFaces {
 public:
  explicit BeamsOfFaces(Index face_count)
      : first_in_face_(face_count, kNone), first_of_origin_(face_count, kNone) {}

  void add(Index origin, const SpreadBeam& beam) {
    Index i = first_free_;
    if (i != kNone) {
      first_free_ = entries_[i].next_of_origin;
    } else {
      i = static_cast<Index>(entries_.size());
      entries_.emplace_back();
    }
    entries_[i] = {beam, first_in_face_[beam.face], first_of_origin_[origin]};
    first_in_face_[beam.face] = first_of_origin_[origin] = i;
  }

  /// Removes the beams of a triangle's lips. @param seen  the faces that saw them are appended.
  void remove_from(Index origin, std::vector<Index>& seen) {
    for (Index i = first_of_origin_[origin]; i != kNone;) {
      Entry& entry = entries_[i];
      Index* link = &first_in_face_[entry.beam.face];
      while (*link != i) link = &entries_[*link].next_in_face;
      *link = entry.next_in_face;
      seen.push_back(entry.beam.face);
      const Index next = entry.next_of_origin;
      entry.next_of_origin = first_free_;
      first_free_ = i;
      i = next;
    }
    first_of_origin_[origin] = kNone;
  }

  template <class Visit>
  void for_each_in(Index face, Visit visit) const {
    for (Index i = first_in_face_[face]; i != kNone; i = entries_[i].next_in_face)
      visit(entries_[i].beam.beam);
  }

 private:
  struct Entry {
    SpreadBeam beam;
    Index next_in_face = 0, next_of_origin = 0;
  };

  std::vector<Entry> entries_;
  std::vector<Index> first_in_face_, first_of_origin_;  ///< Per face; kNone.
  Index first_free_ = kNone;
};

}  // namespace sunder::tear
