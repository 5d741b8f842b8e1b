#include "result/element_strain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/eigen3.h"

namespace fabrica {
namespace {

using Matrix = Mat3<double>;
constexpr int sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                            {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

// column j: derivative of the position along the natural coordinate j at the point xi
Matrix jacobian(const double (&x)[8][3], const double (&xi)[3]) {
  Matrix m{};
  for (int a = 0; a < 8; ++a)
    for (int j = 0; j < 3; ++j) {
      double slope = sign[a][j] / 8.0;
      for (int k = 0; k < 3; ++k)
        if (k != j) slope *= 1 + sign[a][k] * xi[k];
      for (int i = 0; i < 3; ++i) m(i, j) += slope * x[a][i];
    }
  return m;
}

double measured(double square_of_stretch, StrainMeasure measure) {
  return measure == StrainMeasure::green ? 0.5 * (square_of_stretch - 1)
                                         : 0.5 * std::log(square_of_stretch);
}

// first fundamental form of a shell's middle surface at its centre: g11, g12, g22
std::array<double, 3> surface_metric(const double (&x)[4][3]) {
  std::array<double, 3> g{};
  for (int i = 0; i < 3; ++i) {
    const double along = (-x[0][i] + x[1][i] + x[2][i] - x[3][i]) / 4,
                 across = (-x[0][i] - x[1][i] + x[2][i] + x[3][i]) / 4;
    g[0] += along * along, g[1] += along * across, g[2] += across * across;
  }
  return g;
}

// the last five corners are one: then the faces of the map are not those of the tetrahedron
bool is_tetrahedron(const double (&x)[8][3]) {
  for (int a = 4; a < 8; ++a)
    for (int i = 0; i < 3; ++i)
      if (x[a][i] != x[3][i]) return false;
  return true;
}

template <std::size_t n>
void gather(const std::array<int, n>& node, const std::vector<float>& position,
            double (&corner)[n][3]) {
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t i = 0; i < 3; ++i) corner[a][i] = position[3 * std::size_t(node[a]) + i];
}

void check(double strain, const char* kind, std::int64_t id, double time) {
  if (!std::isfinite(strain))
    throw std::runtime_error(fmt::format(
        "{} {} has no strain at time {:g}: it is flat, inside out or not a number. Look at the run",
        kind, id, time));
}

}  // namespace

double solid_strain(const double (&start)[8][3], const double (&now)[8][3], StrainMeasure measure) {
  const double centre[3] = {0, 0, 0};
  const Matrix before = jacobian(start, centre);
  if (!(det(before) > 0)) return std::nan("");
  const Matrix F = jacobian(now, centre) * inverse(before);
  const Eigen3<double> C = eigen_symmetric(left_cauchy_green(transpose(F)));
  return measured(std::max({C.value.x, C.value.y, C.value.z}), measure);
}

double shell_strain(const double (&start)[4][3], const double (&now)[4][3], StrainMeasure measure) {
  const auto A = surface_metric(start), a = surface_metric(now);
  const double area2 = A[0] * A[2] - A[1] * A[1];
  if (!(area2 > 0)) return std::nan("");
  // A^-1 a has the squares of the principal stretches as eigenvalues
  const double trace = (A[2] * a[0] - 2 * A[1] * a[1] + A[0] * a[2]) / area2,
               product = (a[0] * a[2] - a[1] * a[1]) / area2;
  return measured(trace / 2 + std::sqrt(std::max(0.0, trace * trace / 4 - product)), measure);
}

double solid_volume(const double (&corner)[8][3]) {
  double volume = 0;
  if (is_tetrahedron(corner)) {
    Matrix edges{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) edges(i, j) = corner[j][i] - corner[3][i];
    return std::abs(det(edges)) / 6;
  }
  for (int a = 0; a < 8; ++a) {
    double xi[3];
    for (int i = 0; i < 3; ++i) xi[i] = sign[a][i] / std::sqrt(3.0);
    volume += det(jacobian(corner, xi));
  }
  return volume;
}

PeakStrains peak_strains(const D3plotReader& file, const std::vector<bool>& wanted_part,
                         StrainMeasure measure) {
  const ResultMesh& mesh = file.mesh();
  PeakStrains out;
  out.solid.assign(mesh.solid.size(), 0), out.shell.assign(mesh.shell.size(), 0);
  out.solid_volume.assign(mesh.solid.size(), 0);
  double before[8][3], now[8][3], before4[4][3], now4[4][3];
  for (int s = 0; s < int(file.times().size()); ++s) {
    const AnimationState state = file.state(s);
    for (std::size_t e = 0; e < mesh.solid.size(); ++e) {
      if (!wanted_part[std::size_t(mesh.solid_part[e])]) continue;
      gather(mesh.solid[e], mesh.position, before);
      if (s == 0) out.solid_volume[e] = solid_volume(before);
      if (!state.solid_alive.empty() && !state.solid_alive[e]) continue;
      gather(mesh.solid[e], state.position, now);
      const double strain = solid_strain(before, now, measure);
      check(strain, "solid", mesh.solid_id[e], state.time);
      out.solid[e] = std::max(out.solid[e], strain);
    }
    for (std::size_t e = 0; e < mesh.shell.size(); ++e) {
      if (!wanted_part[std::size_t(mesh.shell_part[e])]) continue;
      if (!state.shell_alive.empty() && !state.shell_alive[e]) continue;
      gather(mesh.shell[e], mesh.position, before4);
      gather(mesh.shell[e], state.position, now4);
      const double strain = shell_strain(before4, now4, measure);
      check(strain, "shell", mesh.shell_id[e], state.time);
      out.shell[e] = std::max(out.shell[e], strain);
    }
  }
  return out;
}

}  // namespace fabrica
