// Curves, tables, boxes, local systems, vectors and orientations.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "model/affine.h"
#include "model/resolve.h"

namespace fabrica {
namespace {

Vec3d unit(const Vec3d& v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : v;
}

// Points in ascending order; points of equal abscissa stay in theirs.
void sort_points(Curve& curve) {
  std::vector<std::size_t> order(curve.x.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return curve.x[a] < curve.x[b]; });
  const auto x = curve.x, y = curve.y;
  for (std::size_t i = 0; i < order.size(); ++i) curve.x[i] = x[order[i]], curve.y[i] = y[order[i]];
}

// Gives a system its axes. x: local x axis, xy: a vector in the local xy plane; false if they do
// not span a plane.
bool span(CoordinateSystem& system, const Vec3d& x, const Vec3d& xy) {
  const Vec3d ex = unit(x), ez = unit(cross(x, xy)), ey = cross(ez, ex);
  system.axes = {{{ex.x, ex.y, ex.z}, {ey.x, ey.y, ey.z}, {ez.x, ez.y, ez.z}}};
  return norm(ez) > 0.5;
}

}  // namespace

void Resolver::add_curve(const Card& card, Curve curve) {
  curve.id = card.id("lcid");
  curve.title = card.title;
  if (!define("curve", curve.id, int(model_.curves.size()), card, "lcid")) return;
  if (curve.x.empty())
    error(card, "lcid", "empty-curve", "curve " + std::to_string(curve.id) + " has no points",
          "Give at least one point");
  if (!std::is_sorted(curve.x.begin(), curve.x.end())) {
    warning(card, "lcid", "curve-not-ascending",
            "the abscissae of curve " + std::to_string(curve.id) +
                " do not rise; its points are taken in ascending order",
            "Sort the points");
    sort_points(curve);
  }
  model_.curve_map_.emplace(curve.id, int(model_.curves.size()));
  model_.curves.push_back(std::move(curve));
}

void Resolver::read_curve(const Card& card) {
  const double sfa = nonzero(card, "sfa", 1), sfo = nonzero(card, "sfo", 1);
  const double offa = card.real("offa"), offo = card.real("offo");
  Curve curve;
  for (int i = 0; i < card.row_count(); ++i) {
    curve.x.push_back(sfa * (card.row(i, 0) + offa));
    curve.y.push_back(sfo * (card.row(i, 1) + offo));
  }
  curve.for_stress_initialisation = card.integer("sidr") == 1;
  if (sfa < 0) {
    std::reverse(curve.x.begin(), curve.x.end());
    std::reverse(curve.y.begin(), curve.y.end());
  }
  add_curve(card, std::move(curve));
}

// A velocity pulse with raised-cosine ramps:
//   v = vmax (1 - cos(pi (t - tstart) / trise)) / 2 while rising, mirrored while falling,
// whose integral vmax (tend - tstart - trise) is the distance.
void Resolver::read_smooth_curve(const Card& card) {
  const double start = card.real("tstart"), rise = card.real("trise");
  const double distance = card.real("dist");
  double end = card.real("tend"), top = card.real("vmax");
  if (end == 0 && top != 0) end = start + rise + distance / top;
  if (top == 0 && end - start > rise) top = distance / (end - start - rise);
  constexpr int pieces = 50;
  Curve curve;
  if (start > 0) curve.x.push_back(0), curve.y.push_back(0);
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i <= pieces; ++i) {
      const double s = double(i) / pieces;
      const double v = 0.5 * top * (1 - std::cos(std::numbers::pi * (side == 0 ? s : 1 - s)));
      curve.x.push_back(side == 0 ? start + s * rise : end - rise + s * rise);
      curve.y.push_back(v);
    }
  add_curve(card, std::move(curve));
}

// Coinciding abscissae are moved apart by the smallest step a Real can hold, so that slopes stay
// finite.
void Resolver::finish_curves() {
  for (Curve& curve : model_.curves) {
    const std::size_t n = curve.x.size();
    if (n == 0) continue;
    const double span = std::max(std::abs(curve.x.front()), std::abs(curve.x.back()));
    const double step = 1e-6 * (span > 0 ? span : 1);
    for (std::size_t i = 1; i < n; ++i)
      if (curve.x[i] <= curve.x[i - 1]) curve.x[i] = curve.x[i - 1] + step;
    curve.x_real.resize(n), curve.y_real.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      curve.x_real[i] = Real(curve.x[i]), curve.y_real[i] = Real(curve.y[i]);
      if (i > 0 && curve.x_real[i] <= curve.x_real[i - 1])
        curve.x_real[i] =
            std::nextafter(curve.x_real[i - 1], std::numeric_limits<Real>::infinity());
    }
  }
}

void Resolver::read_table(const Card& card) {
  const std::int64_t id = card.id("tbid");
  if (!define("table", id, int(model_.tables.size()), card, "tbid")) return;
  Table t;
  t.id = id;
  const double sfa = nonzero(card, "sfa", 1), offa = card.real("offa");
  for (int i = 0; i < card.row_count(); ++i) t.rate.push_back(sfa * (card.row(i, 0) + offa));

  if (card.schema->name == "DEFINE_TABLE_2D") {
    for (int i = 0; i < card.row_count(); ++i)
      t.curve.push_back(reference("curve", to_id(card.row(i, 1))));
  } else {
    // the curves are the next ones in the deck
    for (std::size_t k = std::size_t(card_index_[&card]) + 1;
         k < model_.cards.size() && t.curve.size() < t.rate.size(); ++k)
      if (const Card& next = *model_.cards[k]; next.schema && next.schema->name == "DEFINE_CURVE")
        t.curve.push_back(reference("curve", next.id("lcid")));
  }
  const bool complete = t.curve.size() == t.rate.size() && !t.rate.empty() &&
                        std::count(t.curve.begin(), t.curve.end(), -1) == 0;
  if (!complete)
    error(card, "tbid", "missing-curve",
          "table " + std::to_string(id) + " lacks a curve for some of its values",
          "Give as many *DEFINE_CURVE after the table as it has values");
  if (!std::is_sorted(t.rate.begin(), t.rate.end()))
    error(card, "tbid", "table-not-ascending",
          "the values of table " + std::to_string(id) + " do not rise", "Sort them");
  t.log_rate = !t.rate.empty() && t.rate.front() < 0;
  model_.table_map_.emplace(id, int(model_.tables.size()));
  model_.tables.push_back(std::move(t));
}

void Resolver::finish_tables() {
  for (Table& t : model_.tables)
    for (std::size_t i = 0; i < t.curve.size(); ++i) {
      t.rate_real.push_back(Real(t.rate[i]));
      t.views.push_back(t.curve[i] >= 0 ? model_.curves[t.curve[i]].view() : CurveView{});
    }
}

void Resolver::read_box(const Card& card) {
  Box box;
  box.id = card.id("boxid");
  box.low = {card.real("xmn"), card.real("ymn"), card.real("zmn")};
  box.high = {card.real("xmx"), card.real("ymx"), card.real("zmx")};
  if (define("box", box.id, int(model_.boxes.size()), card, "boxid")) model_.boxes.push_back(box);
}

void Resolver::add_system(const Card& card, CoordinateSystem system, const Vec3d& x,
                          const Vec3d& xy) {
  if (!span(system, x, xy)) degenerate_system(card, system);
  if (define("coordinate_system", system.id, int(model_.coordinate_systems.size()), card, "cid"))
    model_.coordinate_systems.push_back(system);
}

void Resolver::degenerate_system(const Card& card, const CoordinateSystem& system) {
  error(card, "cid", "degenerate-coordinate-system",
        "the points of system " + std::to_string(system.id) + " lie on one line",
        "Choose a third point off the x axis");
}

void Resolver::read_coordinate_system(const Card& card) {
  CoordinateSystem s;
  s.id = card.id("cid");
  s.origin = {card.real("xo"), card.real("yo"), card.real("zo")};
  const Vec3d l{card.real("xl"), card.real("yl"), card.real("zl")};
  const Vec3d p{card.real("xp"), card.real("yp"), card.real("zp")};
  add_system(card, s, l - s.origin, p - s.origin);
}

void Resolver::read_coordinate_nodes(const Card& card) {
  CoordinateSystem s;
  s.id = card.id("cid");
  s.moves = card.integer("flag") == 1;
  const char* fields[3] = {"n1", "n2", "n3"};
  for (int k = 0; k < 3; ++k) s.node[k] = node(card.id(fields[k]));
  if (s.moves && card.text("dir").find_first_of("YZ") == 0)
    unsupported(card, "dir", "unsupported-axis", "moving axes along y or z are not computed",
                "Number the nodes so that the first two lie on the x axis");
  s.axes = identity3<double>();
  place_system(card, s);
  if (define("coordinate_system", s.id, int(model_.coordinate_systems.size()), card, "cid"))
    model_.coordinate_systems.push_back(s);
}

// Origin and axes of *DEFINE_COORDINATE_NODES. Nodes that are missing are reported with the
// references.
void Resolver::place_system(const Card& card, CoordinateSystem& s) {
  if (*std::min_element(s.node.begin(), s.node.end()) < 0) return;
  const auto& x = model_.nodes.x;
  s.origin = x[s.node[0]];
  if (!span(s, x[s.node[1]] - s.origin, x[s.node[2]] - s.origin)) degenerate_system(card, s);

  // DIR names the axis along the first two nodes: the axes are renamed in cyclic order
  const std::string_view direction = card.text("dir");
  const int turn = direction.starts_with("Y") ? 1 : direction.starts_with("Z") ? 2 : 0;
  const Mat3d along = s.axes;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j) s.axes((k + turn) % 3, j) = along(k, j);
}

// *NODE_TRANSFORM, in the order of the deck. What was already placed by its nodes follows them.
void Resolver::move_nodes() {
  bool moved = false;
  for (const auto& card : model_.cards) {
    if (!card->schema || card->schema->name != "NODE_TRANSFORM") continue;
    for (int r = 0; r < card->row_count(); ++r) {
      const int definition = reference("transformation", to_id(card->row(r, "trsid")));
      if (definition < 0) continue;  // reported with the references
      std::string problem;
      const auto map = affine_of(*model_.cards[definition], problem);
      if (!map) continue;  // reported where it was read
      for (const int n : set_or_all(to_id(card->row(r, "nsid"))))
        model_.nodes.x[n] = (*map)(model_.nodes.x[n]);
      moved = true;
    }
  }
  if (!moved) return;
  for (const auto& card : model_.cards)
    if (card->schema && card->schema->name == "DEFINE_COORDINATE_NODES")
      if (const int s = reference("coordinate_system", card->id("cid")); s >= 0)
        place_system(*card, model_.coordinate_systems[s]);
  for (Part& part : model_.parts)
    if (part.inertia && part.inertia->node >= 0)
      part.inertia->center = model_.nodes.x[part.inertia->node];
}

void Resolver::read_coordinate_vector(const Card& card) {
  CoordinateSystem s;
  s.id = card.id("cid");
  s.origin = {0, 0, 0};
  add_system(card, s, {card.real("xx"), card.real("yx"), card.real("zx")},
             {card.real("xv"), card.real("yv"), card.real("zv")});
}

Vec3d Resolver::to_global(int system, const Vec3d& v) const {
  return system < 0 ? v : transpose(model_.coordinate_systems[system].axes) * v;
}

void Resolver::read_transformation(const Card& card) {
  table("transformation").insert(card.id("tranid"), card_index_[&card]);
}

void Resolver::read_vector(const Card& card) {
  const Vec3d tail{card.real("xt"), card.real("yt"), card.real("zt")};
  const Vec3d head{card.real("xh"), card.real("yh"), card.real("zh")};
  const int system = reference("coordinate_system", card.id("cid"));
  if (define("vector", card.id("vid"), int(vectors_.size()), card, "vid"))
    vectors_.push_back(to_global(system, unit(head - tail)));
}

void Resolver::read_sd_orientation(const Card& card) {
  SdOrientation s;
  s.id = card.id("vid");
  s.option = card.integer("iop");
  s.direction = unit({card.real("xt"), card.real("yt"), card.real("zt")});
  s.node = {node(card.id("nid1")), node(card.id("nid2"))};
  if (define("sd_orientation", s.id, int(model_.sd_orientations.size()), card, "vid"))
    model_.sd_orientations.push_back(s);
}

}  // namespace fabrica
