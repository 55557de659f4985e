#include "bench/peers/vtk_peer.h"

#include <cstdlib>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataPlaneClipper.h>

#include "bench/harness/cpu_seconds.h"

namespace sunder::bench {

struct VtkPeer::State {
  vtkNew<vtkPolyData> surface;
  vtkNew<vtkPlane> plane;
};

VtkPeer::VtkPeer(const Scene& scene) : state_(std::make_unique<State>()) {
  setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1);  // its header is not C++20
  const Mesh& mesh = scene.mesh();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  for (const Vec3d& position : posed_positions(scene, scene.poses[0]))
    points->InsertNextPoint(position.data());
  vtkNew<vtkCellArray> faces;
  for (const Triangle& t : mesh.triangles)
    faces->InsertNextCell({vtkIdType{t[0]}, vtkIdType{t[1]}, vtkIdType{t[2]}});
  vtkNew<vtkFloatArray> normals, uvs;
  normals->SetNumberOfComponents(3);
  for (const Vec3f& normal : mesh.normals) normals->InsertNextTuple(normal.data());
  uvs->SetNumberOfComponents(2);
  for (const Vec2f& uv : mesh.uv_sets[0]) uvs->InsertNextTuple(uv.data());
  state_->surface->SetPoints(points);
  state_->surface->SetPolys(faces);
  state_->surface->GetPointData()->SetNormals(normals);
  state_->surface->GetPointData()->SetTCoords(uvs);
  const Vec3d normal = scene.middle_plane.normal.normalized();
  state_->plane->SetOrigin(scene.middle_plane.point.data());
  state_->plane->SetNormal(normal.data());
}

VtkPeer::~VtkPeer() = default;

double VtkPeer::clip() {
  vtkNew<vtkPolyDataPlaneClipper> clipper;
  clipper->SetInputData(state_->surface);
  clipper->SetPlane(state_->plane);
  clipper->SetClippingLoops(false);
  clipper->SetCapping(false);
  const double seconds = cpu_seconds_of([&] { clipper->Update(); });
  if (clipper->GetOutput()->GetNumberOfPoints() == 0) std::abort();
  return seconds;
}

}  // namespace sunder::bench
