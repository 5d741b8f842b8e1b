#include "material/discrete/six_dof.h"

#include <cmath>
#include <string>

namespace fabrica {
namespace {
// field names end in the axis: prefix + r, s, t for translations, then for rotations
template <class Get>
auto six(const char* translation, const char* rotation, Get&& get) {
  std::array<decltype(get(std::string())), 6> r;
  for (int i = 0; i < 6; ++i)
    r[i] = get(std::string(i < 3 ? translation : rotation) + "rst"[i % 3]);
  return r;
}
}  // namespace

LinearBeam LinearBeam::from(const Parameters& p) {
  const auto real = [&](const std::string& f) { return p.real(f); };
  return {six("tk", "rk", real), six("td", "rd", real), six("fo", "mo", real)};
}

BeamForce LinearBeam::force(const BeamMotion& m, BeamLawState&) const {
  BeamForce r;
  for (int i = 0; i < 6; ++i) r.force[i] = k[i] * m.u[i] + c[i] * m.rate[i] + preload[i];
  r.stiffness = k;
  r.damping = c;
  return r;
}

GeneralBeam GeneralBeam::from(const Parameters& p) {
  const auto real = [&](const std::string& f) { return p.real(f); };
  const auto curve = [&](const std::string& f) { return Polyline(p.curve(f)).mirrored(); };
  const auto factor = [&](const std::string& f) { return Polyline(p.curve(f)); };
  GeneralBeam law;
  law.kt = p.real("kt"), law.kr = p.real("kr"), law.dampf = p.real("dampf");
  const auto load = six("lcidt", "lcidr", curve), unload = six("lcidtu", "lcidru", curve);
  for (int i = 0; i < 6; ++i) {
    Hysteresis& h = law.path[i];
    h.option = Unloading(p.integer("iunld"));
    h.loading = load[i];
    h.unloading = unload[i];
    // an unloading curve that is not given is the loading curve
    if (!h.unloading && h.option == Unloading::curve) h.unloading = load[i];
    h.stiffness = std::max(i < 3 ? law.kt : law.kr, h.loading.steepest());
    h.offset = p.real("offset");
  }
  law.damping = six("lcidtd", "lcidrd", curve);
  law.damping_scale = six("lcidte", "lcidre", factor);
  law.positive_limit = six("utfail", "wtfail", real);
  law.negative_limit = six("ucfail", "wcfail", real);
  law.initial = six("iu", "iw", real);
  law.one_criterion = p.integer("fcrit") == 1;
  law.strain = p.integer("iflag") == 1;
  return law;
}

bool GeneralBeam::fails(const std::array<double, 6>& u) const {
  double positive = 0, negative = 0;
  for (int i = 0; i < 6; ++i) {
    const double limit = std::fabs(u[i] > 0 ? positive_limit[i] : negative_limit[i]);
    if (limit == 0) continue;
    (u[i] > 0 ? positive : negative) += (u[i] / limit) * (u[i] / limit);
  }
  return one_criterion ? positive + negative >= 1 : positive >= 1 || negative >= 1;
}

BeamForce GeneralBeam::force(const BeamMotion& m, BeamLawState& s) const {
  BeamForce r;
  std::array<double, 6> u = m.u;
  for (int i = 0; i < 6; ++i) u[i] += initial[i];
  r.failed = fails(u);
  if (r.failed) return r;
  for (int i = 0; i < 6; ++i) {
    const double scale = strain && i < 3 && m.length > 0 ? 1 / m.length : 1.0;
    r.force[i] = path[i].force(u[i] * scale, s.positive[i], s.negative[i], r.stiffness[i]);
    r.stiffness[i] = std::max(r.stiffness[i] * scale, 0.0);
    if (damping[i]) {
      double slope = 0;
      const double part = damping[i].at(m.rate[i], slope);
      const double factor = damping_scale[i] ? damping_scale[i].at(u[i]) : 1.0;
      r.force[i] += part * factor;
      r.damping[i] += std::max(slope * factor, 0.0);
    }
    const double c = dampf * std::sqrt(i < 3 ? kt * m.mass : kr * m.inertia);
    // a direction without a curve is free
    if (!path[i].loading) continue;
    r.force[i] += c * m.rate[i];
    r.damping[i] += c;
  }
  return r;
}

std::optional<BeamLaw> beam_law(std::string_view keyword, const Parameters& parameters) {
  if (keyword == LinearBeam::keyword) return LinearBeam::from(parameters);
  if (keyword == GeneralBeam::keyword) return GeneralBeam::from(parameters);
  return {};
}

BeamForce beam_force(const BeamLaw& law, const BeamMotion& motion, BeamLawState& state) {
  return std::visit([&](const auto& l) { return l.force(motion, state); }, law);
}

}  // namespace fabrica
