#pragma once
// Hourglass control of the one-point brick; equations and sources in hex8.h.
#include "element/hex_geometry.h"

namespace fabrica {

// Where a brick is warped or has hourglassed far, X_a = Gamma_a . x and the gradients at its centre
// are large, and gamma with them: |gamma_a|^2 <= 8 + |X_a|^2 B,  B = sum_A |grad N_A|^2. What a
// mode may ask of the step is bounded with that (IHQ 1-5).

// Hourglass quantities of one pack. q[a] is the generalised force of mode a (three components).
// IHQ 1, the viscous control of the oldest codes, takes Gamma for gamma: x is then zero. It resists
// the rotation of a skewed brick a little, but asks no more of the step when the brick is
// distorted.
template <class L>
struct HexHourglass {
  Vec3<L> x[4];  // Gamma_a . x
  Vec3<L> h[4];  // gamma_a . v
  Vec3<L> q[4];

  FABRICA_FN static void modes(const Vec3<L> (&u)[8], Vec3<L> (&m)[4]) {
    const Vec3<L> s1 = u[0] + u[6], s2 = u[1] + u[7], s3 = u[2] + u[4], s4 = u[3] + u[5];
    const Vec3<L> d1 = u[0] - u[6], d2 = u[1] - u[7], d3 = u[2] - u[4], d4 = u[3] - u[5];
    m[0] = (s1 + s2) - (s3 + s4);
    m[1] = (s1 - s2) - (s3 - s4);
    m[2] = (s1 - s2) + (s3 - s4);
    m[3] = (d2 - d1) + (d4 - d3);
  }
  FABRICA_FN void measure(bool orthogonal, const Vec3<L> (&position)[8],
                          const Vec3<L> (&velocity)[8], const Mat3<L>& gradient) {
    modes(velocity, h);
    if (!orthogonal) {
      for (int a = 0; a < 4; ++a) x[a] = {};
      return;
    }
    modes(position, x);
    for (int a = 0; a < 4; ++a) h[a] = h[a] - gradient * x[a];
  }
  // k, or where that is less what gives k |gamma_a|^2 the bound; squares: sum_A |grad N_A|^2
  FABRICA_FN L bounded(int a, const L& k, const L& bound, const L& squares) const {
    return min(k, bound / fma(dot(x[a], x[a]), squares, L(8.0)));
  }
  // gamma_a . v at mid step, where the velocity belongs: with the geometry of its end instead a
  // mode gains or loses energy in proportion to the step
  FABRICA_FN void to_mid_step(const Mat3<L>& gradient, const Mat3<L>& middle, const L& dt) {
    for (int a = 0; a < 4; ++a) {
      const Vec3<L> u = h[a] + gradient * x[a];  // Gamma_a . v
      h[a] = u - middle * (x[a] - L(0.5) * dt * u);
    }
  }
  FABRICA_FN void scale(const L& s) {
    for (int a = 0; a < 4; ++a) q[a] = s * q[a];
  }
};

// IHQ 4, 5: rate form, turned with the element's spin. With the corner mass m the mode has
// (omega dt)^2 = k |gamma|^2 dt^2 / m. The part 8 of |gamma|^2 stands square to the uniform modes
// and to the other three: it may have 0.5, a cube at its own step has 0.49 from QM = 0.1. The part
// |X_a|^2 B of a distorted brick lies among the uniform modes, which have up to 4 TSSFAC^2 = 3.24
// of the 4 that are stable; it may have 0.1 in each of the four.
template <class L>
FABRICA_FN void hexhourglass_stiffness(const ElementParameters& p, const Point<L>& point,
                                       const L& dt, const L& density, const HexGradient<L>& g,
                                       const Mat3<L>& gradient, StateView<L> s,
                                       HexHourglass<L>& hg) {
  const L squares = g.squares();
  const L k = L(p.hourglass_coefficient / 16) * point.modulus * g.volume * squares * dt;
  const L most = L(0.5 / 8) * density * g.volume / dt;
  const Vec3<L> w = {L(0.5) * dt * (gradient.a[2][1] - gradient.a[1][2]),
                     L(0.5) * dt * (gradient.a[0][2] - gradient.a[2][0]),
                     L(0.5) * dt * (gradient.a[1][0] - gradient.a[0][1])};
  for (int a = 0; a < 4; ++a) {
    Vec3<L> q = s.template get<Vec3<L>>(3 * a);
    q += cross(w, q + L(0.5) * cross(w, q));
    q += hg.bounded(a, k, most, L(0.5 / 0.1) * squares) * hg.h[a];
    s.put(3 * a, q);
    hg.q[a] = q;
  }
}

// IHQ 6: assumed strain stabilisation in a corotational frame (rows e[0..2]); gives its work in a
// unit of time
template <class L>
FABRICA_FN L hexhourglass_assumed_strain(const ElementParameters& p, const Point<L>& point,
                                         const L& dt, const Vec3<L> (&x)[8], StateView<L> s,
                                         HexHourglass<L>& hg) {
  const Vec3<L> d1 = x[6] - x[0], d2 = x[7] - x[1], d3 = x[4] - x[2], d4 = x[5] - x[3];
  const Vec3<L> r[3] = {d1 - d2 - d3 + d4, d1 + d2 - d3 - d4, d1 + d2 + d3 + d4};
  Vec3<L> e[3];
  e[0] = (L(1.0) / norm(r[0])) * r[0];
  const Vec3<L> second = r[1] - dot(r[1], e[0]) * e[0];
  e[1] = (L(1.0) / norm(second)) * second;
  e[2] = cross(e[0], e[1]);
  const L length[3] = {abs(dot(e[0], r[0])), abs(dot(e[1], r[1])), abs(dot(e[2], r[2]))};
  const L third = L(1.0 / 3.0), nu = L(p.poisson), G = point.shear;
  const L bend = L(1.0) / (L(1.0) - nu);
  // q[a][i]: coefficient of mode a in component i of the frame, times dt
  L q[4][3], rate[4][3];
  for (int a = 0; a < 4; ++a)
    for (int i = 0; i < 3; ++i) q[a][i] = L(0.125) * dt * dot(e[i], hg.h[a]);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const L hii = third * length[j] * length[k] / length[i];
    const L hjj = third * length[k] * length[i] / length[j];
    const L hkk = third * length[i] * length[j] / length[k];
    const L hij = third * length[k], hik = third * length[j];
    rate[i][i] = G * ((hjj + hkk) * q[i][i] + hij * q[j][j] + hik * q[k][k]);
    rate[j][i] = L(2.0) * G * bend * (hii * q[j][i] + nu * hij * q[i][j]);
    rate[k][i] = L(2.0) * G * bend * (hii * q[k][i] + nu * hik * q[i][k]);
    rate[3][i] = L(2.0 / 3.0) * G * (L(1.0) + nu) * hii * q[3][i];
  }
  const L scale = L(0.125 * double(p.hourglass_coefficient));
  const auto global = [&](const Vec3<L>& q) {
    return scale * (q.x * e[0] + q.y * e[1] + q.z * e[2]);
  };
  L work = L(0.0);
  for (int a = 0; a < 4; ++a) {
    const Vec3<L> old = s.template get<Vec3<L>>(3 * a);
    const Vec3<L> stored = old + Vec3<L>{rate[a][0], rate[a][1], rate[a][2]};
    s.put(3 * a, stored);
    hg.q[a] = global(stored);
    work += L(0.5) * dot(point.alive * hg.q[a] + global(old), hg.h[a]);
  }
  return work;
}

// IHQ 1-3. A damper k on a velocity that is half a step old is stable up to k |gamma|^2 dt / m = 2
// with the corner mass m; a cube at its own step has 1.44 from QM = 0.1. Damping beyond 1.6 is cut
// to that, which a brick reaches only when it is both distorted and the one that sets the step.
template <class L>
FABRICA_FN L hexhourglass_viscous(const ElementParameters& p, const L& dt, const L& density,
                                  const L& sound, const L& length, const HexGradient<L>& g,
                                  HexHourglass<L>& hg) {
  const L k = L(p.hourglass_coefficient * Real(0.25)) * density * sound * length * length;
  const L most = L(1.6 / 8) * density * g.volume / dt;
  const L squares = g.squares();
  L work = L(0.0);
  for (int a = 0; a < 4; ++a) {
    hg.q[a] = hg.bounded(a, k, most, squares) * hg.h[a];
    work += dot(hg.q[a], hg.h[a]);
  }
  return work;
}

// Fills hg.q for the control type of the part and books the hourglass energy of the step.
template <class L>
FABRICA_FN void hexhourglass_forces(const ElementParameters& p, const Point<L>& point, const L& dt,
                                    const L& density, const L& sound, const L& length,
                                    const HexGradient<L>& g, const Corners<L, 8>& c,
                                    const Mat3<L>& gradient, const Mat3<L>& middle, StateView<L> s,
                                    HexHourglass<L>& hg, Totals<L>& totals) {
  L work = L(0.0);
  if (p.hourglass >= 4) hg.to_mid_step(gradient, middle, dt);
  if (p.hourglass == 6) {
    work = hexhourglass_assumed_strain(p, point, dt, c.x, s, hg);
  } else if (p.hourglass >= 4) {
    Vec3<L> old[4];
    for (int a = 0; a < 4; ++a) old[a] = s.template get<Vec3<L>>(3 * a);
    hexhourglass_stiffness(p, point, dt, density, g, middle, s, hg);
    for (int a = 0; a < 4; ++a) work += L(0.5) * dot(point.alive * hg.q[a] + old[a], hg.h[a]);
  } else {
    work = hexhourglass_viscous(p, dt, density, sound, length, g, hg);
  }
  totals.hourglass = dt * work;
}

// f_A = -T b_A - Q Gamma_A with T = V sigma - sum_a q_a (x) x_a
template <class L>
FABRICA_FN void hexcorner_forces(const HexGradient<L>& g, const L& volume, const Sym3<L>& stress,
                                 const HexHourglass<L>& hg, CornerForces<L, 8>& out) {
  const Sym3<L> vs = volume * stress;
  Mat3<L> T{{{vs.xx, vs.xy, vs.zx}, {vs.xy, vs.yy, vs.yz}, {vs.zx, vs.yz, vs.zz}}};
  for (int a = 0; a < 4; ++a)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) T.a[i][j] = fma(-hg.q[a][i], hg.x[a][j], T.a[i][j]);
  const Vec3<L>* q = hg.q;
  const Vec3<L> e1 = q[0] + q[1] + q[2], e2 = q[0] - q[1] - q[2], e3 = q[2] - q[0] - q[1],
                e4 = q[1] - q[0] - q[2];
  Vec3<L> t[8];
  for (int a = 0; a < (g.antisymmetric ? 4 : 8); ++a) t[a] = T * g.b[a];
  if (g.antisymmetric) t[6] = -t[0], t[7] = -t[1], t[4] = -t[2], t[5] = -t[3];
  out.f[0] = q[3] - e1 - t[0];
  out.f[6] = -q[3] - e1 - t[6];
  out.f[1] = -q[3] - e2 - t[1];
  out.f[7] = q[3] - e2 - t[7];
  out.f[2] = q[3] - e3 - t[2];
  out.f[4] = -q[3] - e3 - t[4];
  out.f[3] = -q[3] - e4 - t[3];
  out.f[5] = q[3] - e4 - t[5];
}

}  // namespace fabrica
