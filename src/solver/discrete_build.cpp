// Building the discrete elements from the model, and their restart record.
#include <algorithm>
#include <cmath>
#include <istream>
#include <ostream>
#include <stdexcept>
#include <type_traits>

#include "element/discrete.h"
#include "solver/discrete_elements.h"
#include "solver/rigid_bodies.h"

namespace fabrica {
namespace {

bool is_discrete_beam(const Model& model, int part) {
  const int s = model.parts[std::size_t(part)].section;
  return s >= 0 && model.sections[std::size_t(s)].family == Family::beam &&
         model.sections[std::size_t(s)].formulation == 6;
}

const Section& section_of(const Model& model, int part) {
  return model.sections[std::size_t(model.parts[std::size_t(part)].section)];
}

// the law of a part; an error names the part once
template <class Law, class Make>
std::optional<Law> law_of(const Model& model, int part, Make&& make, Diagnostics& diagnostics) {
  const Part& p = model.parts[std::size_t(part)];
  if (p.material < 0) return {};
  const Material& m = model.materials[std::size_t(p.material)];
  if (m.card == nullptr) return {};
  std::optional<Law> law;
  try {
    law = make(m.law, CardParameters(model, *m.card));
  } catch (const std::invalid_argument& e) {
    diagnostics.error("discrete-law", m.card->where, m.law, "", e.what(), "correct the card");
    return {};
  }
  if (!law)
    diagnostics.error("unsupported-discrete-law", m.card->where, m.law, "",
                      "part " + std::to_string(p.id) + " uses this law for discrete elements",
                      "use one of the laws listed in docs/theory/discrete.md");
  return law;
}

// whether an orientation can be followed; an error says why not
bool usable(const Model& model, int orientation, const Location& where, Diagnostics& diagnostics) {
  if (orientation < 0) return true;
  const SdOrientation& o = model.sd_orientations[std::size_t(orientation)];
  const bool by_nodes = o.option == 2 || o.option == 3;
  if (o.option >= 0 && o.option <= 3 &&
      (by_nodes ? o.node[0] >= 0 && o.node[1] >= 0 : norm(o.direction) > 0))
    return true;
  diagnostics.error("unsupported-orientation", where, "DEFINE_SD_ORIENTATION", "iop",
                    "orientation " + std::to_string(o.id) +
                        " has no direction, lacks its nodes, or IOP is not 0 to 3",
                    "give XT, YT, ZT for IOP 0 and 1, NID1 and NID2 for IOP 2 and 3");
  return false;
}

std::string element_text(std::int64_t id) { return "discrete element " + std::to_string(id); }

}  // namespace

DiscreteElements::DiscreteElements(const Model& model, const State& state,
                                   Diagnostics& diagnostics) {
  spring_law_.resize(model.parts.size());
  beam_law_.resize(model.parts.size());
  node_to_local_.assign(std::size_t(model.nodes.size()), -1);
  add_springs(model, state, diagnostics);
  add_beams(model, state, diagnostics);
}

bool DiscreteElements::turn_nodes(const Model& model) {
  const auto torsional = [&](int part) {
    return model.parts[std::size_t(part)].section >= 0 && section_of(model, part).torsional == 1;
  };
  const auto beam = [&](int part) { return is_discrete_beam(model, part); };
  return std::any_of(model.discretes.part.begin(), model.discretes.part.end(), torsional) ||
         std::any_of(model.beams.part.begin(), model.beams.part.end(), beam);
}

int DiscreteElements::local_node(int node) {
  if (node < 0) return -1;
  int& local = node_to_local_[std::size_t(node)];
  if (local < 0) {
    local = int(nodes_.size());
    nodes_.push_back({node});
  }
  return local;
}

void DiscreteElements::add_springs(const Model& model, const State& state,
                                   Diagnostics& diagnostics) {
  const Discretes& d = model.discretes;
  spring_.resize(std::size_t(d.size()));
  std::vector<bool> tried(model.parts.size());
  for (std::size_t i = 0; i < spring_.size(); ++i) {
    const int part = d.part[i];
    if (!tried[std::size_t(part)]) {
      spring_law_[std::size_t(part)] = law_of<SpringLaw>(
          model, part, [](auto law, const Parameters& p) { return spring_law(law, p); },
          diagnostics);
      tried[std::size_t(part)] = true;
    }
    if (!spring_law_[std::size_t(part)]) continue;
    if (!usable(model, d.orientation[i], model.parts[std::size_t(part)].where, diagnostics))
      continue;
    Spring& s = spring_[i];
    s.law = part;
    s.node1 = d.node[i][0], s.node2 = d.node[i][1];
    s.local1 = local_node(s.node1), s.local2 = local_node(s.node2);
    s.orientation = d.orientation[i];
    // a blank scale factor means one
    s.scale = d.scale[i] != 0 ? d.scale[i] : 1.0;
    s.ground = state.nodes[std::size_t(s.node1)].x;
    if (model.parts[std::size_t(part)].section >= 0) {
      const Section& c = section_of(model, part);
      s.torsional = c.torsional == 1;
      s.dynamic_factor = c.dynamic_factor, s.test_velocity = c.test_velocity;
      s.clearance = c.clearance, s.failure = c.failure_deflection;
      s.shortest = c.deflection_limit_compression, s.longest = c.deflection_limit_tension;
    }
    check_spring(model, state, int(i), diagnostics);
    // the length at the start is what the first call measures
    s.elongation = 0;
    Spring probe = s;
    probe.alive = 1;
    if (!s.torsional) {
      s.rest = 0;
      probe.failure = 0;
      probe.rest = 0;
      pull_spring(model, state, probe);
      s.rest = probe.elongation - d.offset[i];
    } else {
      s.elongation = d.offset[i];
    }
  }
}

void DiscreteElements::check_spring(const Model& model, const State& state, int i,
                                    Diagnostics& diagnostics) const {
  const Spring& s = spring_[std::size_t(i)];
  const Location where = model.parts[std::size_t(s.law)].where;
  const std::string who = element_text(model.discretes.id[std::size_t(i)]);
  const Vec3d line = s.node2 < 0 ? Vec3d{0, 0, 0} : state.nodes[std::size_t(s.node2)].x - s.ground;
  const auto turns = [&](int node) {
    return node >= 0 && !state.spins.empty() &&
           (state.spins[std::size_t(node)].inertia > 0 ||
            state.owner[std::size_t(node)] == NodeOwner::rigid);
  };
  if (s.torsional && !turns(s.node1) && !turns(s.node2))
    diagnostics.error("spring-without-rotations", where, "ELEMENT_DISCRETE", "dro",
                      who + " is torsional, but none of its nodes has a rotary inertia",
                      "attach it to shells, beams, rigid bodies or *ELEMENT_INERTIA");
  if (s.orientation < 0 && norm(line) == 0)
    diagnostics.warning("spring-without-axis", where, "ELEMENT_DISCRETE", "vid",
                        who + " has no length and no orientation: its axis follows the motion",
                        "give a *DEFINE_SD_ORIENTATION");
  if (s.orientation < 0 || s.torsional || norm(line) == 0) return;
  const SdOrientation& o = model.sd_orientations[std::size_t(s.orientation)];
  if (o.option != 0) return;
  if (norm(cross(unit_or_zero(o.direction), unit_or_zero(line))) > 1e-3)
    diagnostics.warning(
        "spring-makes-couple", where, "ELEMENT_DISCRETE", "vid",
        who + " acts along a direction that misses its nodes: its forces form a couple",
        "let the direction run through both nodes, or let the nodes coincide");
}

namespace {
Mat3d first_triad(const Model& model, const State& state, const Section& section, int beam) {
  if (section.local_system >= 0)
    return model.coordinate_systems[std::size_t(section.local_system)].axes;
  const auto& node = model.beams.node[std::size_t(beam)];
  const Vec3d x1 = state.nodes[std::size_t(node[0])].x;
  const Vec3d r = state.nodes[std::size_t(node[1])].x - x1;
  if (norm(r) == 0) return identity3<double>();
  Vec3d s = node[2] >= 0 ? state.nodes[std::size_t(node[2])].x - x1 : Vec3d{0, 0, 0};
  if (!model.beams.orientation.empty() && norm(s) == 0)
    s = model.beams.orientation[std::size_t(beam)];
  if (norm(cross(r, s)) > 1e-12 * norm(r) * std::max(norm(s), 1e-300))
    return orthonormal_rows(r, s);
  // no plane given: any axis that is well away from r
  return orthonormal_rows(r, std::fabs(r.x) < 0.9 * norm(r) ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0});
}
}  // namespace

void DiscreteElements::add_beams(const Model& model, const State& state, Diagnostics& diagnostics) {
  std::vector<bool> tried(model.parts.size());
  for (int i = 0; i < model.beams.size(); ++i) {
    const int part = model.beams.part[std::size_t(i)];
    if (!is_discrete_beam(model, part)) continue;
    const Section& c = section_of(model, part);
    if (!tried[std::size_t(part)]) {
      beam_law_[std::size_t(part)] = law_of<BeamLaw>(
          model, part, [](auto law, const Parameters& p) { return beam_law(law, p); }, diagnostics);
      tried[std::size_t(part)] = true;
      if (std::fabs(c.scoor) > 3 || c.scoor != std::round(c.scoor))
        diagnostics.error("unsupported-scoor", model.parts[std::size_t(part)].where, "SECTION_BEAM",
                          "scoor", "SCOOR is not one of -3 to 3",
                          "use 0 for zero length, 2 or -2 for finite length");
    }
    if (!beam_law_[std::size_t(part)]) continue;
    Beam b;
    b.index = i;
    b.law = part;
    b.node1 = model.beams.node[std::size_t(i)][0], b.node2 = model.beams.node[std::size_t(i)][1];
    b.local1 = local_node(b.node1), b.local2 = local_node(b.node2);
    b.tracking = int(c.scoor);
    b.frozen = {c.rrcon != 0, c.srcon != 0, c.trcon != 0};
    b.triad = first_triad(model, state, c, i);
    const Vec3d line = state.nodes[std::size_t(b.node2)].x - state.nodes[std::size_t(b.node1)].x;
    b.length = norm(line);
    if (std::abs(b.tracking) >= 2 && b.length > 0)
      b.triad = orthonormal_rows(line, row_of(b.triad, 1));
    b.rest = b.triad * line;
    beam_.push_back(b);
  }
}

void DiscreteElements::use_bodies(const RigidBodies& bodies) {
  for (int i = 0; i < bodies.size(); ++i) {
    const RigidBody& b = bodies[i];
    const Vec3d& I = b.motion.inertia;
    const double smallest = std::min({I.x, I.y, I.z});
    for (std::size_t k = 0; k < b.nodes.size() && b.motion.mass > 0; ++k) {
      const double turn = smallest > 0 ? dot(b.r[k], b.r[k]) / smallest : 0.0;
      use_mass(b.nodes[k], i, 1 / (1 / b.motion.mass + turn), smallest);
    }
  }
}

// The members that change during a run, in one place for both directions.
template <class Io>
void DiscreteElements::stream(Io&& io) {
  for (Spring& s : spring_) {
    io(s.alive), io(s.elongation), io(s.force), io(s.stiffness), io(s.damping);
    io(s.state), io(s.pull);
  }
  for (Beam& b : beam_) {
    io(b.alive), io(b.triad), io(b.u), io(b.resultant), io(b.stiffness), io(b.damping);
    io(b.state), io(b.pull);
  }
}

void DiscreteElements::save(std::ostream& out) const {
  const std::int64_t sizes[2] = {springs(), beams()};
  out.write(reinterpret_cast<const char*>(sizes), sizeof sizes);
  const auto write = [&](auto& value) {
    static_assert(std::is_trivially_copyable_v<std::remove_reference_t<decltype(value)>>);
    out.write(reinterpret_cast<const char*>(&value), sizeof value);
  };
  // stream() only reads here
  const_cast<DiscreteElements*>(this)->stream(write);
}

void DiscreteElements::load(std::istream& in) {
  std::int64_t sizes[2] = {-1, -1};
  in.read(reinterpret_cast<char*>(sizes), sizeof sizes);
  if (!in || sizes[0] != springs() || sizes[1] != beams())
    throw std::runtime_error("restart record of discrete elements does not fit this model");
  stream([&](auto& value) { in.read(reinterpret_cast<char*>(&value), sizeof value); });
  if (!in) throw std::runtime_error("restart record of discrete elements is cut short");
}

}  // namespace fabrica
