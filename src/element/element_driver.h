#pragma once
// A small explicit driver for the tests of element kernels: a mesh with double nodes, one lane per
// element.
//   v(n+1/2) = (1 - c dt) v(n-1/2) + dt f/m,  x(n+1) = x(n) + dt v(n+1/2)   (c: mass damping)
#include <functional>
#include <vector>

#include "base/aligned.h"
#include "element/kernel.h"

namespace fabrica::test {

template <class E, class M>
struct Mesh {
  static constexpr int N = E::corners;
  M law;
  ElementParameters p;
  std::vector<Vec3d> x, v, w, force, moment;
  std::vector<double> mass, inertia;
  std::vector<std::array<int, N>> elements;
  std::vector<unsigned> fixed;  // bits 0-2 translation, 3-5 rotation
  AlignedVector<Real> state;
  double internal = 0, hourglass = 0, time = 0, dt = 0, damping = 0, external = 0;
  double step = 0;
  Vec3d orientation{0, 1, 0};
  int fields = 0;

  int add(Vec3d at) {
    x.push_back(at);
    v.push_back({0, 0, 0}), w.push_back({0, 0, 0});
    fixed.push_back(0);
    return int(x.size()) - 1;
  }
  // elastic moduli and density from the law
  void moduli() {
    const Elastic e = law.elastic();
    p.density = Real(e.density), p.bulk = Real(e.bulk), p.shear = Real(e.shear);
    p.youngs = Real(e.youngs()), p.poisson = Real(e.poisson());
  }
  StateView<Real> view(int e) {
    return {state.data() + std::size_t(e / block_size) * fields * block_size + e % block_size};
  }
  Corners<Real, N> gather(int e) const {
    Corners<Real, N> c;
    const Vec3d o = x[elements[e][0]];
    for (int a = 0; a < N; ++a) {
      const int n = elements[e][a];
      const Vec3d r = x[n] - o;
      c.x[a] = {Real(r.x), Real(r.y), Real(r.z)};
      c.v[a] = {Real(v[n].x), Real(v[n].y), Real(v[n].z)};
      c.w[a] = {Real(w[n].x), Real(w[n].y), Real(w[n].z)};
    }
    return c;
  }
  void start(double h) {
    fields = E::template state_fields<M>(p);
    state.assign((elements.size() + block_size - 1) / block_size * block_size * fields, Real(0));
    mass.assign(x.size(), 0), inertia.assign(x.size(), 0);
    for (int e = 0; e < int(elements.size()); ++e) {
      Given<Real> g{};
      Given<double> gd{};
      for (int a = 0; a < 4; ++a) g.thickness[a] = Real(h), gd.thickness[a] = h;
      g.orientation = {Real(orientation.x), Real(orientation.y), Real(orientation.z)};
      gd.orientation = orientation;
      E::template initialise<Real, M>(law, p, gather(e), g, view(e));
      Corners<double, N> c{};
      for (int a = 0; a < N; ++a) c.x[a] = x[elements[e][a]];
      double m[N] = {}, j[N] = {};
      E::lump(p, c, gd, m, j);
      for (int a = 0; a < N; ++a) mass[elements[e][a]] += m[a], inertia[elements[e][a]] += j[a];
    }
    forces();
    dt = 0.9 * step;
  }
  void forces() {
    force.assign(x.size(), {0, 0, 0}), moment.assign(x.size(), {0, 0, 0});
    step = 1e30;
    for (int e = 0; e < int(elements.size()); ++e) {
      CornerForces<Real, N> out{};
      Totals<Real> t{};
      E::template forces<Real, M>(law, p, Real(dt), gather(e), view(e), out, t);
      internal += t.internal, hourglass += t.hourglass;
      step = std::min(step, double(t.time_step));
      for (int a = 0; a < N; ++a) {
        const int n = elements[e][a];
        for (int i = 0; i < 3; ++i) {
          force[n][i] += out.f[a][i];
          if constexpr (E::rotations) moment[n][i] += out.m[a][i];
        }
      }
    }
  }
  // one cycle; load adds to force and moment
  template <class Load>
  void cycle(const Load& load) {
    load(*this);
    const double keep = 1 - damping * dt;
    for (std::size_t n = 0; n < x.size(); ++n)
      for (int i = 0; i < 3; ++i) {
        v[n][i] = fixed[n] >> i & 1 ? 0 : keep * v[n][i] + dt * force[n][i] / mass[n];
        x[n][i] += dt * v[n][i];
        if constexpr (E::rotations)
          w[n][i] = fixed[n] >> (3 + i) & 1 ? 0 : keep * w[n][i] + dt * moment[n][i] / inertia[n];
      }
    time += dt;
    forces();
  }
  double kinetic() const {
    double k = 0;
    for (std::size_t n = 0; n < x.size(); ++n)
      k += 0.5 * mass[n] * dot(v[n], v[n]) +
           (E::rotations ? 0.5 * inertia[n] * dot(w[n], w[n]) : 0.0);
    return k;
  }
};

// equally spaced Gauss points of the thickness, 1 to 5
inline void gauss_layers(ElementParameters& p, int n) {
  static const double z[5][5] = {
      {0},
      {-0.5773502691896257, 0.5773502691896257},
      {-0.7745966692414834, 0, 0.7745966692414834},
      {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526},
      {-0.906179845938664, -0.5384693101056831, 0, 0.5384693101056831, 0.906179845938664}};
  static const double w[5][5] = {
      {1},
      {0.5, 0.5},
      {5. / 18, 8. / 18, 5. / 18},
      {0.17392742256872692, 0.32607257743127308, 0.32607257743127308, 0.17392742256872692},
      {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324,
       0.11846344252809454}};
  p.layers = n;
  for (int q = 0; q < n; ++q)
    p.layer_z[q] = Real(z[n - 1][q]), p.layer_weight[q] = Real(w[n - 1][q]);
}

// n x n quadrilaterals over a square of side a in the plane z = 0
template <class Mesh>
void square(Mesh& m, int n, double a) {
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) m.add({a * i / n, a * j / n, 0});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int k = j * (n + 1) + i;
      m.elements.push_back({k, k + 1, k + n + 2, k + n + 1});
    }
}

}  // namespace fabrica::test
