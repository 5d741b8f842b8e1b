// *INCLUDE_TRANSFORM, *NODE_TRANSFORM and what follows from files that are missing.
#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "deck/reader.h"
#include "model/affine.h"

using namespace fabrica;
namespace fs = std::filesystem;

namespace {

// a folder of decks that lives as long as the test
struct Folder {
  fs::path path = fs::temp_directory_path() / ("fabrica-deck-" + std::to_string(getpid()));
  explicit Folder(const std::map<std::string, std::string>& files) {
    fs::create_directories(path);
    for (const auto& [name, text] : files) std::ofstream(path / name) << text;
  }
  ~Folder() { fs::remove_all(path); }
};

std::string all_of(const Diagnostics& d) {
  std::string text;
  for (const Diagnostic& x : d.list()) text += d.format(x) + "\n";
  return text;
}

int count_of(const Diagnostics& d, Severity severity, std::string_view name) {
  int n = 0;
  for (const Diagnostic& x : d.list()) n += x.severity == severity && x.name == name;
  return n;
}

void check_point(const Vec3d& x, double a, double b, double c) {
  // rounding of coordinates up to 2000
  CHECK(norm(x - Vec3d{a, b, c}) < 2e-12);
}

const std::string head = "*KEYWORD\n*CONTROL_TERMINATION\n       1.0\n";

// a tetrahedron in metres, kilogrammes, seconds
const std::string body = R"(*KEYWORD
*NODE
       1              1.              0.              0.
       2              2.              0.              0.
       3              1.              1.              0.
       4              1.              0.              1.
*ELEMENT_SOLID
       1       1       1       2       3       4       4       4       4       4
*PART
body
         1         1         1
*SECTION_SOLID
         1        10
*MAT_ELASTIC
         1    1000.0     2.0e9       0.3
*SET_NODE_LIST
         7
         1         2
*DEFINE_COORDINATE_NODES
         9         1         2         3
*INITIAL_VELOCITY
         7
       3.0       0.0       0.0
*END
)";

}  // namespace

// x' = R (l x) + t: a quarter turn about z through the origin, then a move
TEST_CASE(
    "include transform: ids are shifted, points moved, values converted to the units of the deck") {
  const Folder folder({{"body.k", body}, {"main.k", head + R"(*DEFINE_TRANSFORMATION
         3
ROTATE         0.0       0.0       1.0       0.0       0.0       0.0      90.0
TRANSL       100.0      20.0       3.0
*INCLUDE_TRANSFORM
body.k
       100      2000     30000       400     50000         6        70
         8
       1.0    1000.0    1000.0
         3
*END
)"}});
  Diagnostics d;
  const auto model = read_deck(folder.path / "main.k", d);
  REQUIRE_MESSAGE(!d.has_errors(), all_of(d));
  REQUIRE(model->nodes.size() == 4);
  CHECK(model->nodes.id[0] == 101);
  check_point(model->nodes.x[0], 100, 1020, 3);
  check_point(model->nodes.x[1], 100, 2020, 3);
  check_point(model->nodes.x[2], -900, 1020, 3);
  CHECK(model->solids.id[0] == 2001);
  CHECK(model->parts[0].id == 30001);
  CHECK(model->materials[0].id == 401);
  CHECK(model->node_sets[0].id == 50007);
  CHECK(model->node_sets[0].nodes == std::vector<int>{0, 1});
  CHECK(model->coordinate_systems[0].id == 79);
  // kg/m3 -> kg/mm3, Pa = kg/(m s2) -> kg/(mm ms2), m/s = mm/ms
  CHECK(model->materials[0].density == doctest::Approx(1e-6));
  for (const auto& card : model->cards)
    if (card->schema->name == "MAT_ELASTIC") CHECK(card->real("e") == doctest::Approx(2.0));
  REQUIRE(model->initial_velocities.size() == 1);
  CHECK(model->initial_velocities[0].velocity.x == doctest::Approx(3.0));
}

// m, s, N, Pa to mm, ms, kN, GPa: a force is 1e-3, a stress 1e-9, a rate 1e-3 of what it was
TEST_CASE("include transform: a curve takes the units of the field that names it") {
  const std::string part = body.substr(0, body.rfind("*END")) + R"(*LOAD_NODE_SET
         7         1         5       2.0
         7         5         6
*DEFINE_CURVE
         5         0       0.0       3.0       0.5      10.0
                 1.0               100.0
                 2.0               200.0
*DEFINE_CURVE
         6
                 0.0               100.0
                 1.0               200.0
*MAT_PIECEWISE_LINEAR_PLASTICITY
         2    7850.0    2.1e11       0.3     2.0e8
                             8         9
*DEFINE_CURVE
         8
                 0.0               2.0e8
                 0.5               4.0e8
*DEFINE_CURVE
         9
                 0.0                 1.0
               100.0                 2.0
*END
)";
  const std::string include =
      "*INCLUDE_TRANSFORM\nbody.k\n\n\n       1.0    1000.0    1000.0\n\n*END\n";
  const Folder folder({{"body.k", part}, {"main.k", head + include}});
  Diagnostics d;
  const auto model = read_deck(folder.path / "main.k", d);
  REQUIRE_MESSAGE(!d.has_errors(), all_of(d));
  const auto at = [&](std::int64_t id, double x) {
    return model->curves[std::size_t(model->curve_index(id))].at(x);
  };
  CHECK(at(5, 1500) == doctest::Approx(0.33));  // (1 + 0.5) s, 3 (100 + 10) N
  CHECK(at(5, 2500) == doctest::Approx(0.63));
  CHECK(at(6, 500) == doctest::Approx(150));  // N m = J, kN mm = J
  CHECK(at(8, 0.25) == doctest::Approx(0.3));
  CHECK(at(9, 0.05) == doctest::Approx(1.5));
}

// A ramp of 3 filtered by the step of the table, an expression of it, and both in an include whose
// ids are moved.
TEST_CASE("functions become curves, with parameters, and their ids move with an include") {
  const std::string functions = R"(*KEYWORD
*DEFINE_FUNCTION_TABULATED
        50
ramp
                 0.0                &low
                 1.0               &high
*DEFINE_FUNCTION
        51,a name with a comma, and spaces
float twice(float x, float y)
{
  if (x > 0 && y > 0) return &factor*x;
  return 0;
}
*DEFINE_CURVE_FUNCTION_TITLE
the inner curve
         7
twice(ramp(TIME), 1) + &low
*DEFINE_CURVE_FUNCTION
         8
MIN(LC7,
  4.0)*10
*END
)";
  const std::string head =
      "*KEYWORD\n*CONTROL_TERMINATION\n       2.0\n*PARAMETER\nR      low       1.0\n"
      "R     high       3.0\nR   factor       2.0\n";
  const Folder folder(
      {{"f.k", functions},
       {"main.k", head + "*INCLUDE\nf.k\n*END\n"},
       {"moved.k", head + "*INCLUDE_TRANSFORM\nf.k\n         0         0         0         0       "
                          "  0     1000\n\n\n\n*END\n"},
       {"units.k",
        head + "*INCLUDE_TRANSFORM\nf.k\n\n\n       1.0    1000.0    1000.0\n\n*END\n"}});
  for (const auto& [file, offset] : {std::pair("main.k", 0), {"moved.k", 1000}}) {
    CAPTURE(file);
    Diagnostics d;
    const auto model = read_deck(folder.path / file, d);
    REQUIRE_MESSAGE(!d.has_errors(), all_of(d));
    CHECK(d.count(Severity::unsupported) == 0);
    const auto at = [&](std::int64_t id, double x) {
      return model->curves.at(std::size_t(model->curve_index(id + offset))).at(x);
    };
    CHECK(at(7, 0.25) == doctest::Approx(2 * 1.5 + 1).epsilon(1e-5));
    CHECK(at(7, 1.7) == doctest::Approx(2 * 3 + 1).epsilon(1e-5));
    CHECK(at(8, 0.125) == doctest::Approx(10 * 3.5).epsilon(1e-5));
    CHECK(at(8, 1.5) == doctest::Approx(40).epsilon(1e-5));
  }
  Diagnostics d;
  read_deck(folder.path / "units.k", d);
  CHECK(all_of(d).find("reaches a function, whose units are not known") != std::string::npos);
}

TEST_CASE("functions that cannot be evaluated are named with their line") {
  const Folder folder(std::map<std::string, std::string>{{"main.k", R"(*KEYWORD
*CONTROL_TERMINATION
       2.0
*DEFINE_CURVE_FUNCTION
         7
MAX(SENSORD(3)-1,0)
*DEFINE_CURVE_FUNCTION
         8
1 + LC9
*DEFINE_CURVE_FUNCTION
         9
1 + LC8
*DEFINE_CURVE_FUNCTION
        10
1 +
*DEFINE_FUNCTION
        11
broken
float f(float x) { printf("x"); return x; }
*END
)"}});
  Diagnostics d;
  read_deck(folder.path / "main.k", d);
  const std::string said = all_of(d);
  for (const char* part :
       {"main.k:4: unsupported [function-not-evaluated] *DEFINE_CURVE_FUNCTION, field function: "
        "curve 7: sensord is not evaluated",
        "curve 8: there is no curve 9 that is evaluated",
        "[bad-function] *DEFINE_CURVE_FUNCTION, field function: curve 10: a number or a name",
        "function 11: "})
    CHECK_MESSAGE(said.find(part) != std::string::npos, part, "\n", said);
}

TEST_CASE("include transform: a curve whose units are not known is an error that says why") {
  const std::string curve =
      "*DEFINE_CURVE\n         5\n                 0.0               100.0\n"
      "                 1.0               200.0\n";
  struct Case {
    std::string users, reason;
  };
  const Case cases[] = {
      {"", "no keyword that says its units uses it"},
      {"*LOAD_NODE_SET\n         7         1         5\n         7         5         5\n",
       "*LOAD_NODE_SET, field lcid wants other units than its other users"},
      {"*MAT_SPRING_NONLINEAR_ELASTIC\n         2         5\n",
       "do not follow from *MAT_SPRING_NONLINEAR_ELASTIC, field lcd"}};
  for (const Case& c : cases) {
    const Folder folder({{"body.k", body.substr(0, body.rfind("*END")) + c.users + curve},
                         {"main.k", head + "*INCLUDE_TRANSFORM\nbody.k\n\n\n"
                                           "       1.0    1000.0    1000.0\n\n*END\n"}});
    Diagnostics d;
    read_deck(folder.path / "main.k", d);
    CHECK_MESSAGE(count_of(d, Severity::error, "unit-not-converted") == 1, all_of(d));
    CHECK_MESSAGE(all_of(d).find(c.reason) != std::string::npos, all_of(d));
  }
}

// planes, walls and boxes are points and directions too
TEST_CASE("include transform: planes of sections, walls and boxes move with what they cut") {
  const std::string part = body.substr(0, body.rfind("*END")) + R"(*DATABASE_CROSS_SECTION_PLANE_ID
         5plane
         0       1.0       0.0       0.0       2.0       0.0       0.0
       1.0       1.0       0.0       2.0       3.0
*RIGIDWALL_PLANAR_MOVING_ID
         6wall
         0         0         0       0.5
       0.0       0.0       0.0       0.0       0.0       1.0
       5.0       2.0
*DEFINE_BOX
         7       0.5       1.5       -.5       0.5       -.5       0.5
*SECTION_BEAM
         9         1       1.0       2.0       1.0
       0.1       0.1       0.0       0.0
*END
)";
  const auto deck = [](const std::string& moves) {
    return head + "*DEFINE_TRANSFORMATION\n         3\n" + moves +
           "*INCLUDE_TRANSFORM\nbody.k\n         0\n         0\n       1.0    1000.0    1000.0\n"
           "         3\n*END\n";
  };
  const std::string turn =
      "ROTATE         0.0       0.0       1.0       0.0       0.0       0.0      90.0\n";
  const Folder folder({{"body.k", part},
                       {"main.k", deck(turn + "TRANSL       100.0\n")},
                       {"scaled.k", deck("SCALE          2.0       2.0       2.0\n")}});
  Diagnostics d;
  const auto model = read_deck(folder.path / "main.k", d);
  REQUIRE_MESSAGE(!d.has_errors(), all_of(d));
  int seen = 0;
  const auto point = [](const Card& c, const char* x, const char* y, const char* z) {
    return Vec3d{c.real(x), c.real(y), c.real(z)};
  };
  for (const auto& card : model->cards) {
    const Card& c = *card;
    if (c.schema->name == "DATABASE_CROSS_SECTION_PLANE") {
      ++seen;
      CHECK(norm(point(c, "xct", "yct", "zct") - Vec3d{100, 1000, 0}) < 1e-9);
      CHECK(norm(point(c, "xch", "ych", "zch") - Vec3d{100, 2000, 0}) < 1e-9);
      CHECK(norm(point(c, "xhev", "yhev", "zhev") - Vec3d{-900, 1000, 0}) < 1e-9);
      CHECK(c.real("lenl") == doctest::Approx(2000));
      CHECK(c.real("lenm") == doctest::Approx(3000));
    } else if (c.schema->name == "DEFINE_BOX") {
      ++seen;
      CHECK(norm(point(c, "xmn", "ymn", "zmn") - Vec3d{-400, 500, -500}) < 1e-9);
      CHECK(norm(point(c, "xmx", "ymx", "zmx") - Vec3d{600, 1500, 500}) < 1e-9);
    } else if (c.schema->name == "SECTION_BEAM") {
      ++seen;
      CHECK(c.real("ts1") == doctest::Approx(100));
      CHECK(c.real("qr") == 2);
    }
  }
  CHECK(seen == 3);
  REQUIRE(model->rigid_walls.size() == 1);
  const RigidWall& w = model->rigid_walls[0];
  CHECK(norm(w.tail - Vec3d{100, 0, 0}) < 1e-9);
  CHECK(norm(w.head - Vec3d{100, 0, 1000}) < 1e-9);
  CHECK(w.offset == doctest::Approx(500));
  CHECK(w.velocity == doctest::Approx(2));  // m/s = mm/ms
  CHECK(w.mass == doctest::Approx(5));

  // what a stretch would do to rectangles is refused
  Diagnostics scaled;
  read_deck(folder.path / "scaled.k", scaled);
  CHECK(count_of(scaled, Severity::error, "transform-unsupported") == 2);
}

// outer map after inner map, in whichever file each was defined
TEST_CASE("include transform: nested placements act one after the other") {
  const std::string turn =
      "*DEFINE_TRANSFORMATION\n         1\nROTATE         0.0       0.0       1.0       0.0"
      "       0.0       0.0      90.0\n";
  const Folder folder(
      {{"body.k", body},
       {"inner.k",
        "*KEYWORD\n*DEFINE_TRANSFORMATION\n         1\nTRANSL         1.0\n"
        "*INCLUDE_TRANSFORM\nbody.k\n        10        10        10        10        10"
        "        10        10\n\n\n         1\n*END\n"},
       {"main.k", head + turn +
                      "*INCLUDE_TRANSFORM\ninner.k\n       100       100       100       100"
                      "       100       100       100\n\n       1.0    1000.0    1000.0\n"
                      "         1\n*END\n"}});
  Diagnostics d;
  const auto model = read_deck(folder.path / "main.k", d);
  REQUIRE_MESSAGE(!d.has_errors(), all_of(d));
  CHECK(model->nodes.id[0] == 111);
  // (1, 0, 0) m -> (2, 0, 0) m -> (0, 2000, 0) mm
  check_point(model->nodes.x[0], 0, 2000, 0);
}

// mirror at the plane x = 5, scale, and a turn about the line of two points; det A tells a mirror
// from a turn
TEST_CASE("transformations: mirror, scale and a turn about two points") {
  Card card("DEFINE_TRANSFORMATION");
  card.add_row("MIRROR", {5, 0, 0, 6, 0, 0});
  card.add_row("SCALE", {1, 2, 1});
  card.add_row("POINT", {1, 0, 0, 0});
  card.add_row("POINT", {2, 0, 0, 4});
  card.add_row("ROTATE", {1, 2, 180});
  std::string problem;
  const auto map = affine_of(card, problem);
  REQUIRE_MESSAGE(map.has_value(), problem);
  // (1, 1, 1) -> (9, 1, 1) -> (9, 2, 1) -> (-9, -2, 1)
  check_point((*map)({1, 1, 1}), -9, -2, 1);
  CHECK(det(map->a) == doctest::Approx(-2));
}

TEST_CASE(
    "node transform: the nodes of a set move, one move after the other, and systems of nodes "
    "follow") {
  std::string text =
      head + body.substr(body.find("*NODE\n"), body.rfind("*INITIAL") - body.find("*NODE\n"));
  text +=
      "*DEFINE_TRANSFORMATION\n         1\nTRANSL        10.0\n*DEFINE_TRANSFORMATION\n         2\n"
      "ROTATE         0.0       0.0       1.0       0.0       0.0       0.0      90.0\n"
      "*NODE_TRANSFORM\n         1         7\n         2         7\n*END\n";
  Diagnostics d;
  const auto model = read_deck_text(text, "deck", d);
  // (1, 0, 0) -> (11, 0, 0) -> (0, 11, 0); node 3 is not in the set
  check_point(model->nodes.x[0], 0, 11, 0);
  check_point(model->nodes.x[1], 0, 12, 0);
  check_point(model->nodes.x[2], 1, 1, 0);
  check_point(model->coordinate_systems[0].origin, 0, 11, 0);
  CHECK(model->coordinate_systems[0].axes(0, 1) == doctest::Approx(1));
  CHECK_MESSAGE(d.count(Severity::unsupported) == 0, all_of(d));

  text.replace(text.find("         2         7\n"), 20, "         5         7\n");
  Diagnostics wrong;
  read_deck_text(text, "deck", wrong);
  CHECK(count_of(wrong, Severity::error, "missing-transformation") == 1);
}

TEST_CASE("missing file: it is the only error, whatever leads nowhere without it") {
  std::string set = "*SET_NODE_LIST\n         1\n";
  for (int i = 1; i <= 50; ++i)
    set += std::string(10 - std::to_string(i).size(), ' ') + std::to_string(i) + "\n";
  const std::string rest = set +
                           "*DEFINE_COORDINATE_NODES\n         9         1         2         3\n"
                           "*BOUNDARY_SPC_SET\n         1         9         1\n*END\n";
  const Folder folder(
      {{"main.k", "*KEYWORD\n*INCLUDE\nmesh.k\n" + rest}, {"whole.k", head + rest}});
  Diagnostics d;
  read_deck(folder.path / "main.k", d);
  CHECK_MESSAGE(d.count(Severity::error) == 1, all_of(d));
  CHECK(count_of(d, Severity::error, "missing-file") == 1);
  CHECK(count_of(d, Severity::note, "missing-node") == 1);

  // with every file there, each case counts: 50 of the set, 3 of the system, which itself is known
  Diagnostics whole;
  read_deck(folder.path / "whole.k", whole);
  CHECK_MESSAGE(whole.count(Severity::error) == 53, all_of(whole));
  CHECK(count_of(whole, Severity::error, "missing-coordinate-system") == 0);
  CHECK(int(whole.list().size()) < 25);
}

TEST_CASE("parameters: the first of two definitions counts unless told otherwise") {
  const auto height = [](const std::string& first, const std::string& keyword) {
    Diagnostics d;
    const std::string text =
        head + first + "\n" + keyword +
        "\nR  height        1.0\n*PARAMETER\nR  height        2.0\n" +
        "*NODE\n       1         &height              0.              0.\n*END\n";
    const auto model = read_deck_text(text, "deck", d);
    CHECK(count_of(d, Severity::warning, "duplicate-parameter") ==
          (first.empty() && keyword == "*PARAMETER" ? 1 : 0));
    return model->nodes.x[0].x;
  };
  CHECK(height("", "*PARAMETER") == 1.0);
  CHECK(height("", "*PARAMETER_MUTABLE") == 2.0);
  CHECK(height("*PARAMETER_DUPLICATION\n         4", "*PARAMETER") == 2.0);
  CHECK(height("*PARAMETER_DUPLICATION\n         5\n*PARAMETER_DUPLICATION\n         4",
               "*PARAMETER") == 1.0);
}

TEST_CASE("shell section: angles of its layers are read by point, eight a line") {
  const std::string text =
      head +
      "*SECTION_SHELL\n         1         2       1.0         9       0.0         0         1\n"
      "       1.0       1.0       1.0       1.0\n"
      "       0.0      45.0      90.0     -45.0       0.0      10.0      20.0      30.0\n"
      "      40.0\n*END\n";
  Diagnostics d;
  const auto model = read_deck_text(text, "deck", d);
  CHECK_MESSAGE(d.count(Severity::error) + d.count(Severity::unsupported) == 0, all_of(d));
  for (const auto& card : model->cards)
    if (card->schema->name == "SECTION_SHELL") {
      CHECK(card->real("b2") == 45);
      CHECK(card->real("b9") == 40);
    }
}
