#include "bench/peers/vtk_clip_peer.h"

#include <vtkCellArray.h>
#include <vtkClipClosedSurface.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

namespace sunder::bench {
namespace {

/// The part of a body towards which a normal points.
test::Solid clip(vtkPolyData* body, const Vec3d& point, const Vec3d& normal) {
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(point.x(), point.y(), point.z());
  plane->SetNormal(normal.x(), normal.y(), normal.z());
  vtkNew<vtkPlaneCollection> planes;
  planes->AddItem(plane);
  vtkNew<vtkClipClosedSurface> clipper;
  clipper->SetInputData(body);
  clipper->SetClippingPlanes(planes);
  clipper->Update();
  vtkPolyData* const clipped = clipper->GetOutput();
  test::Solid solid;
  for (vtkIdType i = 0; i < clipped->GetNumberOfPoints(); ++i) {
    const double* const at = clipped->GetPoint(i);
    solid.positions.emplace_back(at[0], at[1], at[2]);
  }
  vtkNew<vtkIdList> face;
  vtkCellArray* const faces = clipped->GetPolys();
  for (faces->InitTraversal(); faces->GetNextCell(face) != 0;)
    for (vtkIdType k = 2; k < face->GetNumberOfIds(); ++k)
      solid.triangles.push_back({static_cast<std::uint32_t>(face->GetId(0)),
                                 static_cast<std::uint32_t>(face->GetId(k - 1)),
                                 static_cast<std::uint32_t>(face->GetId(k))});
  return solid;
}

}  // namespace

CutSidesOfAll cut_by_vtk(const std::vector<test::HardCut>& cuts) {
  CutSidesOfAll all;
  for (const test::HardCut& cut : cuts) {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const Vec3d& position : cut.body.positions) points->InsertNextPoint(position.data());
    vtkNew<vtkCellArray> faces;
    for (const Triangle& t : cut.body.triangles)
      faces->InsertNextCell({vtkIdType{t[0]}, vtkIdType{t[1]}, vtkIdType{t[2]}});
    vtkNew<vtkPolyData> body;
    body->SetPoints(points);
    body->SetPolys(faces);
    all.emplace_back(
        CutSides{clip(body, cut.point, -cut.normal), clip(body, cut.point, cut.normal)});
  }
  return all;
}

}  // namespace sunder::bench
