#include "result/vtu.h"

#include <doctest/doctest.h>

#include "result/sample_test.h"

using namespace fabrica;

TEST_CASE("vtu: a restart drops the later states of the series") {
  const sample::Scratch scratch;
  const ResultMesh mesh = sample::mesh();
  const std::string path = scratch.file("run.pvd");
  {
    VtuWriter out(path, mesh);
    for (int i = 0; i < 4; ++i) out.write(sample::state(mesh, 0.1 * i));
  }
  CHECK(read_pvd(path).size() == 4);
  CHECK(read_pvd(path)[3] == std::pair<double, std::string>{0.1 * 3, "run_0003.vtu"});
  VtuWriter out(path, mesh, {}, 0.15);
  CHECK_FALSE(std::filesystem::exists(scratch.file("run_0002.vtu")));
  out.write(sample::state(mesh, 0.25));
  CHECK(read_pvd(path).size() == 3);
  CHECK(read_pvd(path)[2] == std::pair<double, std::string>{0.25, "run_0002.vtu"});
  CHECK_THROWS(read_pvd(scratch.file("none.pvd")));
}

TEST_CASE("vtu: values per cell") {
  const ResultMesh mesh = sample::mesh();
  AnimationState s = sample::state(mesh, 0);
  s.shell_plastic_strain = {0.1f, 0.3f, 0.2f, 0.0f, 0.0f, 0.7f};
  s.shell_alive = {1, 0};
  const auto strain = cell_plastic_strain(mesh, s);
  CHECK(strain == std::vector<float>{4000, 4001, 4002, 0.3f, 0.7f, 0, 0});
  CHECK(cell_alive(mesh, s) == std::vector<std::uint8_t>{1, 1, 1, 1, 0, 1, 1});
  CHECK(cell_von_mises(mesh, s)[0] == von_mises(s.solid_stress.data()));
  CHECK(vtk_cells(mesh).types == std::vector<std::uint8_t>{12, 10, 13, 9, 5, 3, 3});
}
