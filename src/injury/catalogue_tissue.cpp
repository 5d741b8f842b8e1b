// Measures of tissues from their elements; formulas and symbols in injury/tissue.h.
#include <fmt/format.h>

#include "injury/catalogue.h"
#include "injury/tissue.h"
#include "signal/units.h"

namespace fabrica {
namespace {

constexpr double cartilage_strength = 4.4;  // [MPa]

// strains as numbers: 15 % -> 0.15
std::vector<double> strains(const Signal& s) {
  return s.unit.empty() || s.unit == "1" ? s.y : in_unit(s, "1").y;
}

template <int percent>
Finding brain_strain(const Subject&, const Channels& c) {
  const Signal& s = c.at("brain.strain");
  return {100 * volume_quantile(strains(s), s.x, percent / 100.0), "strain measure as given", {}};
}

Finding csdm(const Subject& subject, const Channels& c) {
  const Signal& s = c.at("brain.strain");
  return {volume_fraction_above(strains(s), s.x, subject.csdm_strain),
          fmt::format("volume fraction above {} strain", subject.csdm_strain),
          {}};
}

Finding ribs_by_strain(const Subject& subject, const Channels& c) {
  int broken = 0;
  for (const double e : strains(c.at("ribs.strain"))) broken += e > subject.rib_strain;
  return {double(broken), fmt::format("ribs above {} strain", subject.rib_strain), {}};
}

Finding ribs_by_risk(const Subject& subject, const Channels& c,
                     double (*probability)(double, double), const char* source) {
  std::vector<double> p;
  double expected = 0;
  for (const double e : strains(c.at("ribs.strain"))) {
    p.push_back(probability(e, subject.age));
    expected += p.back();
  }
  Finding f{expected, fmt::format("expected number at age {}, {} ribs", subject.age, p.size()), {}};
  for (const int n : {1, 2, 3})
    f.risks.push_back({fmt::format("NFR{}+", n), at_least(p, n), source, read_once});
  return f;
}

Finding ribs_larsson(const Subject& subject, const Channels& c) {
  return ribs_by_risk(subject, c, rib_fracture_probability,
                      "Larsson et al. 2021, doi 10.3389/fbioe.2021.677768");
}
Finding ribs_forman(const Subject& subject, const Channels& c) {
  return ribs_by_risk(subject, c, rib_fracture_probability_forman,
                      "Forman et al. 2012, Ann Adv Automot Med 56:109");
}

Finding ribs_by_cartilage(const Subject&, const Channels& c) {
  int broken = 0;
  for (const double stress : in_unit(c.at("cartilage.stress"), "MPa").y)
    broken += stress >= cartilage_strength;
  return {double(broken), "cartilages at or above 4.4 MPa", {}};
}

enum Organ { liver, spleen, kidney, heart, lung };
constexpr const char* organ_names[]{"liver", "spleen", "kidney", "heart", "lung"};
template <Organ organ>
Finding organ_strain(const Subject&, const Channels& c) {
  const Signal& s = c.at(std::string(organ_names[organ]) + ".strain");
  return {100 * volume_quantile(strains(s), s.x, 1),
          fmt::format("95 % of the volume below {:.1f} %; no confirmed limit",
                      100 * volume_quantile(strains(s), s.x, 0.95)),
          {}};
}

}  // namespace

std::vector<Measure> tissue_measures() {
  std::vector<Measure> out{
      {"MPS",
       "brain",
       "%",
       {"brain.strain"},
       "none",
       "largest first principal strain of any element",
       {},
       "",
       "Iwamoto et al. 2015 report it",
       brain_strain<100>},
      {"MPS95",
       "brain",
       "%",
       {"brain.strain"},
       "none",
       "95 % of the volume lies below",
       {},
       "",
       "Gabler et al. 2019",
       brain_strain<95>,
       "paper not read: 95 % of the volume here, of the elements in one public program"},
      {"CSDM",
       "brain",
       "1",
       {"brain.strain"},
       "none",
       "volume fraction above the threshold",
       {},
       "",
       "Takhounts et al. 2003, Stapp 47",
       csdm,
       "paper not read: public programs use thresholds of 0.15, 0.2 and 0.25"},
      {"fractured ribs, strain",
       "thorax",
       "1",
       {"ribs.strain"},
       "none",
       "ribs above rib_strain, 1.8 % if not set",
       {},
       "",
       "threshold chosen here: median at about 79 years of the risk below",
       ribs_by_strain},
      {"fractured ribs, cartilage",
       "thorax",
       "1",
       {"cartilage.stress"},
       "none",
       "cartilages above 4.4 MPa",
       {},
       "",
       "Yamada 1970 in Iwamoto et al. 2015",
       ribs_by_cartilage},
      {"fractured ribs, risk",
       "thorax",
       "1",
       {"ribs.strain"},
       "none",
       "sum of p(strain, age); P(N >= k)",
       {},
       "",
       "Larsson et al. 2021",
       ribs_larsson},
      {"fractured ribs, Forman",
       "thorax",
       "1",
       {"ribs.strain"},
       "none",
       "p: share of 12 subjects below e/(1 - 0.0051 (age - 25))",
       {},
       "",
       "Forman et al. 2012",
       ribs_forman}};
  Finding (*const evaluate[])(const Subject&, const Channels&){
      organ_strain<liver>, organ_strain<spleen>, organ_strain<kidney>, organ_strain<heart>,
      organ_strain<lung>};
  for (int i = 0; i < 5; ++i)
    out.push_back({std::string(organ_names[i]) + " strain",
                   "abdomen and chest",
                   "%",
                   {std::string(organ_names[i]) + ".strain"},
                   "none",
                   "largest first principal strain of any element",
                   {},
                   "",
                   "no risk curve confirmed in a source",
                   evaluate[i]});
  return out;
}

}  // namespace fabrica
