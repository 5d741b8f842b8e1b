#include "body/mesh/untangle.h"

#include <algorithm>
#include <cmath>

#include "base/lane_math.h"
#include "base/pack.h"
#include "body/mesh/minimise.h"
#include "body/placement.h"

namespace fabrica::body {
namespace {

using Lanes = Pack<double, 8>;  // one lane a corner

// the edge at each corner along the brick's three directions, from its low to its high end
constexpr int low_end[3][8] = {
    {0, 0, 3, 3, 4, 4, 7, 7}, {0, 1, 1, 0, 4, 5, 5, 4}, {0, 1, 2, 3, 0, 1, 2, 3}};
constexpr int high_end[3][8] = {
    {1, 1, 2, 2, 5, 5, 6, 6}, {3, 2, 2, 3, 7, 6, 6, 7}, {4, 5, 6, 7, 4, 5, 6, 7}};

using Edges = Vec3<Lanes>[3];

void gather_edges(const std::vector<Point>& nodes, const Brick& brick,
                  const std::array<float, 3>& target, Edges& edges) {
  double x[3][8];
  for (int c = 0; c < 8; ++c)
    for (int a = 0; a < 3; ++a) x[a][c] = nodes[brick[c]][a];
  for (int d = 0; d < 3; ++d) {
    const double inverse = 1.0 / target[d];
    for (int a = 0; a < 3; ++a) {
      alignas(64) double edge[8];
      for (int c = 0; c < 8; ++c) edge[c] = (x[a][high_end[d][c]] - x[a][low_end[d][c]]) * inverse;
      edges[d][a] = Lanes::load(edge);
    }
  }
}

// energy (1) of the eight corners and its derivative by their edges
double brick_energy(const Edges& edges, double eps, Edges& slope) {
  const Vec3<Lanes>&a = edges[0], &b = edges[1], &c = edges[2];
  const Vec3<Lanes> bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const Lanes D = dot(a, bc);
  const Lanes root = sqrt(D * D + Lanes(eps * eps));
  // for D < 0 the sum would cancel: chi = eps^2 / (2 (root - D))
  const Lanes chi =
      select(D > Lanes(0.0), Lanes(0.5) * (D + root), Lanes(0.5 * eps * eps) / (root - D));
  const Lanes chi_slope = chi / root;
  const Lanes cube_root = cbrt(chi);
  const Lanes shape_scale = Lanes(1.0 / 3.0) / (cube_root * cube_root);
  const Lanes f = (dot(a, a) + dot(b, b) + dot(c, c)) * shape_scale;
  const Lanes g = (D * D + Lanes(1.0)) / (Lanes(2.0) * chi);
  const Lanes energy = f * f * f + Lanes(0.1) * g;
  // dE = 3 f^2 df + 0.1 dg;  df = 2 J scale dJ - 2/3 f/chi dchi;  dg = D/chi dD - g/chi dchi
  const Lanes by_edge = Lanes(6.0) * f * f * shape_scale;
  const Lanes by_det =
      Lanes(-2.0) * f * f * f / chi * chi_slope + Lanes(0.1) * (D - g * chi_slope) / chi;
  for (int i = 0; i < 3; ++i) {
    slope[0][i] = by_edge * a[i] + by_det * bc[i];
    slope[1][i] = by_edge * b[i] + by_det * ca[i];
    slope[2][i] = by_edge * c[i] + by_det * ab[i];
  }
  double sum = 0;
  for (int k = 0; k < 8; ++k) sum += get(energy, k);
  return sum;
}

double total_energy(const UntangleProblem& problem, const std::vector<Point>& nodes, double weight,
                    double eps, std::vector<Point>& gradient) {
  std::fill(gradient.begin(), gradient.end(), Point{0, 0, 0});
  double sum = 0;
  for (std::size_t e = 0; e < problem.bricks.size(); ++e) {
    const Brick& brick = problem.bricks[e];
    Edges edges, slope;
    gather_edges(nodes, brick, problem.target[e], edges);
    sum += brick_energy(edges, eps, slope);
    double force[3][8] = {};
    for (int d = 0; d < 3; ++d) {
      const double inverse = 1.0 / problem.target[e][d];
      for (int a = 0; a < 3; ++a)
        for (int c = 0; c < 8; ++c) {
          const double s = get(slope[d][a], c) * inverse;
          force[a][high_end[d][c]] += s;
          force[a][low_end[d][c]] -= s;
        }
    }
    for (int c = 0; c < 8; ++c) gradient[brick[c]] += Point{force[0][c], force[1][c], force[2][c]};
  }
  const double scale = weight / (problem.spacing * problem.spacing);
  for (const SurfaceNode& s : problem.surface) {
    Point direction;
    const double phi = s.field->value(nodes[s.node], direction) + s.depth;
    sum += scale * phi * phi;
    gradient[s.node] += (2 * scale * phi) * direction;
  }
  return sum;
}

double least_determinant(const UntangleProblem& problem, const std::vector<Point>& nodes) {
  double least = 1e9;
  for (std::size_t e = 0; e < problem.bricks.size(); ++e) {
    Edges edges;
    gather_edges(nodes, problem.bricks[e], problem.target[e], edges);
    const Lanes D = dot(edges[0], cross(edges[1], edges[2]));
    for (int c = 0; c < 8; ++c) least = std::min(least, get(D, c));
  }
  return least;
}

}  // namespace

void restore_symmetry(const std::vector<int>& image, std::vector<Point>& nodes) {
  for (std::size_t n = 0; n < image.size(); ++n) {
    const std::size_t m = std::size_t(image[n]);
    if (m < n) continue;
    nodes[n] = 0.5 * (nodes[n] + mirror(nodes[m]));
    nodes[m] = mirror(nodes[n]);
    if (m == n) nodes[n].y = 0;
  }
}

void untangle(const UntangleProblem& problem, std::vector<Point>& nodes, double weight,
              int iterations) {
  const double least = least_determinant(problem, nodes);
  const double eps = least < 0.02 ? std::max(0.02, std::sqrt(1e-4 + 0.04 * least * least)) : 1e-3;
  const auto energy = [&](const std::vector<Point>& at, std::vector<Point>& gradient) {
    return total_energy(problem, at, weight, eps, gradient);
  };
  minimise(energy, nodes, 0.5 * problem.spacing, iterations);
  restore_symmetry(problem.image, nodes);
}

}  // namespace fabrica::body
