#include "body/materials.h"

#include <doctest/doctest.h>

#include <cmath>

#include "body/mesh/quality.h"

using namespace fabrica;
using namespace fabrica::body;

namespace {

// a row of data/materials.csv as a card
struct Made {
  explicit Made(const std::string& row, bool fracture = false, double faster = 1) {
    Diagnostics diagnostics;
    Builder builder(diagnostics);
    Materials(builder, fracture).use(row, faster);
    model = builder.finish();
    for (const auto& card : model->cards)
      if (card->schema->category == "material") law = card.get();
  }
  std::unique_ptr<Model> model;
  const Card* law = nullptr;
};

}  // namespace

// A wave crosses a shell, area / longest side, with c = sqrt(E / (rho (1 - nu^2))). 0.8 us is asked
// at coarse; bones that are rigid there have no shells.
TEST_CASE("at coarse no shell of a bone asks for a step below 0.8 us") {
  for (const std::string& bone : bone_names()) {
    const BoneMaterial rows = bone_material(bone);
    if (rows.rigid_at_coarse) continue;
    CAPTURE(bone);
    const Made made(rows.cortical);
    const Card& law = *made.law;
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
  const Made made("rib_cortical");
  const Card& law = *made.law;
  const double slope = (law.real("es2") - law.real("es1")) / (law.real("eps2") - law.real("eps1"));
  const double rate = 1 + std::pow(5e-4 / law.real("c"), 1 / law.real("p"));
  const auto stress = [&](double plastic) { return rate * (law.real("es1") + slope * plastic); };
  CHECK(law.real("e") == doctest::Approx(13.9));
  CHECK(stress(0.002) == doctest::Approx(0.0939).epsilon(0.002));
  const double plastic = 0.027 - 0.1242 / law.real("e");
  CHECK(stress(plastic) == doctest::Approx(0.1242).epsilon(0.002));
  // and is deleted there
  CHECK(plastic_strain_at(law, 0.027, 5e-4) == doctest::Approx(plastic).epsilon(0.002));
  const Made broken("rib_cortical", true);
  CHECK(broken.law->real("fail") == doctest::Approx(plastic).epsilon(0.002));
  CHECK(broken.law->real("numint") == 1);
  CHECK(law.real("numint") == 0);
  // in a run that is ten times faster than the test its rates are ten times as high
  const Made hurried("rib_cortical", true, 10);
  CHECK(hurried.law->real("c") == doctest::Approx(10 * law.real("c")));
  CHECK(hurried.law->real("fail") == doctest::Approx(plastic).epsilon(0.002));
  // the curve goes on with the same slope
  CHECK(law.real("es3") ==
        doctest::Approx(law.real("es2") + slope * (0.1 - law.real("eps2"))).epsilon(0.002));
}

// Reilly and Burstein 1975: coupons of human femur pulled at 0.02 to 0.05 1/s (3e-5 1/ms) yield at
// 118 MPa; tibia, of the same laboratory, at 114 MPa. Stress of the law on the plastic rate:
// SIGY (1 + (rate / C)^(1/P)).
TEST_CASE("the cortex of femur and tibia yields as its coupons at the rate of their test") {
  const auto yield = [&](const char* row) {
    const Made made(row);
    const Card& law = *made.law;
    CHECK(law.real("vp") == 1);
    return law.real("sigy") * (1 + std::pow(3e-5 / law.real("c"), 1 / law.real("p")));
  };
  CHECK(yield("femur_cortical") == doctest::Approx(0.118).epsilon(0.002));
  CHECK(yield("tibia_cortical") == doctest::Approx(0.114).epsilon(0.002));
}

// Vandenbulcke 2012 by VIVA+: 100 MPa, bent slowly. Pulled at a rate r the stress is (r / 0.02
// 1/s)^0.06 times the slow one (Carter and Hayes 1977): of each viscoelastic term E r/b (1 - e^(-b
// t)) beside the slow stress, E what its shear modulus adds to Young's modulus.
TEST_CASE("the cortex of the humerus has its slow yield, and stiffens with the rate") {
  const Made made("humerus_cortical", true), hurried("humerus_cortical", false, 10);
  const Card& law = *made.law;
  const double E = law.real("e"), K = E / (3 * (1 - 2 * law.real("pr")));
  double G = E / (2 * (1 + law.real("pr"))), before = E;
  REQUIRE(law.row_count() == 2);
  double modulus[2], decay[2];
  for (int i = 0; i < 2; ++i) {
    G += law.row(i, "gi");
    const double now = 9 * K * G / (3 * K + G);
    modulus[i] = now - before, before = now, decay[i] = law.row(i, "betai");
    CHECK(hurried.law->row(i, "betai") == doctest::Approx(10 * decay[i]));
    CHECK(hurried.law->row(i, "gi") == law.row(i, "gi"));
  }
  // plastic strain at the fracture strain of 0.0197, and the stress there
  const double plastic = law.real("fail"), strength = 0.0991 + 1.0809 * plastic;
  CHECK(plastic + strength / E == doctest::Approx(0.0197));
  for (const double rate : {2e-5, 2e-4, 2e-3, 7e-3, 2e-2})  // [1/ms]
    for (const auto& [strain, slow] :
         {std::pair{0.004, 0.004 * E}, {0.008, 0.1}, {0.018, strength}}) {
      double stress = slow;
      for (int i = 0; i < 2; ++i)
        stress += modulus[i] * rate / decay[i] * (1 - std::exp(-decay[i] * strain / rate));
      CHECK(stress == doctest::Approx(slow * std::pow(rate / 2e-5, 0.06)).epsilon(0.1));
    }
}
