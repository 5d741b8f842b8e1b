#include "body/joints/disc.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "body/joints/disc_frame.h"
#include "body/joints/joint_law.h"
#include "body/joints/ligament_law.h"
#include "body/joints/mend.h"
#include "body/joints/piece_builder.h"
#include "body/mesh/polish.h"
#include "body/mesh/quality.h"
#include "body/tables.h"

namespace fabrica::body {

namespace {

constexpr double nucleus_radius = 0.65;  // of the section: 42 % of its area
constexpr double most_shift = 3.5;       // [mm] of an endplate; L3-L4 needs 1.3

// E [MPa] of the fibres from the outermost ring inwards (s41598-025-22755-z Table 1: 550 to 360
// MPa) and their share of the annulus (Shirazi-Adl 1986: 16 %)
constexpr double fibre_outer = 0.550, fibre_inner = 0.360, fibre_share = 0.16;
// [degrees] to the plane of the disc (VIVA+ 0.2.5, cervical annulus: +-60, 52.5 and 45 degrees to
// its axis from the outside inwards)
constexpr double angle_outer = 30, angle_inner = 45;
// strain at the end of the toe and exponent of the force in it, as that annulus has them: 0.041 and
// 2.5 outside, 0.073 and 3.5 inside (slope over secant at the second of its superficial and at the
// third of its deep points)
constexpr double toe_outer = 0.041, toe_inner = 0.073, exponent_outer = 2.5, exponent_inner = 3.5;
constexpr double farthest_around = 1.0 / 6;  // of the way around, that a fibre spans

struct DiscGrid {
  int deep, wide;     // bricks of the nucleus from behind to the front, from right to left
  int rings, layers;  // bricks in the annulus, along the height
};

// of the way from the innermost ring of the annulus to the outermost
double way_out(int ring, int rings) { return rings == 1 ? 1 : double(ring - 1) / (rings - 1); }

// [degrees] to the plane of the disc, of the fibres of a ring
double fibre_angle(int ring, int rings) {
  const double t = way_out(ring, rings);
  return (1 - t) * angle_inner + t * angle_outer;
}

// As many columns as put the diagonals of the rings' outer faces at the angles of their fibres, in
// the mean: rho tan(angle) = n h / (layers * perimeter).
DiscGrid grid_of(Resolution resolution, const DiscRow& row) {
  const int layers = resolution == Resolution::coarse     ? 2
                     : resolution == Resolution::standard ? 3
                                                          : 4;
  const int rings = layers;
  double slope = 0;
  for (int ring = 1; ring <= rings; ++ring) {
    const double rho = nucleus_radius + (1 - nucleus_radius) * ring / rings;
    slope += rho * std::tan(fibre_angle(ring, rings) * M_PI / 180) / rings;
  }
  const double ratio = row.depth / row.width;  // of an ellipse, to second order in it
  const double perimeter = 2 * std::sqrt(M_PI * row.area * 0.5 * (ratio + 1 / ratio));
  const int half = std::max(4, int(std::lround(0.5 * slope * layers * perimeter / row.wanted)));
  return {half / 2, half - half / 2, rings, layers};
}

// a place of the section, forward and left, of a point (a, b) of the square [-1, 1]^2; towards its
// middle the square keeps its form, so that no corner of a brick opens to 180 degrees
std::array<double, 2> nucleus_place(const DiscSpace& space, double a, double b) {
  const double r = std::max(std::abs(a), std::abs(b));
  if (r == 0) return {0, 0};
  const double phi = std::abs(a) >= std::abs(b) ? M_PI / 4 * b / a + (a < 0 ? M_PI : 0)
                                                : M_PI / 2 - M_PI / 4 * a / b + (b < 0 ? M_PI : 0);
  const double round = 0.65, edge = nucleus_radius * space.radius(phi < 0 ? phi + 2 * M_PI : phi);
  return {edge * (round * r * std::cos(phi) + (1 - round) * 0.82 * a),
          edge * (round * r * std::sin(phi) + (1 - round) * 0.82 * b)};
}

// a node that a fibre may end on, its length [mm] then and by how much its angle misses
struct FibreEnd {
  int node = -1;
  double length = 0, miss = 0;
};

class DiscMaker {
 public:
  DiscMaker(const std::vector<PlacedBone>& bones, const DiscRow& row, BetweenBones& between)
      : bones_(bones),
        row_(row),
        between_(between),
        space_(bones, row, DiscSpace::Section::table),
        grid_(grid_of(bones[std::size_t(row.upper)].mesh.resolution, row)) {
    space_.limit_mean_height(row.wanted);
  }
  DiscReport make();

 private:
  using Column = std::vector<int>;  // nodes of the nucleus or of a ring from below to above
  std::vector<Point> points(double forward, double left) const;
  std::vector<std::array<double, 2>> rim() const;
  void nucleus(DiscReport& report);
  void ring(int number, DiscReport& report);
  void fibres(int number);
  void ties();
  void smooth(DiscReport& report);
  void finish(PieceBuilder& builder, const std::string& tissue, const char* law,
              DiscReport& report);

  const std::vector<PlacedBone>& bones_;
  const DiscRow& row_;
  BetweenBones& between_;
  DiscSpace space_;
  DiscGrid grid_;
  // of the piece made last: its outer columns, counter-clockwise
  int last_piece_ = -1, first_piece_ = 0;
  std::vector<int> ring_pieces_;
  std::vector<std::vector<Column>> ring_columns_;  // outer ones of each ring
  std::vector<Column> last_columns_;
  std::vector<PieceNode> top_, bottom_;
};

// nodes of a line of the disc from the lower to the upper endplate
std::vector<Point> DiscMaker::points(double forward, double left) const {
  const auto [lower, upper] = space_.ends(forward, left);
  std::vector<Point> line;
  for (int k = 0; k <= grid_.layers; ++k) {
    const double t = double(k) / grid_.layers;
    line.push_back((1 - t) * lower + t * upper);
  }
  return line;
}

// the edge of the square, counter-clockwise from its corner (1, -1)
std::vector<std::array<double, 2>> DiscMaker::rim() const {
  std::vector<std::array<double, 2>> edge;
  const int m = grid_.deep, n = grid_.wide;
  for (int i = 0; i < n; ++i) edge.push_back({1, 2.0 * i / n - 1});
  for (int i = 0; i < m; ++i) edge.push_back({1 - 2.0 * i / m, 1});
  for (int i = 0; i < n; ++i) edge.push_back({-1, 1 - 2.0 * i / n});
  for (int i = 0; i < m; ++i) edge.push_back({2.0 * i / m - 1, -1});
  return edge;
}

void DiscMaker::nucleus(DiscReport& report) {
  PieceBuilder builder(bones_);
  const int m = grid_.deep, n = grid_.wide;
  std::map<std::pair<int, int>, Column> columns;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      const auto place = nucleus_place(space_, 2.0 * i / m - 1, 2.0 * j / n - 1);
      for (const Point& p : points(place[0], place[1])) columns[{i, j}].push_back(builder.own(p));
    }
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n; ++j)
      for (std::size_t k = 0; k < std::size_t(grid_.layers); ++k) {
        const Column &a = columns[{i, j}], &b = columns[{i + 1, j}], &c = columns[{i + 1, j + 1}],
                     &d = columns[{i, j + 1}];
        builder.piece.bricks.push_back(
            {a[k], b[k], c[k], d[k], a[k + 1], b[k + 1], c[k + 1], d[k + 1]});
      }
  last_columns_.clear();
  for (const auto& [a, b] : rim())
    last_columns_.push_back(
        columns[{int(std::lround((a + 1) * m / 2)), int(std::lround((b + 1) * n / 2))}]);
  last_piece_ = int(between_.pieces.size());
  for (auto& [key, column] : columns) {
    bottom_.push_back(piece_node(builder.piece, last_piece_, column.front()));
    top_.push_back(piece_node(builder.piece, last_piece_, column.back()));
  }
  finish(builder, "nucleus", "nucleus", report);
}

// number 1 lies next to the nucleus
void DiscMaker::ring(int number, DiscReport& report) {
  PieceBuilder builder(bones_);
  const auto edge = rim();
  const std::size_t n = edge.size();
  const double t = double(number) / grid_.rings;
  std::vector<Column> inner(n), outer(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (int node : last_columns_[i])
      inner[i].push_back(builder.of_piece(between_.pieces, last_piece_, node));
    // towards the rim along the direction of the square's edge
    const auto from = nucleus_place(space_, edge[i][0], edge[i][1]);
    const double phi = std::atan2(from[1], from[0]);
    const double r = space_.radius(phi < 0 ? phi + 2 * M_PI : phi);
    const std::array<double, 2> to{r * std::cos(phi), r * std::sin(phi)};
    for (const Point& p : points((1 - t) * from[0] + t * to[0], (1 - t) * from[1] + t * to[1]))
      outer[i].push_back(builder.own(p));
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < std::size_t(grid_.layers); ++k) {
      const std::size_t j = (i + 1) % n;
      builder.piece.bricks.push_back({inner[i][k], outer[i][k], outer[j][k], inner[j][k],
                                      inner[i][k + 1], outer[i][k + 1], outer[j][k + 1],
                                      inner[j][k + 1]});
    }
  last_piece_ = int(between_.pieces.size());
  last_columns_ = outer;
  ring_columns_.push_back(outer);
  for (const Column& column : outer) {
    bottom_.push_back(piece_node(builder.piece, last_piece_, column.front()));
    top_.push_back(piece_node(builder.piece, last_piece_, column.back()));
  }
  ring_pieces_.push_back(last_piece_);
  finish(builder, fmt::format("annulus{}", number), "annulus", report);
}

// Each brick of a ring has two families of fibres, of half its share each: from a corner of its
// outer face below to the node of the ring one level up whose direction is nearest to theirs. So
// fibres pass through nodes of every level, as lamellae follow the bulge of a pressed disc; chords
// from endplate to endplate would leave what lies between them free to bulge.
//   k = E A / L,   A L = fibre_share V / 2
void DiscMaker::fibres(int number) {
  PieceBuilder builder(bones_);
  const int ring_piece = ring_pieces_[std::size_t(number - 1)];
  const auto& columns = ring_columns_[std::size_t(number - 1)];
  const Piece& ring = between_.pieces[std::size_t(ring_piece)];
  const double t = way_out(number, grid_.rings);
  const double E = (1 - t) * fibre_inner + t * fibre_outer;
  const double wanted = fibre_angle(number, grid_.rings) * M_PI / 180;
  const int n = int(columns.size()), layers = grid_.layers;
  std::map<std::pair<int, int>, double> stiffness;
  for (std::size_t e = 0; e < ring.bricks.size(); ++e) {
    Corners corners;
    for (std::size_t i = 0; i < 8; ++i) corners[i] = ring.nodes[std::size_t(ring.bricks[e][i])].x;
    const double scale = E * fibre_share * volume_of(corners) / 2;
    const int column = int(e) / layers, layer = int(e) % layers;
    for (const int around : {1, -1}) {
      const int from_column = around > 0 ? column : (column + 1) % n;
      const int from = columns[std::size_t(from_column)][std::size_t(layer)];
      FibreEnd best;
      for (int q = 1; q <= std::max(1, int(std::lround(farthest_around * n))); ++q) {
        const int to =
            columns[std::size_t((from_column + around * q + n) % n)][std::size_t(layer + 1)];
        const Point d = ring.nodes[std::size_t(to)].x - ring.nodes[std::size_t(from)].x;
        const double length = norm(d);
        const double angle = std::asin(std::abs(dot(d, space_.frame().normal)) / length);
        if (best.node < 0 || std::abs(angle - wanted) < best.miss)
          best = {to, length, std::abs(angle - wanted)};
      }
      stiffness[std::minmax(from, best.node)] += scale / (best.length * best.length);
    }
  }
  double length = 0;
  for (const auto& [ends, k] : stiffness) {
    length += norm(ring.nodes[std::size_t(ends.first)].x - ring.nodes[std::size_t(ends.second)].x) /
              double(stiffness.size());
    builder.piece.lines.push_back({builder.of_piece(between_.pieces, ring_piece, ends.first),
                                   builder.of_piece(between_.pieces, ring_piece, ends.second)});
    builder.piece.line_scale.push_back(k);
  }
  const PlacedBone& upper = bones_[std::size_t(row_.upper)];
  builder.piece.name =
      fmt::format("{}.mid.disc_{}.fibres{}", name_of(upper.region), row_.name, number);
  builder.piece.region = upper.region;
  builder.piece.kind = PieceKind::spring;
  LigamentStiffness law;  // of 1 kN/mm behind the toe: the scale of a line is its stiffness
  law.k1 = 1;
  law.toe = ((1 - t) * toe_inner + t * toe_outer) * length;
  law.toe_force = law.toe / ((1 - t) * exponent_inner + t * exponent_outer);
  builder.piece.law = ligament_curve(
      law, 1,
      "moduli s41598-025-22755-z Table 1; share of the annulus Shirazi-Adl 1986; angles and toe "
      "VIVA+ 0.2.5 vivaplus-materials.k",
      "read");
  builder.piece.source = builder.piece.law.source;
  builder.piece.bone_a = part_name(upper, "");
  builder.piece.bone_b = part_name(bones_[std::size_t(row_.lower)], "");
  between_.pieces.push_back(std::move(builder.piece));
}

void DiscMaker::finish(PieceBuilder& builder, const std::string& tissue, const char* law,
                       DiscReport& report) {
  const PlacedBone& upper = bones_[std::size_t(row_.upper)];
  Piece& piece = builder.piece;
  report.bricks += int(piece.bricks.size());
  piece.name = fmt::format("{}.mid.disc_{}.{}", name_of(upper.region), row_.name, tissue);
  piece.region = upper.region;
  piece.kind = PieceKind::brick;
  piece.law = joint_law(law);
  piece.bone_a = part_name(upper, "");
  piece.bone_b = part_name(bones_[std::size_t(row_.lower)], "");
  piece.source = "discs.csv; " + piece.law.source;
  between_.pieces.push_back(std::move(piece));
}

// All bricks of the disc at once by the local stage: the nodes on the endplates stay on them, those
// of the rim on its surface.
void DiscMaker::smooth(DiscReport& report) {
  UntangleProblem problem;
  std::vector<Point> nodes;
  std::map<std::pair<int, int>, int> index;  // piece and node of the owner
  const auto number = [&](int piece, int node) {
    const PieceNode& n = between_.pieces[std::size_t(piece)].nodes[std::size_t(node)];
    const auto [at, fresh] = index.try_emplace(
        n.piece >= 0 ? std::pair{n.piece, n.node} : std::pair{piece, node}, int(nodes.size()));
    if (fresh) nodes.push_back(n.x);
    return at->second;
  };
  for (int p = first_piece_; p < int(between_.pieces.size()); ++p)
    for (const auto& brick : between_.pieces[std::size_t(p)].bricks) {
      Brick& b = problem.bricks.emplace_back();
      for (std::size_t i = 0; i < 8; ++i) b[i] = number(p, brick[i]);
    }
  problem.spacing = std::max(space_.mean_height() / grid_.layers, 1.0);
  const DiscFrame& frame = space_.frame();
  for (const auto* face : {&top_, &bottom_})
    for (const PieceNode& n : *face) {
      const int node = index.at({n.piece, n.node});
      problem.planes.push_back({node, nodes[std::size_t(node)], frame.normal, 400, false});
    }
  for (const Column& column : last_columns_)
    for (const int n : column) {
      const int node = index.at({last_piece_, n});
      const Point d = nodes[std::size_t(node)] - frame.centre;
      const Point out = d - dot(d, frame.normal) * frame.normal;
      problem.planes.push_back({node, nodes[std::size_t(node)], (1 / norm(out)) * out, 100, false});
    }
  PolishOptions options;
  options.jacobian = 0.52;
  options.size = 0.6 * problem.spacing;
  options.sweeps = 60;
  polish(problem, nodes, options);
  report.volume = 0;
  for (const Brick& brick : problem.bricks) {
    const Corners corners = corners_of(nodes, brick);
    report.least_scaled_jacobian = std::min(report.least_scaled_jacobian, scaled_jacobian(corners));
    report.volume += volume_of(corners);
  }
  for (int p = first_piece_; p < int(between_.pieces.size()); ++p) {
    Piece& piece = between_.pieces[std::size_t(p)];
    for (std::size_t n = 0; n < piece.nodes.size(); ++n) {
      PieceNode& node = piece.nodes[n];
      const auto at =
          index.find(node.piece >= 0 ? std::pair{node.piece, node.node} : std::pair{p, int(n)});
      if (at != index.end()) node.x = nodes[std::size_t(at->second)];
    }
  }
  for (auto* face : {&top_, &bottom_})
    for (PieceNode& n : *face) n.x = nodes[std::size_t(index.at({n.piece, n.node}))];
}

// The faces of an endplate: those that a node of the disc lies on and their neighbours.
void DiscMaker::ties() {
  for (const bool above : {true, false}) {
    const int index = above ? row_.upper : row_.lower;
    const PlacedBone& bone = bones_[std::size_t(index)];
    const BoneSurface surface(bone.nodes, bone.mesh.surface);
    std::set<int> nodes;
    Tie tie;
    tie.name = fmt::format("{}.mid.disc_{}.{}", name_of(bone.region), row_.name,
                           above ? "upper" : "lower");
    tie.a = above ? top_ : bottom_;
    for (const PieceNode& n : tie.a) {
      const SurfacePoint at = surface.nearest(n.x, 6);
      if (at.quad < 0) continue;
      for (int corner : bone.mesh.surface[std::size_t(at.quad)]) nodes.insert(corner);
    }
    for (const auto& quad : bone.mesh.surface) {
      if (std::none_of(quad.begin(), quad.end(), [&](int n) { return nodes.count(n) > 0; }))
        continue;
      std::array<PieceNode, 4> corners;
      for (std::size_t i = 0; i < 4; ++i) corners[i] = bone_node(bones_, index, quad[i]);
      tie.b.quads.push_back(corners);
    }
    between_.ties.push_back(std::move(tie));
  }
}

DiscReport DiscMaker::make() {
  DiscReport report;
  report.name = row_.name;
  report.wanted = row_.wanted, report.table_area = row_.area;
  report.least_scaled_jacobian = 1;
  first_piece_ = int(between_.pieces.size());
  nucleus(report);
  for (int number = 1; number <= grid_.rings; ++number) ring(number, report);
  constexpr int steps = 360;
  for (int i = 0; i < steps; ++i) {
    const double r = space_.radius(2 * M_PI * i / steps);
    report.area += 0.5 * r * r * 2 * M_PI / steps;
  }
  smooth(report);
  for (int number = 1; number <= grid_.rings; ++number) fibres(number);
  ties();
  report.height = report.volume / report.area;
  return report;
}

// Moves the endplates of one vertebra by `up` at the bottom and `down` at the top, linear between
// them and nothing behind the body. What that takes of the body's volume beyond 3 % comes back in
// its girth.
void compress_body(PlacedBone& bone, double top, double bottom, double back, double down,
                   double up) {
  constexpr double free_loss = 0.03;
  const double loss = (down + up) / (top - bottom);
  const double girth = std::max(0.0, std::sqrt((1 - free_loss) / (1 - loss)) - 1);
  double front = back;
  for (const Point& p : bone.mesh.nodes) front = std::max(front, p.x);
  const double middle = 0.5 * (front + back);
  for (Point& p : bone.mesh.nodes) {
    const double x = std::clamp((p.x - (back - 3)) / 6, 0.0, 1.0);
    const double behind = x * x * (3 - 2 * x);
    const double t = std::clamp((p.z - bottom) / (top - bottom), 0.0, 1.0);
    p.z += behind * ((1 - t) * up - t * down);
    p.x += behind * girth * (p.x - middle);
    p.y += behind * girth * p.y;
  }
  mend(bone.mesh, bone.mesh.nodes, !bone.mesh.image.empty(),
       BoneSurface(bone.mesh.nodes, bone.mesh.surface), {});
  for (std::size_t n = 0; n < bone.nodes.size(); ++n)
    bone.nodes[n] = bone.placement(bone.mesh.nodes[n]);
}

}  // namespace

double fit_endplates(std::vector<PlacedBone>& bones) {
  // how far each vertebra's top goes down and its bottom up; between which heights, before what
  struct Change {
    double down = 0, up = 0, top = 1e30, bottom = -1e30, back = 0;
  };
  std::map<int, Change> changes;
  for (const DiscRow& row : disc_rows(bones)) {
    const double missing =
        row.wanted - DiscSpace(bones, row, DiscSpace::Section::between_endplates).mean_height();
    const double shift = std::clamp(0.5 * missing, 0.0, most_shift);
    changes[row.upper].up = shift, changes[row.lower].down = shift;
  }
  const Table table("anatomy/joints/ligaments.csv");
  for (int row = 0; row < table.rows(); ++row) {
    const std::string& name = table.text(row, "name");
    if (!name.starts_with("PLL_")) continue;
    for (const char* n : {"1", "2"}) {
      const int bone = find_bone(bones, table.text(row, std::string("bone") + n), Side::midline);
      if (bone < 0 || !changes.count(bone)) continue;
      const Point& scale = bones[std::size_t(bone)].mesh.scale;
      const double z = scale.z * table.number(row, std::string("z") + n);
      (n[0] == '1' ? changes[bone].bottom : changes[bone].top) = z;
      changes[bone].back = scale.x * table.number(row, std::string("x") + n);
    }
  }
  double largest = 0;
  for (auto& [bone, change] : changes) {
    // only vertebrae between two discs: C2's dens and the sacrum keep their form
    if (change.top > 1e29 || change.bottom < -1e29) continue;
    compress_body(bones[std::size_t(bone)], change.top, change.bottom, change.back, change.down,
                  change.up);
    largest = std::max({largest, change.down, change.up});
  }
  return largest;
}

std::vector<DiscReport> add_discs(const std::vector<PlacedBone>& bones, BetweenBones& between) {
  std::vector<DiscReport> reports;
  for (const DiscRow& row : disc_rows(bones))
    reports.push_back(DiscMaker(bones, row, between).make());
  return reports;
}

}  // namespace fabrica::body
