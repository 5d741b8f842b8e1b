#include "study/compare.h"

#include <fmt/format.h>

#include <cmath>

#include "body/tables.h"
#include "signal/units.h"
#include "study/error.h"
#include "study/measure.h"
#include "study/rate_curve.h"

namespace fabrica::study {
namespace {

// kinds of data against which a rating means something, as the head of a reference file says it
bool is_data(const std::string& provenance) {
  for (const char* kind : {"tabulated", "digitised", "measured", "third-party file",
                           "standard corridor", "derived", "synthetic"})
    if (provenance.starts_with(kind)) return true;
  return false;
}

void scale(std::vector<double>& values, double factor) {
  for (double& v : values) v *= factor;
}

std::size_t index_of_peak(const std::vector<double>& values) {
  std::size_t at = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (std::abs(values[i]) > std::abs(values[at])) at = i;
  return at;
}

// rows in which both are numbers: columns of one file may be of different length
Curve finite(std::vector<double> x, std::vector<double> y) {
  Curve c;
  for (std::size_t i = 0; i < x.size() && i < y.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) c.x.push_back(x[i]), c.y.push_back(y[i]);
  return c;
}

Curve model_curve(const SignalSpec& s, Channels& channels) {
  Curve c = samples(s.model, s.x, s.filter, s.window, channels);
  scale(c.y, s.scale);
  scale(c.x, s.x_scale);
  if (s.start_at) {
    const double from = first_reaching(c.x, c.y, *s.start_at);
    for (double& v : c.x) v -= from;
  }
  return c;
}

// A column of a reference file over its abscissa; of one over time what lies in the signal's
// window.
Curve file_curve(const std::string& column, const SignalSpec& s, Channels& channels) {
  std::vector<double> x = s.reference_x.empty()
                              ? channels.abscissa(column)
                              : channels.column(table_name_of(column) + ":" + s.reference_x);
  const Curve all = finite(std::move(x), channels.column(column));
  if (!s.x.empty() || !s.window) return all;
  Curve part;
  for (std::size_t i = 0; i < all.x.size(); ++i)
    if (all.x[i] >= s.window->first && all.x[i] <= s.window->second)
      part.x.push_back(all.x[i]), part.y.push_back(all.y[i]);
  return part;
}

void need_unit(const SignalSpec& s, Channels& channels, const Case& c) {
  const std::string unit = channels.unit(s.reference);
  if (unit.empty() && !s.unit.empty())
    throw StudyError(c.file, s.line, "signal.reference",
                     "'" + s.reference + "' has no unit in its header",
                     "Name the column \"" + column_of(s.reference) + " [" + s.unit + "]\"");
  if (unit != s.unit)
    throw StudyError(c.file, s.line, "signal.unit",
                     "is '" + s.unit + "', the reference has '" + unit + "'",
                     "Give the reference's unit and the scale that leads to it");
}

// the abscissa of the reference in the unit of the model's, where both are named
void need_abscissa_unit(const SignalSpec& s, Channels& channels, const Case& c) {
  const std::string wanted = s.x.empty() ? c.time_unit : s.x_unit;
  const std::string unit = s.reference_x.empty()
                               ? channels.abscissa_unit(s.reference)
                               : channels.unit(table_name_of(s.reference) + ":" + s.reference_x);
  if (!wanted.empty() && unit != wanted && known_unit(unit))
    throw StudyError(c.file, s.line, "signal.reference",
                     "'" + s.reference + "' is given over " + unit + ", the model over " + wanted,
                     s.x.empty() ? "Convert the reference, or correct time_unit of the case"
                                 : "Convert the reference, or give x_unit and x_scale");
}

void read_reference(const SignalSpec& s, Channels& channels, const Case& c, SignalResult& r) {
  r.reference = file_curve(s.reference, s, channels);
  if (r.reference.x.size() < 2)
    throw StudyError(
        c.file, s.line, "signal.reference",
        "'" + s.reference + "' has fewer than two points" + (s.window ? " in the window" : ""),
        "Take another column");
  const auto& head = channels.head(s.reference);
  const auto text = [&](const char* key) {
    const auto at = head.find(key);
    return at == head.end() ? std::string() : at->second;
  };
  r.provenance = text("provenance");
  r.reference_source = text("source");
  const std::size_t peak = index_of_peak(r.reference.y);
  r.reference_peak = r.reference.y[peak];
  r.reference_peak_at = r.reference.x[peak];
}

void read_corridor(const SignalSpec& s, Channels& channels, const Case& c, SignalResult& r) {
  if (s.low.empty()) return;
  r.low = file_curve(s.low, s, channels);
  r.high = file_curve(s.high, s, channels);
  r.corridor_name = "corridor of the tests";
  if (r.low.x.empty() || r.low.x != r.high.x)
    throw StudyError(c.file, s.line, "signal.corridor",
                     "is empty, or its two edges have different abscissas",
                     "Give two columns of one file");
  for (std::size_t i = 0; i < r.low.y.size(); ++i)
    if (r.low.y[i] > r.high.y[i])
      throw StudyError(c.file, s.line, "signal.corridor",
                       fmt::format("its lower edge lies above the upper one at {:g}", r.low.x[i]),
                       "Name the lower edge first");
}

void rate(const SignalSpec& s, const std::string& time_unit, SignalResult& r) {
  if (!is_data(r.provenance)) {
    r.remark =
        "not rated: the reference file does not say that its numbers are tabulated, digitised or "
        "measured";
    return;
  }
  Rating shown;
  for (const std::string& method : s.rating) {
    const Rating rated = rate_curve(method, r.reference, r.model, {s.unit, time_unit}, s.interval);
    r.ratings[method] = rated.parts;
    if (shown.parts.empty() || method == "cora") shown = rated;
  }
  r.rated_from = shown.from, r.rated_to = shown.to, r.weight = s.weight;
  if (s.low.empty()) {
    r.low = shown.inner_low, r.high = shown.inner_high;
    r.outer_low = shown.outer_low, r.outer_high = shown.outer_high;
    r.corridor_name = "inner corridor";
  }
}

}  // namespace

SignalResult compare_signal(const SignalSpec& s, Channels& channels, const Case& c) {
  SignalResult r;
  r.name = s.name, r.unit = s.unit, r.filter = s.filter, r.x_unit = s.x_unit, r.paper = s.paper;
  if (!s.x.empty())
    r.x_name = !s.x_name.empty()                    ? s.x_name
               : s.x.find(':') == std::string::npos ? s.x
                                                    : column_of(s.x);
  r.model = model_curve(s, channels);
  const std::size_t peak = index_of_peak(r.model.y);
  r.peak = r.model.y[peak], r.peak_at = r.model.x[peak];
  if (!s.paper.empty()) r.paper_total = published_rating(s.paper, c.file, s.line);
  read_corridor(s, channels, c, r);
  if (s.reference.empty()) {
    r.remark = "no reference curve available";
    return r;
  }
  read_reference(s, channels, c, r);
  if (s.rating.empty()) return r;
  need_unit(s, channels, c);
  need_abscissa_unit(s, channels, c);
  rate(s, c.time_unit, r);
  return r;
}

std::vector<std::pair<std::string, double>> published_ratings() {
  const body::Table table("paper/table1_cora.csv");
  std::vector<std::pair<std::string, double>> out;
  for (int i = 0; i < table.rows(); ++i)
    out.emplace_back(table.text(i, "test") + "/" + table.text(i, "signal"),
                     table.number(i, "total"));
  return out;
}

double published_rating(const std::string& row, const std::string& file, int line) {
  const std::string test = row.substr(0, row.find('/'));
  std::string list;
  for (const auto& [name, total] : published_ratings()) {
    if (name == row) return total;
    if (name.starts_with(test + "/") || test == row) list += (list.empty() ? "" : "; ") + name;
  }
  throw StudyError(file, line, "signal.paper",
                   "'" + row + "' is no row of data/paper/table1_cora.csv",
                   list.empty() ? "Write test/signal as there" : "Take one of: " + list);
}

}  // namespace fabrica::study
