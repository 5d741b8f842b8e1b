#include "deck/placement.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex>

namespace fabrica {
namespace {

// product of powers of mass, length, time that a word stands for
struct Dimension {
  const char* name;
  int mass, length, time;
};
constexpr Dimension dimensions[] = {{"mass", 1, 0, 0},       {"length", 0, 1, 0},
                                    {"time", 0, 0, 1},       {"stress", 1, -1, -2},
                                    {"pressure", 1, -1, -2}, {"force", 1, 1, -2},
                                    {"energy", 1, 2, -2},    {"moment", 1, 2, -2},
                                    {"velocity", 0, 1, -1},  {"acceleration", 0, 1, -2},
                                    {"density", 1, -3, 0},   {"area", 0, 2, 0},
                                    {"volume", 0, 3, 0},     {"strain", 0, 0, 0},
                                    {"angle", 0, 0, 0},      {"1", 0, 0, 0},
                                    {"-", 0, 0, 0},          {"rate", 0, 0, -1},
                                    {"frequency", 0, 0, -1}};

// fields that hold points (true) or directions (false), by keyword; "X*": all keywords that start
// with X
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
    {"DATABASE_CROSS_SECTION_PLANE", {"xct", "yct", "zct"}, true},
    {"DATABASE_CROSS_SECTION_PLANE", {"xch", "ych", "zch"}, true},
    {"DATABASE_CROSS_SECTION_PLANE", {"xhev", "yhev", "zhev"}, true},
    {"RIGIDWALL_*", {"xt", "yt", "zt"}, true},
    {"RIGIDWALL_*", {"xh", "yh", "zh"}, true},
    {"RIGIDWALL_*", {"xhev", "yhev", "zhev"}, true},
    {"RIGIDWALL_*", {"vx", "vy", "vz"}, false},
    {"RIGIDWALL_*", {"dx", "dy", "dz"}, false},
};

bool of_keyword(const Geometry& g, std::string_view keyword) {
  const std::string_view name = g.keyword;
  return name.ends_with('*') ? keyword.starts_with(name.substr(0, name.size() - 1))
                             : keyword == name;
}

bool is_geometry(const Card& card, const FieldSchema& f) {
  if (card.schema->name == "DEFINE_TRANSFORMATION") return f.type == FieldType::real;
  for (const Geometry& g : geometry)
    if (of_keyword(g, card.schema->name))
      for (const char* name : g.fields)
        if (f.name == name) return true;
  return false;
}

bool starts(std::string_view text, std::string_view begin) { return text.starts_with(begin); }

// kind of entity that a keyword defines by the first field of its first card
std::string_view defined_kind(std::string_view keyword) {
  static constexpr std::pair<std::string_view, std::string_view> kinds[] = {
      {"PART_CONTACT", "part"},
      {"PART", "part"},
      {"MAT_", "material"},
      {"EOS_", "eos"},
      {"SECTION_", "section"},
      {"HOURGLASS", "hourglass"},
      {"DEFINE_CURVE", "curve"},
      {"DEFINE_TABLE", "table"},
      {"DEFINE_FUNCTION", "curve"},
      {"DEFINE_", "define"},
      {"SET_", "set"}};
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

Placement nest(const Placement& outer, const Placement& inner) {
  Placement p = inner;
  p.node += outer.node, p.element += outer.element, p.part += outer.part,
      p.material += outer.material;
  p.set += outer.set, p.function += outer.function, p.define += outer.define,
      p.other += outer.other;
  p.mass *= outer.mass, p.time *= outer.time, p.length *= outer.length;
  // lengths are converted once, before any map; maps are in the units of the deck
  p.map = compose(outer.map, inner.map);
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
  for (const char* k :
       {"define", "box", "vector", "coordinate_system", "sd_orientation", "transformation"})
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
    const auto d = std::find_if(std::begin(dimensions), std::end(dimensions),
                                [&](const auto& x) { return word == x.name; });
    if (d == std::end(dimensions)) return std::nullopt;
    if (sign == '/') power = -power;
    value *= std::pow(mass, power * d->mass) * std::pow(length, power * d->length) *
             std::pow(time, power * d->time);
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
    return set_row_kind(keyword,
                        card.table_texts_.empty() ? std::string_view{} : card.row_text(row, 0));
  if (starts(keyword, "DATABASE_HISTORY_") && field.name.starts_with("id"))
    return keyword.find("_SET") != keyword.npos       ? "set"
           : starts(keyword, "DATABASE_HISTORY_NODE") ? "node"
                                                      : "element";
  if (keyword == "MAT_RIGID" &&
      (field.name == "lco" || (field.name == "con1" && card.real("cmo") == -1)))
    return field.name == "lco" && card.given("a2") ? std::string_view{} : "define";
  if (row < 0)
    for (const CardSchema& c : card.schema->cards)
      if (!c.fields.empty())
        return &c.fields[0] == &field ? defined_kind(keyword) : std::string_view{};
  return {};
}

void place(const Placement& placement, Card& card,
           const std::function<void(const FieldSchema&, const std::string&)>& problem) {
  // the units of a curve follow from its use (CurveUnits)
  const bool curve = card.schema->name == "DEFINE_CURVE";
  const auto moved = [&](const FieldSchema& f, int row, double value) {
    if (f.type == FieldType::text || value == 0) return value;
    const std::string_view kind = id_kind(card, f, row);
    if (!kind.empty()) return value + (value < 0 ? -1.0 : 1.0) * double(placement.offset(kind));
    if (f.type == FieldType::integer || !placement.factors() || curve || is_geometry(card, f))
      return value;
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

bool place_functions(const Placement& placement, Card& card) {
  const std::string& keyword = card.schema->name;
  if (!starts(keyword, "DEFINE_FUNCTION") && keyword != "DEFINE_CURVE_FUNCTION") return true;
  if (placement.factors()) return false;
  if (keyword != "DEFINE_CURVE_FUNCTION" || placement.function == 0) return true;
  static const std::regex curve(R"(\b([Ll][Cc])(\d{1,15})\b)");
  for (std::string& text : card.table_texts_) {
    std::string out;
    auto from = text.cbegin();
    for (std::sregex_iterator m(text.begin(), text.end(), curve), none; m != none; ++m) {
      out.append(from, (*m)[2].first);
      out += std::to_string(std::stoll((*m)[2]) + placement.function);
      from = (*m)[2].second;
    }
    out.append(from, text.cend());
    text = std::move(out);
  }
  return true;
}

namespace {

// Converts the lengths of *DEFINE_TRANSFORMATION. Its moves stay in the axes of the included file,
// whose own map comes after them.
void convert_lengths(double factor, Card& card) {
  // first and last of the columns a1.. that hold coordinates
  struct Range {
    const char* option;
    int first, last;
  };
  static constexpr Range ranges[] = {
      {"TRANSL", 1, 3}, {"ROTATE", 4, 6}, {"MIRROR", 1, 6}, {"POINT", 2, 4}};
  for (int r = 0; r < card.row_count(); ++r)
    for (const Range& range : ranges)
      if (card.row_text(r, 0) == range.option)
        for (int c = range.first; c <= std::min(range.last, card.columns() - 1); ++c)
          card.table_[std::size_t(r) * std::size_t(card.columns()) + std::size_t(c)] *= factor;
}

// Whether a rectangle, whose second edge is n x l, and radii keep their shape: turns and shifts.
bool keeps_shapes(const Affine& map) {
  if (map.identity) return true;
  const Mat3d square = transpose(map.a) * map.a;
  double error = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) error += std::abs(square(i, j) - (i == j));
  return error < 1e-9 && det(map.a) > 0;
}

// A box stays one where every axis is mapped onto an axis.
bool move_box(const Affine& map, Card& card) {
  Vec3d low{card.real("xmn"), card.real("ymn"), card.real("zmn")},
      high{card.real("xmx"), card.real("ymx"), card.real("zmx")};
  for (int i = 0; i < 3; ++i) {
    double largest = 0, sum = 0;
    for (int j = 0; j < 3; ++j)
      largest = std::max(largest, std::abs(map.a(i, j))), sum += std::abs(map.a(i, j));
    if (sum - largest > 1e-9 * largest) return false;
  }
  const Vec3d a = map(low), b = map(high);
  for (int i = 0; i < 3; ++i) low[i] = std::min(a[i], b[i]), high[i] = std::max(a[i], b[i]);
  card.set("xmn", low.x).set("ymn", low.y).set("zmn", low.z);
  card.set("xmx", high.x).set("ymx", high.y).set("zmx", high.z);
  return true;
}

}  // namespace

bool move_geometry(const Placement& placement, Card& card) {
  if (placement.map.identity && !placement.factors()) return true;
  const std::string& keyword = card.schema->name;
  if (keyword == "DEFINE_TRANSFORMATION") convert_lengths(placement.length, card);
  if (keyword == "DEFINE_BOX") return placement.map.identity || move_box(placement.map, card);
  const bool shaped =
      starts(keyword, "RIGIDWALL_") || starts(keyword, "DATABASE_CROSS_SECTION_PLANE");
  if (shaped && !keeps_shapes(placement.map)) return false;
  if (keyword == "NODE_TRANSFORM")
    return false;  // its moves are meant in the axes of the included file
  if (keyword == "PART" && !card.has_option("INERTIA")) return true;
  if (keyword == "PART") return false;  // the tensor of inertia would have to turn too
  if (keyword == "DEFINE_VECTOR" && card.real("cid") != 0) return true;
  for (const Geometry& g : geometry) {
    const auto [fx, fy, fz] = g.fields;
    if (!of_keyword(g, keyword) || !card.has_field(fx)) continue;
    const Vec3d old{card.real(fx), card.real(fy), card.real(fz)};
    const Vec3d now = g.point ? placement.point(old) : placement.map.direction(old);
    card.set(fx, now.x).set(fy, now.y).set(fz, now.z);
  }
  return true;
}

}  // namespace fabrica
