#include "signal/channel_file.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "signal/iso_mme.h"

using namespace fabrica;
namespace fs = std::filesystem;

namespace {

std::string file_of(const std::string& name, const std::string& text) {
  const fs::path path = fs::temp_directory_path() / ("fabrica_" + name);
  std::ofstream(path) << text;
  return path.string();
}
std::string error_of(auto&& action) {
  try {
    action();
  } catch (const SignalError& e) {
    return e.name();
  }
  return "none";
}

}  // namespace

TEST_CASE("csv: units are taken from every usual way to write a header") {
  CHECK(name_and_unit("force_kN").unit == "kN");
  CHECK(name_and_unit("head force [N]").name == "head force");
  CHECK(name_and_unit("acc (m/s^2)").unit == "m/s^2");
  CHECK(name_and_unit("omega_rad_s").unit == "rad/s");
  CHECK(name_and_unit("omega_rad_s").name == "omega");
  CHECK(name_and_unit("curve_1").unit.empty());
  CHECK(name_and_unit("total_deflection_mm").name == "total_deflection");
}

TEST_CASE("csv: curves by column, by pair of columns, and by rows of a long table") {
  const std::string f = file_of(
      "long.csv", "# a note\nspecimen,deflection_mm,force_N\nA,0,0\nA,1,5\nB,0,1\nB,2,9\nB,3,\n");
  const Signal b = read_signal(f + ":deflection:force@specimen=B");
  CHECK(b.size() == 2);
  CHECK(b.y[1] == 9);
  CHECK(b.x_unit == "mm");
  CHECK(b.unit == "N");
  CHECK(error_of([&] { read_signal(f + ":torque"); }) == "no-such-channel");
  CHECK(error_of([&] { read_signal(f + ":deflection:force@specimen=C"); }) == "no-such-row");
  CHECK(error_of([&] { read_signal(f + "x"); }) == "no-such-file");
  CHECK(error_of([&] { read_signal(f + ":specimen"); }) == "not-a-number");
}

TEST_CASE("csv and ISO-MME: what is written is read again") {
  Signal s{"11HEAD0000H3ACXA", "g", "ms", {}, {}};
  for (int i = 0; i < 50; ++i) s.x.push_back(-1 + 0.1 * i), s.y.push_back(0.1 * i * i);
  const std::string csv = (fs::temp_directory_path() / "fabrica_again.csv").string();
  write_csv(csv, {s});
  const Signal a = read_signal(csv);
  CHECK(a.name == s.name);
  CHECK(a.unit == "g");
  CHECK(a.y[49] == doctest::Approx(s.y[49]).epsilon(1e-11));

  const fs::path folder = fs::temp_directory_path() / "fabrica_mme";
  write_mme_test(folder.string(), "T1", {s});
  const Signal m = read_signal((folder / "T1.mme").string() + ":11HEAD");
  CHECK(m.name == s.name);
  CHECK(m.size() == 50);
  CHECK(m.x_unit == "s");
  CHECK(m.x[0] == doctest::Approx(-0.001));
  CHECK(m.y[10] == doctest::Approx(s.y[10]));
  CHECK(error_of([&] { read_signal((folder / "T1.mme").string() + ":12"); }) == "no-such-channel");
  fs::remove_all(folder);
}

TEST_CASE("ISO-MME: a file that ends early is refused, and units with signs are understood") {
  const std::string f =
      file_of("x.001",
              "Channel code                :11HEAD\nUnit                        :m/s\xB2\n"
              "Time of first sample        :0\nSampling interval           :.001\n"
              "Number of samples           :3\n1\n2\n");
  CHECK(error_of([&] { read_signal(f); }) == "bad-channel-file");
  std::ofstream(f, std::ios::app) << "3\n";
  CHECK(read_signal(f).unit == "m/s2");
}
