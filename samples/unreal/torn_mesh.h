#pragma once

// How meshes of Unreal take what sunder_get_posed_mesh() says: an FDynamicMesh3, of which only what
// changed is touched, and the sections of a UProceduralMeshComponent. docs/unreal.md

#include <CoreMinimal.h>
#include <DynamicMesh/DynamicMesh3.h>
#include <DynamicMesh/DynamicMeshAttributeSet.h>
#include <ProceduralMeshComponent.h>
#include <sunder_c.h>

namespace Sunder {

using UE::Geometry::FIndex3i;

// glTF has metres, x to the left, y up, z to the front; Unreal centimetres, x to the front, y to
// the right, z up. One is left-handed, the other one right-handed: triangles keep their order.
inline FVector ToDirection(const float* Of) { return FVector(Of[2], -Of[0], Of[1]); }
inline FVector ToPlace(const float* Of) { return 100.0 * ToDirection(Of); }

/// The index buffer: what each slot holds, and what is drawn of it.
class FTriangleSlots {
 public:
  /// @return whether anything changed since the last call.
  bool Update(const sunder_posed_mesh& Posed) {
    TArray<FIndex3i> Before = Slots;
    Slots.SetNum(int32(Posed.triangle_capacity));
    for (uint32 Slot = 0; Slot < Posed.initial_triangle_count; ++Slot)
      Slots[int32(Slot)] = ToIndices(Posed.initial_triangles + 3 * Slot);
    for (uint32 Write = 0; Write < Posed.triangle_write_count; ++Write)
      Slots[int32(Posed.triangle_writes[Write].place)] =
          ToIndices(Posed.triangle_writes[Write].vertices);
    TArray<int32> DrawnBefore = Submeshes;
    Submeshes.SetNum(0);
    Submeshes.Init(-1, Slots.Num());
    for (uint32 Range = 0; Range < Posed.range_count; ++Range)
      for (uint32 Slot = 0; Slot < Posed.ranges[Range].triangle_count; ++Slot)
        Submeshes[int32(Posed.ranges[Range].first_triangle + Slot)] =
            int32(Posed.ranges[Range].submesh);
    return Submeshes != DrawnBefore || Slots != Before;
  }
  int32 Num() const { return Slots.Num(); }
  const FIndex3i& Triangle(int32 Slot) const { return Slots[Slot]; }
  /// -1: the slot is not drawn.
  int32 Submesh(int32 Slot) const { return Submeshes[Slot]; }

 private:
  static FIndex3i ToIndices(const uint32_t* Of) {
    return FIndex3i(int(Of[0]), int(Of[1]), int(Of[2]));
  }

  TArray<FIndex3i> Slots;
  TArray<int32> Submeshes;
};

/// Keeps an FDynamicMesh3 as the instance is drawn. One per mesh of the instance.
class FTornDynamicMesh {
 public:
  /// Call it after sunder_update(), with what sunder_get_posed_mesh() says since Epoch(). The mesh
  /// has attributes and material ids enabled, and no other owner.
  /// @return whether triangles changed: NotifyMeshUpdated(); if not, FastNotifyPositionsUpdated().
  bool Update(const sunder_posed_mesh& Posed, UE::Geometry::FDynamicMesh3& Mesh) {
    UE::Geometry::FDynamicMeshNormalOverlay* Normals = Mesh.Attributes()->PrimaryNormals();
    while (Mesh.MaxVertexID() < int32(Posed.vertex_count)) {
      Mesh.AppendVertex(FVector3d::Zero());
      Normals->AppendElement(FVector3f::UnitZ());  // one per vertex, with its number
    }
    for (uint32 Range = 0; Range < Posed.dirty_vertex_count; ++Range) {
      const sunder_range& Dirty = Posed.dirty_vertices[Range];
      for (uint32 V = Dirty.first; V < Dirty.first + Dirty.count; ++V) {
        Mesh.SetVertex(int32(V), ToPlace(Posed.positions + 3 * V));
        if (Posed.normals)
          Normals->SetElement(int32(V), FVector3f(ToDirection(Posed.normals + 3 * V)));
      }
    }
    LastEpoch = Posed.epoch;
    if (!Slots.Update(Posed)) return false;
    const int32 Before = Ids.Num();
    Ids.SetNum(Slots.Num());
    for (int32 Slot = Before; Slot < Slots.Num(); ++Slot) Ids[Slot] = -1;
    // Old triangles go before new ones come: an edge of more than two is refused.
    for (int32 Slot = 0; Slot < Slots.Num(); ++Slot) Remove(Slot, Mesh);
    for (int32 Slot = 0; Slot < Slots.Num(); ++Slot) Append(Slot, Mesh);
    return true;
  }
  /// To be passed as `seen` next time.
  uint64 Epoch() const { return LastEpoch; }

 private:
  bool IsDrawn(int32 Slot) const {
    return Slots.Submesh(Slot) >= 0 && Slots.Triangle(Slot).A != Slots.Triangle(Slot).B;
  }
  void Remove(int32 Slot, UE::Geometry::FDynamicMesh3& Mesh) {
    int32& Id = Ids[Slot];
    if (Id < 0 || (IsDrawn(Slot) && Mesh.GetTriangle(Id) == Slots.Triangle(Slot))) return;
    Mesh.RemoveTriangle(Id, /*bRemoveIsolatedVertices=*/false);
    Id = -1;
  }
  void Append(int32 Slot, UE::Geometry::FDynamicMesh3& Mesh) {
    int32& Id = Ids[Slot];
    if (Id < 0 && IsDrawn(Slot)) {
      Id = Mesh.AppendTriangle(Slots.Triangle(Slot));
      // Negative: an edge of the source has three triangles; this one is missing.
      if (Id >= 0) Mesh.Attributes()->PrimaryNormals()->SetTriangle(Id, Slots.Triangle(Slot));
    }
    if (Id >= 0) Mesh.Attributes()->GetMaterialID()->SetValue(Id, Slots.Submesh(Slot));
  }

  FTriangleSlots Slots;
  TArray<int32> Ids;  ///< Per slot: the triangle in the mesh, or negative.
  uint64 LastEpoch = 0;
};

/// Keeps the sections of a UProceduralMeshComponent, one per submesh. Takes all vertices of a
/// section each time anything in the mesh moved; any triangles.
class FTornSections {
 public:
  void Update(const sunder_posed_mesh& Posed, int32 SubmeshCount, UProceduralMeshComponent& To) {
    LastEpoch = Posed.epoch;
    const bool bTrianglesChanged = Slots.Update(Posed);
    if (!bTrianglesChanged && Posed.dirty_vertex_count == 0) return;
    for (int32 Submesh = 0; Submesh < SubmeshCount; ++Submesh)
      UpdateSection(Posed, Submesh, bTrianglesChanged, To);
  }
  uint64 Epoch() const { return LastEpoch; }

 private:
  struct FSection {
    TArray<int32> Vertices;  ///< Of the mesh.
    TArray<int32> Triangles;
  };

  void UpdateSection(const sunder_posed_mesh& Posed, int32 Submesh, bool bTrianglesChanged,
                     UProceduralMeshComponent& To) {
    if (Sections.Num() <= Submesh) Sections.SetNum(Submesh + 1);
    FSection& Section = Sections[Submesh];
    if (bTrianglesChanged) Collect(Posed, Submesh, Section);
    TArray<FVector> Places, Normals;
    for (const int32 Vertex : Section.Vertices) {
      Places.Add(ToPlace(Posed.positions + 3 * Vertex));
      if (Posed.normals) Normals.Add(ToDirection(Posed.normals + 3 * Vertex));
    }
    if (bTrianglesChanged)
      To.CreateMeshSection(Submesh, Places, Section.Triangles, Normals, {}, {}, {}, false);
    else
      To.UpdateMeshSection(Submesh, Places, Normals, {}, {}, {});
  }
  void Collect(const sunder_posed_mesh& Posed, int32 Submesh, FSection& Section) {
    Section = FSection();
    TArray<int32> Local;
    Local.Init(-1, int32(Posed.vertex_count));
    for (int32 Slot = 0; Slot < Slots.Num(); ++Slot) {
      const FIndex3i& Triangle = Slots.Triangle(Slot);
      if (Slots.Submesh(Slot) != Submesh || Triangle.A == Triangle.B) continue;
      for (const int32 Vertex : {Triangle.A, Triangle.B, Triangle.C}) {
        if (Local[Vertex] < 0) Local[Vertex] = Section.Vertices.Add(Vertex);
        Section.Triangles.Add(Local[Vertex]);
      }
    }
  }

  FTriangleSlots Slots;
  TArray<FSection> Sections;
  uint64 LastEpoch = 0;
};

}  // namespace Sunder
