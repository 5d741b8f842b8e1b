// What we write must open in VTK's own readers, and hold there what we meant.
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkLSDynaReader.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <map>
#include <set>

#include "result/d3plot.h"
#include "result/sample_test.h"
#include "result/vtu.h"

using namespace fabrica;

namespace {

// All grids of a nested set of blocks, with their names.
void collect(vtkMultiBlockDataSet* blocks, std::map<std::string, vtkUnstructuredGrid*>& out) {
  for (unsigned i = 0; i < blocks->GetNumberOfBlocks(); ++i) {
    vtkDataObject* block = blocks->GetBlock(i);
    if (auto* nested = vtkMultiBlockDataSet::SafeDownCast(block)) collect(nested, out);
    auto* grid = vtkUnstructuredGrid::SafeDownCast(block);
    if (!grid) continue;
    const char* name =
        blocks->HasMetaData(i) ? blocks->GetMetaData(i)->Get(vtkCompositeDataSet::NAME()) : nullptr;
    out[name ? name : std::to_string(i)] = grid;
  }
}

}  // namespace

TEST_CASE("d3plot: VTK's reader sees our points, cells, parts, times, coordinates and stresses") {
  const sample::Scratch scratch;
  const std::string path = scratch.file("d3plot");
  const ResultMesh mesh = sample::mesh();
  D3plotOptions options;
  options.rigid_walls = 1;
  D3plotWriter writer(path, mesh, options);
  for (int i = 0; i < 3; ++i) writer.write(sample::state(mesh, 0.5 * i));

  vtkNew<vtkLSDynaReader> reader;
  CHECK(reader->CanReadFile(path.c_str()) == 1);
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  CHECK(reader->GetNumberOfNodes() == mesh.nodes());
  CHECK(reader->GetNumberOfSolidCells() == mesh.solids());
  CHECK(reader->GetNumberOfShellCells() == mesh.shells());
  CHECK(reader->GetNumberOfBeamCells() == mesh.beams());
  CHECK(reader->GetNumberOfPartArrays() == mesh.parts());
  REQUIRE(reader->GetNumberOfTimeSteps() == 3);
  CHECK(reader->GetTimeValue(2) == 1.0);

  // everything on, the state at t = 1
  for (int i = 0; i < reader->GetNumberOfPointArrays(); ++i)
    reader->SetPointArrayStatus(reader->GetPointArrayName(i), 1);
  constexpr int cell_types = 7;  // particle, beam, shell, thick shell, solid, rigid body, road
  for (int type = 0; type < cell_types; ++type)
    for (int i = 0; i < reader->GetNumberOfCellArrays(type); ++i)
      reader->SetCellArrayStatus(type, reader->GetCellArrayName(type, i), 1);
  reader->SetDeformedMesh(1);
  reader->GetOutputInformation(0)->Set(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP(), 1.0);
  reader->Update();
  std::map<std::string, vtkUnstructuredGrid*> grids;
  collect(reader->GetOutput(), grids);
  std::string names;
  vtkIdType cells = 0;
  for (const auto& [name, grid] : grids) {
    names += name + "; ";
    cells += grid->GetNumberOfCells();
  }
  CAPTURE(names);
  CHECK(cells == mesh.solids() + mesh.shells() + mesh.beams());

  // the part of the tetrahedron: its corners moved by t, its stress and velocity are those given
  vtkUnstructuredGrid* tet = nullptr;
  for (const auto& [name, grid] : grids)
    if (name.find("tetrahedron") != std::string::npos) tet = grid;
  REQUIRE(tet != nullptr);
  REQUIRE(tet->GetNumberOfCells() == 1);
  const AnimationState s = sample::state(mesh, 1.0);
  double x[3];
  tet->GetPoint(tet->GetCell(0)->GetPointId(0), x);
  for (int k = 0; k < 3; ++k) CHECK(x[k] == s.position[3 * mesh.solid[1][0] + k]);
  vtkDataArray* stress = tet->GetCellData()->GetArray("Stress");
  REQUIRE(stress != nullptr);
  for (int k = 0; k < 6; ++k) CHECK(stress->GetComponent(0, k) == s.solid_stress[6 + k]);
  vtkDataArray* strain = tet->GetCellData()->GetArray("EffPlastStrn");
  REQUIRE(strain != nullptr);
  CHECK(strain->GetComponent(0, 0) == s.solid_plastic_strain[1]);
  vtkDataArray* velocity = tet->GetPointData()->GetArray("Velocity");
  REQUIRE(velocity != nullptr);
  CHECK(velocity->GetComponent(tet->GetCell(0)->GetPointId(0), 1) ==
        s.velocity[3 * mesh.solid[1][0] + 1]);
}

TEST_CASE("vtu: VTK's reader sees our mesh and fields, compressed or not") {
  for (const bool compress : {false, true}) {
    const sample::Scratch scratch;
    const ResultMesh mesh = sample::mesh();
    AnimationState s = sample::state(mesh, 0.25);
    s.shell_alive = {1, 0};
    VtuWriter writer(scratch.file("run.pvd"), mesh, {compress});
    writer.write(sample::state(mesh, 0));
    writer.write(s);

    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(scratch.file("run_0001.vtu").c_str());
    reader->Update();
    vtkUnstructuredGrid* grid = reader->GetOutput();
    REQUIRE(grid->GetNumberOfPoints() == mesh.nodes());
    REQUIRE(grid->GetNumberOfCells() == 7);
    CHECK(grid->GetPoint(1)[0] == 1.25);
    CHECK(grid->GetCellType(1) == VTK_TETRA);
    CHECK(grid->GetCellType(2) == VTK_WEDGE);
    CHECK(grid->GetCell(3)->GetPointId(2) == 10);
    auto cell = [&](const char* name, int e, int k = 0) {
      vtkDataArray* a = grid->GetCellData()->GetArray(name);
      REQUIRE(a != nullptr);
      return a->GetComponent(e, k);
    };
    CHECK(cell("part_id", 1) == 50);
    CHECK(cell("element_id", 4) == 4);
    CHECK(cell("stress", 1, 5) == s.solid_stress[11]);
    CHECK(cell("von_mises", 0) == von_mises(s.solid_stress.data()));
    CHECK(cell("plastic_strain", 3) == s.shell_plastic_strain[2]);
    CHECK(cell("vtkGhostType", 4) == 32);
    CHECK(cell("vtkGhostType", 3) == 0);
    CHECK(grid->GetPointData()->GetArray("velocity")->GetComponent(2, 1) == s.velocity[7]);
    CHECK(grid->GetPointData()->GetArray("displacement")->GetComponent(5, 2) == 0.25);
    CHECK(grid->GetPointData()->GetArray("node_id")->GetComponent(1, 0) == 993);
    CHECK(grid->GetFieldData()->GetArray("TimeValue")->GetComponent(0, 0) == 0.25);
  }
}
