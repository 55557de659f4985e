#pragma once

#include <map>
#include <vector>

#include "CoreMinimal.h"

namespace UE::Geometry {

class FDynamicMeshNormalOverlay {
 public:
  int AppendElement(const FVector3f& value) {
    Elements.push_back(value);
    return int(Elements.size()) - 1;
  }
  void SetElement(int id, const FVector3f& value) { Elements.at(std::size_t(id)) = value; }
  void SetTriangle(int triangle, const FIndex3i& elements) { Triangles[triangle] = elements; }

  std::vector<FVector3f> Elements;
  std::map<int, FIndex3i> Triangles;
};

class FDynamicMeshMaterialAttribute {
 public:
  void SetValue(int triangle, int material) { Values[triangle] = material; }
  std::map<int, int> Values;
};

class FDynamicMeshAttributeSet {
 public:
  FDynamicMeshNormalOverlay* PrimaryNormals() { return &Normals; }
  FDynamicMeshMaterialAttribute* GetMaterialID() { return &Materials; }

 private:
  FDynamicMeshNormalOverlay Normals;
  FDynamicMeshMaterialAttribute Materials;
};

}  // namespace UE::Geometry
