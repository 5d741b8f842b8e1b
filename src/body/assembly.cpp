#include "body/assembly.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "body/cards.h"
#include "body/materials.h"
#include "body/mesh/shell_layer.h"

namespace fabrica::body {
namespace {

using Id = std::int64_t;

// counters of ids, one block of a million a region
struct RegionIds {
  Id node, element, part;
  explicit RegionIds(Region region) : node(int(region) * 1000000), element(node), part(node) {}
};

class Assembly {
 public:
  Assembly(const Body& body, const AssemblyOptions& options, Builder& builder)
      : body_(body), options_(options), builder_(builder), materials_(builder, options.fracture) {
    for (int r = 0; r <= int(Region::leg); ++r) ids_.emplace_back(Region(r));
  }
  AssembledBody run() {
    sections();
    for (std::size_t b = 0; b < body_.bones.size(); ++b) bone(int(b));
    for (std::size_t p = 0; p < body_.between.pieces.size(); ++p) piece(int(p));
    if (options_.contacts)
      for (const ContactPair& pair : body_.between.contacts) contact(pair);
    for (const Tie& tie : body_.between.ties) tied(tie);
    part_set();
    controls();
    return std::move(out_);
  }

 private:
  static constexpr Id solid_section = 1, bone_shell_section = 2, bending_section = 3,
                      stiff_hourglass = 1, layer_hourglass = 2, cortex_hourglass = 3,
                      disc_hourglass = 4;
  // Of a flat brick of thickness h under the mode u = d xi (1 + zeta) / 2 the law holds
  // QM C A d^2 / (4 h), full integration C A d^2 / (6 h), C = K + 4 G / 3.
  static constexpr double flat_brick = 2.0 / 3.0;
  static constexpr double tie_reach = 30;  // [mm]

  RegionIds& ids(Region region) { return ids_[std::size_t(region)]; }
  // bricks with one point; shells lie under the surface of the bone (NLOC 1), each with its own
  // thickness
  void sections() {
    titled(builder_, "SECTION_SOLID", "bricks")
        .set("secid", double(solid_section))
        .set("elform", 1);
    titled(builder_, "SECTION_SOLID", "bricks that bend, integrated in full")
        .set("secid", double(bending_section))
        .set("elform", -1);
    Card& shell = titled(builder_, "SECTION_SHELL", "cortex under the surface of the bone");
    shell.set("secid", double(bone_shell_section))
        .set("elform", 2)
        .set("shrf", 0.8333)
        .set("nip", 3)
        .set("nloc", 1);
    for (const char* t : {"t1", "t2", "t3", "t4"}) shell.set(t, 1);
    Card& h = titled(builder_, "HOURGLASS", "stiffness form for bone and cartilage");
    h.set("hgid", stiff_hourglass).set("ihq", 5).set("qm", 0.1);
    titled(builder_, "HOURGLASS", "layers on bone: flat bricks as if integrated in full")
        .set("hgid", layer_hourglass)
        .set("ihq", 5)
        .set("qm", flat_brick);
    // the usual coefficient; what the viscous default takes is lost (docs/theory/elements/shell.md)
    titled(builder_, "HOURGLASS", "stiffness form for cortical shells")
        .set("hgid", cortex_hourglass)
        .set("ihq", 4)
        .set("qm", 0.05);
    // nearly incompressible: IHQ 5 would take its stiffness from the bulk modulus, hundreds of
    // times that of shear, and hold a nucleus that its law lets bend
    titled(builder_, "HOURGLASS", "assumed strain for discs")
        .set("hgid", disc_hourglass)
        .set("ihq", 6)
        .set("qm", 1);
  }

  Id part(Region region, const std::string& name, Id section, Id material, Id hourglass,
          PartEntry entry) {
    const Id id = ++ids(region).part;
    Card& c = builder_.add_card("PART");
    c.title = name;
    c.set("pid", double(id)).set("secid", double(section)).set("mid", double(material));
    if (hourglass) c.set("hgid", double(hourglass));
    entry.id = id, entry.name = name;
    out_.parts.push_back(entry);
    return id;
  }

  // tissue of a layer of bricks
  static const char* tissue(const PlacedBone& bone, int layer) {
    static const char* const vault[] = {"trabecular", "outer_table", "diploe", "inner_table"};
    if (bone.mesh.name == "skull") return vault[layer];
    if (bone.mesh.name.starts_with("costal_cartilage")) return "cartilage";
    return layer == 1 ? "cortical" : "trabecular";
  }
  static std::string material_of(const PlacedBone& bone, const BoneMaterial& rows, int layer) {
    static const char* const vault[] = {"skull_trabecular", "skull_outer", "skull_diploe",
                                        "skull_inner"};
    if (bone.mesh.name == "skull") return vault[layer];
    return layer == 1 ? rows.cortical : rows.trabecular;
  }

  void bone(int index) {
    const PlacedBone& bone = body_.bones[std::size_t(index)];
    RegionIds& counter = ids(bone.region);
    std::vector<Id> node;
    node.reserve(bone.nodes.size());
    for (const Point& x : bone.nodes)
      builder_.add_node(++counter.node, to_field(x)), node.push_back(counter.node);
    out_.bone_node.push_back(node);
    const BoneMaterial rows = bone_material(bone.mesh.name);
    const bool rigid = rows.rigid_at_coarse && body_.resolution == Resolution::coarse;
    out_.bone_brick.emplace_back(), out_.bone_shell.emplace_back();
    bricks(index, bone, rows, rigid, node);
    if (!rigid) cortex(index, bone, rows, node);
  }

  void bricks(int index, const PlacedBone& bone, const BoneMaterial& rows, bool rigid,
              const std::vector<Id>& node) {
    std::map<int, Id> part_of_layer;
    for (std::size_t e = 0; e < bone.mesh.bricks.size(); ++e) {
      const int layer = rigid ? 0 : bone.mesh.brick_layer[e];
      if (!part_of_layer.count(layer)) {
        const std::string row = rigid ? "small_bone" : material_of(bone, rows, layer);
        // costal cartilage carries bending in its bricks alone, two or three over the height
        const bool bends = !rigid && bone.mesh.name.starts_with("costal_cartilage");
        // each rigid bone is a body of its own: parts that share a rigid material stay apart
        part_of_layer[layer] =
            part(bone.region, part_name(bone, rigid ? "whole" : tissue(bone, layer)),
                 bends ? bending_section : solid_section, materials_.use(row, bone.faster),
                 rigid || bends ? 0 : stiff_hourglass, {0, "", row, "", index, -1, 0, rigid});
        entry_of_[part_of_layer[layer]] = out_.parts.size() - 1;
      }
      std::array<Id, 8> corner{};
      for (std::size_t k = 0; k < 8; ++k) corner[k] = node[std::size_t(bone.mesh.bricks[e][k])];
      builder_.add_solid(++ids(bone.region).element, part_of_layer[layer], corner.data(), 8);
      out_.bone_brick.back().push_back(ids(bone.region).element);
      ++out_.parts[entry_of_[part_of_layer[layer]]].elements;
    }
  }

  // shells on the surface where the cortex is thin
  void cortex(int index, const PlacedBone& bone, const BoneMaterial& rows,
              const std::vector<Id>& node) {
    if (bone.mesh.cortex.empty()) return;
    out_.bone_shell.back().assign(bone.mesh.surface.size(), 0);
    Id pid = 0;
    bool solid = false;
    for (const int layer : bone.mesh.brick_layer)
      solid = solid || (layer == 1 && bone.mesh.name != "skull");
    const std::vector<double> shell = shell_thickness(bone.mesh, bone.mesh.cortex);
    for (std::size_t q = 0; q < bone.mesh.surface.size(); ++q) {
      const double t = to_field(shell[q]);
      if (t <= 0) continue;
      if (!pid) {
        const std::string name = bone.mesh.name.starts_with("costal_cartilage") ? "perichondrium"
                                 : solid                                        ? "cortical_shell"
                                                                                : "cortical";
        pid = part(bone.region, part_name(bone, name), bone_shell_section,
                   materials_.use(rows.cortical, bone.faster), cortex_hourglass,
                   {0, "", rows.cortical, "", index, -1, 0, false});
      }
      std::array<Id, 4> corner{};
      for (std::size_t k = 0; k < 4; ++k) corner[k] = node[std::size_t(bone.mesh.surface[q][k])];
      const double thickness[4] = {t, t, t, t};
      builder_.add_shell(++ids(bone.region).element, pid, corner.data(), 4, thickness);
      out_.bone_shell.back()[q] = ids(bone.region).element;
      ++out_.parts.back().elements;
    }
  }

  Id id_of(const PieceNode& n) const {
    if (n.bone >= 0) return out_.bone_node[std::size_t(n.bone)][std::size_t(n.node)];
    return out_.piece_node[std::size_t(n.piece)][std::size_t(n.node)];
  }

  Id piece_section(const Piece& p) {
    const Id id = ++last_section_;
    switch (p.kind) {
      case PieceKind::brick:
        titled(builder_, "SECTION_SOLID", p.name)
            .set("secid", double(id))
            .set("elform", p.formulation ? p.formulation : 1);
        break;
      case PieceKind::shell:
      case PieceKind::membrane: {
        Card& c = titled(builder_, "SECTION_SHELL", p.name);
        c.set("secid", double(id))
            .set("elform", p.formulation                ? p.formulation
                           : p.kind == PieceKind::shell ? 2
                                                        : 5);
        c.set("nip", p.kind == PieceKind::shell ? 3 : 1);
        for (const char* t : {"t1", "t2", "t3", "t4"}) c.set(t, p.thickness);
        break;
      }
      case PieceKind::truss:
        titled(builder_, "SECTION_BEAM", p.name)
            .set("secid", double(id))
            .set("elform", 3)
            .set("a3", p.area);
        break;
      case PieceKind::spring:
        titled(builder_, "SECTION_DISCRETE", p.name).set("secid", double(id)).set("dro", 0);
        break;
    }
    return id;
  }

  void piece(int index) {
    const Piece& p = body_.between.pieces[std::size_t(index)];
    RegionIds& counter = ids(p.region);
    std::vector<Id> node;
    for (const PieceNode& n : p.nodes) {
      if (n.bone < 0 && n.piece < 0)
        builder_.add_node(++counter.node, to_field(n.x)), node.push_back(counter.node);
      else
        node.push_back(id_of(n));
    }
    out_.piece_node.push_back(node);
    if (p.bricks.empty() && p.quads.empty() && p.lines.empty()) return;
    const Id material =
        p.material.empty() ? materials_.add(p.name, p.law) : materials_.use(p.material);
    // a layer on one bone takes contact forces at single nodes: without stiffness its one-point
    // bricks give way in modes that strain nothing
    const bool brick = p.kind == PieceKind::brick, layer = brick && p.bone_a == p.bone_b;
    const Id pid = part(p.region, p.name, piece_section(p), material,
                        layer   ? layer_hourglass
                        : brick ? disc_hourglass
                                : 0,
                        {0, "", p.material.empty() ? p.law.keyword : p.material, p.source, -1,
                         index, int(p.bricks.size() + p.quads.size() + p.lines.size()), false});
    piece_elements(p, pid, node);
  }

  void piece_elements(const Piece& p, Id pid, const std::vector<Id>& node) {
    Id& element = ids(p.region).element;
    for (const auto& b : p.bricks) {
      std::array<Id, 8> corner{};
      for (std::size_t k = 0; k < 8; ++k) corner[k] = node[std::size_t(b[k])];
      builder_.add_solid(++element, pid, corner.data(), 8);
    }
    for (const auto& q : p.quads) {
      std::array<Id, 4> corner{};
      for (std::size_t k = 0; k < 4; ++k) corner[k] = node[std::size_t(q[k])];
      builder_.add_shell(++element, pid, corner.data(), 4);
    }
    for (std::size_t i = 0; i < p.lines.size(); ++i) {
      const Id a = node[std::size_t(p.lines[i][0])], b = node[std::size_t(p.lines[i][1])];
      if (p.kind == PieceKind::truss)
        builder_.add_beam(++element, pid, a, b, 0);
      else
        builder_.add_discrete(++element, pid, a, b, 0, p.line_scale.empty() ? 1 : p.line_scale[i],
                              0);
    }
  }

  Id segment_set(const std::string& title, const SurfacePatch& patch) {
    Card& c = titled(builder_, "SET_SEGMENT", title);
    c.set("sid", double(++last_set_));
    for (const auto& q : patch.quads)
      c.add_row({double(id_of(q[0])), double(id_of(q[1])), double(id_of(q[2])), double(id_of(q[3])),
                 0, 0, 0, 0});
    return last_set_;
  }

  void contact(const ContactPair& pair) {
    if (pair.a.quads.empty() || pair.b.quads.empty()) return;
    const Id a = segment_set(pair.name + ".a", pair.a), b = segment_set(pair.name + ".b", pair.b);
    Card& c = builder_.add_card("CONTACT_AUTOMATIC_SURFACE_TO_SURFACE");
    c.options = {"ID"};
    c.set("cid", double(++last_contact_)).set("heading", pair.name);
    c.set("ssid", double(a)).set("msid", double(b)).set("sstyp", 0).set("mstyp", 0);
    c.set("fs", pair.friction).set("fd", pair.friction);
    c.set("soft", 1).set("ignore", 1);
  }

  void tied(const Tie& tie) {
    if (tie.a.empty() || tie.b.quads.empty()) return;
    Card& set = titled(builder_, "SET_NODE_LIST", tie.name + ".nodes");
    const Id nodes = ++last_set_;
    set.set("sid", double(nodes));
    add_ids(set, tie.a.size(), [&](std::size_t i) { return id_of(tie.a[i]); });
    const Id segments = segment_set(tie.name + ".surface", tie.b);
    Card& c = builder_.add_card("CONTACT_TIED_NODES_TO_SURFACE_OFFSET");
    c.options = {"ID"};
    c.set("cid", double(++last_contact_)).set("heading", tie.name);
    c.set("ssid", double(nodes)).set("msid", double(segments)).set("sstyp", 4).set("mstyp", 0);
    c.set("sst", -tie_reach)
        .set("mst", -tie_reach);  // negative: the distance within which nodes are tied
  }

  void part_set() {
    Card& set = titled(builder_, "SET_PART_LIST", "whole body");
    out_.all_parts_set = ++last_set_;
    set.set("sid", double(out_.all_parts_set));
    add_ids(set, out_.parts.size(), [&](std::size_t i) { return out_.parts[i].id; });
  }

  void controls() {
    builder_.add_card("CONTROL_TERMINATION").set("endtim", options_.end_time);
    builder_.add_card("CONTROL_TIMESTEP").set("tssfac", options_.step_scale);
    builder_.add_card("CONTROL_ENERGY")
        .set("hgen", 2)
        .set("rwen", 2)
        .set("slnten", 2)
        .set("rylen", 2);
    for (const char* database :
         {"DATABASE_GLSTAT", "DATABASE_MATSUM", "DATABASE_RCFORC", "DATABASE_SLEOUT"})
      builder_.add_card(database).set("dt", options_.output_every);
    builder_.add_card("DATABASE_BINARY_D3PLOT").set("dt", options_.states_every);
  }

  const Body& body_;
  const AssemblyOptions& options_;
  Builder& builder_;
  Materials materials_;
  std::vector<RegionIds> ids_;
  std::map<Id, std::size_t> entry_of_;
  Id last_section_ = bending_section, last_set_ = 0, last_contact_ = 0;
  AssembledBody out_;
};

}  // namespace

AssembledBody assemble(const Body& body, const AssemblyOptions& options, Builder& builder) {
  builder.set_title(fmt::format("Fabrica body: {} {:g} mm {:g} kg, {}, {}", body.subject.sex,
                                body.subject.stature, body.subject.mass, body.posture.name,
                                name_of(body.resolution)));
  return Assembly(body, options, builder).run();
}

}  // namespace fabrica::body
