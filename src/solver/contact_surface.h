#pragma once
// Surfaces of contacts: segments of shells (both sides), of exterior faces of solids, of segment
// sets; and the nodes on them. Contact stiffness and thickness are those of the start
// (contact/penalty.h).
#include <array>
#include <cstdint>
#include <vector>

#include "base/diagnostics.h"
#include "model/model.h"

namespace fabrica {

// What the solver's set-up knows about elements. Sizes: parts, parts, parts, shells.
struct ContactInput {
  std::vector<double> part_bulk, part_youngs, part_poisson;
  std::vector<double> shell_thickness;
  double initial_dt = 0;
};

struct ContactSegment {
  int node[4];  // triangle: node[3] == node[2]
  int part = -1;
  int body = -1;  // rigid body all of it belongs to, or -1
  double half_thickness = 0;
  double stiffness = 0;  // with SLSFAC and SFS/SFM
  double limit = 0;      // deeper than this behind the surface: not in contact
  double reach = 0;      // the largest limit of it and of those that share a node with it
  double area = 0;
  double mass_per_area = 0;  // of the shell, of half the solid; 0: not known
  bool triangle = false;
  bool two_sided = true;  // false: the normal points out of a solid, or an oriented shell
  bool shell = false;
  std::uint8_t free_features =
      0;  // bit i: edge i -> i+1 belongs to no other segment; bit 4+i: corner i on such
};

struct ContactNode {
  int node = -1;
  int part = -1;
  int body = -1;
  double half_thickness = 0;
  double stiffness = 0;  // mean over the segments around it; infinite without any
  Vec3d normal{};        // mean outward normal where the segments have an outside; else zero
};

// A beam, or a free edge of a shell.
struct ContactEdge {
  int node[2];
  int part = -1;
  int body = -1;     // rigid body it belongs to, or -1
  int segment = -1;  // of the surface, whose edge it is
  double radius = 0;
  int side = -1;  // of a contact between two surfaces: 0 or 1; -1: both, or there is one surface
};

struct ContactSurface {
  std::vector<ContactSegment> segments;
  std::vector<ContactEdge> edges;  // where edges touch edges
  int unused_edges = 0;  // rims without thickness, folds and edges of solids, of such contacts
  std::vector<ContactNode> nodes;  // ascending node index
};

// What does not depend on the contact: which faces of solids are exterior, which nodes move
// together.
class SurfaceSource {
 public:
  SurfaceSource(const Model& model, const ContactInput& input);
  // Builds one side. reference: side b (MST, SFM ...). Nodes only, where the side is a node set.
  ContactSurface build(const Contact& contact, const ContactSide& side, bool reference) const;
  const std::vector<int>& node_body() const { return node_body_; }

 private:
  struct Face {
    std::array<int, 4> key;  // corners sorted; triangle: -1 first
    std::array<int, 4> node;
    int solid;
    double volume;
    bool exterior;
  };
  void collect_faces();
  void collect_shells();
  void describe_nodes();
  void find_bodies();
  const Face* across(const std::array<int, 4>& key, int solid) const;
  double thickness_behind(const Face& face, double enough) const;
  void add_solid_face(const Face& face, const Contact& contact, double scale,
                      ContactSurface& s) const;
  void add_shell(int shell, const Contact& contact, bool reference, ContactSurface& s) const;
  void add_set(const SegmentSet& set, const Contact& contact, bool reference,
               ContactSurface& s) const;
  std::vector<int> beams_of(const ContactSide& side) const;
  double beam_radius(int beam) const;
  void add_beam_edges(const ContactSide& side, ContactSurface& s) const;
  void add_shell_edges(ContactSurface& s) const;
  int sharp_edges(const ContactSurface& s) const;
  void add_beam_nodes(const ContactSide& side, ContactSurface& s) const;
  void add_set_nodes(const NodeSet& set, ContactSurface& s) const;
  double density(int part) const;
  void finish_segment(ContactSegment& segment) const;
  void orient(ContactSegment& segment, const Contact& contact) const;
  void collect_nodes(const Contact& contact, ContactSurface& s) const;

  const Model& model_;
  const ContactInput& input_;
  std::vector<Face> faces_;                                 // ascending key
  std::vector<std::pair<std::array<int, 4>, int>> shells_;  // key and element, ascending
  std::vector<int> node_body_,
      node_part_;                  // part: of a shell at the node, else of a solid, else -1
  std::vector<double> node_half_;  // half the thickness of the thickest shell at the node
};

// AUTOMATIC_GENERAL, and SOFT=2 with a DEPTH that ends in 5
bool edges_touch(const Contact& contact);
// Both surfaces as one, with edges that know their side.
ContactSurface join_edges(const ContactSurface& a, const ContactSurface& b);

// automatic kinds use shell thickness; the old kinds only with SHLTHK
bool uses_thickness(const Model& model, const Contact& contact);

}  // namespace fabrica
