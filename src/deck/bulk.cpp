// *NODE and *ELEMENT_*: the long lists of a mesh, without detours into the model's arrays.
#include <algorithm>
#include <array>
#include <charconv>

#include "deck/context.h"
#include "deck/number.h"

namespace fabrica {
namespace {

struct Column {
  const char* name;
  bool integer;
  int column, width;
};

// fields one behind the other; widths become 20 in long format, and 10 instead of 8 for integers
// with I10
class Layout {
 public:
  struct Field {
    const char* name;
    bool integer;
    int width;
  };
  Layout(std::initializer_list<Field> fields, Format format) {
    int at = 0;
    for (const Field& f : fields) {
      int width = f.width;
      if (format.long_fields)
        width = 20;
      else if (format.wide_ids && f.integer && f.width == 8)
        width = 10;
      columns.push_back({f.name, f.integer, at, width});
      places.push_back({at, width});
      at += width;
    }
  }
  std::vector<Column> columns;
  std::vector<FieldPlace> places;
};

// the values of one line
struct Row {
  std::array<double, 12> real{};
  std::array<std::int64_t, 12> integer{};
  int last = -1;  // last field that is not blank
  bool good = true;
};

std::string_view without_blanks(std::string_view t) {
  while (!t.empty() && t.front() == ' ') t.remove_prefix(1);
  while (!t.empty() && t.back() == ' ') t.remove_suffix(1);
  return t;
}

// plain numbers in fixed columns; false if there is anything else
bool read_plain(std::string_view line, const Layout& layout, Row& row) {
  row = Row();
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const Column& c = layout.columns[i];
    if (std::size_t(c.column) >= line.size()) return true;
    const std::string_view text =
        without_blanks(line.substr(std::size_t(c.column), std::size_t(c.width)));
    if (text.empty()) continue;
    row.last = int(i);
    const char* const end = text.data() + text.size();
    if (c.integer) {
      const auto [p, e] = std::from_chars(text.data(), end, row.integer[i]);
      if (e != std::errc() || p != end) return false;
    } else {
      const auto [p, e] = std::from_chars(text.data(), end, row.real[i]);
      if (e != std::errc() || p != end || !std::isfinite(row.real[i])) return false;
    }
  }
  return true;
}

class BulkReader {
 public:
  BulkReader(Context& context, Block& block)
      : context_(context), block_(block), p_(block.placement) {}

  // moves to the next line that is not blank and reads it
  bool next(const Layout& layout, Row& row) {
    while (block_.next()) {
      if (without_blanks(block_.line()).empty()) continue;
      read(layout, row);
      return true;
    }
    return false;
  }
  // the next line, which may be blank, of an element that has several
  bool follow(const Layout& layout, Row& row) {
    if (!block_.next()) {
      context_.error("truncated-card", block_.here(), block_.keyword, "",
                     "the last element lacks its next line", "Give every line of the element");
      return false;
    }
    read(layout, row);
    return true;
  }

  void nodes() {
    const Layout layout({{"nid", true, 8},
                         {"x", false, 16},
                         {"y", false, 16},
                         {"z", false, 16},
                         {"tc", true, 8},
                         {"rc", true, 8}},
                        block_.format);
    Row row;
    while (next(layout, row)) {
      if (!row.good || !positive(row.integer[0], "nid")) continue;
      for (int i = 4; i < 6; ++i)
        if (row.integer[i] < 0 || row.integer[i] > 7)
          context_.error("value-out-of-range", block_.here(), block_.keyword,
                         layout.columns[i].name,
                         std::to_string(row.integer[i]) + " is not a constraint code from 0 to 7",
                         "Use 0 to 7");
      context_.builder.add_node(row.integer[0] + p_.node,
                                p_.point({row.real[1], row.real[2], row.real[3]}),
                                int(row.integer[4]) & 7, int(row.integer[5]) & 7, block_.here());
    }
  }

  void solids() {
    const Layout one({{"eid", true, 8},
                      {"pid", true, 8},
                      {"n1", true, 8},
                      {"n2", true, 8},
                      {"n3", true, 8},
                      {"n4", true, 8},
                      {"n5", true, 8},
                      {"n6", true, 8},
                      {"n7", true, 8},
                      {"n8", true, 8}},
                     block_.format);
    const Layout two({{"n1", true, 8},
                      {"n2", true, 8},
                      {"n3", true, 8},
                      {"n4", true, 8},
                      {"n5", true, 8},
                      {"n6", true, 8},
                      {"n7", true, 8},
                      {"n8", true, 8},
                      {"n9", true, 8},
                      {"n10", true, 8}},
                     block_.format);
    Row row, second;
    while (next(one, row)) {
      const Location here = block_.here();
      std::array<std::int64_t, 10> n{};
      bool good = row.good;
      if (row.last >= 2) {
        for (int i = 0; i < 8; ++i) n[i] = row.integer[i + 2];
      } else {
        if (!follow(two, second)) return;
        good = good && second.good;
        for (int i = 0; i < 10; ++i) n[i] = second.integer[i];
      }
      const int count = count_nodes(n.data(), 10);
      if (!good || !positive(row.integer[0], "eid")) continue;
      if ((count != 4 && count != 6 && count != 8 && count != 10) || has_gap(n.data(), count)) {
        wrong_count(count, "4, 6, 8 or 10", here);
        continue;
      }
      offset(n.data(), count);
      context_.builder.add_solid(row.integer[0] + p_.element, row.integer[1] + p_.part, n.data(),
                                 count, here);
    }
  }

  void shells(bool second_line) {
    const Layout one({{"eid", true, 8},
                      {"pid", true, 8},
                      {"n1", true, 8},
                      {"n2", true, 8},
                      {"n3", true, 8},
                      {"n4", true, 8},
                      {"n5", true, 8},
                      {"n6", true, 8},
                      {"n7", true, 8},
                      {"n8", true, 8}},
                     block_.format);
    const Layout two({{"thic1", false, 16},
                      {"thic2", false, 16},
                      {"thic3", false, 16},
                      {"thic4", false, 16},
                      {"beta", false, 16}},
                     block_.format);
    Row row, extra;
    while (next(one, row)) {
      const Location here = block_.here();
      std::array<std::int64_t, 8> n{};
      for (int i = 0; i < 8; ++i) n[i] = row.integer[i + 2];
      const int count = count_nodes(n.data(), 8);
      if (second_line && !follow(two, extra)) return;
      if (second_line && count > 4) block_.next();
      if (!row.good || !positive(row.integer[0], "eid")) continue;
      if (count < 3 || has_gap(n.data(), count)) {
        wrong_count(count, "3 or 4", here);
        continue;
      }
      if (count > 4) {
        context_.report(Severity::unsupported, "unsupported-element", here, block_.keyword, "n5",
                        "shells of 6 and 8 nodes are not computed", "Use shells of 3 or 4 nodes");
        continue;
      }
      offset(n.data(), 4);
      std::array<double, 4> thickness{};
      for (int i = 0; i < 4 && second_line; ++i) thickness[i] = extra.real[i] * p_.length;
      const bool given = second_line && thickness != std::array<double, 4>{};
      context_.builder.add_shell(row.integer[0] + p_.element, row.integer[1] + p_.part, n.data(), 4,
                                 given ? thickness.data() : nullptr,
                                 second_line ? extra.real[4] : 0.0, here);
    }
  }

  void beams(bool thickness, bool orientation) {
    const Layout one({{"eid", true, 8},
                      {"pid", true, 8},
                      {"n1", true, 8},
                      {"n2", true, 8},
                      {"n3", true, 8},
                      {"rt1", true, 8},
                      {"rr1", true, 8},
                      {"rt2", true, 8},
                      {"rr2", true, 8},
                      {"local", true, 8}},
                     block_.format);
    const Layout parameters({{"parm1", false, 16},
                             {"parm2", false, 16},
                             {"parm3", false, 16},
                             {"parm4", false, 16},
                             {"parm5", false, 16}},
                            block_.format);
    const Layout vector({{"vx", false, 10}, {"vy", false, 10}, {"vz", false, 10}}, block_.format);
    Row row, extra;
    while (next(one, row)) {
      const Location here = block_.here();
      if (thickness) {
        if (!follow(parameters, extra)) return;
        for (int i = 0; i < 5; ++i)
          if (extra.real[i] != 0)
            unsupported("parm" + std::to_string(i + 1), "section values by element");
      }
      Vec3d v{0, 0, 0};
      if (orientation) {
        if (!follow(vector, extra)) return;
        v = p_.map.direction({extra.real[0], extra.real[1], extra.real[2]});
      }
      if (!row.good || !positive(row.integer[0], "eid")) continue;
      for (int i = 5; i < 9; ++i)
        if (row.integer[i] != 0) unsupported(one.columns[i].name, "releases of beam ends");
      std::int64_t n[3] = {row.integer[2], row.integer[3], row.integer[4]};
      if (has_gap(n, 2)) {
        wrong_count(count_nodes(n, 2), "2 or 3", here);
        continue;
      }
      offset(n, 3);
      context_.builder.add_beam(row.integer[0] + p_.element, row.integer[1] + p_.part, n[0], n[1],
                                n[2], orientation ? &v : nullptr, here);
    }
  }

  void discretes() {
    const Layout layout({{"eid", true, 8},
                         {"pid", true, 8},
                         {"n1", true, 8},
                         {"n2", true, 8},
                         {"vid", true, 8},
                         {"s", false, 16},
                         {"pf", true, 8},
                         {"offset", false, 16}},
                        block_.format);
    Row row;
    while (next(layout, row)) {
      if (!row.good || !positive(row.integer[0], "eid")) continue;
      std::int64_t n[2] = {row.integer[2], row.integer[3]};
      if (n[0] == 0 && n[1] == 0) {
        wrong_count(0, "1 or 2", block_.here());
        continue;
      }
      offset(n, 2);
      const std::int64_t vid = row.integer[4] ? row.integer[4] + p_.define : 0;
      context_.builder.add_discrete(row.integer[0] + p_.element, row.integer[1] + p_.part, n[0],
                                    n[1], vid, row.real[5] == 0 ? 1.0 : row.real[5],
                                    row.real[7] * p_.length, block_.here());
    }
  }

  void masses() {
    const Layout layout({{"eid", true, 8}, {"nid", true, 8}, {"mass", false, 16}, {"pid", true, 8}},
                        block_.format);
    Row row;
    while (next(layout, row)) {
      if (!row.good || !positive(row.integer[1], "nid") || !not_negative(row.real[2], "mass"))
        continue;
      const std::int64_t part = row.integer[3] ? row.integer[3] + p_.part : 0;
      context_.builder.add_mass(row.integer[0] + p_.element, row.integer[1] + p_.node,
                                row.real[2] * p_.mass, part, block_.here());
    }
  }

  void inertias() {
    const Layout one({{"eid", true, 8}, {"nid", true, 8}, {"csid", true, 8}}, block_.format);
    const Layout two({{"ixx", false, 10},
                      {"ixy", false, 10},
                      {"ixz", false, 10},
                      {"iyy", false, 10},
                      {"iyz", false, 10},
                      {"izz", false, 10},
                      {"mass", false, 10}},
                     block_.format);
    Row row, second;
    while (next(one, row)) {
      const Location here = block_.here();
      if (!follow(two, second)) return;
      if (!row.good || !second.good || !positive(row.integer[1], "nid") ||
          !not_negative(second.real[6], "mass"))
        continue;
      if (row.integer[2] != 0) unsupported("csid", "inertia in a local system");
      if (!p_.map.identity)
        context_.error("transform-unsupported", here, block_.keyword, "ixx",
                       "the tensor is not turned",
                       "Give the nodal inertia outside *INCLUDE_TRANSFORM");
      std::array<double, 6> inertia{};
      for (int i = 0; i < 6; ++i) inertia[i] = second.real[i] * p_.mass * p_.length * p_.length;
      context_.builder.add_inertia(row.integer[0] + p_.element, row.integer[1] + p_.node,
                                   second.real[6] * p_.mass, inertia, here);
    }
  }

 private:
  void read(const Layout& layout, Row& row) {
    if (!block_.long_line && read_plain(block_.line(), layout, row)) return;
    // anything unusual: commas, parameters, Fortran numbers, tabs, errors
    row = Row();
    cut_fields(block_.line(), layout.places, 1 << 30, texts_);
    for (std::size_t i = 0; i < layout.columns.size(); ++i) {
      const Column& c = layout.columns[i];
      double value = 0;
      bool given = false;
      if (!context_.number(block_, block_.here(), c.name, texts_.text[i], c.integer, value, given))
        row.good = false;
      if (given) row.last = int(i);
      if (c.integer)
        row.integer[i] = std::abs(value) < 9e15 ? std::int64_t(value) : 0;
      else
        row.real[i] = value;
    }
  }
  static int count_nodes(const std::int64_t* n, int most) {
    int count = 0;
    for (int i = 0; i < most; ++i)
      if (n[i] != 0) count = i + 1;
    return count;
  }
  static bool has_gap(const std::int64_t* n, int count) { return std::count(n, n + count, 0) > 0; }
  void offset(std::int64_t* n, int count) const {
    for (int i = 0; i < count; ++i)
      if (n[i] != 0) n[i] += p_.node;
  }
  bool positive(std::int64_t id, const char* field) {
    constexpr std::int64_t largest = 1'000'000'000'000'000;
    if (id > 0 && id < largest) return true;
    context_.error("value-out-of-range", block_.here(), block_.keyword, field,
                   "id " + std::to_string(id) + " is not a positive number",
                   "Give ids from 1 upwards");
    return false;
  }
  bool not_negative(double value, const char* field) {
    if (value >= 0) return true;
    context_.error("value-out-of-range", block_.here(), block_.keyword, field,
                   std::to_string(value) + " is negative", "Give a mass of zero or more");
    return false;
  }
  void wrong_count(int count, const std::string& expected, Location where) {
    context_.error("wrong-node-count", where, block_.keyword, "n1",
                   "the element names " + std::to_string(count) +
                       " nodes or leaves one out, expected " + expected,
                   "Complete the node list; repeat nodes for degenerate shapes");
  }
  void unsupported(const std::string& field, const std::string& what) {
    context_.report(Severity::unsupported, "unsupported-field", block_.here(), block_.keyword,
                    field, what + " are not computed", "Leave the field blank");
  }

  Context& context_;
  Block& block_;
  const Placement& p_;
  FieldTexts texts_;
};

// the options of a keyword behind its stem, or false if it has others than allowed
bool options_after(std::string_view keyword, std::string_view stem,
                   std::initializer_list<std::string_view> allowed,
                   std::vector<std::string_view>& found) {
  if (!keyword.starts_with(stem)) return false;
  keyword.remove_prefix(stem.size());
  found.clear();
  while (!keyword.empty()) {
    bool any = false;
    for (const std::string_view option : allowed)
      if (keyword.size() > option.size() && keyword[0] == '_' &&
          keyword.substr(1).starts_with(option)) {
        found.push_back(option);
        keyword.remove_prefix(option.size() + 1);
        any = true;
        break;
      }
    if (!any) return false;
  }
  return true;
}

}  // namespace

bool read_bulk(Context& context, Block& block) {
  BulkReader reader(context, block);
  std::vector<std::string_view> options;
  const auto has = [&](std::string_view o) {
    return std::find(options.begin(), options.end(), o) != options.end();
  };
  if (block.keyword == "NODE")
    reader.nodes();
  else if (block.keyword == "ELEMENT_SOLID")
    reader.solids();
  else if (options_after(block.keyword, "ELEMENT_SHELL", {"THICKNESS", "BETA"}, options))
    reader.shells(!options.empty());
  else if (options_after(block.keyword, "ELEMENT_BEAM", {"THICKNESS", "ORIENTATION"}, options))
    reader.beams(has("THICKNESS"), has("ORIENTATION"));
  else if (block.keyword == "ELEMENT_DISCRETE")
    reader.discretes();
  else if (block.keyword == "ELEMENT_MASS")
    reader.masses();
  else if (block.keyword == "ELEMENT_INERTIA")
    reader.inertias();
  else
    return false;
  return true;
}

}  // namespace fabrica
