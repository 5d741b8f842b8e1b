#include "result/lsda.h"

#include <doctest/doctest.h>

#include <fstream>

#include "result/binout.h"
#include "result/csv_history.h"
#include "result/sample_test.h"

using namespace fabrica;

namespace {

HistoryDatabase nodout() {
  HistoryDatabase d;
  d.path = "nodout";
  d.ids = {605, 7, 5000000000};  // the last needs eight bytes
  d.legend = {"head", "", "pelvis"};
  d.variables = {{"x_displacement", 3, false}, {"state", 1, true}};
  return d;
}
HistorySample nodout_sample(int i) {
  return {0.1 * i, i, {{1.5 * i, 2.0 * i, -3.0 * i}, {double(i)}}};
}
HistoryDatabase energies() {
  HistoryDatabase d;
  d.path = "glstat";
  d.text_metadata = {{"element_types", "node,solid,shell"}};
  d.integer_metadata = {{"side", {0, 1}}};
  d.variables = {{"kinetic_energy", 1, false}};
  return d;
}

std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("binout: what is written is read, in the layout of LS-DYNA") {
  const sample::Scratch scratch;
  const std::string path = scratch.file("binout0000");
  {
    BinoutWriter out(path, "a title");
    const int n = out.add(nodout()), g = out.add(energies());
    for (int i = 0; i < 250; ++i) {
      out.write(n, nodout_sample(i));
      if (i % 2 == 0) out.write(g, {0.1 * i, i, {{i * i * 1.0}}});
    }
    out.flush();
  }
  const LsdaReader in(path);
  CHECK(in.list("/") == std::vector<std::string>{"glstat", "nodout"});
  CHECK(in.integers("/nodout/metadata/ids") == nodout().ids);
  CHECK(in.text("/nodout/metadata/title") == "a title");
  CHECK(in.raw("/nodout/metadata/title").size() == 80);
  CHECK(in.raw("/nodout/metadata/legend").size() == 3 * 70);
  CHECK(in.text("/glstat/metadata/element_types") == "node,solid,shell");
  CHECK(in.integers("/glstat/metadata/side") == std::vector<std::int64_t>{0, 1});
  CHECK(in.list("/nodout").size() == 251);
  CHECK(in.list("/glstat").size() == 126);
  for (const int i : {0, 1, 99, 100, 249}) {
    const std::string state = "/nodout/" + state_name(i + 1);
    CHECK(in.reals(state + "/time").at(0) == doctest::Approx(0.1 * i));
    CHECK(in.reals(state + "/x_displacement") == std::vector<double>{1.5 * i, 2.0 * i, -3.0 * i});
    CHECK(in.integers(state + "/state").at(0) == i);
  }
  CHECK_THROWS(in.reals("/nodout/d000001/nothing"));
}

TEST_CASE("binout: records that no table names yet, and a torn last record, do not hide the rest") {
  const sample::Scratch scratch;
  const std::string path = scratch.file("binout"), torn = scratch.file("torn");
  BinoutWriter out(path, "");
  const int n = out.add(nodout());
  for (int i = 0; i < 150; ++i) out.write(n, nodout_sample(i));  // 100 are flushed by themselves
  std::filesystem::copy_file(path, torn);                        // what a killed run leaves
  CHECK(LsdaReader(torn).list("/nodout").size() >= 101);

  // all in the file but the last bytes: the states after the table are found by scanning
  out.flush();
  std::string bytes = contents(path);
  const LsdaReader whole(path);
  const auto last = whole.symbols().at("/nodout/d000150/x_displacement");
  bytes.resize(last.data + 4);
  std::ofstream(torn, std::ios::binary) << bytes;
  const LsdaReader in(torn);
  CHECK(in.has("/nodout/d000149/x_displacement"));
  CHECK_FALSE(in.has("/nodout/d000150/x_displacement"));
}

TEST_CASE("binout and csv: a restarted run leaves the files of an uninterrupted one") {
  const sample::Scratch scratch;
  auto run = [&](auto& out, int from, int to) {
    const int n = out.add(nodout());
    for (int i = from; i < to; ++i) out.write(n, nodout_sample(i));
    out.flush();
  };
  const std::string path = scratch.file("binout");
  {
    BinoutWriter out(path, "t");
    run(out, 0, 12);
  }
  {
    BinoutWriter out(path, "t", 0.7);
    run(out, 8, 20);
  }
  const LsdaReader in(path);
  CHECK(in.list("/nodout").size() == 21);
  for (int i = 0; i < 20; ++i)
    CHECK(in.reals("/nodout/" + state_name(i + 1) + "/x_displacement").at(0) == 1.5 * i);

  const std::string whole = scratch.file("whole"), parts = scratch.file("parts");
  {
    CsvHistoryWriter out(whole);
    run(out, 0, 20);
  }
  {
    CsvHistoryWriter out(parts);
    run(out, 0, 12);
  }
  {
    CsvHistoryWriter out(parts, 7 * 0.1);
    run(out, 8, 20);
  }
  CHECK(contents(whole + "/nodout.csv") == contents(parts + "/nodout.csv"));
  const CsvTable table = read_csv(whole + "/nodout.csv");
  CHECK(table.names == std::vector<std::string>{"time", "cycle", "x_displacement:605",
                                                "x_displacement:7", "x_displacement:5000000000",
                                                "state"});
  CHECK(table.columns[4][19] == -57);
}

TEST_CASE("csv: columns name entity and place") {
  HistoryDatabase d;
  d.path = "elout/shell";
  d.ids = {3, 9};
  d.variables = {{"sig_xx", 4, false}, {"wall", 3, false}};
  CHECK(csv_name(d.path) == "elout_shell.csv");
  CHECK(column_names(d) == std::vector<std::string>{"sig_xx:3.1", "sig_xx:3.2", "sig_xx:9.1",
                                                    "sig_xx:9.2", "wall:1", "wall:2", "wall:3"});
  const sample::Scratch scratch;
  std::ofstream(scratch.file("bad.csv")) << "a,b\n1,x\n";
  CHECK_THROWS_WITH(read_csv(scratch.file("bad.csv")),
                    doctest::Contains("bad.csv:2: 'x' is not a number"));
}

TEST_CASE("binout: a sample of the wrong shape is refused") {
  const sample::Scratch scratch;
  BinoutWriter out(scratch.file("binout"), "");
  const int n = out.add(nodout());
  CHECK_THROWS_WITH(out.write(n, {0, 0, {{1, 2}, {1}}}),
                    "nodout/x_displacement: 3 values announced, 2 given");
}

TEST_CASE("lsda: the reference binout") {
  const std::string path = sample::reference("ansys_binout/binout_glstat");
  if (path.empty()) return;
  const LsdaReader in(path);
  CHECK(in.text("/glstat/metadata/title") == "Geometric Sphere Impacting a Plate");
  CHECK(in.text("/glstat/metadata/build_id") == "R13.0_365_f8a97bda2a");
  const auto states = in.list("/glstat");
  CHECK(states.size() > 100);
  // relative directories ("../../transducer") are followed
  CHECK(in.has("/rwforc/transducer/d000001/x_force"));
  // each state is complete, times rise, and the total energy is the sum of its parts
  double last = -1;
  for (const std::string& s : states) {
    if (s == "metadata") continue;
    auto value = [&](const char* name) { return in.reals("/glstat/" + s + "/" + name).at(0); };
    CHECK(value("time") > last);
    last = value("time");
    const double sum = value("kinetic_energy") + value("internal_energy") +
                       value("stonewall_energy") + value("sliding_interface_energy") +
                       value("system_damping_energy");
    CHECK(sum == doctest::Approx(value("total_energy")).epsilon(1e-3));
  }
  const sample::Scratch scratch;
  CHECK_THROWS_WITH(LsdaReader(sample::reference("PROVENANCE.md")),
                    doctest::Contains("is not a binout"));
}
