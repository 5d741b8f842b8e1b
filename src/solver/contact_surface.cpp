#include "solver/contact_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "contact/penalty.h"

namespace fabrica {
namespace {

struct Corners {
  int node[4];
  int count;
};

// a face without repeated corners
Corners distinct(const std::array<int, 4>& face) {
  Corners c{{-1, -1, -1, -1}, 0};
  for (int n : face)
    if (std::find(c.node, c.node + c.count, n) == c.node + c.count) c.node[c.count++] = n;
  return c;
}

std::array<int, 4> key_of(const Corners& c) {
  std::array<int, 4> key{-1, -1, -1, -1};
  std::copy(c.node, c.node + c.count, key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

using Faces = std::vector<std::array<int, 4>>;

// corner numbers of the faces; quadratic tetrahedra have four triangles a face
Faces local_faces(const std::array<int, 10>& n) {
  if (n[8] >= 0)
    return {{0, 6, 4, 4}, {6, 2, 5, 5}, {4, 5, 1, 1}, {4, 6, 5, 5}, {0, 4, 7, 7}, {4, 1, 8, 8},
            {7, 8, 3, 3}, {4, 8, 7, 7}, {1, 5, 8, 8}, {5, 2, 9, 9}, {8, 9, 3, 3}, {5, 9, 8, 8},
            {2, 6, 9, 9}, {6, 0, 7, 7}, {9, 7, 3, 3}, {6, 7, 9, 9}};
  if (n[4] < 0) return {{0, 2, 1, 1}, {0, 1, 3, 3}, {1, 2, 3, 3}, {2, 0, 3, 3}};
  if (n[6] < 0) return {{0, 1, 4, 4}, {1, 2, 5, 4}, {0, 4, 5, 3}, {0, 3, 2, 1}, {2, 3, 5, 5}};
  return {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
}

Vec3d area_vector(const std::vector<Vec3d>& x, const Corners& c) {
  const Vec3d& a = x[c.node[0]];
  if (c.count == 3) return 0.5 * cross(x[c.node[1]] - a, x[c.node[2]] - a);
  return 0.5 * cross(x[c.node[2]] - a, x[c.node[3]] - x[c.node[1]]);
}

Vec3d centre(const std::vector<Vec3d>& x, const Corners& c) {
  Vec3d sum{0, 0, 0};
  for (int i = 0; i < c.count; ++i) sum += x[c.node[i]];
  return (1.0 / c.count) * sum;
}

double longest_diagonal(const std::vector<Vec3d>& x, const ContactSegment& s) {
  const Vec3d &a = x[s.node[0]], &b = x[s.node[1]], &c = x[s.node[2]], &d = x[s.node[3]];
  if (s.triangle) return std::max({norm(b - a), norm(c - b), norm(a - c)});
  return std::max(norm(c - a), norm(d - b));
}

double shortest_edge(const std::vector<Vec3d>& x, const ContactSegment& s) {
  double shortest = 1e300;
  const int corners = s.triangle ? 3 : 4;
  for (int i = 0; i < corners; ++i)
    shortest = std::min(shortest, norm(x[s.node[(i + 1) % corners]] - x[s.node[i]]));
  return shortest;
}

}  // namespace

bool uses_thickness(const Model& model, const Contact& contact) {
  const bool old_kind = contact.kind == ContactKind::surface_to_surface ||
                        contact.kind == ContactKind::nodes_to_surface;
  return !old_kind || contact.shlthk > 0 || model.controls.shell_thickness_option > 0;
}

SurfaceSource::SurfaceSource(const Model& model, const ContactInput& input)
    : model_(model), input_(input) {
  collect_faces();
  collect_shells();
  find_bodies();
  describe_nodes();
}

void SurfaceSource::collect_faces() {
  const std::vector<Vec3d>& x = model_.nodes.x;
  for (int e = 0; e < model_.solids.size(); ++e) {
    const auto& n = model_.solids.node[e];
    std::vector<Face> own;
    Vec3d middle{0, 0, 0};
    int count = 0;
    for (int i = 0; i < 10 && n[i] >= 0; ++i) middle += x[n[i]], ++count;
    middle = (1.0 / count) * middle;
    double volume = 0;
    for (const auto& local : local_faces(n)) {
      Corners c = distinct({n[local[0]], n[local[1]], n[local[2]], n[local[3]]});
      if (c.count < 3) continue;
      // turn the normal out of the element
      double cone = dot(area_vector(x, c), centre(x, c) - middle) / 3;
      if (cone < 0) std::reverse(c.node, c.node + c.count), cone = -cone;
      volume += cone;
      if (c.count == 3) c.node[3] = c.node[2];
      own.push_back({key_of(distinct({c.node[0], c.node[1], c.node[2], c.node[3]})),
                     {c.node[0], c.node[1], c.node[2], c.node[3]},
                     e,
                     0,
                     true});
    }
    for (Face& f : own) f.volume = volume, faces_.push_back(f);
  }
  std::stable_sort(faces_.begin(), faces_.end(),
                   [](const Face& a, const Face& b) { return a.key < b.key; });
  for (std::size_t i = 1; i < faces_.size(); ++i)
    if (faces_[i].key == faces_[i - 1].key) faces_[i].exterior = faces_[i - 1].exterior = false;
}

void SurfaceSource::collect_shells() {
  for (int e = 0; e < model_.shells.size(); ++e)
    shells_.emplace_back(key_of(distinct(model_.shells.node[e])), e);
  std::sort(shells_.begin(), shells_.end());
}

// nodes that move together: rigid parts (merged ones as one), extra nodes, nodal rigid bodies
void SurfaceSource::find_bodies() {
  std::vector<int> lead(model_.parts.size());
  std::iota(lead.begin(), lead.end(), 0);
  auto root = [&](int p) {
    while (lead[p] != p) p = lead[p];
    return p;
  };
  for (const RigidMerge& m : model_.rigid_merges) lead[root(m.constrained)] = root(m.lead);
  node_body_.assign(model_.nodes.size(), -1);
  auto mark = [&](const auto& elements) {
    for (int e = 0; e < elements.size(); ++e) {
      if (elements.part[e] < 0 || !model_.parts[elements.part[e]].rigid) continue;
      for (int n : elements.node[e])
        if (n >= 0) node_body_[n] = root(elements.part[e]);
    }
  };
  mark(model_.solids), mark(model_.shells);
  for (int e = 0; e < model_.beams.size(); ++e)
    if (model_.beams.part[e] >= 0 && model_.parts[model_.beams.part[e]].rigid)
      for (int i = 0; i < 2; ++i) node_body_[model_.beams.node[e][i]] = root(model_.beams.part[e]);
  for (const ExtraNodes& extra : model_.extra_nodes)
    for (int n : extra.nodes) node_body_[n] = root(extra.part);
  for (std::size_t b = 0; b < model_.nodal_rigid_bodies.size(); ++b)
    for (int n : model_.nodal_rigid_bodies[b].nodes)
      if (node_body_[n] < 0) node_body_[n] = int(model_.parts.size() + b);
}

void SurfaceSource::describe_nodes() {
  node_half_.assign(model_.nodes.size(), 0);
  node_part_.assign(model_.nodes.size(), -1);
  for (int e = 0; e < model_.shells.size(); ++e)
    for (int n : model_.shells.node[e]) {
      node_half_[n] = std::max(node_half_[n], 0.5 * input_.shell_thickness[e]);
      node_part_[n] = model_.shells.part[e];
    }
  for (int e = 0; e < model_.solids.size(); ++e)
    for (int n : model_.solids.node[e])
      if (n >= 0 && node_part_[n] < 0) node_part_[n] = model_.solids.part[e];
}

double SurfaceSource::density(int part) const {
  const int material = model_.parts[part].material;
  return material < 0 ? 0 : model_.materials[material].density;
}

void SurfaceSource::finish_segment(ContactSegment& s) const {
  const int body = node_body_[s.node[0]];
  const bool same = std::all_of(s.node, s.node + 4, [&](int n) { return node_body_[n] == body; });
  s.body = same ? body : -1;
}

void SurfaceSource::add_solid_face(const Face& face, const Contact&, double scale,
                                   ContactSurface& s) const {
  ContactSegment g;
  std::copy(face.node.begin(), face.node.end(), g.node);
  g.triangle = g.node[3] == g.node[2];
  g.part = model_.solids.part[face.solid];
  g.two_sided = false;
  g.area = norm(area_vector(model_.nodes.x, distinct(face.node)));
  const auto& contact = model_.parts[g.part].contact;
  if (contact && contact->stiffness_scale > 0) scale *= contact->stiffness_scale;
  g.stiffness = scale * solid_face_stiffness(input_.part_bulk[g.part], g.area, face.volume);
  const double own = g.area > 0 ? face.volume / g.area : 0, flat = 0.5 * std::sqrt(g.area);
  g.limit = 0.5 * (own < flat ? thickness_behind(face, flat) : own);
  g.mass_per_area = 0.5 * density(g.part) * own;
  finish_segment(g);
  s.segments.push_back(g);
}

// the other solid on that face; null where there is none
const SurfaceSource::Face* SurfaceSource::across(const std::array<int, 4>& key, int solid) const {
  auto f = std::lower_bound(faces_.begin(), faces_.end(), key,
                            [](const Face& a, const auto& k) { return a.key < k; });
  while (f != faces_.end() && f->key == key && f->solid == solid) ++f;
  return f != faces_.end() && f->key == key ? &*f : nullptr;
}

// A thin layer on a body is no thin plate: thickness of the bricks that lie one behind the other
// under a face, until they are enough or end.
double SurfaceSource::thickness_behind(const Face& face, double enough) const {
  constexpr int opposite[6] = {1, 0, 4, 5, 2, 3};
  double sum = 0;
  for (const Face* f = &face; f;) {
    const double area = norm(area_vector(model_.nodes.x, distinct(f->node)));
    if (area > 0) sum += f->volume / area;
    const auto& n = model_.solids.node[f->solid];
    if (sum >= enough || n[7] < 0 || n[8] >= 0) break;
    const Faces local = local_faces(n);
    const auto key = [&](std::size_t i) {
      return key_of(distinct({n[local[i][0]], n[local[i][1]], n[local[i][2]], n[local[i][3]]}));
    };
    const Face* next = nullptr;
    for (std::size_t i = 0; i < 6; ++i)
      if (key(i) == f->key) next = across(key(std::size_t(opposite[i])), f->solid);
    f = next;
  }
  return std::min(sum, enough);
}

void SurfaceSource::add_shell(int shell, const Contact& contact, bool reference,
                              ContactSurface& s) const {
  ContactSegment g;
  std::copy_n(model_.shells.node[shell].begin(), 4, g.node);
  g.triangle = g.node[3] == g.node[2];
  g.part = model_.shells.part[shell];
  const Corners corners = distinct(model_.shells.node[shell]);
  if (corners.count < 3) return;
  g.area = norm(area_vector(model_.nodes.x, corners));
  double scale = model_.controls.contact_scale * (reference ? contact.sfm : contact.sfs);
  const double given = reference ? contact.mst : contact.sst;
  double thickness = input_.shell_thickness[shell],
         factor = reference ? contact.sfmt : contact.sfst;
  if (const auto& p = model_.parts[g.part].contact) {
    if (p->stiffness_scale > 0) scale *= p->stiffness_scale;
    if (p->thickness > 0) thickness = p->thickness;
    if (p->thickness_scale > 0) factor *= p->thickness_scale;
  }
  if (given > 0) thickness = given;
  // thicker than the mesh is fine: a surface would touch itself
  thickness = std::min(thickness * factor, 0.8 * shortest_edge(model_.nodes.x, g));
  g.half_thickness = uses_thickness(model_, contact) ? 0.5 * thickness : 0;
  g.stiffness = scale * shell_stiffness(input_.part_bulk[g.part], g.area,
                                        longest_diagonal(model_.nodes.x, g));
  g.limit = std::max(g.half_thickness, 0.25 * std::sqrt(g.area));
  g.mass_per_area = density(g.part) * input_.shell_thickness[shell];
  orient(g, contact);
  finish_segment(g);
  s.segments.push_back(g);
}

// what lies behind an oriented shell penetrates, however thin the shell is
void SurfaceSource::orient(ContactSegment& g, const Contact& contact) const {
  g.shell = true, g.two_sided = !contact.oriented;
  if (contact.oriented) g.limit = contact.penmax > 0 ? contact.penmax : std::sqrt(g.area);
}

// A segment of a set takes after the shell or the exterior face that it lies on. The outside of a
// shell's segment is the one of the segment's own corners, which may run against the shell's.
void SurfaceSource::add_set(const SegmentSet& set, const Contact& contact, bool reference,
                            ContactSurface& s) const {
  const double scale = model_.controls.contact_scale * (reference ? contact.sfm : contact.sfs);
  for (const auto& segment : set.segments) {
    const Corners corners = distinct(segment);
    if (corners.count < 3) continue;
    const auto key = key_of(corners);
    const auto face = std::lower_bound(faces_.begin(), faces_.end(), key,
                                       [](const Face& f, const auto& k) { return f.key < k; });
    const auto shell = std::lower_bound(shells_.begin(), shells_.end(), std::pair(key, -1));
    if (shell != shells_.end() && shell->first == key) {
      add_shell(shell->second, contact, reference, s);
      ContactSegment& g = s.segments.back();
      std::copy_n(corners.node, corners.count, g.node);
      if (g.triangle) g.node[3] = g.node[2];
    } else if (face != faces_.end() && face->key == key) {
      add_solid_face(*face, contact, scale, s);
    } else {
      ContactSegment g;
      std::copy(segment.begin(), segment.end(), g.node);
      g.triangle = g.node[3] == g.node[2];
      g.area = norm(area_vector(model_.nodes.x, corners));
      g.stiffness = std::numeric_limits<double>::infinity();
      g.limit = 0.25 * std::sqrt(g.area);
      orient(g, contact);
      finish_segment(g);
      s.segments.push_back(g);
    }
  }
}

// of the round bar with the area of the section
double SurfaceSource::beam_radius(int beam) const {
  const Section& section = model_.sections[model_.parts[model_.beams.part[beam]].section];
  const double area = section.area > 0 ? section.area : M_PI / 4 * section.ts1 * section.ts1;
  return std::sqrt(area / M_PI);
}

std::vector<int> SurfaceSource::beams_of(const ContactSide& side) const {
  std::vector<bool> wanted(model_.parts.size(), false);
  for (int p : side.parts) wanted[p] = true;
  std::vector<int> beams;
  for (int e = 0; e < model_.beams.size(); ++e) {
    const int part = model_.beams.part[e];
    if (part >= 0 && wanted[part] && model_.parts[part].section >= 0) beams.push_back(e);
  }
  return beams;
}

void SurfaceSource::add_beam_nodes(const ContactSide& side, ContactSurface& s) const {
  for (int e : beams_of(side))
    for (int i = 0; i < 2; ++i) {
      ContactNode n;
      n.node = model_.beams.node[e][i], n.part = model_.beams.part[e],
      n.half_thickness = beam_radius(e);
      s.nodes.push_back(n);
    }
}

void SurfaceSource::add_beam_edges(const ContactSide& side, ContactSurface& s) const {
  for (int e : beams_of(side)) {
    const int a = model_.beams.node[e][0], b = model_.beams.node[e][1];
    const int body = node_body_[a] == node_body_[b] ? node_body_[a] : -1;
    s.edges.push_back({{a, b}, model_.beams.part[e], body, -1, beam_radius(e)});
  }
}

void SurfaceSource::add_shell_edges(ContactSurface& s) const {
  for (int g = 0; g < int(s.segments.size()); ++g) {
    const ContactSegment& segment = s.segments[g];
    const int corners = segment.triangle ? 3 : 4;
    for (int i = 0; i < corners && segment.shell; ++i) {
      if (!(segment.free_features >> i & 1)) continue;
      s.edges.push_back({{segment.node[i], segment.node[(i + 1) % corners]},
                         segment.part,
                         segment.body,
                         g,
                         segment.half_thickness});
      s.unused_edges += segment.half_thickness == 0;
    }
  }
  s.unused_edges += sharp_edges(s);
}

// edges inside the surface at which it turns by more than 60 degrees, or more than two segments
// meet
int SurfaceSource::sharp_edges(const ContactSurface& s) const {
  // of each segment around an edge: into it, square to the edge
  std::map<std::pair<int, int>, std::vector<Vec3d>> inwards;
  for (const ContactSegment& g : s.segments) {
    const int corners = g.triangle ? 3 : 4;
    Vec3d centre{0, 0, 0};
    for (int i = 0; i < corners; ++i) centre += (1.0 / corners) * model_.nodes.x[g.node[i]];
    for (int i = 0; i < corners; ++i) {
      const int a = g.node[i], b = g.node[(i + 1) % corners];
      const Vec3d &x = model_.nodes.x[a], along = model_.nodes.x[b] - x, to = centre - x;
      const double length = dot(along, along);
      if (length > 0) inwards[std::minmax(a, b)].push_back(to - (dot(to, along) / length) * along);
    }
  }
  int count = 0;
  for (const auto& [edge, t] : inwards)
    count += t.size() > 2 || (t.size() == 2 && dot(t[0], t[1]) > -0.5 * norm(t[0]) * norm(t[1]));
  return count;
}

bool edges_touch(const Contact& contact) {
  return contact.kind == ContactKind::automatic_general ||
         (contact.soft == 2 && contact.depth % 10 == 5);
}

ContactSurface join_edges(const ContactSurface& a, const ContactSurface& b) {
  ContactSurface s = a;
  std::map<std::pair<int, int>, std::size_t> known;
  for (std::size_t e = 0; e < s.edges.size(); ++e) {
    ContactEdge& edge = s.edges[e];
    edge.side = 0, known[std::minmax(edge.node[0], edge.node[1])] = e;
  }
  for (ContactEdge edge : b.edges) {
    const auto twin = known.find(std::minmax(edge.node[0], edge.node[1]));
    if (twin != known.end()) {
      s.edges[twin->second].side = -1;
      continue;
    }
    edge.side = 1;
    if (edge.segment >= 0) edge.segment += int(a.segments.size());
    s.edges.push_back(edge);
  }
  s.segments.insert(s.segments.end(), b.segments.begin(), b.segments.end());
  s.unused_edges += b.unused_edges;
  return s;
}

void SurfaceSource::add_set_nodes(const NodeSet& set, ContactSurface& s) const {
  for (int node : set.nodes) {
    ContactNode n;
    n.node = node, n.part = node_part_[node], n.half_thickness = node_half_[node];
    s.nodes.push_back(n);
  }
}

// one entry a node; stiffness the mean, thickness the largest of the segments around it; free edges
void SurfaceSource::collect_nodes(const Contact& contact, ContactSurface& s) const {
  std::map<int, ContactNode> nodes;
  std::map<int, std::pair<double, int>> stiffness;
  for (ContactNode& n : s.nodes) {
    if (!uses_thickness(model_, contact)) n.half_thickness = 0;
    if (contact.sst > 0 && n.half_thickness > 0 && s.segments.empty())
      n.half_thickness = contact.sst / 2;
    auto& entry = nodes.emplace(n.node, n).first->second;
    entry.half_thickness = std::max(entry.half_thickness, n.half_thickness);
  }
  std::map<std::pair<int, int>, int> edges;
  for (const ContactSegment& g : s.segments) {
    const int corners = g.triangle ? 3 : 4;
    for (int i = 0; i < corners; ++i) {
      const int a = g.node[i], b = g.node[(i + 1) % corners];
      ++edges[std::minmax(a, b)];
      ContactNode& n = nodes[a];
      n.node = a;
      if (n.part < 0) n.part = g.part;
      n.half_thickness = std::max(n.half_thickness, g.half_thickness);
      stiffness[a].first += g.stiffness, ++stiffness[a].second;
      if (!g.shell)
        n.normal +=
            area_vector(model_.nodes.x, distinct({g.node[0], g.node[1], g.node[2], g.node[3]}));
    }
  }
  std::vector<bool> on_edge(model_.nodes.size(), false);
  for (const auto& [edge, count] : edges)
    if (count == 1) on_edge[edge.first] = on_edge[edge.second] = true;
  for (ContactSegment& g : s.segments) {
    const int corners = g.triangle ? 3 : 4;
    for (int i = 0; i < corners; ++i) {
      if (edges[std::minmax(g.node[i], g.node[(i + 1) % corners])] == 1) g.free_features |= 1 << i;
      if (on_edge[g.node[i]]) g.free_features |= 16 << i;
    }
  }
  s.nodes.clear();
  for (auto& [index, n] : nodes) {
    const auto k = stiffness.find(index);
    n.stiffness = k == stiffness.end() ? std::numeric_limits<double>::infinity()
                                       : k->second.first / k->second.second;
    n.body = node_body_[index];
    const double size = norm(n.normal);
    if (size > 0) n.normal = (1 / size) * n.normal;
    s.nodes.push_back(n);
  }
}

ContactSurface SurfaceSource::build(const Contact& contact, const ContactSide& side,
                                    bool reference) const {
  ContactSurface s;
  using Kind = ContactSide::Kind;
  if (side.kind == Kind::segments) add_set(model_.segment_sets[side.set], contact, reference, s);
  if (side.kind == Kind::shells)
    for (int e : model_.element_sets[side.set].elements) add_shell(e, contact, reference, s);
  if (side.kind == Kind::nodes) add_set_nodes(model_.node_sets[side.set], s);
  if (side.kind == Kind::parts || side.kind == Kind::part || side.kind == Kind::all) {
    std::vector<bool> wanted(model_.parts.size(), false);
    for (int p : side.parts) wanted[p] = true;
    const double scale = model_.controls.contact_scale * (reference ? contact.sfm : contact.sfs);
    for (const Face& f : faces_)
      if (f.exterior && wanted[model_.solids.part[f.solid]]) add_solid_face(f, contact, scale, s);
    for (int e = 0; e < model_.shells.size(); ++e)
      if (model_.shells.part[e] >= 0 && wanted[model_.shells.part[e]])
        add_shell(e, contact, reference, s);
    add_beam_nodes(side, s);
    if (contact.kind == ContactKind::automatic_general) add_beam_edges(side, s);
  }
  // a box keeps what starts inside it
  if (side.box >= 0) {
    const Box& box = model_.boxes[side.box];
    auto outside = [&](int n) {
      const Vec3d& x = model_.nodes.x[n];
      for (int d = 0; d < 3; ++d)
        if (x[d] < box.low[d] || x[d] > box.high[d]) return true;
      return false;
    };
    std::erase_if(s.segments, [&](const ContactSegment& g) {
      return std::any_of(g.node, g.node + 4, outside);
    });
    std::erase_if(s.nodes, [&](const ContactNode& n) { return outside(n.node); });
    std::erase_if(s.edges,
                  [&](const ContactEdge& e) { return outside(e.node[0]) || outside(e.node[1]); });
  }
  collect_nodes(contact, s);
  if (edges_touch(contact)) add_shell_edges(s);
  return s;
}

}  // namespace fabrica
