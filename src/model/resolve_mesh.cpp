// Nodes and elements: user ids to indices; for each part the list of its elements.
#include <algorithm>

#include "model/resolve.h"

namespace fabrica {

void Resolver::resolve_nodes() {
  Nodes& nodes = model_.nodes;
  nodes_.reset(nodes.id.size());
  model_.node_map_.reserve(nodes.id.size());
  for (int i = 0; i < nodes.size(); ++i) {
    const std::int64_t id = nodes.id[i];
    const int first = nodes_.insert(id, i);
    if (first < 0) {
      model_.node_map_.emplace(id, i);
      continue;
    }
    if (may_report("duplicate-id"))
      diagnostics_.error("duplicate-id", builder_.staging_.node_where[i], "NODE", "nid",
                         "node " + std::to_string(id) + " is defined twice",
                         "Give one of the two another id, or remove it");
  }
}

int Resolver::element_node(std::int64_t id, std::int64_t element, const char* keyword,
                           Location where) {
  if (id == 0) return -1;
  const int index = nodes_.find(id);
  if (index < 0 && may_report("missing-node"))
    diagnostics_.error("missing-node", where, keyword, "",
                       "element " + std::to_string(element) + " names node " + std::to_string(id) +
                           ", which does not exist",
                       "Define the node, or correct the element");
  return index;
}

int Resolver::element_part(std::int64_t id, std::int64_t element, const char* keyword,
                           Location where, Family family) {
  const int index = part(id);
  if (index < 0) {
    if (may_report("missing-part"))
      diagnostics_.error("missing-part", where, keyword, "pid",
                         "element " + std::to_string(element) + " names part " +
                             std::to_string(id) + ", which does not exist",
                         "Define the part with *PART, or correct the element");
    return -1;
  }
  Part& p = model_.parts[index];
  const Family of_section = p.section >= 0 ? model_.sections[p.section].family : Family::none;
  if (p.family == Family::none) p.family = family;
  if ((p.family != family || (of_section != Family::none && of_section != family)) &&
      may_report("section-family-mismatch"))
    diagnostics_.error("section-family-mismatch", where, keyword, "pid",
                       "element " + std::to_string(element) + " belongs to part " +
                           std::to_string(id) + ", whose section is for another kind of element",
                       "Give the part a section of the kind of its elements");
  return index;
}

namespace {

// registers the id of an element; true if it is new
bool new_element(IdTable& table, std::int64_t id, int index) { return table.insert(id, index) < 0; }

}  // namespace

void Resolver::resolve_elements() {
  resolve_solids();
  resolve_shells();
  resolve_beams();
  resolve_discretes();
  resolve_masses();
}

void Resolver::resolve_solids() {
  Solids& solids = model_.solids;
  auto& staging = builder_.staging_;
  IdTable& ids = table("solid");
  ids.reset(solids.id.size());
  solids.part.resize(solids.id.size());
  solids.node.resize(solids.id.size());
  for (int i = 0; i < solids.size(); ++i) {
    const Location where = staging.solid_where[i];
    const std::int64_t id = solids.id[i];
    if (!new_element(ids, id, i) && may_report("duplicate-id"))
      diagnostics_.error("duplicate-id", where, "ELEMENT_SOLID", "eid",
                         "solid " + std::to_string(id) + " is defined twice",
                         "Give one of the two another id");
    solids.part[i] = element_part(staging.solid_part[i], id, "ELEMENT_SOLID", where, Family::solid);
    for (int k = 0; k < 10; ++k)
      solids.node[i][k] = element_node(staging.solid_nodes[i][k], id, "ELEMENT_SOLID", where);
  }
}

void Resolver::resolve_shells() {
  Shells& shells = model_.shells;
  auto& staging = builder_.staging_;
  IdTable& ids = table("shell");
  ids.reset(shells.id.size());
  shells.part.resize(shells.id.size());
  shells.node.resize(shells.id.size());
  if (!shells.thickness.empty()) shells.thickness.resize(shells.id.size());
  if (!shells.beta.empty()) shells.beta.resize(shells.id.size());
  for (int i = 0; i < shells.size(); ++i) {
    const Location where = staging.shell_where[i];
    const std::int64_t id = shells.id[i];
    if (!new_element(ids, id, i) && may_report("duplicate-id"))
      diagnostics_.error("duplicate-id", where, "ELEMENT_SHELL", "eid",
                         "shell " + std::to_string(id) + " is defined twice",
                         "Give one of the two another id");
    shells.part[i] = element_part(staging.shell_part[i], id, "ELEMENT_SHELL", where, Family::shell);
    for (int k = 0; k < 4; ++k)
      shells.node[i][k] = element_node(staging.shell_nodes[i][k], id, "ELEMENT_SHELL", where);
  }
}

void Resolver::resolve_beams() {
  Beams& beams = model_.beams;
  auto& staging = builder_.staging_;
  IdTable& ids = table("beam");
  ids.reset(beams.id.size());
  beams.part.resize(beams.id.size());
  beams.node.resize(beams.id.size());
  if (!beams.orientation.empty()) beams.orientation.resize(beams.id.size(), Vec3d{0, 0, 0});
  for (int i = 0; i < beams.size(); ++i) {
    const Location where = staging.beam_where[i];
    const std::int64_t id = beams.id[i];
    if (!new_element(ids, id, i) && may_report("duplicate-id"))
      diagnostics_.error("duplicate-id", where, "ELEMENT_BEAM", "eid",
                         "beam " + std::to_string(id) + " is defined twice",
                         "Give one of the two another id");
    beams.part[i] = element_part(staging.beam_part[i], id, "ELEMENT_BEAM", where, Family::beam);
    for (int k = 0; k < 3; ++k)
      beams.node[i][k] = element_node(staging.beam_nodes[i][k], id, "ELEMENT_BEAM", where);
  }
}

void Resolver::resolve_discretes() {
  Discretes& discretes = model_.discretes;
  auto& staging = builder_.staging_;
  IdTable& ids = table("discrete");
  ids.reset(discretes.id.size());
  discretes.part.resize(discretes.id.size());
  discretes.node.resize(discretes.id.size());
  discretes.orientation.resize(discretes.id.size());
  for (int i = 0; i < discretes.size(); ++i) {
    const Location where = staging.discrete_where[i];
    const std::int64_t id = discretes.id[i];
    const auto& n = staging.discrete_nodes[i];
    if (!new_element(ids, id, i) && may_report("duplicate-id"))
      diagnostics_.error("duplicate-id", where, "ELEMENT_DISCRETE", "eid",
                         "discrete element " + std::to_string(id) + " is defined twice",
                         "Give one of the two another id");
    discretes.part[i] =
        element_part(staging.discrete_part[i], id, "ELEMENT_DISCRETE", where, Family::discrete);
    for (int k = 0; k < 2; ++k)
      discretes.node[i][k] = element_node(n[k], id, "ELEMENT_DISCRETE", where);
    discretes.orientation[i] = reference("sd_orientation", n[2]);
    if (n[2] != 0 && discretes.orientation[i] < 0 && may_report("missing-sd-orientation"))
      diagnostics_.error("missing-sd-orientation", where, "ELEMENT_DISCRETE", "vid",
                         "there is no orientation " + std::to_string(n[2]),
                         "Define it with *DEFINE_SD_ORIENTATION, or leave VID blank");
  }
}

void Resolver::resolve_masses() {
  auto& staging = builder_.staging_;
  for (std::size_t i = 0; i < model_.masses.size(); ++i) {
    NodalMass& m = model_.masses[i];
    m.node = element_node(staging.mass_node[i], m.id, "ELEMENT_MASS", staging.mass_where[i]);
    m.part = part(staging.mass_part[i]);
  }
  for (std::size_t i = 0; i < model_.inertias.size(); ++i) {
    NodalInertia& m = model_.inertias[i];
    m.node =
        element_node(staging.inertia_node[i], m.id, "ELEMENT_INERTIA", staging.inertia_where[i]);
  }
}

// Compressed rows part -> elements for each family, elements in deck order.
void Resolver::index_parts() {
  const std::vector<int>* maps[5] = {nullptr, &model_.solids.part, &model_.shells.part,
                                     &model_.beams.part, &model_.discretes.part};
  for (int f = 1; f < 5; ++f) {
    Rows& rows = part_elements_[f];
    const std::vector<int>& part_of = *maps[f];
    rows.start.assign(model_.parts.size() + 1, 0);
    for (int p : part_of)
      if (p >= 0) ++rows.start[p + 1];
    for (std::size_t p = 1; p < rows.start.size(); ++p) rows.start[p] += rows.start[p - 1];
    rows.element.resize(std::size_t(rows.start.back()));
    std::vector<int> next(rows.start.begin(), rows.start.end() - 1);
    for (int e = 0; e < int(part_of.size()); ++e)
      if (part_of[e] >= 0) rows.element[next[part_of[e]]++] = e;
  }
}

std::vector<int> Resolver::elements_of_part(Family family, int part) const {
  const Rows& rows = part_elements_[int(family)];
  return {rows.element.begin() + rows.start[part], rows.element.begin() + rows.start[part + 1]};
}

int Resolver::element_count(Family family) const {
  switch (family) {
    case Family::solid:
      return model_.solids.size();
    case Family::shell:
      return model_.shells.size();
    case Family::beam:
      return model_.beams.size();
    case Family::discrete:
      return model_.discretes.size();
    case Family::none:
      break;
  }
  return 0;
}

// Appends the valid nodes of an element: beams without their orientation node.
void Resolver::element_nodes(Family family, int element, std::vector<int>& nodes) const {
  const auto take = [&](const auto& list, int count) {
    for (int k = 0; k < count; ++k)
      if (list[k] >= 0) nodes.push_back(list[k]);
  };
  switch (family) {
    case Family::solid:
      return take(model_.solids.node[element], 10);
    case Family::shell:
      return take(model_.shells.node[element], 4);
    case Family::beam:
      return take(model_.beams.node[element], 2);
    case Family::discrete:
      return take(model_.discretes.node[element], 2);
    case Family::none:
      return;
  }
}

std::vector<int> Resolver::nodes_of_elements(Family family,
                                             const std::vector<int>& elements) const {
  std::vector<int> nodes;
  for (int e : elements) element_nodes(family, e, nodes);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<int> Resolver::nodes_of_part(int part) const { return nodes_of_parts({part}); }

// Few nodes are sorted, many are marked: small parts of big models stay cheap.
std::vector<int> Resolver::nodes_of_parts(const std::vector<int>& parts) const {
  std::vector<int> nodes;
  for (int p : parts) {
    if (p < 0) continue;
    for (int f = 1; f < 5; ++f) {
      const Rows& rows = part_elements_[f];
      for (int i = rows.start[p]; i < rows.start[p + 1]; ++i)
        element_nodes(Family(f), rows.element[i], nodes);
    }
  }
  if (nodes.size() < model_.nodes.id.size() / 16) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }
  std::vector<std::uint8_t> used(model_.nodes.id.size(), 0);
  for (int n : nodes) used[n] = 1;
  nodes.clear();
  for (int n = 0; n < int(used.size()); ++n)
    if (used[n]) nodes.push_back(n);
  return nodes;
}

bool Resolver::in_box(const Box& box, int node) const {
  const Vec3d& x = model_.nodes.x[node];
  for (int k = 0; k < 3; ++k)
    if (x[k] < box.low[k] || x[k] > box.high[k]) return false;
  return true;
}

}  // namespace fabrica
