#include "deck/reader.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "deck/number.h"
#include "deck/parameter.h"
#include "deck/writer.h"
#include "model/schema.h"

using namespace fabrica;

TEST_CASE("vocabulary: the compiled texts follow their grammar") {
  for (const std::string& problem : Vocabulary::get().problems()) FAIL_CHECK(problem);
  std::vector<std::string> options;
  const KeywordSchema* k =
      Vocabulary::get().find("CONTACT_AUTOMATIC_SINGLE_SURFACE_MPP_ID", options);
  REQUIRE(k);
  CHECK(k->name == "CONTACT_AUTOMATIC_SINGLE_SURFACE");
  CHECK(options == std::vector<std::string>{"MPP", "ID"});
  REQUIRE_FALSE(Vocabulary::get().suggest("MAT_ELASTC").empty());
  CHECK(Vocabulary::get().suggest("MAT_ELASTC")[0] == "MAT_ELASTIC");
}

TEST_CASE("numbers: Fortran forms, and nothing that is not a finite number") {
  CHECK(parse_real("1.5d3") == 1500.0);
  CHECK(parse_real("1.0+3") == 1000.0);
  CHECK(parse_real("-7.83000E-6") == -7.83e-6);
  CHECK(parse_real(".5") == 0.5);
  CHECK(parse_real("+5.") == 5.0);
  for (const char* bad : {"nan", "inf", "1e999", "1 2", "1.2.3", "e5", "--1", "", "+", "1e"})
    CHECK_FALSE(parse_real(bad));
  CHECK(parse_integer("0.0") == 0);
  CHECK(parse_integer("12.") == 12);
  CHECK_FALSE(parse_integer("1.5"));
}

TEST_CASE("expressions: integers divide as in Fortran, powers bind first and from the right") {
  ParameterTable table;
  table.define("N", std::int64_t(7), false);
  const auto value = [&](const char* text) {
    std::string problem;
    const auto v = evaluate_expression(text, table, problem);
    REQUIRE_MESSAGE(v.has_value(), problem);
    return as_real(*v);
  };
  CHECK(value("n / 2") == 3);
  CHECK(value("n / 2.0") == 3.5);
  CHECK(value("-2**2") == -4);
  CHECK(value("2**3**2") == 512);
  CHECK(value("2 * -&n + max(1, 3)") == -11);
  CHECK(value("mod(7, 4)") == 3);
}

namespace {

const char* const cube = R"(*KEYWORD
*PARAMETER
R  height        1.0I    part         1
*CONTROL_TERMINATION
       1.0
*NODE
       1              0.              0.              0.
2,1.,0.,0.
       3      0.1000d+1             1.0              0.
       4              0.              1.              0.
       5              0.              0.         &height
       6              1.              0.         &height
$ a comment among nodes
       7              1.              1.         &height
       8.333333333333333              1.         &height
*element_solid (ten nodes format)
       1       1
       1       2       3       4       5       6       7       8
*PART
a cube, with a comma
     &part         1         1
*SECTION_SOLID_TITLE
bricks
         1         1
*MAT_ELASTIC
         17.83000E-6      210.       0.3
*DEFINE_CURVE
         5
                 0.0                 0.1
    0.12345678901234                 2.0
*END)";

}  // namespace

TEST_CASE("reader: one deck, many forms") {
  Diagnostics d;
  const auto model = read_deck_text(cube, "cube", d);
  std::string all;
  for (const Diagnostic& x : d.list()) all += d.format(x) + "\n";
  REQUIRE_MESSAGE(!d.has_errors(), all);
  REQUIRE(model->nodes.size() == 8);
  CHECK(model->nodes.x[2].x == 1.0);
  CHECK(model->nodes.x[4].z == 1.0);
  REQUIRE(model->solids.size() == 1);
  REQUIRE(model->materials.size() == 1);
  CHECK(model->materials[0].density == 7.83e-6);
}

// a/b/deck.k names ../shared from its own folder, and its include names it again from there
TEST_CASE("reader: *INCLUDE_PATH_RELATIVE starts at the main file, also where that is included") {
  namespace fs = std::filesystem;
  const fs::path root =
      fs::temp_directory_path() / ("fabrica_include_" + std::to_string(::getpid()));
  for (const char* folder : {"a/b", "a/shared", "out"}) fs::create_directories(root / folder);
  const auto write = [&](const char* file, const std::string& text) {
    std::ofstream(root / file) << "*KEYWORD\n" << text << "*END\n";
  };
  write("a/b/deck.k", "*INCLUDE_PATH_RELATIVE\n../shared\n*INCLUDE\nnodes.k\n");
  write("a/shared/nodes.k", "*NODE\n1,0.0,0.0,0.0\n");
  write("out/main.k", "*INCLUDE\n" + (root / "a/b/deck.k").string() + "\n");
  for (const char* file : {"a/b/deck.k", "out/main.k"}) {
    Diagnostics diagnostics;
    read_deck((root / file).string(), diagnostics);
    CHECK(fs::equivalent(diagnostics.files.back(), root / "a/shared/nodes.k"));
    for (const Diagnostic& d : diagnostics.list())
      CHECK(diagnostics.format(d).find("search paths") == std::string::npos);
  }
  fs::remove_all(root);
}

TEST_CASE("writer: reading back gives the same bits, in short and in long format") {
  for (const char* x : {".333333333333333", "0.33333333333333331", "0.12345678901234567"}) {
    std::string text = cube;
    text.replace(text.find(".333333333333333"), 16, std::string("&third").insert(0, 10, ' '));
    text.replace(text.find("*CONTROL"), 0,
                 std::string("*PARAMETER_EXPRESSION\nR third   ") + x + "\n");
    Diagnostics d;
    const auto model = read_deck_text(text, "cube", d);
    REQUIRE_FALSE(d.has_errors());
    std::stringstream out;
    write_deck(*model, out);
    Diagnostics again;
    const auto copy = read_deck_text(out.str(), "copy", again);
    REQUIRE_MESSAGE(!again.has_errors(), out.str());
    CHECK(copy->nodes.x[7].x == model->nodes.x[7].x);
    CHECK_MESSAGE(copy->content_hash() == model->content_hash(), out.str());
  }
}

TEST_CASE("writer: rows that repeat stand behind blank optional cards") {
  Diagnostics d;
  Builder builder(d);
  Card& law = builder.add_card("MAT_PLASTICITY_COMPRESSION_TENSION");
  law.set("mid", 1).set("ro", 2e-6).set("e", 17).set("lcidc", 1).set("lcidt", 1);
  law.add_row({1.15, 0.0333}).add_row({2.48, 3.33});
  const auto model = builder.finish();
  std::stringstream out;
  write_deck(*model, out);
  Diagnostics again;
  const auto copy = read_deck_text(out.str(), "copy", again);
  const Card* read = nullptr;
  for (const auto& card : copy->cards)
    if (card->schema->category == "material") read = card.get();
  REQUIRE(read);
  CHECK_FALSE(read->given("k"));
  REQUIRE(read->row_count() == 2);
  CHECK(read->row(0, "betai") == 0.0333);
  CHECK(read->row(1, "gi") == 2.48);
}

// No double may grow out of its 20 columns into those of the next field.
TEST_CASE("writer: numbers of 17 digits keep to their columns") {
  for (const char* x :
       {"-.033312000000333124", "-3.3312000000333124E-13", "-1.2345678901234567E+123",
        "1.2345678901234567E-300", "-1.0976931348623157E+308"}) {
    std::string text = cube;
    text.replace(text.find(".333333333333333"), 16, std::string("&third").insert(0, 10, ' '));
    text.replace(text.find("*CONTROL"), 0,
                 std::string("*PARAMETER_EXPRESSION\nR third   ") + x + "\n");
    Diagnostics d;
    const auto model = read_deck_text(text, "cube", d);
    std::stringstream out;
    write_deck(*model, out);
    Diagnostics again;
    const auto copy = read_deck_text(out.str(), "copy", again);
    const double sent = model->nodes.x[7].x;
    CHECK(std::abs(copy->nodes.x[7].x - sent) <= 1e-14 * std::abs(sent));
    CHECK(copy->nodes.x[7].y == model->nodes.x[7].y);
    CHECK(copy->nodes.x[7].z == model->nodes.x[7].z);
  }
}
