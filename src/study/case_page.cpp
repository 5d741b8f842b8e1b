#include "study/case_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "study/rate_curve.h"

namespace fabrica::study {
namespace {

std::string figure(double v) { return fmt::format("{:.5g}", v); }
std::string rating(double v) { return fmt::format("{:.3f}", v); }
std::string marked(State s) { return fmt::format("<span class=\"{0}\">{0}</span>", state_name(s)); }
bool is_plain(const std::string& unit) { return unit.empty() || unit == "1" || unit == "-"; }
std::string with_unit(const std::string& name, const std::string& unit) {
  return is_plain(unit) ? name : name + " [" + unit + "]";
}
std::string figure(double v, const std::string& unit) {
  return figure(v) + (is_plain(unit) ? "" : " " + escaped(unit));
}
std::string method_name(const std::string& method) {
  return method == "cora" ? "CORA 3.6" : method == "iso18571" ? "ISO/TS 18571:2014" : method;
}

void add_band(Chart& chart, const std::string& name, const Curve& low, const Curve& high,
              bool outer) {
  if (low.x.empty()) return;
  chart.bands.push_back({name, low.x, low.y, high.y, outer});
}

Chart signal_chart(const SignalResult& s, std::size_t number, const std::string& time_unit) {
  Chart c;
  c.id = fmt::format("signal{}", number);
  c.loop = !s.x_name.empty();
  c.x = c.loop ? with_unit(s.x_name, s.x_unit) : with_unit("time", time_unit);
  c.y = with_unit(s.name, s.unit);
  add_band(c, "outer corridor", s.outer_low, s.outer_high, true);
  add_band(c, s.corridor_name.empty() ? "corridor" : s.corridor_name, s.low, s.high, false);
  c.traces.push_back({"model", s.model.x, s.model.y});
  if (!s.reference.x.empty())
    c.traces.push_back({"reference", s.reference.x, s.reference.y, "dashed"});
  return c;
}

std::string ratings_of(const SignalResult& s, const std::string& time_unit) {
  std::string out;
  std::vector<std::vector<std::string>> rows;
  for (const auto& [method, parts] : s.ratings)
    for (const auto& [part, value] : parts)
      rows.push_back({method_name(method), escaped(part), rating(value),
                      part == "total" ? rating_word(method, value) : ""});
  if (!rows.empty()) {
    out += table({"method", "part", "rating", ""}, rows);
    out += fmt::format(
        "<p class=\"note\">Rated from {:g} to {:g} {}, all other options as the methods' "
        "defaults.</p>\n",
        s.rated_from, s.rated_to, escaped(time_unit));
  }
  if (s.paper_total)
    out +=
        fmt::format("<p>Published rating (CORA 3.6, Iwamoto et al. 2015, Table 1, {}): {}.</p>\n",
                    escaped(s.paper), rating(*s.paper_total));
  return out;
}

std::string signal_section(const SignalResult& s, const Chart& chart,
                           const std::string& time_unit) {
  std::string out = "<h3>" + escaped(s.name) + "</h3>\n" + place_of(chart);
  std::vector<std::vector<std::string>> rows;
  const std::string at = s.x_name.empty() ? time_unit : s.x_unit;
  rows.push_back({"model", figure(s.peak, s.unit), figure(s.peak_at, at)});
  if (s.reference_peak)
    rows.push_back({"reference", figure(*s.reference_peak, s.unit),
                    figure(s.reference_peak_at.value_or(0), at)});
  out += table({"", "peak", "at"}, rows);
  if (!s.filter.empty())
    out += "<p class=\"note\">Filter: " + escaped(s.filter) + " (SAE J211).</p>\n";
  if (!s.remark.empty()) out += "<p><strong>" + escaped(s.remark) + "</strong></p>\n";
  out += ratings_of(s, time_unit);
  if (!s.provenance.empty())
    out += "<p class=\"note\">Reference: " + escaped(s.provenance) +
           (s.reference_source.empty() ? "" : "; " + escaped(s.reference_source)) + "</p>\n";
  return out;
}

std::string check_section(const Outcome& o) {
  if (o.checks.empty()) return "";
  std::vector<std::vector<std::string>> rows;
  for (const CheckResult& c : o.checks)
    rows.push_back({escaped(c.name), c.computed ? figure(c.value) : escaped(c.problem),
                    escaped(c.bound), marked(c.passed ? State::passed : State::failed)});
  return "<h2>Checks</h2>\n" + table({"what", "found", "demanded", ""}, rows);
}

std::string setup_section(const Case& c, const Outcome& o) {
  std::vector<std::vector<std::string>> rows;
  const auto row = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) rows.push_back({name, escaped(value)});
  };
  row("source", c.source);
  row("set-up", c.setup);
  row("deck", c.deck);
  for (const auto& [name, value] : c.body) row("body: " + name, value);
  row("loads", c.loads);
  for (const auto& [name, value] : c.parameters) row("parameter " + name, value);
  if (c.end_time > 0) row("end time", fmt::format("{:g} {}", c.end_time, c.time_unit));
  row("resolution", o.resolution);
  return "<h2>Set-up</h2>\n" + table({}, rows);
}

std::string run_section(const Outcome& o, const PageExtras& e) {
  if (o.summary.is_null()) return "";
  std::vector<std::vector<std::string>> rows;
  const auto row = [&](const char* name, const char* key) {
    if (!o.summary.contains(key)) return;
    const auto& v = o.summary[key];
    rows.push_back({name, v.is_number()
                              ? figure(v.get<double>())
                              : escaped(v.is_string() ? v.get<std::string>() : v.dump())});
  };
  row("ended", "ending"), row("time reached", "time"), row("cycles", "cycles");
  row("elements", "elements"), row("run time [s]", "wall_time"), row("threads", "threads");
  row("element updates a second", "updates_per_second");
  row("energy ratio", "energy_ratio"), row("hourglass energy", "hourglass_energy");
  row("internal energy", "internal_energy"), row("added mass [%]", "added_mass_percent");
  row("rigid walls stop nodes by", "rigid_wall_method"), row("hash of the last state", "hash");
  for (const auto& finding : o.summary.value("findings", nlohmann::ordered_json::array()))
    rows.push_back({"finding", escaped(finding.get<std::string>())});
  std::string out = "<h2>Run</h2>\n" + table({}, rows);
  if (!e.files.empty()) {
    out += "<p class=\"note\">Files read: ";
    for (std::size_t i = 0; i < e.files.size(); ++i) out += (i ? ", " : "") + escaped(e.files[i]);
    out += "</p>\n";
  }
  return out;
}

}  // namespace

std::string case_page(const Case& c, const Outcome& o, const PageExtras& e) {
  std::vector<Chart> charts;
  std::string body =
      "<p><a href=\"../index.html\">all cases</a></p>\n<h1>" + escaped(c.title) + "</h1>\n";
  body += fmt::format("<p>{} {}</p>\n<p>{}</p>\n", marked(o.state), escaped(o.reason),
                      escaped(c.requirement));
  body += setup_section(c, o);
  if (!e.picture.empty())
    body += fmt::format("<h2>Picture</h2>\n<img src=\"{}\" alt=\"states of the run\">\n",
                        escaped(e.picture));
  else if (!e.picture_remark.empty())
    body += "<h2>Picture</h2>\n<p class=\"note\">" + escaped(e.picture_remark) + "</p>\n";
  if (!o.signals.empty()) body += "<h2>Signals</h2>\n";
  for (const SignalResult& s : o.signals) {
    if (!s.model.x.empty()) charts.push_back(signal_chart(s, charts.size() + 1, c.time_unit));
    body += s.model.x.empty()
                ? "<h3>" + escaped(s.name) + "</h3>\n<p>" + escaped(s.remark) + "</p>\n"
                : signal_section(s, charts.back(), c.time_unit);
  }
  if (o.cora_of_all)
    body += fmt::format(
        "<p>CORA 3.6 of all signals, the mean of their totals by weight: <strong>{} "
        "{}</strong>.</p>\n",
        rating(*o.cora_of_all), rating_word("cora", *o.cora_of_all));
  body += check_section(o);
  if (!e.energies.empty()) {
    Chart energy{.id = "energies", .x = with_unit("time", c.time_unit), .y = "energy"};
    for (auto [name, curve] : e.energies) {
      name = name.substr(0, name.rfind("_energy"));  // as the axis says
      std::replace(name.begin(), name.end(), '_', ' ');
      energy.traces.push_back({name, curve.x, curve.y});
    }
    body += "<h2>Energies</h2>\n" + place_of(energy);
    charts.push_back(energy);
  }
  body += run_section(o, e);
  if (!e.readme.empty())
    body += "<h2>Notes</h2>\n<div class=\"notes\">\n" + html_of_markdown(e.readme) + "</div>\n";
  body += fmt::format("<p class=\"note\">Fabrica {}; inputs {}; finished {}.</p>\n",
                      escaped(o.version), escaped(o.fingerprint), escaped(o.finished));
  return page(c.title, "../assets", body, charts);
}

std::string index_page(const std::vector<Outcome>& outcomes) {
  int count[3] = {0, 0, 0};
  std::vector<std::vector<std::string>> rows, rated;
  for (const Outcome& o : outcomes) {
    ++count[int(o.state)];
    int good = 0;
    for (const CheckResult& c : o.checks) good += c.passed;
    const std::string link = fmt::format("<a href=\"{0}/index.html\">{0}</a>", escaped(o.name));
    rows.push_back({link, escaped(o.title), marked(o.state),
                    o.checks.empty() ? "" : fmt::format("{} of {}", good, o.checks.size()),
                    o.run_seconds > 0 ? fmt::format("{:.3g} s", o.run_seconds) : "",
                    escaped(o.reason)});
    for (const SignalResult& s : o.signals)
      for (const auto& [method, parts] : s.ratings)
        rated.push_back({link, escaped(s.name), method_name(method), rating(parts.back().second),
                         rating_word(method, parts.back().second),
                         s.paper_total && method == "cora" ? rating(*s.paper_total) : ""});
    if (o.cora_of_all)
      rated.push_back({link, all_signals, method_name("cora"), rating(*o.cora_of_all),
                       rating_word("cora", *o.cora_of_all), ""});
  }
  std::string body =
      "<h1>Cases</h1>\n" + fmt::format("<p>{} passed, {} failed, {} skipped. Fabrica {}.</p>\n",
                                       count[0], count[1], count[2],
                                       outcomes.empty() ? "" : escaped(outcomes[0].version));
  body += table({"case", "what", "state", "checks", "run time", ""}, rows);
  if (!rated.empty())
    body += "<h2>Ratings</h2>\n" +
            table({"case", "signal", "method", "rating", "", "published"}, rated);
  return page("Cases", "assets", body, {});
}

std::string rating_table(const std::vector<Outcome>& outcomes,
                         const std::vector<std::pair<std::string, double>>& published) {
  // rows of cells: case, signal, method, rating, word, published
  std::vector<std::array<std::string, 6>> rows{
      {"case", "signal", "method", "rating", "", "published"}};
  std::vector<std::string> found;
  for (const Outcome& o : outcomes) {
    for (const SignalResult& s : o.signals) {
      found.push_back(s.paper);
      for (const auto& [method, parts] : s.ratings)
        rows.push_back({o.name, s.name, method, rating(parts.back().second),
                        rating_word(method, parts.back().second),
                        s.paper_total && method == "cora" ? rating(*s.paper_total) : "-"});
      if (s.ratings.empty())
        rows.push_back(
            {o.name, s.name, "-", "-",
             fmt::format("{} (peak {:.4g} {} at {:.4g})", s.remark, s.peak, s.unit, s.peak_at),
             s.paper_total ? rating(*s.paper_total) : "-"});
    }
    if (o.cora_of_all)
      rows.push_back({o.name, all_signals, "cora", rating(*o.cora_of_all),
                      rating_word("cora", *o.cora_of_all), "-"});
  }
  if (rows.size() == 1) return "no signal has been computed yet: run `fabrica validate`\n";
  for (const auto& [name, total] : published)
    if (std::find(found.begin(), found.end(), name) == found.end())
      rows.push_back({"-", name, "cora", "-", "no case yet", rating(total)});
  std::array<std::size_t, 6> width{};
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  std::string out;
  for (const auto& r : rows)
    out += fmt::format("{:<{}}  {:<{}}  {:<{}}  {:>{}}  {:<{}}  {:>{}}\n", r[0], width[0], r[1],
                       width[1], r[2], width[2], r[3], width[3], r[4], width[4], r[5], width[5]);
  return out;
}

}  // namespace fabrica::study
