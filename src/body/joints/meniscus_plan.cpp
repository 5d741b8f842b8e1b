#include "body/joints/meniscus_plan.h"

#include <algorithm>
#include <cmath>

#include "body/catmull_rom.h"
#include "body/tables.h"

namespace fabrica::body {

namespace {

constexpr int pieces = 96;  // of the curves, where lengths and areas are summed
// of the standing body, in the frame of the tibia, whose y joins the malleoli
constexpr PlanPoint backwards{-0.832, -0.554};

double cross2(const PlanPoint& o, const PlanPoint& a, const PlanPoint& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

}  // namespace

MeniscusPlan::MeniscusPlan(const std::string& name, const Point& scale, double flexion)
    : name_(name) {
  const Table table("anatomy/joints/menisci.csv");
  const double q = std::clamp(flexion / 120, 0.0, 1.0), share = q * (1.814 - 0.814 * q);
  const auto place = [&](int row, const char* x, const char* y) {
    const double back = share * table.number(row, "back");
    return PlanPoint{scale.x * (table.number(row, x) + back * backwards.x),
                     scale.y * (table.number(row, y) + back * backwards.y)};
  };
  for (int row = 0; row < table.rows(); ++row)
    if (table.text(row, "meniscus") == name)
      stations_.push_back({place(row, "inner_x", "inner_y"), place(row, "outer_x", "outer_y"),
                           scale.z * table.number(row, "height")});
  if (stations_.size() < 4)
    throw BodyError("anatomy/joints/menisci.csv: meniscus \"" + name + "\" has " +
                    std::to_string(stations_.size()) + " stations, at least 4 are needed");
}

MeniscusPlan::Station MeniscusPlan::station(double s) const {
  const int last = int(stations_.size()) - 1;
  const double at = std::clamp(s, 0.0, 1.0) * last;
  const int i = std::min(int(at), last - 1);
  const auto of = [&](auto value) {
    return catmull_rom(last + 1, i, at - i,
                       [&](int k) { return value(stations_[std::size_t(k)]); });
  };
  return {{of([](const Station& q) { return q.inner.x; }),
           of([](const Station& q) { return q.inner.y; })},
          {of([](const Station& q) { return q.outer.x; }),
           of([](const Station& q) { return q.outer.y; })},
          of([](const Station& q) { return q.rim; })};
}

PlanPoint MeniscusPlan::at(double s, double r) const {
  const Station q = station(s);
  return {(1 - r) * q.inner.x + r * q.outer.x, (1 - r) * q.inner.y + r * q.outer.y};
}

double MeniscusPlan::height(double s, double r) const {
  return edge_height + r * (station(s).rim - edge_height);
}

double MeniscusPlan::height_at(const PlanPoint& p) const {
  for (int i = 0; i < pieces; ++i) {
    const double s = double(i) / pieces, t = double(i + 1) / pieces;
    const PlanPoint a = at(s, 0), b = at(s, 1), c = at(t, 1), d = at(t, 0);
    const double side = cross2(a, b, p), other = cross2(d, c, p);
    // between the two sections, and between inner edge and rim
    if (side * other > 0) continue;
    const double inner = cross2(a, d, p), outer = cross2(b, c, p);
    if (inner * outer > 0) continue;
    const double r = std::abs(inner) / std::max(std::abs(inner) + std::abs(outer), 1e-12);
    return height(0.5 * (s + t), r);
  }
  return 0;
}

double MeniscusPlan::length(double r) const {
  double sum = 0;
  for (int i = 0; i < pieces; ++i) {
    const PlanPoint a = at(double(i) / pieces, r), b = at(double(i + 1) / pieces, r);
    sum += std::hypot(b.x - a.x, b.y - a.y);
  }
  return sum;
}

}  // namespace fabrica::body
