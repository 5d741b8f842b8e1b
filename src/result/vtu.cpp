#include "result/vtu.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace fabrica {
namespace {

enum VtkType : std::uint8_t {
  vertex = 1,
  line = 3,
  triangle = 5,
  quad = 9,
  tet = 10,
  brick = 12,
  wedge = 13,
  pyramid
};
constexpr std::uint8_t hidden_cell = 32;

// The data behind the XML: each array with its length in front, as VTK's appended raw encoding
// wants it.
class Appended {
 public:
  explicit Appended(bool compress) : compress_(compress) {}

  // Adds an array and returns its XML element.
  template <class T>
  std::string array(const char* name, const char* type, int components,
                    const std::vector<T>& values) {
    const std::string xml = fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        type, name, components, data_.size());
    const char* bytes = reinterpret_cast<const char*>(values.data());
    const std::size_t size = values.size() * sizeof(T);
    compress_ ? deflate(bytes, size) : plain(bytes, size);
    return xml;
  }
  const std::string& data() const { return data_; }

 private:
  void number(std::uint64_t v) { data_.append(reinterpret_cast<const char*>(&v), 8); }
  void plain(const char* bytes, std::size_t size) {
    number(size);
    data_.append(bytes, size);
  }
  // blocks, size of a block, size of the last if it is shorter, compressed sizes; then the blocks
  void deflate(const char* bytes, std::size_t size) {
    constexpr std::size_t block = 1 << 20;
    const std::size_t blocks = (size + block - 1) / block;
    number(blocks);
    number(block);
    number(size % block);
    const std::size_t sizes = data_.size();
    data_.resize(sizes + 8 * blocks);
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::size_t length = std::min(block, size - b * block);
      uLongf packed = compressBound(length);
      const std::size_t at = data_.size();
      data_.resize(at + packed);
      if (compress2(reinterpret_cast<Bytef*>(&data_[at]), &packed,
                    reinterpret_cast<const Bytef*>(bytes + b * block), length, 1) != Z_OK)
        throw std::runtime_error("zlib refuses to compress");
      data_.resize(at + packed);
      const std::uint64_t stored = packed;
      data_.replace(sizes + 8 * b, 8, reinterpret_cast<const char*>(&stored), 8);
    }
  }

  bool compress_;
  std::string data_;
};

std::string document(const ResultMesh& mesh, const AnimationState& s, bool compress) {
  Appended out(compress);
  const VtkCells cells = vtk_cells(mesh);
  std::string xml = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" ";
  xml += "byte_order=\"LittleEndian\" header_type=\"UInt64\"";
  if (compress) xml += " compressor=\"vtkZLibDataCompressor\"";
  xml += fmt::format(">\n<UnstructuredGrid>\n<FieldData>\n{}</FieldData>\n",
                     out.array("TimeValue", "Float64", 1, std::vector<double>{s.time}));
  // field data needs its length stated
  const std::string one = "Name=\"TimeValue\"";
  xml.insert(xml.find(one) + one.size(), " NumberOfTuples=\"1\"");
  xml += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", mesh.nodes(),
                     cells.types.size());

  xml += "<Points>\n" + out.array("Points", "Float32", 3, s.position) + "</Points>\n<Cells>\n";
  xml += out.array("connectivity", "Int64", 1, cells.connectivity);
  xml += out.array("offsets", "Int64", 1, cells.offsets);
  xml += out.array("types", "UInt8", 1, cells.types) + "</Cells>\n<PointData>\n";
  std::vector<float> displacement(s.position.size());
  for (std::size_t i = 0; i < displacement.size(); ++i)
    displacement[i] = s.position[i] - mesh.position[i];
  xml += out.array("displacement", "Float32", 3, displacement);
  if (!s.velocity.empty()) xml += out.array("velocity", "Float32", 3, s.velocity);
  if (!s.acceleration.empty()) xml += out.array("acceleration", "Float32", 3, s.acceleration);
  xml += out.array("node_id", "Int64", 1, mesh.node_id) + "</PointData>\n<CellData>\n";

  std::vector<std::int64_t> part, id;
  for (const auto* parts : {&mesh.solid_part, &mesh.shell_part, &mesh.beam_part})
    for (const int p : *parts) part.push_back(mesh.part_id[p]);
  for (const auto* ids : {&mesh.solid_id, &mesh.shell_id, &mesh.beam_id})
    id.insert(id.end(), ids->begin(), ids->end());
  xml += out.array("part_id", "Int64", 1, part) + out.array("element_id", "Int64", 1, id);

  // solids whole, of each shell the first layer, beams none
  std::vector<float> stress(6 * cells.types.size());
  if (!s.solid_stress.empty())
    std::copy(s.solid_stress.begin(), s.solid_stress.end(), stress.begin());
  if (!s.shell_stress.empty())
    for (int e = 0; e < mesh.shells(); ++e)
      std::copy_n(&s.shell_stress[6 * std::size_t(e) * s.shell_layers], 6,
                  &stress[6 * std::size_t(mesh.solids() + e)]);
  xml += out.array("stress", "Float32", 6, stress);
  xml += out.array("von_mises", "Float32", 1, cell_von_mises(mesh, s));
  xml += out.array("plastic_strain", "Float32", 1, cell_plastic_strain(mesh, s));
  std::vector<std::uint8_t> ghost = cell_alive(mesh, s);
  for (std::uint8_t& g : ghost) g = g ? 0 : hidden_cell;
  xml +=
      out.array("vtkGhostType", "UInt8", 1, ghost) + "</CellData>\n</Piece>\n</UnstructuredGrid>\n";
  return xml + "<AppendedData encoding=\"raw\">\n_" + out.data() +
         "\n</AppendedData>\n</VTKFile>\n";
}

void store(const std::string& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary);
  out << bytes;
  out.flush();
  if (!out) throw std::runtime_error("cannot write " + path);
}

}  // namespace

VtkCells vtk_cells(const ResultMesh& mesh) {
  VtkCells out;
  auto add = [&](VtkType type, const int* nodes, int count) {
    out.connectivity.insert(out.connectivity.end(), nodes, nodes + count);
    out.offsets.push_back(std::int64_t(out.connectivity.size()));
    out.types.push_back(type);
  };
  for (const auto& n : mesh.solid) {
    const SolidCorners c = solid_corners(n);
    add(c.count == 4   ? tet
        : c.count == 5 ? pyramid
        : c.count == 6 ? wedge
                       : brick,
        c.node.data(), c.count);
  }
  for (const auto& n : mesh.shell)
    n[2] == n[3] ? add(triangle, n.data(), 3) : add(quad, n.data(), 4);
  for (const auto& n : mesh.beam) n[0] == n[1] ? add(vertex, n.data(), 1) : add(line, n.data(), 2);
  return out;
}

std::vector<float> cell_von_mises(const ResultMesh& mesh, const AnimationState& s) {
  std::vector<float> out(std::size_t(mesh.solids() + mesh.shells() + mesh.beams()));
  if (!s.solid_stress.empty())
    for (int e = 0; e < mesh.solids(); ++e) out[e] = von_mises(&s.solid_stress[6 * std::size_t(e)]);
  if (!s.shell_stress.empty())
    for (int i = 0; i < mesh.shells() * s.shell_layers; ++i) {
      float& largest = out[mesh.solids() + i / s.shell_layers];
      largest = std::max(largest, von_mises(&s.shell_stress[6 * std::size_t(i)]));
    }
  return out;
}

std::vector<float> cell_plastic_strain(const ResultMesh& mesh, const AnimationState& s) {
  std::vector<float> out(std::size_t(mesh.solids() + mesh.shells() + mesh.beams()));
  std::copy(s.solid_plastic_strain.begin(), s.solid_plastic_strain.end(), out.begin());
  for (std::size_t i = 0; i < s.shell_plastic_strain.size(); ++i) {
    float& largest = out[mesh.solids() + i / s.shell_layers];
    largest = std::max(largest, s.shell_plastic_strain[i]);
  }
  return out;
}

std::vector<std::uint8_t> cell_alive(const ResultMesh& mesh, const AnimationState& s) {
  std::vector<std::uint8_t> out(std::size_t(mesh.solids() + mesh.shells() + mesh.beams()), 1);
  std::copy(s.solid_alive.begin(), s.solid_alive.end(), out.begin());
  std::copy(s.shell_alive.begin(), s.shell_alive.end(), out.begin() + mesh.solids());
  std::copy(s.beam_alive.begin(), s.beam_alive.end(), out.begin() + mesh.solids() + mesh.shells());
  return out;
}

VtuWriter::VtuWriter(const std::string& path, const ResultMesh& mesh, const VtuOptions& options)
    : path_(path), mesh_(mesh), options_(options) {}

VtuWriter::VtuWriter(const std::string& path, const ResultMesh& mesh, const VtuOptions& options,
                     double restart_time)
    : VtuWriter(path, mesh, options) {
  if (!std::filesystem::exists(path)) return;
  for (auto& entry : read_pvd(path))
    if (entry.first <= restart_time)
      series_.push_back(std::move(entry));
    else
      std::filesystem::remove(std::filesystem::path(path).parent_path() / entry.second);
}

void VtuWriter::write(const AnimationState& state) {
  check_state(mesh_, state);
  const std::filesystem::path pvd(path_);
  const std::string name = fmt::format("{}_{:04d}.vtu", pvd.stem().string(), series_.size());
  store((pvd.parent_path() / name).string(), document(mesh_, state, options_.compress));
  series_.emplace_back(state.time, name);

  // the whole list each time: a killed run leaves a series that opens
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const auto& [time, file] : series_)
    xml += fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n", time, file);
  store(path_, xml + "</Collection>\n</VTKFile>\n");
}

std::vector<std::pair<double, std::string>> read_pvd(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot open " + path);
  const std::string xml{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::pair<double, std::string>> out;
  for (std::size_t at = 0; (at = xml.find("<DataSet", at)) != std::string::npos; ++at) {
    const std::string tag = xml.substr(at, xml.find('>', at) - at);
    auto attribute = [&](const std::string& name) -> std::string {
      const std::size_t from = tag.find(" " + name + "=\"");
      if (from == std::string::npos) return {};
      const std::size_t start = from + name.size() + 3;
      return tag.substr(start, tag.find('"', start) - start);
    };
    out.emplace_back(std::strtod(attribute("timestep").c_str(), nullptr), attribute("file"));
  }
  if (out.empty()) throw std::runtime_error(path + " names no states");
  return out;
}

}  // namespace fabrica
