#include "app/body_pictures.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>

#include "body/mesh/quality.h"
#include "result/picture.h"
#include "result/vtu.h"

namespace fabrica {
namespace {

using body::Body;
using body::Piece;
using body::PlacedBone;
using body::Point;

// what is drawn in one colour
enum Tissue {
  bone = 1,
  second_bone,
  outer_table,
  diploe,
  inner_table,
  cartilage,
  meniscus,
  ligament
};
const std::vector<std::array<unsigned char, 3>> palette = {
    {232, 220, 196}, {205, 178, 140}, {214, 190, 150}, {196, 120, 90},
    {170, 140, 100}, {130, 170, 205}, {120, 175, 150}, {176, 60, 60}};

struct View {
  std::string name, direction;
  double width, height;  // pixels, at most
  std::function<bool(const PlacedBone&)> take;
  bool pieces = true;
  std::function<bool(const Point&)> keep = {};  // bricks and lines by their centre; empty: all
  bool layers = false;                          // colours by layer, with element edges
};

bool starts(const std::string& text, std::initializer_list<const char*> prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const char* p) { return text.starts_with(p); });
}

bool right(const PlacedBone& b) { return b.side != body::Side::left; }

std::vector<View> views(const Body& body) {
  const auto all = [](const PlacedBone&) { return true; };
  const auto named = [](std::initializer_list<const char*> prefixes, bool right_only) {
    const std::vector<std::string> list(prefixes.begin(), prefixes.end());
    return [list, right_only](const PlacedBone& b) {
      return (!right_only || right(b)) &&
             std::any_of(list.begin(), list.end(),
                         [&](const std::string& p) { return b.mesh.name.starts_with(p); });
    };
  };
  const auto limb = [](const char* region, std::initializer_list<const char*> prefixes) {
    const std::vector<std::string> list(prefixes.begin(), prefixes.end());
    const std::string r = region;
    return [list, r](const PlacedBone& b) {
      return right(b) && r == body::name_of(b.region) &&
             std::any_of(list.begin(), list.end(),
                         [&](const std::string& p) { return b.mesh.name.starts_with(p); });
    };
  };
  const Point knee = body.skeleton.joint_centre("knee", body::Side::right);
  const Point shoulder = body.skeleton.joint_centre("shoulder", body::Side::right);
  const auto right_half = [](const Point& x) { return x.y < 0; };
  const auto trunk = [](const PlacedBone& b) { return b.region == body::Region::thorax; };
  return {
      {"front", "front", 1000, 1000, all},
      {"side", "right", 1000, 1000, all},
      {"back", "back", 1000, 1000, all},
      {"oblique", "1,-0.8,0.3", 900, 900, all},
      {"thorax", "1,-0.5,0.2", 620, 620, trunk},
      {"thorax_back", "-1,-0.6,0.3", 620, 620, trunk},
      {"pelvis", "1,-0.5,0.5", 620, 560,
       [](const PlacedBone& b) { return b.region == body::Region::pelvis || b.mesh.name == "L5"; }},
      {"knee", "1,-0.7,0.3", 600, 700, limb("leg", {"femur", "tibia", "fibula", "patella"}), true,
       [knee](const Point& x) { return norm(x - knee) < 130; }},
      {"knee_plateau", "0.5,-0.2,1", 700, 560, limb("leg", {"tibia", "fibula"}), true,
       [knee](const Point& x) { return norm(x - knee) < 90; }},
      {"shoulder", "1,-0.7,0.3", 700, 600, limb("arm", {"clavicle", "scapula", "humerus"}), true,
       [shoulder](const Point& x) { return norm(x - shoulder) < 190; }},
      {"hand", "1,-0.3,0.2", 700, 800,
       [](const PlacedBone& b) {
         return right(b) && b.region == body::Region::arm &&
                !starts(b.mesh.name, {"clavicle", "scapula", "humerus", "ulna", "radius"});
       }},
      {"foot", "0.6,-1,0.5", 900, 600,
       [](const PlacedBone& b) {
         return right(b) && b.region == body::Region::leg &&
                !starts(b.mesh.name, {"femur", "tibia", "fibula", "patella"});
       }},
      {"skull", "1,-0.8,0.25", 620, 620, named({"skull", "mandible"}, false)},
      {"skull_cut", "right", 560, 560, named({"skull", "mandible"}, false), true, right_half, true},
      {"vertebra_pair", "1,-0.8,0.5", 620, 620, named({"L3", "L4"}, false)},
      {"vertebra_pair_cut", "right", 620, 560, named({"L3", "L4"}, false), true, right_half, true},
  };
}

// surface mesh of what a view shows
class Scene {
 public:
  explicit Scene(const Body& body) : body_(body) {
    for (int t = bone; t <= ligament; ++t) {
      mesh_.part_id.push_back(t);
      mesh_.part_title.push_back("");
      mesh_.part_family.push_back(Family::shell);
    }
  }
  ResultMesh take(const View& view) {
    view_ = &view;
    for (std::size_t b = 0; b < body_.bones.size(); ++b)
      if (view.take(body_.bones[b])) add_bone(body_.bones[b]);
    if (view.pieces) add_pieces();
    return std::move(mesh_);
  }

 private:
  bool keep(const Point& x) const { return !view_->keep || view_->keep(x); }
  int node(const Point& x) {
    mesh_.node_id.push_back(std::int64_t(mesh_.node_id.size()) + 1);
    for (int k = 0; k < 3; ++k) mesh_.position.push_back(float(x[k]));
    return mesh_.nodes() - 1;
  }
  void quad(const std::array<int, 4>& corners, int tissue) {
    mesh_.shell.push_back(corners);
    mesh_.shell_id.push_back(mesh_.shells());
    mesh_.shell_part.push_back(tissue - 1);
  }
  void surface(const std::vector<Point>& nodes, const std::vector<body::Brick>& bricks,
               int tissue) {
    std::vector<body::Brick> kept;
    for (const body::Brick& b : bricks) {
      Point centre{0, 0, 0};
      for (const int n : b) centre += 0.125 * nodes[std::size_t(n)];
      if (keep(centre)) kept.push_back(b);
    }
    std::vector<int> at(nodes.size(), -1);
    for (const body::Quad& q : body::boundary_quads(kept)) {
      std::array<int, 4> corners{};
      for (std::size_t k = 0; k < 4; ++k) {
        int& n = at[std::size_t(q[k])];
        if (n < 0) n = node(nodes[std::size_t(q[k])]);
        corners[k] = n;
      }
      quad(corners, tissue);
    }
  }
  void add_bone(const PlacedBone& b) {
    if (!view_->layers)
      return surface(b.nodes, b.mesh.bricks,
                     b.mesh.name.starts_with("costal_cartilage") ? cartilage : bone);
    for (int layer = 0; layer < 4; ++layer) {
      std::vector<body::Brick> bricks;
      for (std::size_t e = 0; e < b.mesh.bricks.size(); ++e)
        if (b.mesh.brick_layer[e] == layer) bricks.push_back(b.mesh.bricks[e]);
      if (!bricks.empty()) surface(b.nodes, bricks, layer == 0 ? bone : second_bone + layer);
    }
  }
  // pieces whose shared nodes all belong to bones that are shown, and so do the ends that they name
  void add_pieces() {
    std::set<std::string> names{""};
    for (const PlacedBone& b : body_.bones)
      if (view_->take(b)) names.insert(body::part_name(b, ""));
    std::vector<std::vector<Point>> places;
    for (const Piece& piece : body_.between.pieces) {
      std::vector<Point>& nodes = places.emplace_back();
      bool shown = names.count(piece.bone_a) && names.count(piece.bone_b);
      for (const body::PieceNode& n : piece.nodes) {
        if (n.bone >= 0) shown = shown && view_->take(body_.bones[std::size_t(n.bone)]);
        nodes.push_back(n.bone >= 0    ? body_.bones[std::size_t(n.bone)].nodes[std::size_t(n.node)]
                        : n.piece >= 0 ? places[std::size_t(n.piece)][std::size_t(n.node)]
                                       : n.x);
      }
      if (!shown || !connected_to_shown(piece)) continue;
      if (!piece.bricks.empty())
        surface(nodes, piece.bricks, piece.material == "meniscus" ? meniscus : cartilage);
      for (const auto& q : piece.quads) {
        if (!keep(0.5 * (nodes[std::size_t(q[0])] + nodes[std::size_t(q[2])]))) continue;
        std::array<int, 4> corners{};
        for (std::size_t k = 0; k < 4; ++k) corners[k] = node(nodes[std::size_t(q[k])]);
        quad(corners, ligament);
      }
      // fibres of a layer lie in its bricks
      if (on_one_bone(piece)) continue;
      for (const auto& l : piece.lines) line(nodes[std::size_t(l[0])], nodes[std::size_t(l[1])]);
    }
  }
  // a body that one bone carries without a node of it, or what lies in such a body
  static bool on_one_bone(const Piece& piece) {
    return !piece.bone_a.empty() && piece.bone_a == piece.bone_b &&
           std::all_of(piece.nodes.begin(), piece.nodes.end(), [&](const body::PieceNode& n) {
             return n.bone < 0 && n.piece == piece.nodes.front().piece;
           });
  }
  bool connected_to_shown(const Piece& piece) const {
    if (on_one_bone(piece)) return true;
    for (const body::PieceNode& n : piece.nodes)
      if (n.bone >= 0 || n.piece >= 0) return true;
    return false;
  }
  // a ligament's line as a bar of 1.2 mm
  void line(const Point& a, const Point& b) {
    if (!keep(0.5 * (a + b))) return;
    const Point d = b - a;
    Point side = cross(d, std::abs(d.z) > std::abs(d.x) ? Point{1, 0, 0} : Point{0, 0, 1});
    if (norm(side) < 1e-9) return;
    side = (0.6 / norm(side)) * side;
    Point other = cross(d, side);
    other = (0.6 / std::max(norm(other), 1e-9)) * other;
    const Point offsets[4] = {side, other, -side, -other};
    int ring[2][4];
    for (int e = 0; e < 2; ++e)
      for (int k = 0; k < 4; ++k) ring[e][k] = node((e ? b : a) + offsets[k]);
    for (int k = 0; k < 4; ++k)
      quad({ring[0][k], ring[0][(k + 1) % 4], ring[1][(k + 1) % 4], ring[1][k]}, ligament);
  }

  const Body& body_;
  const View* view_ = nullptr;
  ResultMesh mesh_;
};

// colours of the tissues that occur, in their order
std::vector<std::array<unsigned char, 3>> colors_of(const ResultMesh& mesh) {
  std::vector<std::array<unsigned char, 3>> colors;
  for (int t = bone; t <= ligament; ++t)
    if (std::find(mesh.shell_part.begin(), mesh.shell_part.end(), t - 1) != mesh.shell_part.end())
      colors.push_back(palette[std::size_t(t - 1)]);
  return colors;
}

}  // namespace

std::vector<std::string> draw_body(const Body& body, const std::string& folder) {
  std::filesystem::create_directories(folder);
  std::vector<std::string> drawn;
  for (const View& view : views(body)) {
    const ResultMesh mesh = Scene(body).take(view);
    if (mesh.shells() == 0) continue;
    const std::string state = folder + "/" + view.name + ".pvd";
    AnimationState now;
    now.position = mesh.position;
    now.velocity.assign(mesh.position.size(), 0), now.acceleration = now.velocity;
    VtuWriter(state, mesh).write(now);
    PictureOptions picture;
    picture.input = state, picture.output = folder + "/" + view.name + ".png";
    picture.view = view.direction;
    picture.width = int(view.width), picture.height = int(view.height), picture.trim = true;
    picture.edges = view.layers, picture.caption = false;
    picture.feature_angle = 175, picture.palette = colors_of(mesh);
    render_picture(picture);
    std::filesystem::remove(state);
    std::filesystem::remove(folder + "/" + view.name + "_0000.vtu");
    drawn.push_back(picture.output);
  }
  return drawn;
}

}  // namespace fabrica
