#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "signal/channel_file.h"
#include "signal/cora.h"
#include "signal/iso18571.h"
#include "signal/time_warping.h"

using namespace fabrica;
namespace fs = std::filesystem;

namespace {

const fs::path vectors = fs::path(FABRICA_SHARED) / "validation" / "rating_vectors";

bool vectors_missing() {
  if (fs::exists(vectors)) return false;
  MESSAGE("skipped: the published rating vectors are not at hand");
  return true;
}

// rows of a csv by their first cell, as text
std::vector<std::vector<std::string>> rows_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> row;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    rows.push_back(row);
  }
  rows.erase(rows.begin());
  return rows;
}

struct Pair {
  Signal reference, signal;
};
Pair pair_of(const std::string& name) {
  const std::string file = (vectors / "pairs" / (name + ".csv")).string();
  Pair p{read_signal(file + ":reference"), read_signal(file + ":comparison")};
  p.reference.unit = "1";
  return p;
}

// a versine pulse of `width` that starts at `start`, over 0 to 200 ms by 0.5 ms
Signal pulse(double start, double width, double height = 1) {
  Signal s{"pulse", "kN", "ms", {}, {}};
  for (int i = 0; i <= 400; ++i) {
    const double t = 0.5 * i, a = (t - start) / width;
    s.x.push_back(t);
    s.y.push_back(a <= 0 || a >= 1 ? 0 : height * std::pow(std::sin(std::numbers::pi * a), 2));
  }
  return s;
}

CoraOptions whole() {
  CoraOptions o;
  o.t_min = 0, o.t_max = 200;
  return o;
}

std::string error_of(auto&& action) {
  try {
    action();
  } catch (const SignalError& e) {
    return e.name();
  }
  return "none";
}

}  // namespace

// The scores are those of an independent engine (github.com/yeonsoo-p/ISO18571, MIT, 1.0.15).
TEST_CASE("ISO 18571: the scores of all public pairs are those of an independent engine") {
  if (vectors_missing()) return;
  int pairs = 0;
  for (const auto& row : rows_of(vectors / "iso18571_expected.csv")) {
    CAPTURE(row[0]);
    const Pair p = pair_of(row[0]);
    const Iso18571Rating r = iso18571(p.reference, p.signal);
    CHECK(std::abs(r.total - std::stod(row[1])) < 1e-4);
    CHECK(std::abs(r.corridor - std::stod(row[2])) < 1e-6);
    CHECK(std::abs(r.phase - std::stod(row[3])) < 1e-6);
    CHECK(std::abs(r.magnitude - std::stod(row[4])) < 1e-4);
    CHECK(std::abs(r.slope - std::stod(row[5])) < 1e-4);
    // the same corridor by the other method
    CoraOptions o;
    o.t_min = p.reference.x.front(), o.t_max = p.reference.x.back();
    CHECK(cora(p.reference, p.signal, o).corridor == r.corridor);
    ++pairs;
  }
  CHECK(pairs == 15);
}

TEST_CASE("CORA: two readings of its equations agree for all public pairs") {
  if (vectors_missing()) return;
  for (const auto& row : rows_of(vectors / "cora_expected.csv")) {
    CAPTURE(row[0]);
    const Pair p = pair_of(row[0]);
    CoraOptions o;
    o.t_min = p.reference.x.front(), o.t_max = p.reference.x.back();
    const CoraRating r = cora(p.reference, p.signal, o);
    const double found[] = {r.corridor, r.largest_k, r.shift,       r.progression,
                            r.size,     r.phase,     r.correlation, r.total};
    for (int i = 0; i < 8; ++i) {
      CAPTURE(i);
      CHECK(std::abs(found[i] - std::stod(row[i + 1])) < 1e-6);
    }
  }
}

// Table 1 of Iwamoto, Nakahira, Kimpara 2015: totals and words printed beside their parts.
TEST_CASE("CORA: totals and words follow from the printed parts of thirty ratings") {
  if (vectors_missing()) return;
  int rows = 0;
  for (const auto& row : rows_of(vectors / "iwamoto2015_table1_cora.csv")) {
    CAPTURE(row[1]);
    const double corridor = std::stod(row[2]), correlation = std::stod(row[6]);
    CHECK(std::abs(cora_correlation(std::stod(row[3]), std::stod(row[4]), std::stod(row[5])) -
                   correlation) < 0.001);
    const double total = cora_total(corridor, correlation);
    CHECK(std::abs(total - std::stod(row[7])) < 0.001);
    CHECK(cora_word(total) == row[8]);
    ++rows;
  }
  CHECK(rows == 30);
}

TEST_CASE("CORA: a curve is fully like itself") {
  const CoraRating r = cora(pulse(50, 80), pulse(50, 80), whole());
  CHECK(r.total == 1);
  CHECK(r.shift == 0);
}

// G = s^2 for y = s x
TEST_CASE(
    "CORA: a smaller amplitude costs its square in size and nothing in progression and phase") {
  const CoraRating r = cora(pulse(50, 80), pulse(50, 80, 0.7), whole());
  CHECK(std::abs(r.size - 0.49) < 1e-12);
  CHECK(std::abs(r.progression - 1) < 1e-12);
  CHECK(r.phase == 1);
}

// (24 - 5) / (24 - 2): limits 1 and 12 % of 200 ms
TEST_CASE("CORA: 5 ms late in 200 ms is the phase 19/22, with a negative shift") {
  const CoraRating r = cora(pulse(50, 80), pulse(55, 80), whole());
  CHECK(r.shift == -5);
  CHECK(std::abs(r.phase - 19.0 / 22.0) < 1e-12);
  CHECK(std::abs(r.progression - 1) < 1e-12);
}

TEST_CASE("CORA: the opposite of a constant has no progression") {
  Signal x = pulse(0, 1), y;
  for (double& v : x.y) v = 2;
  y = x;
  for (double& v : y.y) v = -2;
  CHECK(cora(x, y, whole()).progression < 1e-12);
}

TEST_CASE("CORA: the automatic interval begins and ends where the reference is small") {
  // sin^2 reaches 3 % of its peak at a = asin(sqrt(0.03)) / pi = 0.05541 of 80 ms, 7.5 % at 0.08847
  // from the end
  CoraOptions o;
  o.b_delta_end = 0;
  const CoraRating r = cora(pulse(50, 80), pulse(50, 80), o);
  const double first = 54.5, last = 122.5, margin = 0.01 * (last - first);  // samples next inside
  CHECK(std::abs(r.t_min - (first - margin)) < 0.5);
  CHECK(std::abs(r.t_max - (last + margin)) < 0.5);
}

TEST_CASE("ratings do not change with the unit of the signal") {
  Signal in_newton = pulse(55, 80, 900);
  in_newton.unit = "N";
  for (double& t : in_newton.x) t *= 1e-3;
  in_newton.x_unit = "s";
  const double a = cora(pulse(50, 80), in_newton, whole()).total;
  const double b = cora(pulse(50, 80), pulse(55, 80, 0.9), whole()).total;
  CHECK(std::abs(a - b) < 1e-12);
}

TEST_CASE("bad pairs are refused by name") {
  const Signal good = pulse(50, 80);
  Signal coarse = good, nan = good, bare = good, mass = good, flat = good;
  for (double& t : coarse.x) t *= 2;
  nan.y[7] = std::nan("");
  bare.unit = "";
  mass.unit = "kg";
  for (double& y : flat.y) y = 0;
  CoraOptions narrow = whole(), outside = whole();
  narrow.b_0 = 0.05;
  outside.t_max = 300;
  CHECK(error_of([&] { cora(good, coarse); }) == "different-time-base");
  CHECK(error_of([&] { cora(good, nan); }) == "not-a-number");
  CHECK(error_of([&] { cora(bare, good); }) == "unit-missing");
  CHECK(error_of([&] { cora(good, mass); }) == "different-units");
  CHECK(error_of([&] { cora(flat, good); }) == "flat-reference");
  CHECK(error_of([&] { cora(good, good, narrow); }) == "empty-corridor");
  CHECK(error_of([&] { cora(good, good, outside); }) == "bad-interval");
  CHECK(error_of([&] { iso18571(bare, good); }) == "unit-missing");
  CHECK(error_of([&] { iso18571(good, coarse); }) == "different-time-base");
}

// a path of the whole table by plain recursion over rows, traced back from its end
TEST_CASE("time warping: sums along the path are those of the full table traced back") {
  std::vector<double> a, b;
  for (int i = 0; i < 60; ++i)
    a.push_back(std::sin(0.2 * i)), b.push_back(std::sin(0.2 * i - 0.7) + 0.1 * (i % 3));
  const int n = 60, band = 9;
  std::vector<std::vector<double>> cost(n, std::vector<double>(n, 1e300));
  auto at = [&](int i, int j) -> double { return i < 0 || j < 0 ? 1e300 : cost[i][j]; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (std::abs(i - j) >= band) continue;
      const double before =
          i + j == 0 ? 0 : std::min({at(i - 1, j), at(i, j - 1), at(i - 1, j - 1)});
      cost[i][j] = before + (a[i] - b[j]) * (a[i] - b[j]);
    }
  double difference = 0, reference = 0;
  for (int i = n - 1, j = n - 1;;) {
    difference += std::abs(a[i] - b[j]), reference += std::abs(b[j]);
    if (i + j == 0) break;
    const double up = at(i - 1, j), left = at(i, j - 1), corner = at(i - 1, j - 1);
    if (up <= left && up <= corner)
      --i;
    else if (left <= corner)
      --j;
    else
      --i, --j;
  }
  const WarpedSums sums = warped_sums(a, b, band);
  CHECK(std::abs(sums.difference - difference) < 1e-12);
  CHECK(std::abs(sums.reference - reference) < 1e-12);
}

// every correlation summed as its definition says
TEST_CASE("the best shift is that of the sums written out, raw and centred, early and late") {
  for (const int late : {-13, 0, 9})
    for (const bool centred : {false, true}) {
      CAPTURE(late);
      CAPTURE(centred);
      std::vector<double> r, s;
      for (int i = 0; i < 101; ++i) {
        auto y = [](double t) { return 3 + std::exp(-std::pow((t - 50) / 12, 2)); };
        r.push_back(y(i)), s.push_back(0.8 * y(i - late) + 0.01 * std::sin(2.0 * i));
      }
      const int n = int(r.size()), most = 20;
      int shift = 0;
      double largest = -2;
      for (int m = -most; m <= most; ++m) {
        double c = 0, sr = 0, ss = 0, rr = 0, rs = 0, s2 = 0;
        for (int i = std::max(0, -m); i < n && i + m < n; ++i) {
          const double a = r[i + m], b = s[i];
          c += 1, sr += a, ss += b, rr += a * a, rs += a * b, s2 += b * b;
        }
        const double value =
            centred ? (rs - sr * ss / c) / std::sqrt((rr - sr * sr / c) * (s2 - ss * ss / c))
                    : rs / std::sqrt(rr * s2);
        if (value > largest) largest = value, shift = m;
      }
      const BestShift best = best_shift(r, s, most, centred);
      CHECK(best.shift == shift);
      CHECK(std::abs(best.value - largest) < 1e-11);
    }
}

TEST_CASE(
    "ISO 18571: sampling finer than 0.1 ms is thinned on request, with nearly the same score") {
  Signal x{"x", "kN", "s", {}, {}}, y;
  for (int i = 0; i <= 20000; ++i) {
    const double t = 1e-5 * i;
    x.x.push_back(t);
    x.y.push_back(std::sin(40 * t));
  }
  y = x;
  for (double& v : y.y) v *= 0.8;
  Iso18571Options o;
  o.least_step = 1e-4;
  const Iso18571Rating r = iso18571(x, y, o);
  CHECK(r.edges.inner_low.size() == 2001);
  CHECK(std::abs(r.slope - 0.9) < 1e-3);  // slopes differ by a fifth: 1 - 0.2 / 2
}
