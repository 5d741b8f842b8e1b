#include "study/study_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/assets.h"
#include "study/campaign.h"
#include "study/html.h"
#include "study/outcome.h"

namespace fabrica::study {
namespace {

// ranks from 0; equal values share the mean of theirs
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> out(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t j = i;
    while (j < order.size() && values[order[j]] == values[order[i]]) ++j;
    for (std::size_t k = i; k < j; ++k) out[order[k]] = 0.5 * double(i + j - 1);
    i = j;
  }
  return out;
}

// the rows in which an output and its reference are numbers
struct Pairs {
  std::vector<double> ours, theirs;
  std::vector<std::string> labels;
};
Pairs pairs_of(const StudyReport& r, std::size_t output) {
  Pairs p;
  for (std::size_t i = 0; i < r.rows.size(); ++i)
    if (std::isfinite(r.rows[i].outputs[output])) {
      p.ours.push_back(r.rows[i].outputs[output]);
      if (!r.references[output].empty()) p.theirs.push_back(r.references[output][i]);
      p.labels.push_back(fmt::format("row {}", r.rows[i].number));
    }
  return p;
}

std::string comparison(const Pairs& p) {
  if (p.theirs.size() < 2) return {};
  return fmt::format("mean error {:.2f} %, rank correlation {:.3f} ({} rows)",
                     100 * mean_error(p.ours, p.theirs), rank_correlation(p.ours, p.theirs),
                     p.ours.size());
}

// the output over everything that varies, and over its reference
std::string output_section(const StudyReport& r, std::size_t output, std::vector<Chart>& charts) {
  const std::string& name = r.plan.outputs[output].measure.name;
  const Pairs p = pairs_of(r, output);
  std::string out =
      "<h2>" + escaped(name) + "</h2>\n<p>" + comparison(p) + "</p>\n<div class=\"charts\">\n";
  const auto add = [&](const std::string& x_name, std::vector<double> x) {
    Chart c{.id = fmt::format("chart{}", charts.size() + 1), .x = x_name, .y = name, .loop = true};
    c.traces.push_back({name, std::move(x), p.ours, "points", p.labels});
    out += place_of(c, true);
    charts.push_back(std::move(c));
  };
  if (!p.theirs.empty()) add("reference", p.theirs);
  for (std::size_t k = 0; k < r.plan.names.size(); ++k) {
    std::vector<double> x;
    for (std::size_t i = 0; i < r.rows.size(); ++i)
      if (std::isfinite(r.rows[i].outputs[output])) x.push_back(std::stod(r.plan.rows[i][k]));
    add(r.plan.names[k], std::move(x));
  }
  return out + "</div>\n";
}

std::string study_page(const StudyReport& r) {
  std::vector<Chart> charts;
  int done = 0;
  for (const StudyRow& row : r.rows) done += row.status == 0;
  std::string body =
      "<h1>" + escaped(r.plan.title) + "</h1>\n" +
      fmt::format(
          "<p>{} of {} rows have a result. The numbers: <a href=\"study.csv\">study.csv</a></p>\n",
          done, r.rows.size());
  for (std::size_t o = 0; o < r.plan.outputs.size(); ++o) body += output_section(r, o, charts);
  return page(r.plan.title, "assets", body, charts);
}

}  // namespace

double mean_error(const std::vector<double>& ours, const std::vector<double>& theirs) {
  double sum = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) sum += std::abs(ours[i] / theirs[i] - 1);
  return sum / double(ours.size());
}

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> x = ranks(a), y = ranks(b);
  const double mean = 0.5 * (double(a.size()) - 1);
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean) * (y[i] - mean);
    xx += (x[i] - mean) * (x[i] - mean);
    yy += (y[i] - mean) * (y[i] - mean);
  }
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : 0;
}

std::string study_table(const StudyReport& r) {
  std::string out = "row";
  for (const std::string& n : r.plan.names) out += "," + n;
  for (std::size_t o = 0; o < r.plan.outputs.size(); ++o) {
    out += "," + r.plan.outputs[o].measure.name;
    if (!r.references[o].empty()) out += "," + r.plan.outputs[o].measure.name + " reference";
  }
  out += ",status,seconds\n";
  for (std::size_t i = 0; i < r.rows.size(); ++i) {
    const StudyRow& row = r.rows[i];
    out += std::to_string(row.number);
    for (const std::string& v : r.plan.rows[i]) out += "," + v;
    for (std::size_t o = 0; o < row.outputs.size(); ++o) {
      out += std::isfinite(row.outputs[o]) ? fmt::format(",{:.9g}", row.outputs[o]) : ",";
      if (!r.references[o].empty()) out += fmt::format(",{:.9g}", r.references[o][i]);
    }
    out += fmt::format(",{},{:.1f}\n", row.status, row.seconds);
  }
  return out;
}

void write_report(const StudyReport& r, const std::string& folder) {
  write_file(folder + "/study.csv", study_table(r));
  write_assets(folder);
  write_file(folder + "/index.html", study_page(r));
  for (std::size_t o = 0; o < r.plan.outputs.size(); ++o)
    if (const std::string text = comparison(pairs_of(r, o)); !text.empty())
      fmt::print("{}: {}\n", r.plan.outputs[o].measure.name, text);
  fmt::print("table: {0}/study.csv\nplots: {0}/index.html\n", folder);
}

}  // namespace fabrica::study
