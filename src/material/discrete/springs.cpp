#include "material/discrete/springs.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace fabrica {

SpringForce ElastoplasticSpring::force(const SpringMotion& m, SpringState& s) const {
  const double trial = k * (m.d - s.plastic);
  const double hardening = kt < k ? k * kt / (k - kt) : 0.0;
  const double over = std::fabs(trial) - (fy + hardening * s.amount);
  if (over <= 0 || fy <= 0) return {trial, k, 0};
  // return to the yield force: it grows by H da while the trial force falls by K da
  const double da = over / (k + hardening);
  s.amount += da;
  s.plastic += trial > 0 ? da : -da;
  return {k * (m.d - s.plastic), k, 0};
}

NonlinearSpring NonlinearSpring::from(const Parameters& p) {
  NonlinearSpring law;
  law.deflection = Polyline(p.curve("lcd"));
  law.rate_factor = Polyline(p.curve("lcr"));
  if (law.deflection) return law;
  const TableView t = p.table("lcd");
  law.log_rate = t.log_rate;
  for (int i = 0; i < t.n; ++i) {
    law.rates.push_back(t.rate[i]);
    law.family.emplace_back(t.curves[i]);
  }
  return law;
}

SpringForce NonlinearSpring::force(const SpringMotion& m, SpringState&) const {
  if (!family.empty()) return from_family(m);
  double slope = 0, factor_slope = 0;
  const double f = deflection.at(m.d, slope);
  const double factor = rate_factor ? rate_factor.at(m.rate, factor_slope) : 1.0;
  return {f * factor, std::max(slope * factor, 0.0), std::max(f * factor_slope, 0.0)};
}

SpringForce NonlinearSpring::from_family(const SpringMotion& m) const {
  const double r = log_rate ? std::log(std::max(std::fabs(m.rate), 1e-300)) : m.rate;
  const auto above = std::upper_bound(rates.begin(), rates.end(), r);
  double slope = 0, slope2 = 0;
  if (above == rates.begin() || above == rates.end()) {
    const double f = (above == rates.begin() ? family.front() : family.back()).at(m.d, slope);
    return {f, std::max(slope, 0.0), 0};
  }
  const std::size_t i = std::size_t(above - rates.begin()) - 1;
  const double w = (r - rates[i]) / (rates[i + 1] - rates[i]);
  const double a = family[i].at(m.d, slope), b = family[i + 1].at(m.d, slope2);
  const double dr = (b - a) / (rates[i + 1] - rates[i]);
  const double damping = log_rate ? dr / std::max(std::fabs(m.rate), 1e-300) : dr;
  return {a + w * (b - a), std::max(slope + w * (slope2 - slope), 0.0), std::max(damping, 0.0)};
}

GeneralSpring GeneralSpring::from(const Parameters& p) {
  GeneralSpring law{Polyline(p.curve("lcdl")), Polyline(p.curve("lcdu")), p.real("beta"),
                    p.real("tyi"), p.real("cyi")};
  // without an unloading curve the spring unloads with the steepest slope of the loading curve
  if (!law.unloading) law.unloading = Polyline::line(law.loading.steepest());
  return law;
}

void GeneralSpring::move_window(int side, double force, SpringState& s) const {
  double& edge = side > 0 ? s.high : s.low;
  double& other = side > 0 ? s.low : s.high;
  const double change = force - (side > 0 ? high(s) : low(s));
  edge += change;
  if (beta == 1) other -= change;
  if (beta != 0 && beta != 1) other += change;
}

// Where on the loading curve a side begins to yield, and the force by which the curve is moved,
// when the path comes to its edge from the other side.
void GeneralSpring::enter(int side, SpringState& s) const {
  const double edge = side > 0 ? high(s) : low(s);
  double& reached = side > 0 ? s.reached_high : s.reached_low;
  s.back = 0;
  if (beta == 0) {
    if (reached == 0) reached = loading.inverse(edge);
  } else if (beta == 1) {
    reached = loading.inverse(edge);
  } else {
    const double first = side > 0 ? tension_yield : compression_yield;
    reached = loading.inverse(first);
    s.back = edge - first;
  }
  s.plastic = s.shift + unloading.inverse(edge) - reached;
  s.side = side;
}

// On the loading curve at the given side of the window.
SpringForce GeneralSpring::yield(int side, double d, SpringState& s) const {
  SpringForce r;
  r.force = s.back + loading.at(d - s.plastic, r.stiffness);
  // only BETA = 0 lets the force fall below the edge
  const double edge = side > 0 ? high(s) : low(s);
  if (beta != 0 && side * (r.force - edge) < 0) r.force = edge;
  (side > 0 ? s.reached_high : s.reached_low) = d - s.plastic;
  move_window(side, r.force, s);
  s.yielded = s.side = side;
  // where an unloading from here would run
  s.shift = d - unloading.inverse(r.force);
  r.stiffness = std::max({r.stiffness, unloading.steepest(), 0.0});
  return r;
}

SpringForce GeneralSpring::force(const SpringMotion& m, SpringState& s) const {
  const double step = m.d - s.last;
  s.last = m.d;
  SpringForce r;
  const auto edge_passed = [&] { return r.force > high(s) ? 1 : r.force < low(s) ? -1 : 0; };
  if (s.yielded == 0) {
    r.force = loading.at(m.d, r.stiffness);
    // by position, since a softening curve may never rise above its yield force
    const int side = m.d > loading.inverse(tension_yield)       ? 1
                     : m.d < loading.inverse(compression_yield) ? -1
                                                                : 0;
    r.stiffness = std::max(r.stiffness, 0.0);
    return side == 0 ? r : yield(side, m.d, s);
  }
  // still loading on the side that yields
  if (std::fabs(s.yielded) == 1 && s.yielded * step >= 0) return yield(int(s.yielded), m.d, s);
  // elastic path inside the window
  s.yielded = 2;
  r.force = unloading.at(m.d - s.shift, r.stiffness);
  r.stiffness = std::max(r.stiffness, 0.0);
  const int side = edge_passed();
  if (side == 0) return r;
  if (side != int(s.side)) enter(side, s);
  return yield(side, m.d, s);
}

MaxwellSpring MaxwellSpring::from(const Parameters& p) {
  // a blank cut-off time means none
  const double tc = p.real("tc");
  return {p.real("k0"), p.real("ki"), p.real("beta"), tc > 0 ? tc : 1e20, p.real("fc")};
}

SpringForce MaxwellSpring::force(const SpringMotion& m, SpringState& s) const {
  const double change = m.d - s.last;
  s.last = m.d;
  if (m.time >= tc) return {fc, 0, 0};
  // exact for an elongation that is linear within the step
  const double z = beta * m.dt;
  const double fade = z > 0 ? -std::expm1(-z) / z : 1.0;
  s.viscous = std::exp(-z) * s.viscous + (k0 - ki) * fade * change;
  return {ki * m.d + s.viscous, std::max(k0, ki), 0};
}

InelasticSpring InelasticSpring::from(const Parameters& p) {
  InelasticSpring law{Polyline(p.curve("lcfd")), p.real("ku"), p.real("ctf") < 0 ? 1 : -1};
  law.unloading = std::max(law.unloading, law.curve.steepest());
  return law;
}

SpringForce InelasticSpring::force(const SpringMotion& m, SpringState& s) const {
  const double x = side * m.d;
  SpringForce r;
  if (x >= s.plastic && x > 0) {
    s.plastic = x;
    r.force = curve.at(x, r.stiffness);
  } else if (s.plastic > 0) {
    r.force = std::max(0.0, curve.at(s.plastic) - unloading * (s.plastic - x));
  }
  r.stiffness = r.force > 0 ? unloading : std::max(r.stiffness, 0.0);
  r.force *= side;
  return r;
}

namespace {
// the curve of a negative field; a missing one is an error
Polyline curve_of(const Parameters& p, const char* field) {
  if (p.real(field) >= 0) return {};
  const CurveView c = p.curve(field);
  if (c) return Polyline(c);
  throw std::invalid_argument(
      "the field " + std::string(field) + " names curve " + std::to_string(-p.integer(field)) +
      ", which is not a curve of the model; define it by points, or by a function that is "
      "evaluated");
}
}  // namespace

MuscleSpring MuscleSpring::from(const Parameters& p) {
  MuscleSpring m{};
  m.l0 = p.given("l0") ? p.real("l0") : 1.0;
  m.vmax = p.real("vmax"), m.sv = p.given("sv") ? p.real("sv") : 1.0;
  m.a = p.real("a"), m.fmax = p.real("fmax"), m.lmax = p.real("lmax"), m.ksh = p.real("ksh");
  m.exponential = p.real("fpe") == 0;
  m.activation = curve_of(p, "a"), m.speed = curve_of(p, "sv");
  m.length = curve_of(p, "tl"), m.velocity = curve_of(p, "tv"), m.passive = curve_of(p, "fpe");
  if (m.l0 <= 0) throw std::invalid_argument("L0, the optimal length, is not positive");
  if (m.velocity && m.vmax * (m.speed ? 1.0 : m.sv) <= 0)
    throw std::invalid_argument("TV is a curve of velocity / VMAX, but VMAX SV is not positive");
  if (m.exponential && m.lmax <= 0)
    throw std::invalid_argument(
        "FPE = 0 asks for the exponential passive force, but LMAX, its elongation at FMAX, is not "
        "positive; give LMAX, or a curve in FPE, or FPE = 1 for no passive force");
  return m;
}

// h of (9) and its slope
double MuscleSpring::passive_part(double x, double& slope) const {
  slope = 0;
  if (passive) return passive.at(x, slope);
  const double strain = (x - 1) / lmax;
  if (!exponential || strain <= 0) return 0;
  if (ksh <= 0) return slope = 1 / lmax, strain;
  slope = ksh / lmax * std::exp(ksh * strain) / std::expm1(ksh);
  return std::expm1(ksh * strain) / std::expm1(ksh);
}

SpringForce MuscleSpring::force(const SpringMotion& m, SpringState&) const {
  const double x = m.length / l0;
  const double now = activation ? activation.held(m.time) : a;
  double f = 1, g = 1, f_slope = 0, g_slope = 0, h_slope = 0;
  double fast = vmax * sv;
  if (length) f = length.at(x, f_slope);
  if (f < 0) f = f_slope = 0;
  if (speed) fast = vmax * std::max(speed.held(now), 1e-6);
  if (velocity) g = velocity.at(m.rate / fast, g_slope);
  if (g < 0) g = g_slope = 0;
  const double h = passive_part(x, h_slope);
  SpringForce r;
  r.force = fmax * (now * f * g + h);
  r.stiffness = fmax / l0 * (now * std::fabs(f_slope) * g + std::max(h_slope, 0.0));
  // the steepest slope, so that the step stays stable where the rate crosses a kink
  if (velocity) r.damping = fmax * now * f * std::max(velocity.steepest(), 0.0) / fast;
  return r;
}

namespace {
template <class Law>
bool try_law(std::string_view keyword, const Parameters& p, std::optional<SpringLaw>& found) {
  if (keyword != Law::keyword) return false;
  found = Law::from(p);
  return true;
}
template <class... Laws>
std::optional<SpringLaw> first_of(std::string_view keyword, const Parameters& p,
                                  std::variant<Laws...>*) {
  std::optional<SpringLaw> found;
  (try_law<Laws>(keyword, p, found) || ...);
  return found;
}
}  // namespace

std::optional<SpringLaw> spring_law(std::string_view keyword, const Parameters& parameters) {
  return first_of(keyword, parameters, static_cast<SpringLaw*>(nullptr));
}

SpringForce spring_force(const SpringLaw& law, const SpringMotion& motion, SpringState& state) {
  return std::visit([&](const auto& l) { return l.force(motion, state); }, law);
}

}  // namespace fabrica
