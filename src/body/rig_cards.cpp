#include "body/rig_cards.h"

#include "body/cards.h"

namespace fabrica::body {
namespace {

constexpr std::int64_t rigid_section = 8000001;

// the code by which supports name a choice of x, y, z
int support_code(bool x, bool y, bool z) {
  static constexpr int code[8] = {0, 1, 2, 4, 3, 6, 5, 7};
  return code[int(x) + 2 * int(y) + 4 * int(z)];
}

// degree of freedom as motions and loads number it: 1 to 3 and 5 to 7
int keyword_dof(const RigCurve& curve) { return curve.dof < 3 ? curve.dof + 1 : curve.dof + 2; }

}  // namespace

void RigidMass::add(double m, const Point& x) {
  const Point r = x - centre;
  const double rr = dot(r, r);
  const double moments[6] = {rr - r.x * r.x, -r.x * r.y, -r.x * r.z,
                             rr - r.y * r.y, -r.y * r.z, rr - r.z * r.z};
  mass += m;
  for (std::size_t k = 0; k < 6; ++k) inertia[k] += m * moments[k];
}

RigCards::RigCards(AssembledBody& assembled, Builder& builder)
    : assembled_(assembled), builder_(builder) {
  builder_.add_card("SECTION_SOLID").set("secid", double(rigid_section)).set("elform", 1);
}

std::int64_t RigCards::set(const char* keyword, const std::string& title,
                           const std::vector<std::int64_t>& ids) {
  Card& card = titled(builder_, keyword, title);
  card.set("sid", double(++assembled_.next_set));
  add_ids(card, ids.size(), [&](std::size_t i) { return ids[i]; });
  return assembled_.next_set;
}

std::int64_t RigCards::curve(const std::string& title,
                             const std::vector<std::pair<double, double>>& points) {
  add_curve(builder_, ++last_curve_, title, points);
  return last_curve_;
}

RigCards::Curves RigCards::curves(const std::string& title, const RigSupport& support) {
  Curves out;
  for (const RigCurve& motion : support.motions) out.push_back(curve(title, motion.points));
  for (const RigCurve& load : support.loads) out.push_back(curve(title + " load", load.points));
  return out;
}

std::int64_t RigCards::rigid_part(const std::string& title, double density,
                                  const RigSupport& support, const Curves& curves,
                                  const std::optional<RigidMass>& mass) {
  const double id = double(assembled_.next_part++);
  std::array<int, 6> held{};
  for (std::size_t d = 0; d < 6; ++d) held[d] = support.holds(d);
  Card& law = titled(builder_, "MAT_RIGID", title);
  law.set("mid", id).set("ro", density).set("e", 70).set("pr", 0.3).set("cmo", 1);
  law.set("con1", support_code(held[0], held[1], held[2]));
  law.set("con2", support_code(held[3], held[4], held[5]));
  Card& part = builder_.add_card("PART");
  part.title = "rig." + title;
  part.set("pid", id).set("secid", double(rigid_section)).set("mid", id);
  if (mass) {
    part.options = {"INERTIA"};
    part.set("xc", mass->centre.x).set("yc", mass->centre.y).set("zc", mass->centre.z);
    part.set("tm", mass->mass);
    std::size_t k = 0;
    for (const char* field : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"})
      part.set(field, mass->inertia[k++]);
  }
  std::size_t next = 0;
  for (const RigCurve& motion : support.motions) {
    Card& card = builder_.add_card("BOUNDARY_PRESCRIBED_MOTION_RIGID");
    card.options = {"ID"};
    card.set("id", id + 1000.0 * double(next)).set("heading", title).set("pid", id);
    card.set("dof", keyword_dof(motion));
    card.set("vad", motion.kind == RigCurve::velocity ? 0 : 2);
    card.set("lcid", double(curves[next++])).set("sf", 1);
  }
  for (const RigCurve& load : support.loads) {
    builder_.add_card("LOAD_RIGID_BODY")
        .add_row({id, double(keyword_dof(load)), double(curves[next++]), 1});
  }
  if (norm(support.velocity) > 0)
    builder_.add_card("INITIAL_VELOCITY_GENERATION")
        .set("id", id)
        .set("styp", 2)
        .set("vx", support.velocity.x)
        .set("vy", support.velocity.y)
        .set("vz", support.velocity.z);
  return std::int64_t(id);
}

}  // namespace fabrica::body
