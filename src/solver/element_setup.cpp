#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "element/hex_geometry.h"
#include "solver/tiles.h"

namespace fabrica {
namespace {

// Gauss points and weights on -1..1, weights summing to 1 (Abramowitz and Stegun, table 25.4)
void gauss(int n, Real* z, Real* w) {
  // roots of the Legendre polynomial by Newton's method
  for (int i = 0; i < n; ++i) {
    double x = std::cos(3.14159265358979323846 * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int pass = 0; pass < 50; ++pass) {
      double p0 = 1, p1 = x;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1, p1 = p2;
      }
      if (n == 1) p0 = 1, p1 = x;
      slope = n * (x * p1 - p0) / (x * x - 1);
      x -= p1 / slope;
    }
    if (2 * i + 1 == n) x = 0;
    z[n - 1 - i] = Real(x);
    w[n - 1 - i] = Real(1 / ((1 - x * x) * slope * slope));
  }
  if (n == 1) z[0] = 0, w[0] = 1;
}

// Lobatto points: the surfaces are among them
void lobatto(int n, Real* z, Real* w) {
  static const double x3[] = {-1, 0, 1}, w3[] = {1. / 6, 4. / 6, 1. / 6};
  static const double x4[] = {-1, -0.4472135954999579, 0.4472135954999579, 1},
                      w4[] = {1. / 12, 5. / 12, 5. / 12, 1. / 12};
  static const double x5[] = {-1, -0.6546536707079771, 0, 0.6546536707079771, 1},
                      w5[] = {1. / 20, 49. / 180, 32. / 90, 49. / 180, 1. / 20};
  const double *x = n == 3 ? x3 : n == 4 ? x4 : x5, *v = n == 3 ? w3 : n == 4 ? w4 : w5;
  for (int i = 0; i < n; ++i) z[i] = Real(x[i]), w[i] = Real(v[i]);
}

void layers(const Section& s, ElementParameters& p) {
  p.layers = std::clamp(s.through_thickness_points, 1, max_layers);
  if (s.quadrature == 1 && p.layers >= 3 && p.layers <= 5)
    lobatto(p.layers, p.layer_z, p.layer_weight);
  else
    gauss(p.layers, p.layer_z, p.layer_weight);
}

// rectangular or tubular section of a Hughes-Liu beam
void hughes_liu_section(const Section& s, ElementParameters& p) {
  const double pi = 3.14159265358979323846;
  if (s.cross_section == 1) {  // tube: 2x4 points on the mid radius
    const double outer = 0.5 * std::max(s.ts1, s.tt1 > 0 ? 0 : 0.0), inner = 0.5 * s.tt1;
    const double area = pi * (outer * outer - inner * inner),
                 r = std::sqrt(0.5 * (outer * outer + inner * inner));
    p.section_points = 8;
    for (int i = 0; i < 8; ++i) {
      p.section_s[i] = Real(r * std::cos(pi / 4 * (i + 0.5))),
      p.section_t[i] = Real(r * std::sin(pi / 4 * (i + 0.5)));
      p.section_weight[i] = Real(area / 8);
    }
    p.area = Real(area);
    p.iss = p.itt = Real(pi / 4 * (std::pow(outer, 4) - std::pow(inner, 4)));
  } else {  // 2x2 Gauss
    const double g = 0.5 / std::sqrt(3.0), area = s.ts1 * s.tt1;
    p.section_points = 4;
    for (int i = 0; i < 4; ++i) {
      p.section_s[i] = Real((i % 2 ? g : -g) * s.ts1),
      p.section_t[i] = Real((i / 2 ? g : -g) * s.tt1);
      p.section_weight[i] = Real(area / 4);
    }
    p.area = Real(area);
    p.iss = Real(s.ts1 * std::pow(s.tt1, 3) / 12), p.itt = Real(s.tt1 * std::pow(s.ts1, 3) / 12);
  }
  p.torsion = p.iss + p.itt;
}

void beam_section(const Section& s, const Card* material, ElementParameters& p) {
  if (s.formulation == 1) {
    hughes_liu_section(s, p);
  } else {
    p.area = Real(s.area), p.iss = Real(s.iss), p.itt = Real(s.itt);
    p.torsion = Real(s.j != 0 ? s.j : s.iss + s.itt), p.shear_area = Real(s.shear_area);
  }
  if (material && material->has_field("da")) {
    p.axial_damping = Real(material->real("da")), p.bending_damping = Real(material->real("db"));
  }
}

}  // namespace

int solid_shape(const std::array<int, 10>& deck, std::array<int, 8>& nodes) {
  std::array<int, 8> n;
  std::copy_n(deck.begin(), 8, n.begin());
  nodes = n;
  if (n[4] < 0 || (n[3] == n[4] && n[4] == n[5] && n[5] == n[6] && n[6] == n[7]))
    return 4;                                                          // (a b c d d d d d)
  if (n[2] == n[3] && n[4] == n[5] && n[5] == n[6] && n[6] == n[7]) {  // (a b c c d d d d)
    nodes = {n[0], n[1], n[2], n[4], -1, -1, -1, -1};
    return 4;
  }
  if (n[4] == n[5] &&
      n[6] == n[7]) {  // wedge (a b c d e e f f): triangles (a e b) and (d f c), normals inwards
    nodes = {n[0], n[4], n[1], n[3], n[6], n[2], -1, -1};
    return 6;
  }
  if (n[2] == n[3] && n[6] == n[7]) {  // wedge (a b c c d e f f): triangles (a b c) and (d e f)
    nodes = {n[0], n[1], n[2], n[4], n[5], n[6], -1, -1};
    return 6;
  }
  return 8;
}

std::array<double, 4> shell_thickness(const Model& model, int shell) {
  const Section& s = model.sections[model.parts[model.shells.part[shell]].section];
  std::array<double, 4> h = s.thickness;
  for (int a = 1; a < 4; ++a)
    if (h[a] == 0) h[a] = h[0];
  if (shell < int(model.shells.thickness.size()))
    for (int a = 0; a < 4; ++a)
      if (model.shells.thickness[shell][a] > 0) h[a] = model.shells.thickness[shell][a];
  return h;
}

ElementKind element_kind(const Model& model, const Part& part, Family family, int corners) {
  if (part.section < 0) throw std::invalid_argument("the part has no section");
  const Section& s = model.sections[part.section];
  const int form = s.formulation;
  if (family == Family::solid) {
    if (corners == 4) return form == 13 ? ElementKind::tet4_nodal : ElementKind::tet4;
    if (corners == 6) return ElementKind::penta6;
    if (form == 2 || form == -1 || form == -2) return ElementKind::hex8_full;
    if (form == 0 || form == 1 || form == 10 || form == 13 || form == 15) {
      const int type = part.hourglass ? part.hourglass->type : model.controls.hourglass.type;
      return type == 3 || type == 5 ? ElementKind::hex8_exact : ElementKind::hex8;
    }
  } else if (family == Family::shell) {
    if (form == 5) return ElementKind::membrane;
    if (form == 9) return ElementKind::membrane_full;
    if (corners == 3) return ElementKind::shell_triangle;
    if (form == 16 || form == -16) return ElementKind::shell_full;
    if (form == 1 || form == 2 || form == 10 || form == 0 || form == 4 || form == 3 || form == 17)
      return ElementKind::shell_bt;
  } else if (family == Family::beam) {
    if (form == 3) return ElementKind::truss;
    if (form == 2) return ElementKind::beam_resultant;
    if (form == 1 || form == 0) return ElementKind::beam_hughes_liu;
  }
  throw std::invalid_argument("element formulation " + std::to_string(form) + " is not supported");
}

ElementParameters element_parameters(const Model& model, const Part& part, const Elastic& elastic) {
  const Section& s = model.sections[part.section];
  const Controls& control = model.controls;
  ElementParameters p;
  p.density = Real(elastic.density), p.bulk = Real(elastic.bulk), p.shear = Real(elastic.shear);
  p.youngs = Real(elastic.youngs()), p.poisson = Real(elastic.poisson());
  p.formulation = s.formulation;
  const Hourglass& h = part.hourglass ? *part.hourglass : control.hourglass;
  p.hourglass = h.type != 0 ? h.type : 2;
  if (p.hourglass == 7 || p.hourglass == 9 || p.hourglass == 10) p.hourglass = 6;
  p.hourglass_coefficient = Real(h.coefficient);
  p.hourglass_bending = Real(h.bending), p.hourglass_warping = Real(h.warping);
  p.quadratic_viscosity = Real(h.quadratic_viscosity),
  p.linear_viscosity = Real(h.linear_viscosity);
  // of the formulations that the keyword names for it
  const int form = std::abs(s.formulation);
  if (part.family == Family::shell &&
      (form == 0 || form == 2 || form == 4 || form == 10 || form == 16 || form == 17))
    p.shell_viscosity = control.shell_viscosity;
  for (const PartDamping& d : model.part_damping)
    if (d.stiffness != 0 &&
        std::find(d.parts.begin(), d.parts.end(), int(&part - model.parts.data())) != d.parts.end())
      p.stiffness_damping = Real(d.stiffness);
  p.shear_factor = Real(s.shear_factor), p.reference_location = Real(s.reference_location);
  p.area_mass = Real(s.area_mass);
  p.thickness_update = control.shell_update, p.projection = control.shell_projection;
  p.warping = s.formulation == 10 || control.shell_warping == 1 ? 1 : 0;
  p.time_step_option = control.shell_time_step;
  p.mass_scaling_time_step = Real(std::abs(control.mass_scaling_time_step));
  if (part.family == Family::shell) layers(s, p);
  if (part.family == Family::beam) beam_section(s, model.materials[part.material].card, p);
  return p;
}

namespace {

void add_rigid_solids(const Model& model, std::vector<double>& mass) {
  for (int e = 0; e < model.solids.size(); ++e) {
    const Part& part = model.parts[model.solids.part[e]];
    if (!part.rigid) continue;
    std::array<int, 8> n;
    const int corners = solid_shape(model.solids.node[e], n);
    Vec3<double> x[8];
    if (corners == 4) {
      const Vec3d a = model.nodes.x[n[0]];
      const double v =
          dot(model.nodes.x[n[1]] - a, cross(model.nodes.x[n[2]] - a, model.nodes.x[n[3]] - a)) / 6;
      for (int i = 0; i < 4; ++i)
        mass[n[i]] += std::abs(v) * model.materials[part.material].density / 4;
      continue;
    }
    const auto& deck = model.solids.node[e];
    for (int i = 0; i < 8; ++i) x[i] = model.nodes.x[deck[i]];
    const double m =
        std::abs(hex_gradient<true>(x).volume) * model.materials[part.material].density / 8;
    for (int i = 0; i < 8; ++i) mass[deck[i]] += m;
  }
}

// rigid shells, and shells of null material, which have no kernel either
void add_plain_shells(const Model& model, std::vector<double>& mass, std::vector<double>& inertia) {
  for (int e = 0; e < model.shells.size(); ++e) {
    const Part& part = model.parts[model.shells.part[e]];
    if (part.material < 0) continue;
    const Material& material = model.materials[part.material];
    if (!part.rigid && material.law != "MAT_NULL") continue;
    const auto& n = model.shells.node[e];
    const int corners = n[3] == n[2] || n[3] < 0 ? 3 : 4;
    const Vec3d d1 = model.nodes.x[n[2]] - model.nodes.x[n[0]];
    const Vec3d d2 = model.nodes.x[n[corners - 1]] - model.nodes.x[n[1]];
    const double area = corners == 4
                            ? 0.5 * norm(cross(d1, d2))
                            : 0.5 * norm(cross(d1, model.nodes.x[n[1]] - model.nodes.x[n[0]]));
    const auto h = shell_thickness(model, e);
    const double thickness = std::accumulate(h.begin(), h.begin() + corners, 0.0) / corners;
    const double m = material.density * thickness * area / corners;
    for (int i = 0; i < corners; ++i) {
      mass[n[i]] += m;
      if (part.rigid) inertia[n[i]] += m * std::max(thickness * thickness / 12, area / 8);
    }
  }
}

}  // namespace

void add_rigid_part_mass(const Model& model, std::vector<double>& mass,
                         std::vector<double>& inertia) {
  add_rigid_solids(model, mass);
  add_plain_shells(model, mass, inertia);
  for (int e = 0; e < model.beams.size(); ++e) {
    const Part& part = model.parts[model.beams.part[e]];
    if (part.material < 0 || part.section < 0) continue;
    const Section& s = model.sections[part.section];
    const auto& n = model.beams.node[e];
    const double density = model.materials[part.material].density;
    if (s.formulation == 6) {  // discrete beam: mass from its volume, half to each end
      for (int i = 0; i < 2; ++i)
        mass[n[i]] += 0.5 * density * s.volume, inertia[n[i]] += 0.5 * s.rotary_inertia;
    } else if (part.rigid) {
      const double area = s.area != 0 ? s.area : s.ts1 * s.tt1;
      const double m = 0.5 * density * area * norm(model.nodes.x[n[1]] - model.nodes.x[n[0]]);
      for (int i = 0; i < 2; ++i) mass[n[i]] += m;
    }
  }
}

}  // namespace fabrica
