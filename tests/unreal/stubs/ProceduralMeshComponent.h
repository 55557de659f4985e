#pragma once

#include <map>
#include <stdexcept>

#include "CoreMinimal.h"

struct FProcMeshTangent {};

class UProceduralMeshComponent {
 public:
  struct Section {
    TArray<FVector> Vertices;
    TArray<int32> Triangles;
  };
  void CreateMeshSection(int32 index, const TArray<FVector>& vertices,
                         const TArray<int32>& triangles, const TArray<FVector>& /*normals*/,
                         const TArray<FVector2D>& /*uvs*/, const TArray<FColor>& /*colors*/,
                         const TArray<FProcMeshTangent>& /*tangents*/, bool /*bCreateCollision*/) {
    Sections[index] = {vertices, triangles};
  }
  void UpdateMeshSection(int32 index, const TArray<FVector>& vertices,
                         const TArray<FVector>& /*normals*/, const TArray<FVector2D>& /*uvs*/,
                         const TArray<FColor>& /*colors*/,
                         const TArray<FProcMeshTangent>& /*tangents*/) {
    if (vertices.Num() != Sections.at(index).Vertices.Num())
      throw std::logic_error("a section is updated with another number of vertices");
    Sections.at(index).Vertices = vertices;
  }
  std::map<int32, Section> Sections;
};
