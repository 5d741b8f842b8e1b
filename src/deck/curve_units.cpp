#include "deck/curve_units.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

#include "deck/context.h"

namespace fabrica {
namespace {

// units of abscissa and ordinate
using Axes = std::pair<const char*, const char*>;
using AxesOf = std::optional<Axes> (*)(const Card& card, int row);

// value of a field, in the table where row >= 0
int value(const Card& card, int row, const char* field) {
  return row < 0 ? card.integer(field) : to_int(card.row(row, field));
}
bool translates(int dof) { return std::abs(dof) <= 4; }

template <const char* const& Abscissa, const char* const& Ordinate>
std::optional<Axes> fixed(const Card&, int) {
  return Axes{Abscissa, Ordinate};
}

constexpr const char *time = "time", *one = "1", *length = "length", *force = "force",
                     *moment = "moment", *stress = "stress", *rate = "rate", *velocity = "velocity",
                     *acceleration = "acceleration";

// VAD 0 velocity, 1 acceleration, 2 and 4 displacement over time, 3 velocity over displacement
std::optional<Axes> prescribed_motion(const Card& card, int row) {
  const bool linear = translates(value(card, row, "dof"));
  switch (value(card, row, "vad")) {
    case 0:
      return Axes{time, linear ? velocity : rate};
    case 1:
      return Axes{time, linear ? acceleration : "1/time^2"};
    case 3:
      return Axes{linear ? length : one, linear ? velocity : rate};
    default:
      return Axes{time, linear ? length : one};
  }
}
std::optional<Axes> nodal_load(const Card& card, int row) {
  return Axes{time, translates(value(card, row, "dof")) ? force : moment};
}
std::optional<Axes> wall_motion(const Card& card, int row) {
  return Axes{time, value(card, row, "opt") == 0 ? velocity : length};
}

struct Use {
  const char* keyword;  // or its start, before *
  const char* fields;   // separated by blanks
  AxesOf axes;
};
constexpr Use uses[] = {
    {"BOUNDARY_PRESCRIBED_MOTION_*", "lcid", prescribed_motion},
    {"CONTROL_TIMESTEP", "lctm", fixed<time, time>},
    {"DAMPING_GLOBAL", "lcid", fixed<time, rate>},
    {"DAMPING_PART_MASS", "lcid", fixed<time, rate>},
    {"DATABASE_*", "lcur lcdt", fixed<time, time>},
    {"LOAD_BODY_*", "lcid", fixed<time, acceleration>},
    {"LOAD_NODE_*", "lcid", nodal_load},
    {"LOAD_RIGID_BODY", "lcid", nodal_load},
    {"LOAD_SEGMENT*", "lcid", fixed<time, stress>},
    {"LOAD_SHELL_*", "lcid", fixed<time, stress>},
    {"MAT_CRUSHABLE_FOAM", "lcid", fixed<one, stress>},
    {"MAT_GENERAL_NONLINEAR_6DOF_DISCRETE_BEAM", "lcidtr lcidts lcidtt lcidtur lcidtus lcidtut",
     fixed<length, force>},
    {"MAT_GENERAL_NONLINEAR_6DOF_DISCRETE_BEAM", "lcidrr lcidrs lcidrt lcidrur lcidrus lcidrut",
     fixed<one, moment>},
    {"MAT_GENERAL_NONLINEAR_6DOF_DISCRETE_BEAM", "lcidtdr lcidtds lcidtdt", fixed<velocity, force>},
    {"MAT_GENERAL_NONLINEAR_6DOF_DISCRETE_BEAM", "lcidrdr lcidrds lcidrdt", fixed<rate, moment>},
    {"MAT_GENERAL_NONLINEAR_6DOF_DISCRETE_BEAM", "lcidter lcidtes lcidtet", fixed<length, one>},
    {"MAT_GENERAL_NONLINEAR_6DOF_DISCRETE_BEAM", "lcidrer lcidres lcidret", fixed<one, one>},
    {"MAT_LOW_DENSITY_FOAM", "lcid", fixed<one, stress>},
    {"MAT_PIECEWISE_LINEAR_PLASTICITY", "lcss", fixed<one, stress>},
    {"MAT_PIECEWISE_LINEAR_PLASTICITY", "lcsr", fixed<rate, one>},
    {"RIGIDWALL_GEOMETRIC_*", "lcid", wall_motion},
};

bool names(std::string_view list, std::string_view word) {
  for (std::size_t at = 0; (at = list.find(word, at)) != list.npos; at += word.size()) {
    const std::size_t end = at + word.size();
    if ((at == 0 || list[at - 1] == ' ') && (end == list.size() || list[end] == ' ')) return true;
  }
  return false;
}

std::optional<Axes> axes_of(const Card& card, const FieldSchema& field, int row) {
  const std::string& keyword = card.schema->name;
  for (const Use& use : uses) {
    std::string_view name = use.keyword;
    const bool any = name.ends_with('*');
    if (any) name.remove_suffix(1);
    if ((any ? keyword.starts_with(name) : keyword == name) && names(use.fields, field.name))
      return use.axes(card, row);
  }
  return std::nullopt;
}

// one field that names a curve; axes: nothing where its units are not known
struct Reference {
  const Card* card;
  const FieldSchema* field;
  std::optional<Axes> axes;
};

void collect(const Card& card, std::multimap<std::int64_t, Reference>& out) {
  std::size_t i = 0;
  int column = 0;
  const auto add = [&](const FieldSchema& field, double id, int row) {
    if (id != 0) out.insert({to_id(std::abs(id)), {&card, &field, axes_of(card, field, row)}});
  };
  for (const CardSchema& c : card.schema->cards)
    for (const FieldSchema& field : c.fields) {
      const bool curve = field.reference == "curve";
      if (!c.repeats) {
        if (curve) add(field, card.values[i], -1);
        ++i;
        continue;
      }
      for (int r = 0; curve && r < card.row_count(); ++r) add(field, card.row(r, column), r);
      ++column;
    }
}

using Factors = std::pair<double, double>;

void not_converted(Context& context, const Card& curve, const std::string& why) {
  context.error("unit-not-converted", curve.where, curve.schema->name, "lcid",
                "a unit factor of *INCLUDE_TRANSFORM reaches curve " +
                    std::to_string(curve.id("lcid")) + ", but " + why,
                "Convert the included file to the units of the deck");
}

}  // namespace

void CurveUnits::add(Card& card, const Placement& placement) {
  if (card.schema->name == "DEFINE_CURVE" && placement.factors())
    pending_.push_back({&card, placement});
  users_.push_back(&card);
}

void CurveUnits::convert(Context& context) {
  if (pending_.empty()) return;
  std::multimap<std::int64_t, Reference> references;
  for (const Card* card : users_) collect(*card, references);
  for (const Pending& p : pending_) {
    std::optional<Factors> factors;
    std::string problem;
    const auto [first, last] = references.equal_range(p.card->id("lcid"));
    for (auto r = first; r != last; ++r) {
      const Reference& use = r->second;
      const std::string user = "*" + use.card->schema->name + ", field " + use.field->name;
      if (!use.axes) {
        problem = "the units of its axes do not follow from " + user;
        break;
      }
      const Factors now{p.placement.factor(use.axes->first).value(),
                        p.placement.factor(use.axes->second).value()};
      if (factors && *factors != now) problem = user + " wants other units than its other users";
      factors = now;
    }
    if (!factors && problem.empty()) problem = "no keyword that says its units uses it";
    if (!problem.empty()) {
      not_converted(context, *p.card, problem);
      continue;
    }
    const auto scale = [&](const char* field, double factor) {
      const double given = p.card->real(field);
      p.card->set(field, (given == 0 ? 1 : given) * factor);
    };
    scale("sfa", factors->first), scale("sfo", factors->second);
  }
}

}  // namespace fabrica
