#include "deck/placement.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace fabrica {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

// turn about the axis through p: Rodrigues' formula R = I + sin(t) K + (1 - cos(t)) K^2
std::optional<Affine> turn(const Vec3d& axis, const Vec3d& p, double angle) {
  const double length = norm(axis);
  if (!(length > 0)) return std::nullopt;
  const Vec3d u = (1 / length) * axis;
  const Mat3d k{{{0, -u.z, u.y}, {u.z, 0, -u.x}, {-u.y, u.x, 0}}};
  const Mat3d k2 = k * k;
  Affine t;
  t.identity = false;
  const double s = std::sin(angle * degree), c = 1 - std::cos(angle * degree);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.a(i, j) = (i == j) + s * k(i, j) + c * k2(i, j);
  t.b = p - t.a * p;
  return t;
}

// reflection at the plane through p with normal n: x' = x - 2 n (n . (x - p))
std::optional<Affine> mirror(const Vec3d& p, const Vec3d& normal) {
  const double length = norm(normal);
  if (!(length > 0)) return std::nullopt;
  const Vec3d n = (1 / length) * normal;
  Affine t;
  t.identity = false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.a(i, j) = (i == j) - 2 * n[i] * n[j];
  t.b = (2 * dot(n, p)) * n;
  return t;
}

using Points = std::map<std::int64_t, Vec3d>;

// ROTATE: axis a1-a3 through the point a4-a6 by a7 degrees, or about the line of points a1, a2 by a3
std::optional<Affine> rotation(const Card& card, int r, const double* a, const Points& points, std::string& problem) {
  const bool by_points = a[3] == 0 && a[4] == 0 && a[5] == 0 && a[6] == 0 && !card.row_given(r, 7);
  if (!by_points) {
    const auto t = turn({a[0], a[1], a[2]}, {a[3], a[4], a[5]}, a[6]);
    if (!t) problem = "the axis of ROTATE has no length";
    return t;
  }
  const auto p = points.find(std::int64_t(a[0])), q = points.find(std::int64_t(a[1]));
  if (p == points.end() || q == points.end()) {
    if (a[2] == 0) return Affine();
    problem = "ROTATE names a POINT that is not defined above it";
    return std::nullopt;
  }
  const auto t = turn(q->second - p->second, p->second, a[2]);
  if (!t) problem = "the two points of ROTATE coincide";
  return t;
}

// product of powers of mass, length, time that a word stands for
struct Dimension {
  const char* name;
  int mass, length, time;
};
constexpr Dimension dimensions[] = {
    {"mass", 1, 0, 0},      {"length", 0, 1, 0},        {"time", 0, 0, 1},   {"stress", 1, -1, -2},
    {"pressure", 1, -1, -2}, {"force", 1, 1, -2},        {"energy", 1, 2, -2}, {"moment", 1, 2, -2},
    {"velocity", 0, 1, -1}, {"acceleration", 0, 1, -2}, {"density", 1, -3, 0}, {"area", 0, 2, 0},
    {"volume", 0, 3, 0},    {"strain", 0, 0, 0},        {"angle", 0, 0, 0},  {"1", 0, 0, 0},
    {"-", 0, 0, 0},         {"rate", 0, 0, -1},         {"frequency", 0, 0, -1}};

// fields that hold points (true) or directions (false), by keyword
struct Geometry {
  const char* keyword;
  std::array<const char*, 3> fields;
  bool point;
};
constexpr Geometry geometry[] = {
    {"DEFINE_COORDINATE_SYSTEM", {"xo", "yo", "zo"}, true},
    {"DEFINE_COORDINATE_SYSTEM", {"xl", "yl", "zl"}, true},
    {"DEFINE_COORDINATE_SYSTEM", {"xp", "yp", "zp"}, true},
    {"DEFINE_COORDINATE_VECTOR", {"xx", "yx", "zx"}, false},
    {"DEFINE_COORDINATE_VECTOR", {"xv", "yv", "zv"}, false},
    {"DEFINE_VECTOR", {"xt", "yt", "zt"}, true},
    {"DEFINE_VECTOR", {"xh", "yh", "zh"}, true},
    {"DEFINE_SD_ORIENTATION", {"xt", "yt", "zt"}, false},
    {"PART", {"xc", "yc", "zc"}, true},
};

bool is_geometry(const Card& card, const FieldSchema& f) {
  for (const Geometry& g : geometry)
    if (card.schema->name == g.keyword)
      for (const char* name : g.fields)
        if (f.name == name) return true;
  return false;
}

bool starts(std::string_view text, std::string_view begin) { return text.starts_with(begin); }

// kind of entity that a keyword defines by the first field of its first card
std::string_view defined_kind(std::string_view keyword) {
  static constexpr std::pair<std::string_view, std::string_view> kinds[] = {
      {"PART_CONTACT", "part"}, {"PART", "part"},           {"MAT_", "material"},      {"EOS_", "eos"},
      {"SECTION_", "section"},  {"HOURGLASS", "hourglass"}, {"DEFINE_CURVE", "curve"}, {"DEFINE_TABLE", "table"},
      {"DEFINE_FUNCTION", "curve"}, {"DEFINE_", "define"},  {"SET_", "set"}};
  for (const auto& [begin, kind] : kinds)
    if (starts(keyword, begin)) return kind;
  return {};
}

std::string_view set_row_kind(std::string_view keyword, std::string_view option) {
  if (keyword.ends_with("_ADD")) return "set";
  if (keyword.ends_with("_GENERAL")) {
    if (starts(option, "SET_")) return "set";
    if (option == "PART" || option == "DPART") return "part";
    if (option == "NODE" || option == "DNODE" || option == "SEG" || option == "DSEG") return "node";
    if (option == "BOX" || option == "DBOX") return "box";
    if (option == "ALL") return {};
    return "element";
  }
  if (starts(keyword, "SET_NODE") || starts(keyword, "SET_SEGMENT")) return "node";
  if (starts(keyword, "SET_PART")) return "part";
  return "element";
}

// contact sides: 0 segment set, 1 shell set, 2 part set, 3 part, 4 node set, 6 part set exempted
std::string_view side_kind(const Card& card, const char* type) {
  const int t = card.integer(type);
  return t == 3 ? "part" : t == 5 ? std::string_view{} : std::string_view("set");
}

}  // namespace

Affine compose(const Affine& outer, const Affine& inner) {
  if (outer.identity) return inner;
  if (inner.identity) return outer;
  return {outer.a * inner.a, outer.a * inner.b + outer.b, false};
}

std::optional<Affine> affine_of(const Card& card, std::string& problem) {
  Affine whole;
  Points points;
  for (int r = 0; r < card.row_count(); ++r) {
    std::string option(card.row_text(r, 0));
    for (char& c : option)
      if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
    double a[7];
    for (int i = 0; i < 7; ++i) a[i] = i + 1 < card.columns() ? card.row(r, i + 1) : 0;
    std::optional<Affine> t = Affine();
    if (option == "TRANSL") {
      t->b = {a[0], a[1], a[2]};
      t->identity = false;
    } else if (option == "SCALE") {
      for (int i = 0; i < 3; ++i) t->a(i, i) = a[i] == 0 ? 1 : a[i];
      t->identity = false;
    } else if (option == "ROTATE") {
      t = rotation(card, r, a, points, problem);
    } else if (option == "MIRROR") {
      t = mirror({a[0], a[1], a[2]}, Vec3d{a[3], a[4], a[5]} - Vec3d{a[0], a[1], a[2]});
      if (!t) problem = "the normal of MIRROR has no length";
    } else if (option == "POINT") {
      points[std::int64_t(a[0])] = {a[1], a[2], a[3]};
    } else {
      problem = "transformation " + option + " is not supported";
      return std::nullopt;
    }
    if (!t) return std::nullopt;
    whole = compose(*t, whole);
  }
  return whole;
}

Placement nest(const Placement& outer, const Placement& inner) {
  Placement p = inner;
  p.node += outer.node, p.element += outer.element, p.part += outer.part, p.material += outer.material;
  p.set += outer.set, p.function += outer.function, p.define += outer.define, p.other += outer.other;
  p.mass *= outer.mass, p.time *= outer.time, p.length *= outer.length;
  // lengths are converted once, before any map: the inner map's translation is in the units of its includer
  Affine scaled = inner.map;
  scaled.b = outer.length * scaled.b;
  p.map = compose(outer.map, scaled);
  return p;
}

std::int64_t Placement::offset(std::string_view kind) const {
  if (kind.ends_with("set")) return set;
  if (kind == "node") return node;
  if (kind == "part") return part;
  if (kind == "material" || kind == "eos") return material;
  if (kind == "curve" || kind == "table" || kind == "function") return function;
  for (const char* k : {"element", "solid", "shell", "beam", "discrete"})
    if (kind == k) return element;
  for (const char* k : {"define", "box", "vector", "coordinate_system", "sd_orientation", "transformation"})
    if (kind == k) return define;
  return other;
}

std::optional<double> Placement::factor(std::string_view unit) const {
  if (unit.empty()) return std::nullopt;
  double value = 1;
  char sign = '*';
  while (!unit.empty()) {
    const std::size_t end = std::min(unit.find_first_of("*/"), unit.size());
    std::string_view word = unit.substr(0, end);
    int power = 1;
    if (const std::size_t hat = word.find('^'); hat != word.npos) {
      const std::string_view digits = word.substr(hat + 1);
      const auto [p, e] = std::from_chars(digits.data(), digits.data() + digits.size(), power);
      if (e != std::errc() || p != digits.data() + digits.size()) return std::nullopt;
      word = word.substr(0, hat);
    }
    const auto d = std::find_if(std::begin(dimensions), std::end(dimensions), [&](const auto& x) { return word == x.name; });
    if (d == std::end(dimensions)) return std::nullopt;
    if (sign == '/') power = -power;
    value *= std::pow(mass, power * d->mass) * std::pow(length, power * d->length) * std::pow(time, power * d->time);
    sign = end < unit.size() ? unit[end] : '*';
    unit.remove_prefix(std::min(end + 1, unit.size()));
  }
  return value;
}

std::string_view id_kind(const Card& card, const FieldSchema& field, int row) {
  const std::string& keyword = card.schema->name;
  if (!field.reference.empty()) return field.reference;
  if (starts(keyword, "CONTACT_")) {
    if (field.name == "ssid" && card.has_field("sstyp")) return side_kind(card, "sstyp");
    if (field.name == "msid" && card.has_field("mstyp")) return side_kind(card, "mstyp");
    return field.name == "cid" ? "other" : std::string_view{};
  }
  if (row >= 0 && starts(keyword, "SET_") && field.type == FieldType::integer)
    return set_row_kind(keyword, card.table_texts_.empty() ? std::string_view{} : card.row_text(row, 0));
  if (starts(keyword, "DATABASE_HISTORY_") && field.name.starts_with("id"))
    return keyword.find("_SET") != keyword.npos ? "set" : starts(keyword, "DATABASE_HISTORY_NODE") ? "node" : "element";
  if (keyword == "MAT_RIGID" && (field.name == "lco" || (field.name == "con1" && card.real("cmo") == -1)))
    return field.name == "lco" && card.given("a2") ? std::string_view{} : "define";
  if (row < 0)
    for (const CardSchema& c : card.schema->cards)
      if (!c.fields.empty()) return &c.fields[0] == &field ? defined_kind(keyword) : std::string_view{};
  return {};
}

void place(const Placement& placement, Card& card,
           const std::function<void(const FieldSchema&, const std::string&)>& problem) {
  const auto moved = [&](const FieldSchema& f, int row, double value) {
    if (f.type == FieldType::text || value == 0) return value;
    const std::string_view kind = id_kind(card, f, row);
    if (!kind.empty()) return value + (value < 0 ? -1.0 : 1.0) * double(placement.offset(kind));
    if (f.type == FieldType::integer || !placement.factors() || is_geometry(card, f)) return value;
    if (const auto scale = placement.factor(f.unit)) return value * *scale;
    problem(f, f.unit.empty() ? "its unit is not known" : "unit " + f.unit + " is not understood");
    return value;
  };
  // kinds may depend on values, so nothing is written back before all is known
  std::vector<double> values = card.values, table = card.table_;
  std::size_t i = 0, column = 0;
  for (const CardSchema& c : card.schema->cards)
    for (const FieldSchema& f : c.fields) {
      if (!c.repeats) {
        if (card.values_given[i]) values[i] = moved(f, -1, values[i]);
        ++i;
        continue;
      }
      for (int r = 0; r < card.row_count(); ++r) {
        const std::size_t cell = std::size_t(r) * std::size_t(card.columns()) + column;
        if (card.table_given_[cell]) table[cell] = moved(f, r, table[cell]);
      }
      ++column;
    }
  card.values = std::move(values);
  card.table_ = std::move(table);
}

bool move_geometry(const Placement& placement, Card& card) {
  if (placement.map.identity && !placement.factors()) return true;
  const std::string& keyword = card.schema->name;
  if (starts(keyword, "RIGIDWALL_") || keyword == "DEFINE_BOX" || starts(keyword, "DATABASE_CROSS_SECTION_PLANE"))
    return placement.map.identity;
  if (keyword == "PART" && !card.has_option("INERTIA")) return true;
  if (keyword == "PART") return false;  // the tensor of inertia would have to turn too
  if (keyword == "DEFINE_VECTOR" && card.real("cid") != 0) return true;
  for (const Geometry& g : geometry) {
    if (keyword != g.keyword) continue;
    const auto [fx, fy, fz] = g.fields;
    const Vec3d old{card.real(fx), card.real(fy), card.real(fz)};
    const Vec3d now = g.point ? placement.point(old) : placement.map.direction(old);
    card.set(fx, now.x).set(fy, now.y).set(fz, now.z);
  }
  return true;
}

}  // namespace fabrica
