#include "solver/contact.h"

#include <algorithm>
#include <istream>
#include <ostream>
#include <string>

#include "solver/contact_orientation.h"

namespace fabrica {
namespace {

bool is_tied(ContactKind k) {
  return k == ContactKind::tied_nodes_to_surface || k == ContactKind::tied_surface_to_surface ||
         k == ContactKind::tied_shell_edge_to_surface;
}

bool is_single(ContactKind k) {
  return k == ContactKind::automatic_single_surface || k == ContactKind::automatic_general;
}

bool is_two_way(ContactKind k) {
  return k == ContactKind::automatic_surface_to_surface || k == ContactKind::surface_to_surface;
}

void check_friction(const Model& model, const Contact& c, Diagnostics& diagnostics) {
  if (c.fs == -2 && !ContactFriction::table(model, c))
    diagnostics.error("missing-friction-table", c.where, "CONTACT", "fd",
                      "contact " + std::to_string(c.id) +
                          ": FS = -2 asks for a *DEFINE_FRICTION, but FD names none",
                      "Define it, and name it by FD where there are several");
}

// old kinds: shells given by parts turn to the other side, those of sets only where ORIEN asks
void orient(const Model& model, const Contact& c, ContactSurface& a, ContactSurface& b) {
  using Kind = ContactSide::Kind;
  const int option = model.controls.contact_orientation;
  if (!c.oriented || option == 3) return;
  auto wanted = [&](const ContactSide& s) {
    return option == 2 || s.kind == Kind::parts || s.kind == Kind::part || s.kind == Kind::all;
  };
  if (wanted(c.a)) face_each_other(a, b, model.nodes.x);
  if (wanted(c.b)) face_each_other(b, a, model.nodes.x);
}

}  // namespace

Contacts::Contacts(const Model& model, State& state, const ContactInput& input,
                   Diagnostics& diagnostics)
    : tied_(std::make_unique<TiedNodes>(model)), initial_dt_(input.initial_dt) {
  fixed_.resize(model.contacts.size());
  if (model.contacts.empty()) return;
  const SurfaceSource source(model, input);
  for (int c = 0; c < int(model.contacts.size()); ++c) {
    const Contact& contact = model.contacts[c];
    fixed_[c].contact = c;
    if (!is_tied(contact.kind)) continue;
    const ContactSurface a = source.build(contact, contact.a, false);
    const ContactSurface b = source.build(contact, contact.b, true);
    for (const ContactNode& n : a.nodes) fixed_[c].mass_a += state.nodes[n.node].mass;
    for (const ContactNode& n : b.nodes) fixed_[c].mass_b += state.nodes[n.node].mass;
    tied_->add(c, a, b, state, input.initial_dt, diagnostics);
  }
  tied_->finish(state);
  carriers_ = tied_->carriers();
  for (int c = 0; c < int(model.contacts.size()); ++c) {
    if (is_tied(model.contacts[c].kind)) continue;
    if (model.contacts[c].kind == ContactKind::force_transducer)
      add_transducer(model, c, source);
    else
      add_contact(model, c, source, diagnostics);
  }
  for (std::size_t p = 0; p < passes_.size(); ++p) {
    stable_time_step_ = std::min(stable_time_step_, passes_[p]->stable_time_step(state));
    Resultant& r = fixed_[passes_[p]->contact_index()];
    double mass = 0, other = 0;
    for (const ContactNode& n : passes_[p]->tracked().nodes) mass += state.nodes[n.node].mass;
    for (const ContactNode& n : passes_[p]->reference().nodes) other += state.nodes[n.node].mass;
    const bool single = is_single(model.contacts[passes_[p]->contact_index()].kind);
    if (!second_pass_[p]) r.mass_a = mass, r.mass_b = single ? 0 : other;
  }
  report_.tied_nodes = tied_->count();
  report_.untied_nodes = tied_->untied();
}

void Contacts::add_contact(const Model& model, int index, const SurfaceSource& source,
                           Diagnostics& diagnostics) {
  const Contact& contact = model.contacts[index];
  check_friction(model, contact, diagnostics);
  auto add = [&](ContactSurface tracked, ContactSurface reference, bool second) {
    passes_.push_back(std::make_unique<ContactPass>(model, contact, index, std::move(tracked),
                                                    std::move(reference), carriers_));
    second_pass_.push_back(second);
  };
  ContactSurface a = source.build(contact, contact.a, false);
  if (is_single(contact.kind)) {
    if (edges_touch(contact)) add_edges(model, index, a, diagnostics);
    if (contact.soft == 2)
      segment_passes_.push_back(
          std::make_unique<SegmentPass>(model, contact, index, a, a, true, carriers_));
    return add(a, a, false);
  }
  ContactSurface b = source.build(contact, contact.b, true);
  if (b.segments.empty())
    diagnostics.warning(
        "contact-no-segments", contact.where, "CONTACT", "msid",
        "contact " + std::to_string(contact.id) + ": the reference side has no segments",
        "Check the set or part of the reference side");
  orient(model, contact, a, b);
  if (edges_touch(contact)) add_edges(model, index, join_edges(a, b), diagnostics);
  if (contact.soft == 2)
    segment_passes_.push_back(
        std::make_unique<SegmentPass>(model, contact, index, a, b, false, carriers_));
  add(a, b, false);
  if (is_two_way(contact.kind) && !a.segments.empty()) add(std::move(b), std::move(a), true);
}

void Contacts::add_edges(const Model& model, int index, ContactSurface surface,
                         Diagnostics& diagnostics) {
  const Contact& contact = model.contacts[index];
  if (contact.kind != ContactKind::automatic_general && surface.unused_edges > 0)
    diagnostics.warning(
        "contact-edges", contact.where, "CONTACT", "depth",
        "contact " + std::to_string(contact.id) + ": DEPTH = " + std::to_string(contact.depth) +
            " asks for edges against edges; free edges of shells touch each other, but " +
            std::to_string(surface.unused_edges) +
            " others do not (folds and branches of shells, edges of solids, shells without "
            "thickness)",
        "Surfaces and nodes still touch there; look at the run where two such edges may cross");
  edge_passes_.push_back(
      std::make_unique<EdgePass>(model, contact, index, std::move(surface), carriers_));
}

void Contacts::add_transducer(const Model& model, int index, const SurfaceSource& source) {
  const Contact& contact = model.contacts[index];
  Transducer t{index, std::vector<char>(model.nodes.size(), 0), {}};
  for (const ContactNode& n : source.build(contact, contact.a, false).nodes) t.in_a[n.node] = 1;
  if (contact.b.kind != ContactSide::Kind::none) {
    t.in_b.assign(model.nodes.size(), 0);
    for (const ContactNode& n : source.build(contact, contact.b, true).nodes) t.in_b[n.node] = 1;
  }
  transducers_.push_back(std::move(t));
}

void Contacts::forces(const Model&, State& state, Team& team) {
  const double dt = state.dt;
  // the first forces have no step behind them: stiffness that depends on one takes the expected
  // step
  for (auto& pass : passes_) pass->forces(state, team, dt > 0 ? dt : initial_dt_);
  for (auto& pass : segment_passes_) pass->forces(state, team, dt > 0 ? dt : initial_dt_);
  for (auto& pass : edge_passes_) pass->forces(state, dt > 0 ? dt : initial_dt_);
  tied_->forces(state);
  if (!report_complete_) complete_report();
}

void Contacts::complete_report() {
  report_complete_ = true;
  for (const auto& pass : passes_)
    for (const InitialPenetration& p : pass->initial_penetrations()) report_.worst.push_back(p);
  for (const auto& pass : segment_passes_)
    for (const InitialPenetration& p : pass->initial_penetrations()) report_.worst.push_back(p);
  for (const auto& pass : edge_passes_)
    for (const InitialPenetration& p : pass->initial_penetrations()) report_.worst.push_back(p);
  report_.penetrating_nodes = int(report_.worst.size());
  std::stable_sort(report_.worst.begin(), report_.worst.end(),
                   [](const auto& a, const auto& b) { return a.depth > b.depth; });
  if (report_.worst.size() > 20) report_.worst.resize(20);
  if (!report_.worst.empty()) report_.largest_penetration = report_.worst[0].depth;
}

void Contacts::account(State& state) {
  for (auto& pass : passes_) pass->account(state);
  for (auto& pass : segment_passes_) pass->account(state);
  for (auto& pass : edge_passes_) pass->account(state);
  tied_->account(state);
}

void Contacts::transfer_tied_forces(State& state, Team&) { tied_->transfer_forces(state); }
void Contacts::place_tied_nodes(State& state, Team&) { tied_->place_nodes(state); }

std::vector<ContactCheck> Contacts::checks() const {
  std::vector<ContactCheck> list;
  auto add = [&](const auto& pass) {
    ContactCheck c{pass->contact_index(), int(pass->initial_penetrations().size()), 0,
                   pass->penetration()};
    for (const InitialPenetration& p : pass->initial_penetrations())
      c.initial_depth = std::max(c.initial_depth, p.depth);
    list.push_back(c);
  };
  for (const auto& pass : passes_) add(pass);
  for (const auto& pass : segment_passes_) add(pass);
  for (const auto& pass : edge_passes_) add(pass);
  return list;
}

std::vector<Contacts::Resultant> Contacts::resultants() const {
  std::vector<Resultant> list = fixed_;
  for (std::size_t p = 0; p < passes_.size(); ++p) {
    const ContactPass& pass = *passes_[p];
    Resultant& r = list[pass.contact_index()];
    Vec3d sum{0, 0, 0};
    for (const auto& chunk : pass.active_forces())
      for (const ContactForce& f : chunk) sum += f.normal + f.friction;
    // a surface against itself has no sides: the sums cancel
    if (&pass.tracked() != &pass.reference() && r.mass_b != 0) {
      r.side_a += second_pass_[p] ? -sum : sum;
      r.side_b += second_pass_[p] ? sum : -sum;
    }
    (second_pass_[p] ? r.energy_b : r.energy_a) += pass.energy();
    r.friction_energy += pass.friction_energy();
  }
  for (const auto& pass : segment_passes_) {
    Resultant& r = list[pass->contact_index()];
    Vec3d sum{0, 0, 0};
    for (const auto& chunk : pass->active_forces())
      for (const SegmentForce& f : chunk) sum += f.normal + f.friction;
    if (r.mass_b != 0) r.side_a += sum, r.side_b -= sum;
    r.energy_a += 0.5 * pass->energy(), r.energy_b += 0.5 * pass->energy();
    r.friction_energy += pass->friction_energy();
  }
  for (const auto& pass : edge_passes_) {
    Resultant& r = list[pass->contact_index()];
    if (r.mass_b != 0)
      for (const EdgeForce& f : pass->active_forces()) {
        // the first edge lies on side a unless the second lies there alone
        const bool swapped = pass->surface().edges[f.second].side == 0;
        const Vec3d total = swapped ? -(f.normal + f.friction) : f.normal + f.friction;
        r.side_a += total, r.side_b -= total;
      }
    r.energy_a += 0.5 * pass->energy(), r.energy_b += 0.5 * pass->energy();
    r.friction_energy += pass->friction_energy();
  }
  for (Resultant& r : list)
    if (r.contact >= 0 && tied_->has_ties(r.contact)) {
      r.side_a = tied_->force_of(r.contact);
      r.side_b = -r.side_a;
    }
  add_to_transducers(list);
  return list;
}

// visit(a node of the side that gets the force, a node of the other side, force)
template <class Visit>
void Contacts::each_force(Visit visit) const {
  for (const auto& pass : passes_)
    for (const auto& chunk : pass->active_forces())
      for (const ContactForce& f : chunk)
        visit(f.node, pass->reference().segments[f.segment].node[0], f.normal + f.friction);
  for (const auto& pass : segment_passes_)
    for (const auto& chunk : pass->active_forces())
      for (const SegmentForce& f : chunk)
        visit(pass->first().segments[f.first].node[0], pass->second().segments[f.second].node[0],
              f.normal + f.friction);
  for (const auto& pass : edge_passes_)
    for (const EdgeForce& f : pass->active_forces())
      visit(pass->surface().edges[f.first].node[0], pass->surface().edges[f.second].node[0],
            f.normal + f.friction);
}

void Contacts::add_to_transducers(std::vector<Resultant>& list) const {
  for (const Transducer& t : transducers_) {
    Resultant& r = list[t.contact];
    r.contact = t.contact;
    const bool any = t.in_b.empty();
    each_force([&](int node, int other, const Vec3d& total) {
      if (t.in_a[node] && (any || t.in_b[other])) r.side_a += total, r.side_b -= total;
      if (t.in_a[other] && (any || t.in_b[node])) r.side_a -= total, r.side_b += total;
    });
  }
}

void Contacts::save(std::ostream& out) const {
  tied_->save(out);
  for (const auto& pass : passes_) pass->save(out);
  for (const auto& pass : segment_passes_) pass->save(out);
  for (const auto& pass : edge_passes_) pass->save(out);
}
void Contacts::load(std::istream& in) {
  tied_->load(in);
  for (auto& pass : passes_) pass->load(in);
  for (auto& pass : segment_passes_) pass->load(in);
  for (auto& pass : edge_passes_) pass->load(in);
}

}  // namespace fabrica
