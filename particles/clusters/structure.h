#pragma once

#include <algorithm>
#include <memory>

#include "particles/clusters/change.h"
#include "particles/clusters/change_journal.h"
#include "particles/clusters/decomposition_pose.h"
#include "particles/clusters/point_factors.h"
#include "particles/clusters/repair_scratch.h"
#include "particles/clusters/source_border.h"
#include "particles/clusters/surface_pose.h"
#include "particles/clusters/vertex_points.h"

namespace sunder::particles {

struct Band;
class Gradients;

/// Data of the character from which the structure was created.
struct CharacterLink {
  const Character* source = nullptr;  ///< Only for comparison.
  std::vector<Skin> skins;
  std::size_t bone_count = 0, morph_weight_count = 0;
  float edge_length = 0;  ///< Mean length of the edges of the decomposition's surface, metres.
  DecompositionPose decomposition_pose;
  std::vector<Index> first_slots;  ///< SurfacePose::first_slots() of the skins.
  SourceBorder border;
};

/// The members of all particles.
struct MemberLists {
  struct OfDecomposition {
    std::vector<Index> first, points;  ///< Particle by particle.
  };
  /// Copies of a structure share it.
  std::shared_ptr<OfDecomposition> decomposed = std::make_shared<OfDecomposition>();
  /// Per particle: members that joined later. Members of both lists may have left since.
  std::vector<std::vector<Index>> joined;

  /// Appends to `joined`. A list that is full loses what it has twice, so that operations that are
  /// undone again and again do not let it grow.
  void join(Index particle, Index point) {
    std::vector<Index>& list = joined[particle];
    if (list.size() == list.capacity()) {
      drop_repeated(list);
      // Room for as many again, so that not every call sorts.
      if (2 * list.size() > list.capacity()) list.reserve(2 * list.capacity());
    }
    list.push_back(point);
  }
  static void drop_repeated(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
};

/// The followed operations. Each is a tear, whose number is the index of its change in `done`.
struct TearLog {
  std::vector<Change> done, undone;
  std::unique_ptr<Band> band;  ///< Remaining work of the last tears, for settle().
  /// The work that is left while operations could be redone. It waits for the next operation,
  /// because the redone values are those of the work as it was.
  std::shared_ptr<const PendingWork> waiting;
  std::vector<SutureThread> threads;  ///< Of the model when it was last followed.
  Index triangle_count = 0;           ///< Of the surface when it was last followed.
  bool is_broken = false;             ///< Memory ran out in the middle of an update.
};

/// The data of a ParticleSet.
struct Structure {
  Structure();
  ~Structure();

  DecompositionReport report;
  std::uint64_t revision = 0;
  std::uint64_t next_serial = 1;
  std::vector<Index> dirty;  ///< Points whose influences the last call changed, in no order.
  ChangeJournal journal;     ///< The same of all calls, for readers that are some calls behind.

  CharacterLink character;
  VertexPoints vertex_points;
  PointTable points;
  AuthoredPoints authored;
  std::vector<Particle> particles;
  MemberLists members;
  std::vector<LipEdge> lips;
  TearLog tears;

  // ---- Scratch memory.
  RepairScratch scratch;
  std::unique_ptr<Gradients> gradients;

  /// A copy of a structure that no tear has changed, with scratch memory of its own.
  /// @throws std::bad_alloc
  [[nodiscard]] std::unique_ptr<Structure> copy() const;
  /// A copy of any structure in which no stroke is in progress, to follow the next operation. Its
  /// log has an empty entry for each operation that is done, and no work that is left.
  /// @throws std::bad_alloc
  [[nodiscard]] std::unique_ptr<Structure> fork() const;
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Ends the decomposition.
  void finish(Index triangles);
  /// The same, with scratch memory for the first tears, so that none of them has to allocate for
  /// all points.
  void prepare_for_tears(Index triangles);
  void make_room(std::size_t point_count);
  /// Calls visit(point) for all members of a particle, and for points that were members once.
  /// Points may be repeated.
  template <class Visit>
  void for_each_candidate(Index particle, Visit visit) const {
    for_each_decomposed(particle, visit);
    for_each_joined(particle, visit);
  }
  /// Those that the decomposition gave it.
  template <class Visit>
  void for_each_decomposed(Index particle, Visit visit) const {
    const auto& [first, of_all] = *members.decomposed;
    if (particle + 1 < first.size())
      for (Index m = first[particle]; m < first[particle + 1]; ++m)
        if (of_all[m] < points.count()) visit(of_all[m]);
  }
  /// Those that joined it later.
  template <class Visit>
  void for_each_joined(Index particle, Visit visit) const {
    for (const Index point : members.joined[particle])
      if (point < points.count()) visit(point);
  }
  /// Follows threads that were tied or undone. @return whether there were any.
  bool follow_threads(const TornModel& model);
  /// Adds the dirty points to the journal, at the end of a call.
  void note_dirty_points();
};

/// Lets the last operation, if there is one, go on to log each point and particle once, after
/// scratch memory was made anew. @throws std::bad_alloc
void resume_log(Structure& structure);

}  // namespace sunder::particles
