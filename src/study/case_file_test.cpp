#include "study/case_file.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "study/error.h"

using namespace fabrica::study;

namespace {

namespace fs = std::filesystem;

// A folder with a case.toml that is gone after the test.
struct Folder {
  fs::path path;
  explicit Folder(const std::string& text, const std::string& name = "some-case") {
    path = fs::temp_directory_path() / ("fabrica_case_" + std::to_string(::getpid())) / name;
    fs::create_directories(path);
    std::ofstream(path / "case.toml") << text;
    std::ofstream(path / "a.k") << "*KEYWORD\n*END\n";
  }
  ~Folder() { fs::remove_all(path.parent_path()); }
};

const std::string head = "title = \"t\"\nrequirement = \"r\"\nsource = \"s\"\ndeck = \"a.k\"\n";
const std::string check =
    "[[check]]\nname = \"c\"\nmodel = \"glstat:total\"\nexpected = 1\ntolerance = 0.1\n";

// what reading this text says
std::string error_of(const std::string& text) {
  const Folder folder(text);
  try {
    read_case(folder.path.string());
  } catch (const StudyError& e) {
    return e.what();
  }
  return "";
}
bool says(const std::string& error, std::initializer_list<const char*> parts) {
  for (const char* p : parts)
    if (error.find(p) == std::string::npos) {
      MESSAGE("\"", error, "\" lacks \"", p, "\"");
      return false;
    }
  return true;
}

}  // namespace

TEST_CASE("a case is read with its signals, checks and limits") {
  const Folder folder(
      head + "end_time = 20\n[parameters]\nspeed = 6.9\ncount = 3\n" + check +
      "[[limit]]\nname = \"l\"\nmodel = \"a:b / c:d\"\nstatistic = \"max\"\nmost = 0.1\n"
      "[[signal]]\nname = \"f\"\nmodel = \"rcforc:x:1\"\nfilter = \"CFC180\"\nrating = [\"cora\"]\n"
      "interval = [0, 60]\n");
  const Case c = read_case(folder.path.string());
  CHECK(c.name == "some-case");
  CHECK(c.end_time == 20);
  CHECK(c.parameters.at("speed") == "6.9");
  CHECK(c.parameters.at("count") == "3");
  REQUIRE(c.checks.size() == 2);
  CHECK(*c.checks[0].expected == 1);
  CHECK(*c.checks[1].most == 0.1);
  CHECK(c.signals[0].interval->second == 60);
}

TEST_CASE("every fault of a case is named with file, line, key and remedy") {
  CHECK(says(error_of(head), {"case.toml", "compares nothing", "Add [[signal]]"}));
  CHECK(says(error_of(head + check + "colour = 1\n"),
             {"case.toml:10", "check[1].colour", "not a key", "tolerance"}));
  CHECK(says(error_of("title = \"t\"\n"), {"requirement", "is missing"}));
  CHECK(says(error_of("title = 3\nrequirement = \"r\"\nsource = \"s\"\n"),
             {":1", "title", "not a text", "quotes"}));
  CHECK(says(error_of(head + "end_time = \"soon\"\n" + check), {":5", "end_time", "not a number"}));
  CHECK(says(error_of(head + "x = [\n"), {"case.toml:", "TOML"}));
  CHECK(
      says(error_of("title = \"t\"\nrequirement = \"r\"\nsource = \"s\"\ndeck = \"b.k\"\n" + check),
           {":4", "deck", "there is no b.k", "Correct the name"}));
  CHECK(says(error_of(head + check +
                      "[[check]]\nname = \"c\"\nmodel = \"a:b\"\nexpected = 1\ntolerance = 0.1\n"
                      "statistic = \"median\"\n"),
             {"check[2].statistic", "'median' is not known", "mean, last"}));
  CHECK(says(error_of(head + check + "statistic = \"failure\"\n"),
             {"check[1].energy", "is missing", "matsum:internal_energy"}));
  CHECK(says(error_of(head + check + "energy = \"matsum:internal_energy:1\"\n"),
             {"check[1].energy", "without the statistic failure"}));
  CHECK(says(
      error_of(head + check + "[[signal]]\nname = \"s\"\nmodel = \"a:b\"\nfilter = \"CFC100\"\n"),
      {"signal[1].filter", "CFC180"}));
  CHECK(says(error_of(head + check + "filter = \"CFC100\"\n"), {"check[1].filter", "CFC180"}));
  CHECK(says(error_of(head + "body = { sex = \"male\" }\n" + check), {"body", "beside a deck"}));
  CHECK(says(error_of(head + check + "[[limit]]\nname = \"l\"\nmodel = \"a:b\"\n"),
             {"limit[1]", "without a bound"}));
}

TEST_CASE("names of folders in file names are replaced, and a missing one is named") {
  const std::map<std::string, std::string> values = {{"car6", "over/there"}};
  CHECK(expand("{car6}/main.k", values, "f", 1) == "over/there/main.k");
  CHECK_THROWS_WITH_AS(expand("{muscle}/main.k", values, "f", 3),
                       doctest::Contains("f:3: {muscle}"), StudyError);
  CHECK(missing_path("{muscle}/main.k", {{"muscle", "decks"}}, values) == "muscle");
  CHECK(missing_path("{car6}/main.k", {{"car6", "decks"}}, values).empty());
}
