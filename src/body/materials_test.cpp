#include "body/materials.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "body/mesh/quality.h"

using namespace fabrica;
using namespace fabrica::body;

namespace {

// fields of a row of data/materials.csv on the card of its keyword
Card& law_of(const std::string& name, Builder& builder) {
  const body::Table table("materials.csv");
  for (int row = 0; row < table.rows(); ++row) {
    if (table.text(row, "row") != name) continue;
    Card& card = builder.add_card(table.text(row, "keyword"));
    std::istringstream fields(table.text(row, "fields"));
    for (std::string item; fields >> item;) {
      const std::size_t equals = item.find('=');
      card.set(item.substr(0, equals), std::atof(item.c_str() + equals + 1));
    }
    return card;
  }
  throw BodyError("no row " + name);
}

}  // namespace

// A wave crosses a shell, area / longest side, with c = sqrt(E / (rho (1 - nu^2))). 0.8 us is asked
// at coarse; bones that are rigid there have no shells.
TEST_CASE("at coarse no shell of a bone asks for a step below 0.8 us") {
  Diagnostics diagnostics;
  for (const std::string& bone : bone_names()) {
    const BoneMaterial rows = bone_material(bone);
    if (rows.rigid_at_coarse) continue;
    CAPTURE(bone);
    Builder builder(diagnostics);
    const Card& law = law_of(rows.cortical, builder);
    const double nu = law.real("pr");
    const double speed = std::sqrt(law.real("e") / (law.real("ro") * (1 - nu * nu)));
    const BoneMesh mesh = mesh_bone({bone, Resolution::coarse});
    for (std::size_t q = 0; q < mesh.surface.size(); ++q)
      if (mesh.cortex[q] > 0) CHECK(shell_size(mesh.nodes, mesh.surface[q]) / speed > 0.8e-3);
  }
}

// Kemper 2005, cortex of ribs, 117 coupons pulled at 0.5 1/s (5e-4 1/ms): 93.9 MPa at 0.2 % plastic
// strain, 124.2 MPa at a strain of 2.7 %. Stress of the law: s(e_p) (1 + (rate / C)^(1/P)).
TEST_CASE("the cortex of ribs has the stress of its coupons at the rate of their test") {
  Diagnostics diagnostics;
  Builder builder(diagnostics);
  const Card& law = law_of("rib_cortical", builder);
  const double slope = (law.real("es2") - law.real("es1")) / (law.real("eps2") - law.real("eps1"));
  const double rate = 1 + std::pow(5e-4 / law.real("c"), 1 / law.real("p"));
  const auto stress = [&](double plastic) { return rate * (law.real("es1") + slope * plastic); };
  CHECK(law.real("e") == doctest::Approx(13.9));
  CHECK(stress(0.002) == doctest::Approx(0.0939).epsilon(0.002));
  const double plastic = 0.027 - 0.1242 / law.real("e");
  CHECK(stress(plastic) == doctest::Approx(0.1242).epsilon(0.002));
  // and is deleted there
  CHECK(plastic_strain_at(law, 0.027, 5e-4) == doctest::Approx(plastic).epsilon(0.002));
  Builder other(diagnostics);
  Materials(other, true).use("rib_cortical");
  const std::unique_ptr<Model> model = other.finish();
  REQUIRE(model->cards.size() == 1);
  CHECK(model->cards[0]->real("fail") == doctest::Approx(plastic).epsilon(0.002));
  // the curve goes on with the same slope
  CHECK(law.real("es3") ==
        doctest::Approx(law.real("es2") + slope * (0.1 - law.real("eps2"))).epsilon(0.002));
}

// Reilly and Burstein 1975: coupons of human femur pulled at 0.02 to 0.05 1/s (3e-5 1/ms) yield at
// 118 MPa; tibia, of the same laboratory, at 114 MPa. Stress of the law on the plastic rate:
// SIGY (1 + (rate / C)^(1/P)).
TEST_CASE("the cortex of femur and tibia yields as its coupons at the rate of their test") {
  Diagnostics diagnostics;
  const auto yield = [&](const char* row) {
    Builder builder(diagnostics);
    const Card& law = law_of(row, builder);
    CHECK(law.real("vp") == 1);
    return law.real("sigy") * (1 + std::pow(3e-5 / law.real("c"), 1 / law.real("p")));
  };
  CHECK(yield("femur_cortical") == doctest::Approx(0.118).epsilon(0.002));
  CHECK(yield("tibia_cortical") == doctest::Approx(0.114).epsilon(0.002));
}

// Vandenbulcke 2012 by VIVA+: 100 MPa, bent slowly; the rate effect is that of the other long
// bones.
TEST_CASE("the cortex of the humerus has its slow yield, and the rate effect of the tibia") {
  Diagnostics diagnostics;
  Builder builder(diagnostics), other(diagnostics);
  const Card &law = law_of("humerus_cortical", builder), &tibia = law_of("tibia_cortical", other);
  CHECK(law.real("sigy") == 0.1);
  for (const char* name : {"c", "p", "vp"}) CHECK(law.real(name) == tibia.real(name));
}
