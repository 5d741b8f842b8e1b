#include "body/joints/meniscus.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "body/joints/articulation.h"
#include "body/joints/ligament_law.h"
#include "body/joints/meniscus_mesh.h"
#include "body/mesh/quality.h"

namespace fabrica::body {

namespace {

constexpr double gap = 0.1;             // [mm] left to the cartilage on either side
constexpr double least_height = 0.3;    // [mm] of a column
constexpr double least_jacobian = 0.3;  // of a brick
constexpr double most_drawn = 0.8;      // of the width, by which the inner edge gives way
constexpr double least_width = 0.4;     // of it: the rim gives way, too, to keep as much
constexpr double steepest = 0.2;        // cosine of a face's normal to the tibia's axis
constexpr double reach = 45;            // [mm] of rays along the tibia
constexpr double rim_step = 3;          // [mm] deeper than the last place: beside the plateau
constexpr double steepest_rim = 0.5;    // slope of the rim beside the plateau
constexpr double under = 6;             // [mm] below a place the femur is looked for
constexpr double fibre_modulus = 0.12;  // [GPa] 140 MPa along the sweep less 20 MPa of the bricks
constexpr double friction = 0.02;

const char* const names[] = {"medial", "lateral"};

PlanPoint operator*(double t, const PlanPoint& p) { return {t * p.x, t * p.y}; }
PlanPoint operator+(const PlanPoint& p, const PlanPoint& q) { return {p.x + q.x, p.y + q.y}; }

struct Grid {
  int along, across, layers;
};

// Finer bones get finer menisci: bricks of seven tenths of the faces of the plateau.
Grid grid_for(const PlacedBone& tibia, const MeniscusPlan& plan) {
  double edges = 0;
  for (const auto& q : tibia.mesh.surface)
    for (std::size_t i = 0; i < 4; ++i)
      edges += norm(tibia.nodes[std::size_t(q[(i + 1) % 4])] - tibia.nodes[std::size_t(q[i])]) / 4;
  const double size = std::clamp(0.7 * edges / double(tibia.mesh.surface.size()), 2.5, 6.0);
  const double width = 9.5;
  return {int(std::ceil(plan.rim_length() / size)), std::max(2, int(std::lround(width / size))),
          size < 4.5 ? 2 : 1};
}

double distance(const PlanPoint& a, const PlanPoint& b) { return std::hypot(b.x - a.x, b.y - a.y); }

// [deg] between the axes of both bones
double flexion(const PlacedBone& femur, const PlacedBone& tibia) {
  const Point z{0, 0, 1}, a = femur.placement.R * z, b = tibia.placement.R * z;
  return std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

class MeniscusMaker {
 public:
  MeniscusMaker(const std::vector<PlacedBone>& bones, const Knee& knee, const MeniscusPlan& plan,
                BetweenBones& between)
      : bones_(bones),
        tibia_(bones[std::size_t(knee.tibia)]),
        knee_(knee),
        plan_(plan),
        between_(between),
        above_(knee.above.nodes, knee.above.quads),
        below_(knee.below.nodes, knee.below.quads),
        grid_(grid_for(tibia_, plan)) {
    for (const Point& p : tibia_.mesh.nodes) top_ = std::max(top_, p.z);
    mesh_.name =
        fmt::format("{}.{}.{}_meniscus", name_of(tibia_.region), name_of(knee.side), plan.name());
  }
  std::pair<MeniscusMesh, MeniscusReport> make();

 private:
  struct Column {
    PlanPoint place;
    double bottom = 0, top = 0, wanted = 0;  // [mm] along the tibia, its frame; height
  };
  // a place of the top (or bottom) face between four columns, with the warp of its two triangles
  struct Sample {
    std::array<double, 4> weight;  // of the columns
    std::array<double, 4> slope;   // of the overlap over the height (or depth) of the columns
    double most_warp;              // of the slope
    double overlap;  // [mm] nearer to the cartilage than the gap; negative where there is room
  };
  Column& column(int i, int j) { return columns_[std::size_t(i * (grid_.across + 1) + j)]; }
  Point global(const PlanPoint& p, double z) const {
    return tibia_.placement({p.x, knee_.side == Side::left ? -p.y : p.y, z});
  }
  // [mm] along the tibia, where contact with it and with the femur begins over a place
  std::optional<double> below(const PlanPoint& p) const;
  std::optional<double> above(const PlanPoint& p, double from) const;
  void draw_in();
  bool draw_in_again();
  void fill_columns();
  void raise_tops();
  template <class F>
  void samples(int i, int j, bool up, F&& act);
  double clear_face(int i, int j, bool up);
  void raise_top(int i, int j);
  void clear(bool up);
  void bricks();
  void fibres();
  void contact(bool up);

  const std::vector<PlacedBone>& bones_;
  const PlacedBone& tibia_;
  const Knee& knee_;
  const MeniscusPlan& plan_;
  BetweenBones& between_;
  BoneSurface above_, below_;
  Grid grid_;
  double top_ = -1e30;
  std::vector<double> inner_;  // r of the inner edge, by i
  std::vector<Column> columns_;
  MeniscusMesh mesh_;
  MeniscusReport report_;
};

std::optional<double> MeniscusMaker::below(const PlanPoint& p) const {
  const Point axis = tibia_.placement.R * Point{0, 0, 1};
  const SurfacePoint at = below_.hit(global(p, top_ + 5), Point{0, 0, 0} - axis, reach);
  if (at.quad < 0 || dot(at.normal, axis) < steepest) return {};
  return top_ + 5 - at.distance + knee_.below.shell[std::size_t(at.quad)];
}

std::optional<double> MeniscusMaker::above(const PlanPoint& p, double from) const {
  const Point axis = tibia_.placement.R * Point{0, 0, 1};
  const SurfacePoint at = above_.hit(global(p, from), axis, reach);
  if (at.quad < 0) return {};
  return from + at.distance - knee_.above.shell[std::size_t(at.quad)];
}

// the inner edge lies where the room begins, smoothed along the sweep
void MeniscusMaker::draw_in() {
  constexpr int steps = 24;
  const double needed = MeniscusPlan::edge_height + 2 * gap;
  std::vector<double> first(std::size_t(grid_.along) + 1, 0);
  for (int i = 0; i <= grid_.along; ++i)
    for (int k = 0; k <= steps; ++k) {
      const double r = 0.8 * k / steps;
      const PlanPoint p = plan_.at(double(i) / grid_.along, r);
      const auto t = below(p);
      if (!t) continue;
      const auto f = above(p, *t - under);
      if (f && *f - *t < needed) first[std::size_t(i)] = 0.8 * (k + 1) / steps;
    }
  for (double& r : first) r = std::min(r, most_drawn);
  inner_ = first;
  for (int i = 0; i <= grid_.along; ++i)
    for (int n : {i - 1, i + 1})
      if (n >= 0 && n <= grid_.along)
        inner_[std::size_t(i)] =
            std::max(inner_[std::size_t(i)], 0.5 * (first[std::size_t(i)] + first[std::size_t(n)]));
}

void MeniscusMaker::fill_columns() {
  columns_.resize(std::size_t((grid_.along + 1) * (grid_.across + 1)));
  for (int i = 0; i <= grid_.along; ++i) {
    const double s = double(i) / grid_.along, r0 = inner_[std::size_t(i)];
    const double r1 = std::max(1.0, r0 + least_width);
    // where the inner edge has nothing below it the nearest place outwards counts, then inwards
    std::optional<double> last;
    for (double r = r0; !last && r < 1; r += 0.05) last = below(plan_.at(s, r));
    for (double r = r0; !last && r > 0; r -= 0.05) last = below(plan_.at(s, r));
    if (!last) throw BodyError(mesh_.name + ": the tibia is not below it");
    double slope = 0;
    for (int j = 0; j <= grid_.across; ++j) {
      const double r = r0 + (r1 - r0) * j / grid_.across;
      Column& c = column(i, j);
      c.place = plan_.at(s, r);
      auto t = below(c.place);
      // beside the plateau the rim goes on as the plateau slopes
      const double step = j == 0 ? 0 : distance(c.place, column(i, j - 1).place);
      if (!t || (r > 0.6 && *t < *last - rim_step)) t = *last + slope * step;
      if (step > 0) slope = std::clamp((*t - *last) / step, -steepest_rim, 0.0);
      last = t;
      c.bottom = *t + gap, c.wanted = plan_.height(s, std::min(r, 1.0));
    }
  }
}

void MeniscusMaker::raise_tops() {
  for (Column& c : columns_) {
    c.top = c.bottom + c.wanted;
    if (const auto f = above(c.place, c.bottom - under)) c.top = std::min(c.top, *f - gap);
  }
}

// Moves the inner edge out where a column is too low; false when none is.
bool MeniscusMaker::draw_in_again() {
  bool again = false;
  for (int i = 0; i <= grid_.along; ++i) {
    double lowest = 1e30;
    for (int j = 0; j <= grid_.across; ++j)
      lowest = std::min(lowest, column(i, j).top - column(i, j).bottom);
    if (lowest >= least_height || inner_[std::size_t(i)] >= most_drawn) continue;
    again = true;
    for (int n : {i - 1, i, i + 1})
      if (n >= 0 && n <= grid_.along)
        inner_[std::size_t(n)] =
            std::min(most_drawn, inner_[std::size_t(n)] + (n == i ? 0.08 : 0.04));
  }
  return again;
}

// Calls act over places of the top (or bottom) face of the columns from i, j to i + 1, j + 1.
template <class F>
void MeniscusMaker::samples(int i, int j, bool up, F&& act) {
  constexpr int count = 5;
  Column* const c[4] = {&column(i, j), &column(i + 1, j), &column(i + 1, j + 1), &column(i, j + 1)};
  for (int a = 0; a <= count; ++a)
    for (int b = 0; b <= count; ++b) {
      const double u = double(a) / count, v = double(b) / count;
      const std::array<double, 4> w{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
      PlanPoint p{0, 0};
      double face = 0, foot = 0, twist = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        p = p + w[k] * c[k]->place;
        const double z = up ? c[k]->top : c[k]->bottom;
        face += w[k] * z, foot += w[k] * c[k]->bottom;
        twist += k % 2 ? -z : z;
      }
      Sample at{w, w, std::min(u, 1 - u) * std::min(v, 1 - v), 0};
      const double warp = std::abs(twist) * at.most_warp;
      for (std::size_t k = 0; k < 4; ++k)
        at.slope[k] += ((k % 2 == 0) == (twist > 0) ? 1 : -1) * (up ? 1 : -1) * at.most_warp;
      if (up) {
        const auto f = above(p, foot - under);
        if (!f) continue;
        at.overlap = face + warp - (*f - gap);
      } else {
        const auto t = below(p);
        if (!t) continue;
        at.overlap = *t + gap - (face - warp);
      }
      act(at);
    }
}

// Moves the columns of a face as little as possible until it has its gap everywhere; gives the
// largest overlap [mm] there was.
double MeniscusMaker::clear_face(int i, int j, bool up) {
  Column* const c[4] = {&column(i, j), &column(i + 1, j), &column(i + 1, j + 1), &column(i, j + 1)};
  double worst = 0;
  std::array<double, 4> slope{};
  samples(i, j, up, [&](const Sample& at) {
    if (at.overlap > worst) worst = at.overlap, slope = at.slope;
  });
  if (worst <= 1e-3) return 0;
  double squares = 0;
  for (const double a : slope) squares += a * a;
  for (std::size_t k = 0; k < 4; ++k)
    (up ? c[k]->top : c[k]->bottom) += (up ? -1 : 1) * worst * slope[k] / squares;
  return worst;
}

// raises the top of a column towards the height it wants as far as its faces leave room
void MeniscusMaker::raise_top(int i, int j) {
  Column& c = column(i, j);
  double by = c.bottom + c.wanted - c.top;
  for (const auto& [di, dj] : {std::pair{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}) {
    const int fi = i + di, fj = j + dj;
    if (fi < 0 || fj < 0 || fi >= grid_.along || fj >= grid_.across) continue;
    const std::size_t own = di == 0 ? (dj == 0 ? 0 : 3) : (dj == 0 ? 1 : 2);
    samples(fi, fj, true, [&](const Sample& at) {
      const double steepest = at.weight[own] + at.most_warp;
      if (steepest > 1e-9) by = std::min(by, std::max(0.0, -at.overlap) / steepest);
    });
  }
  c.top += std::max(by, 0.0);
}

void MeniscusMaker::clear(bool up) {
  constexpr int passes = 60;
  for (int pass = 0; pass < passes; ++pass) {
    double worst = 0;
    for (int i = 0; i < grid_.along; ++i)
      for (int j = 0; j < grid_.across; ++j) worst = std::max(worst, clear_face(i, j, up));
    if (up && pass < 30)
      for (int i = 0; i <= grid_.along; ++i)
        for (int j = 0; j <= grid_.across; ++j) raise_top(i, j);
    else if (worst == 0)
      return;
  }
}

void MeniscusMaker::bricks() {
  PieceBuilder builder(bones_);
  mesh_.along = grid_.along, mesh_.across = grid_.across, mesh_.layers = grid_.layers;
  mesh_.ds = 1.0 / grid_.along;
  const auto place = [&](int i, int j, int k) {
    const Column& c = column(i, j);
    return global(c.place, c.bottom + (c.top - c.bottom) * k / grid_.layers);
  };
  mesh_.node.assign(columns_.size() * std::size_t(grid_.layers + 1), -1);
  const auto node = [&](int i, int j, int k) {
    int& n = mesh_.node[std::size_t((i * (grid_.across + 1) + j) * (grid_.layers + 1) + k)];
    if (n < 0) n = builder.own(place(i, j, k));
    return n;
  };
  // right: the rim lies to the left of the sweep seen from above, or the other way round
  const PlanPoint a = plan_.at(0.5, 0), b = plan_.at(0.55, 0), c = plan_.at(0.5, 1);
  bool turned = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < 0;
  if (knee_.side == Side::left) turned = !turned;
  for (int i = 0; i < grid_.along; ++i)
    for (int j = 0; j < grid_.across; ++j) {
      bool room = true;
      for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        room = room && column(i + di, j + dj).top - column(i + di, j + dj).bottom >= least_height;
      const int i0 = turned ? i + 1 : i, i1 = turned ? i : i + 1;
      for (int k = 0; k < grid_.layers; ++k) {
        const std::array<std::array<int, 3>, 8> at{{{i0, j, k},
                                                    {i1, j, k},
                                                    {i1, j + 1, k},
                                                    {i0, j + 1, k},
                                                    {i0, j, k + 1},
                                                    {i1, j, k + 1},
                                                    {i1, j + 1, k + 1},
                                                    {i0, j + 1, k + 1}}};
        Corners corners;
        for (std::size_t n = 0; n < 8; ++n) corners[n] = place(at[n][0], at[n][1], at[n][2]);
        const double jacobian = room ? scaled_jacobian(corners) : 0;
        if (jacobian < least_jacobian) {
          ++report_.without_room;
          continue;
        }
        report_.least_scaled_jacobian = std::min(report_.least_scaled_jacobian, jacobian);
        report_.volume += volume_of(corners);
        std::array<int, 8> brick;
        for (std::size_t n = 0; n < 8; ++n) brick[n] = node(at[n][0], at[n][1], at[n][2]);
        builder.piece.bricks.push_back(brick);
      }
    }
  if (builder.piece.bricks.empty()) throw BodyError(mesh_.name + " has no room in the knee");
  report_.bricks = int(builder.piece.bricks.size());
  mesh_.piece = int(between_.pieces.size());
  builder.piece.name = mesh_.name;
  builder.piece.region = tibia_.region;
  builder.piece.kind = PieceKind::brick;
  builder.piece.material = "meniscus";
  builder.piece.bone_a = builder.piece.bone_b = part_name(tibia_, "");
  between_.pieces.push_back(std::move(builder.piece));
}

// equation (2)
void MeniscusMaker::fibres() {
  PieceBuilder builder(bones_);
  const Piece& body = between_.pieces[std::size_t(mesh_.piece)];
  std::map<std::pair<int, int>, double> share;  // edge -> volume
  for (const auto& brick : body.bricks) {
    Corners corners;
    for (std::size_t n = 0; n < 8; ++n) corners[n] = body.nodes[std::size_t(brick[n])].x;
    const double quarter = volume_of(corners) / 4;
    for (const auto& [a, b] : {std::pair{0, 1}, {3, 2}, {4, 5}, {7, 6}})
      share[std::minmax(brick[std::size_t(a)], brick[std::size_t(b)])] += quarter;
  }
  for (const auto& [edge, volume] : share) {
    const double length =
        norm(body.nodes[std::size_t(edge.first)].x - body.nodes[std::size_t(edge.second)].x);
    builder.piece.lines.push_back({builder.of_piece(between_.pieces, mesh_.piece, edge.first),
                                   builder.of_piece(between_.pieces, mesh_.piece, edge.second)});
    builder.piece.line_scale.push_back(fibre_modulus * volume / (length * length));
  }
  builder.piece.name = mesh_.name + ".fibres";
  builder.piece.region = tibia_.region;
  builder.piece.kind = PieceKind::spring;
  builder.piece.law = pull_only(
      "140 MPa along the fibres, 20 MPa across: models after Haut "
      "Donahue 2002, as quoted in one of them",
      "read");
  builder.piece.source = builder.piece.law.source;
  builder.piece.bone_a = builder.piece.bone_b = part_name(tibia_, "");
  between_.pieces.push_back(std::move(builder.piece));
}

void MeniscusMaker::contact(bool up) {
  const Piece& body = between_.pieces[std::size_t(mesh_.piece)];
  ContactPair pair;
  pair.name = mesh_.name + (up ? ".femur" : ".tibia");
  pair.friction = friction;
  pair.source = "friction of cartilage on cartilage 0.02; estimated";
  for (const auto& b : body.bricks) {
    const std::array<int, 4> corners = up ? std::array<int, 4>{b[4], b[5], b[6], b[7]}
                                          : std::array<int, 4>{b[0], b[3], b[2], b[1]};
    // inner faces between layers are none
    const int level = up ? grid_.layers : 0;
    const auto outer = [&](int node) {
      for (int i = 0; i <= grid_.along; ++i)
        for (int j = 0; j <= grid_.across; ++j)
          if (mesh_.at(i, j, level) == node) return true;
      return false;
    };
    if (!std::all_of(corners.begin(), corners.end(), outer)) continue;
    std::array<PieceNode, 4> face;
    for (std::size_t n = 0; n < 4; ++n) face[n] = piece_node(body, mesh_.piece, corners[n]);
    pair.a.quads.push_back(face);
  }
  const Point axis = tibia_.placement.R * Point{0, 0, 1};
  // the faces that it can come to lie on
  Point low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};
  for (const PieceNode& n : body.nodes)
    for (int k = 0; k < 3; ++k)
      low[k] = std::min(low[k], n.x[k]), high[k] = std::max(high[k], n.x[k]);
  constexpr double slide = 12;  // [mm]
  const Knee::Faces& faces = up ? knee_.above : knee_.below;
  for (std::size_t f = 0; f < faces.patch.size(); ++f) {
    const auto& face = faces.patch[f];
    const Point centre = 0.25 * (face[0].x + face[1].x + face[2].x + face[3].x);
    // looks at the meniscus
    const double along = dot(quad_normal(face[0].x, face[1].x, face[2].x, face[3].x), axis);
    bool near = up ? along < -steepest : along > steepest;
    for (int k = 0; k < 3; ++k)
      near = near && centre[k] > low[k] - slide && centre[k] < high[k] + slide;
    if (near && clear_of(face, faces.shell[f], faces.corner_shell[f], pair.a.quads))
      pair.b.quads.push_back(face);
  }
  between_.contacts.push_back(std::move(pair));
}

std::pair<MeniscusMesh, MeniscusReport> MeniscusMaker::make() {
  report_.name = mesh_.name;
  draw_in();
  for (int pass = 0; pass < 20; ++pass) {
    fill_columns();
    clear(false);
    raise_tops();
    clear(true);
    if (!draw_in_again()) break;
  }
  for (int i = 0; i <= grid_.along; ++i) {
    const double s = double(i) / grid_.along;
    const PlanPoint a = plan_.at(s, 0), b = plan_.at(s, inner_[std::size_t(i)]);
    report_.drawn_in = std::max(report_.drawn_in, distance(a, b));
  }
  bricks();
  fibres();
  contact(true), contact(false);
  for (int i = 0; i <= grid_.along; ++i) {
    const Column& rim = column(i, grid_.across);
    report_.rim_height += (rim.top - rim.bottom) / (grid_.along + 1);
    if (i == 0) continue;
    for (const auto& [j, length] :
         {std::pair{0, &report_.inner_length}, {grid_.across, &report_.rim_length}}) {
      const PlanPoint a = column(i - 1, j).place, b = column(i, j).place;
      *length += distance(a, b);
    }
  }
  return {mesh_, report_};
}

}  // namespace

std::vector<MeniscusReport> add_menisci(const std::vector<PlacedBone>& bones,
                                        BetweenBones& between) {
  std::vector<MeniscusReport> reports;
  for (const Articulation& joint : articulations(bones)) {
    if (joint.kind != ArticulationKind::meniscal) continue;
    Knee knee{joint.a, joint.b, joint.side, {}, {}};
    const PlacedBone &femur = bones[std::size_t(joint.a)], &tibia = bones[std::size_t(joint.b)];
    const std::string cartilage =
        fmt::format("{}.{}.{}.cartilage_", name_of(tibia.region), name_of(joint.side), joint.name);
    knee.above = knee_faces(bones, knee.femur, between, cartilage + femur.mesh.name);
    knee.below = knee_faces(bones, knee.tibia, between, cartilage + tibia.mesh.name);
    std::vector<std::pair<MeniscusPlan, MeniscusMesh>> menisci;
    for (const char* name : names) {
      const MeniscusPlan plan(name, tibia.mesh.scale, flexion(femur, tibia));
      auto [mesh, report] = MeniscusMaker(bones, knee, plan, between).make();
      menisci.emplace_back(plan, mesh);
      reports.push_back(report);
    }
    add_meniscus_ligaments(bones, knee, menisci, between);
  }
  return reports;
}

MeniscusRoom::MeniscusRoom(const PlacedBone& femur, const PlacedBone& tibia) : tibia_(tibia) {
  const double bent = flexion(femur, tibia);
  for (const char* name : names) plans_.emplace_back(name, tibia.mesh.scale, bent);
}

double MeniscusRoom::height(const Point& p) const {
  const Point local = tibia_.placement.inverse(p);
  const PlanPoint place{local.x, tibia_.side == Side::left ? -local.y : local.y};
  double height = 0;
  for (const MeniscusPlan& plan : plans_) height = std::max(height, plan.height_at(place));
  return height;
}

}  // namespace fabrica::body
