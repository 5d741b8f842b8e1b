#include "result/picture/snapshot.h"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkExtractCells.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTypeInt64Array.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "result/d3plot.h"
#include "result/vtu.h"

namespace fabrica {
namespace {

namespace fs = std::filesystem;

// The file that holds the states: the input itself, or what a result directory has.
std::string find_file(const std::string& input) {
  if (!fs::exists(input)) throw std::runtime_error("there is no " + input);
  if (!fs::is_directory(input)) return input;
  if (fs::exists(fs::path(input) / "d3plot")) return (fs::path(input) / "d3plot").string();
  std::set<std::string> series;
  for (const auto& entry : fs::directory_iterator(input))
    if (entry.path().extension() == ".pvd") series.insert(entry.path().string());
  if (series.empty()) throw std::runtime_error(input + " holds neither a d3plot nor a .pvd");
  return *series.begin();
}

// Indices of the states that are asked for.
std::vector<int> choose(const PictureOptions& options, const std::vector<double>& times) {
  const int count = int(times.size());
  if (count == 0) throw std::runtime_error(options.input + " holds no states yet");
  std::vector<int> out;
  for (const int i : options.states) {
    const int index = i < 0 ? count + i : i;
    if (index < 0 || index >= count)
      throw std::runtime_error(
          fmt::format("there is no state {}: {} has states 0 to {}", i, options.input, count - 1));
    out.push_back(index);
  }
  for (const double t : options.times) {
    auto farther = [t](double a, double b) { return std::abs(a - t) < std::abs(b - t); };
    out.push_back(int(std::min_element(times.begin(), times.end(), farther) - times.begin()));
  }
  if (out.empty()) out.push_back(count - 1);
  return out;
}

void add_array(vtkDataSetAttributes* to, const char* name, const std::vector<float>& values,
               int components) {
  if (values.empty()) return;
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(vtkIdType(values.size()) / components);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  to->AddArray(array);
}

vtkSmartPointer<vtkUnstructuredGrid> make_grid(const ResultMesh& mesh, const AnimationState& s) {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(mesh.nodes());
  for (vtkIdType n = 0; n < mesh.nodes(); ++n) points->SetPoint(n, &s.position[3 * n]);
  grid->SetPoints(points);

  const VtkCells cells = vtk_cells(mesh);
  grid->Allocate(vtkIdType(cells.types.size()));
  std::vector<vtkIdType> nodes;
  for (std::size_t c = 0, from = 0; c < cells.types.size(); from = cells.offsets[c++]) {
    nodes.assign(cells.connectivity.begin() + from, cells.connectivity.begin() + cells.offsets[c]);
    grid->InsertNextCell(cells.types[c], vtkIdType(nodes.size()), nodes.data());
  }

  vtkNew<vtkTypeInt64Array> part;
  part->SetName("part_id");
  for (const auto* parts : {&mesh.solid_part, &mesh.shell_part, &mesh.beam_part})
    for (const int p : *parts) part->InsertNextValue(mesh.part_id[p]);
  grid->GetCellData()->AddArray(part);
  const std::vector<std::uint8_t> alive = cell_alive(mesh, s);
  add_array(grid->GetCellData(), "alive", {alive.begin(), alive.end()}, 1);
  add_array(grid->GetCellData(), "von_mises", cell_von_mises(mesh, s), 1);
  add_array(grid->GetCellData(), "plastic_strain", cell_plastic_strain(mesh, s), 1);

  std::vector<float> displacement(s.position);
  for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] -= mesh.position[i];
  add_array(grid->GetPointData(), "displacement", displacement, 3);
  add_array(grid->GetPointData(), "velocity", s.velocity, 3);
  add_array(grid->GetPointData(), "acceleration", s.acceleration, 3);
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> read_vtu(const std::string& path) {
  if (!fs::exists(path)) throw std::runtime_error("cannot open " + path);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  if (reader->GetErrorCode() != 0 || reader->GetOutput()->GetNumberOfPoints() == 0)
    throw std::runtime_error(path + " is not a .vtu that VTK can read, or it is empty");
  vtkSmartPointer<vtkUnstructuredGrid> grid = reader->GetOutput();
  if (!grid->GetCellData()->GetArray("part_id")) {
    // foreign files: all one part
    vtkNew<vtkTypeInt64Array> part;
    part->SetName("part_id");
    part->SetNumberOfTuples(grid->GetNumberOfCells());
    part->FillValue(1);
    grid->GetCellData()->AddArray(part);
  }
  return grid;
}

// Without deleted cells and those of parts that are not wanted.
vtkSmartPointer<vtkUnstructuredGrid> wanted_cells(const PictureOptions& options,
                                                  vtkSmartPointer<vtkUnstructuredGrid> grid) {
  vtkDataArray* alive = grid->GetCellData()->GetArray("alive");
  vtkDataArray* ghost = grid->GetCellData()->GetArray("vtkGhostType");
  vtkDataArray* part = grid->GetCellData()->GetArray("part_id");
  auto lists = [](const std::vector<std::int64_t>& ids, double id) {
    return std::find(ids.begin(), ids.end(), std::int64_t(id)) != ids.end();
  };
  vtkNew<vtkIdList> kept;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    const double id = part->GetTuple1(c);
    if ((alive && alive->GetTuple1(c) == 0) || (ghost && ghost->GetTuple1(c) != 0)) continue;
    if ((!options.only.empty() && !lists(options.only, id)) || lists(options.hide, id)) continue;
    kept->InsertNextId(c);
  }
  if (kept->GetNumberOfIds() == 0) throw std::runtime_error("no element is left to be drawn");
  if (kept->GetNumberOfIds() == grid->GetNumberOfCells()) return grid;
  vtkNew<vtkExtractCells> extract;
  grid->GetCellData()->RemoveArray("vtkGhostType");
  extract->SetInputData(grid);
  extract->SetCellList(kept);
  extract->Update();
  return extract->GetOutput();
}

// the parts of files that do not tell their titles
void note_parts(const vtkUnstructuredGrid* grid, Snapshots& out) {
  vtkDataArray* part = const_cast<vtkUnstructuredGrid*>(grid)->GetCellData()->GetArray("part_id");
  std::set<std::int64_t> ids(out.part_id.begin(), out.part_id.end());
  for (vtkIdType c = 0; c < part->GetNumberOfTuples(); ++c)
    ids.insert(std::int64_t(part->GetTuple1(c)));
  out.part_id.assign(ids.begin(), ids.end());
  out.part_title.resize(ids.size());
}

}  // namespace

Snapshots load_snapshots(const PictureOptions& options) {
  const std::string file = find_file(options.input);
  const std::string extension = fs::path(file).extension().string();
  Snapshots out;
  if (extension == ".vtu" || extension == ".pvd") {
    std::vector<std::pair<double, std::string>> series{{0.0, fs::path(file).filename().string()}};
    if (extension == ".pvd") series = read_pvd(file);
    std::vector<double> times;
    for (const auto& entry : series) times.push_back(entry.first);
    out.title = fs::path(file).stem().string();
    for (const int i : choose(options, times)) {
      auto grid = read_vtu((fs::path(file).parent_path() / series[i].second).string());
      note_parts(grid, out);
      out.list.push_back({times[i], wanted_cells(options, grid)});
    }
    return out;
  }
  const D3plotReader reader(file);
  const ResultMesh& mesh = reader.mesh();
  out.title = mesh.title;
  std::vector<std::pair<std::int64_t, std::string>> parts;
  for (int p = 0; p < mesh.parts(); ++p) parts.emplace_back(mesh.part_id[p], mesh.part_title[p]);
  std::sort(parts.begin(), parts.end());
  for (const auto& [id, title] : parts) {
    out.part_id.push_back(id);
    out.part_title.push_back(title);
  }
  for (const int i : choose(options, reader.times()))
    out.list.push_back(
        {reader.times()[i], wanted_cells(options, make_grid(mesh, reader.state(i)))});
  return out;
}

}  // namespace fabrica
