#pragma once

#include <array>
#include <map>
#include <set>

#include "CoreMinimal.h"
#include "DynamicMesh/DynamicMeshAttributeSet.h"

namespace UE::Geometry {

/// Vertices, and triangles with ids that are used again. Edges have at most two triangles.
class FDynamicMesh3 {
 public:
  int32 MaxVertexID() const { return int32(Vertices.size()); }
  int AppendVertex(const FVector3d& place) {
    Vertices.push_back(place);
    return MaxVertexID() - 1;
  }
  void SetVertex(int id, const FVector3d& place) {
    Vertices.at(std::size_t(id)) = place;
    ++VerticesSet;
  }
  int AppendTriangle(const FIndex3i& of, int /*group*/ = 0) {
    constexpr int NonManifold = -2;
    for (const auto& edge : EdgesOf(of))
      if (Edges[edge] >= 2) return NonManifold;
    for (const auto& edge : EdgesOf(of)) ++Edges[edge];
    int id = Next;
    if (Free.empty())
      ++Next;
    else
      id = *Free.begin(), Free.erase(Free.begin());
    Triangles[id] = of;
    ++TrianglesTouched;
    return id;
  }
  void RemoveTriangle(int id, bool /*bRemoveIsolatedVertices*/ = true) {
    for (const auto& edge : EdgesOf(Triangles.at(id))) --Edges[edge];
    Triangles.erase(id);
    Free.insert(id);
    ++TrianglesTouched;
  }
  FIndex3i GetTriangle(int id) const { return Triangles.at(id); }
  FDynamicMeshAttributeSet* Attributes() { return &Set; }

  std::vector<FVector3d> Vertices;
  std::map<int, FIndex3i> Triangles;
  std::size_t VerticesSet = 0, TrianglesTouched = 0;

 private:
  static std::array<std::array<int, 2>, 3> EdgesOf(const FIndex3i& t) {
    const auto edge = [](int a, int b) { return a < b ? std::array{a, b} : std::array{b, a}; };
    return {edge(t.A, t.B), edge(t.B, t.C), edge(t.C, t.A)};
  }
  std::map<std::array<int, 2>, int> Edges;
  std::set<int> Free;
  int Next = 0;
  FDynamicMeshAttributeSet Set;
};

}  // namespace UE::Geometry
