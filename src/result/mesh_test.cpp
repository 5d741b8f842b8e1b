#include "result/mesh.h"

#include <doctest/doctest.h>

#include <cmath>

#include "result/sample_test.h"

using namespace fabrica;

TEST_CASE("mesh: a solid is named by its repeated nodes") {
  CHECK(solid_corners({1, 2, 3, 4, 5, 6, 7, 8}).count == 8);
  CHECK(solid_corners({1, 2, 3, 4, 4, 4, 4, 4}).count == 4);
  CHECK(solid_corners({1, 2, 3, 4, 5, 5, 5, 5}).count == 5);
  const SolidCorners wedge = solid_corners({1, 2, 3, 4, 5, 5, 6, 6});
  CHECK(wedge.count == 6);
  CHECK(wedge.node == std::array<int, 8>{1, 2, 5, 4, 3, 6, 0, 0});
  CHECK(solid_corners({1, 2, 3, 3, 4, 5, 6, 6}).node == std::array<int, 8>{1, 2, 3, 4, 5, 6, 0, 0});
}

TEST_CASE("mesh: of a model with all families") {
  Model model;
  model.title = "model";
  for (int i = 0; i < 10; ++i) {
    model.nodes.id.push_back(i + 1);
    model.nodes.x.push_back({double(i), 0, 0});
  }
  model.parts.resize(2);
  model.parts[0].id = 3;
  model.parts[1].id = 4;
  model.solids.id = {1, 2, 3, 4};
  model.solids.part = {0, 0, 0, 0};
  model.solids.node = {{0, 1, 2, 3, -1, -1, -1, -1, -1, -1},
                       {0, 1, 2, 3, 4, 5, -1, -1, -1, -1},
                       {0, 1, 2, 3, 4, 5, 6, 7, -1, -1},
                       {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}};
  model.beams.id = {5};
  model.beams.part = {1};
  model.beams.node = {{0, 1, -1}};
  model.discretes.id = {6};
  model.discretes.part = {1};
  model.discretes.node = {{2, -1}};
  const ResultMesh m = result_mesh(model);
  CHECK(m.solid[0] == std::array<int, 8>{0, 1, 2, 3, 3, 3, 3, 3});
  CHECK(m.solid[1] == std::array<int, 8>{0, 1, 2, 3, 4, 4, 5, 5});
  CHECK(m.solid[2] == std::array<int, 8>{0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(m.solid[3] == std::array<int, 8>{0, 1, 2, 3, 3, 3, 3, 3});
  CHECK(m.beams() == 2);
  CHECK(m.discretes == 1);
  CHECK(m.beam[1] == std::array<int, 3>{2, 2, -1});  // grounded
  CHECK(m.position[3] == 1);
}

TEST_CASE("mesh: von Mises stress of pure states") {
  const float tension[6] = {3, 0, 0, 0, 0, 0}, shear[6] = {0, 0, 0, 0, 2, 0},
              pressure[6] = {5, 5, 5, 0, 0, 0};
  CHECK(von_mises(tension) == doctest::Approx(3));
  CHECK(von_mises(shear) == doctest::Approx(2 * std::sqrt(3.0)));
  CHECK(von_mises(pressure) == 0);
}
