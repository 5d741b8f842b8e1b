#include "body/tables.h"

#include <doctest/doctest.h>

using namespace fabrica::body;

TEST_CASE("a table gives cells by row and column, past comments and quotes") {
  const Table table(
      "x.csv",
      "# a comment\nbone,volume,source\nfemur,527.72,\"measured, scaled\"\nulna,44.86,measured\n");
  CHECK(table.rows() == 2);
  CHECK(table.text(0, "source") == "measured, scaled");
  CHECK(table.number(1, "volume") == 44.86);
  CHECK(table.line(1) == 4);
}

TEST_CASE("a broken table is refused with file, line, column and remedy") {
  const Table table("x.csv", "bone,volume\nfemur,many\n");
  CHECK_THROWS_WITH_AS(table.number(0, "volume"),
                       "x.csv:2: 'many' in column 'volume' is no number; write one such as 12.5",
                       BodyError);
  CHECK_THROWS_WITH_AS(table.number(0, "mass"),
                       "x.csv:2: no column is named 'mass'; name it in the header", BodyError);
  CHECK_THROWS_WITH_AS(Table("y.csv", "a,b\n1,2,3\n"),
                       "y.csv:2: 3 cells where the header names 2 columns; add or remove commas",
                       BodyError);
}

TEST_CASE("every file of the data folder is in the program, in order") {
  const auto& files = embedded_data_files();
  REQUIRE(!files.empty());
  for (std::size_t i = 1; i < files.size(); ++i) CHECK(files[i - 1].path < files[i].path);
  CHECK(has_data_file("anatomy/bones/index.csv"));
  CHECK_THROWS_AS(data_file("no_such_table.csv"), BodyError);
}
