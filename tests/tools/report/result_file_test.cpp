#include "report/result_file.hpp"

#include <fstream>

#include "catch.hpp"
#include "system/command.hpp"
#include "tools/report/run_results.hpp"

using namespace bodeflow::tools::report;
using bodeflow::test::Folder;

namespace {

ResultFile read(const std::string& text) {
  const Folder folder;
  return read_result(folder.write("result.json", text)).value();
}

std::string one_array(const std::string& array) {
  return R"({"results": {"a": {"type": "t", "attributes": {}, "arrays": {"x": )" + array + "}}}}";
}

}  // namespace

TEST_CASE("report input: records come with their attributes and arrays, complex ones as two lists, null as NaN") {
  const ResultFile file = read(R"({"bodeflow": 1, "graph": "g", "status": "complete", "results": {
    "a": {"type": "t", "attributes": {"n": 3, "f": 0.5, "yes": true, "name": "x", "list": ["p", "q"], "none": null},
          "arrays": {"r": {"unit": "V", "shape": [2, 2], "data": [1, 2.5, null, -4]},
                     "c": {"unit": "", "shape": [2], "data": [[1, 2], [null, 4]]},
                     "s": {"unit": "", "shape": [], "data": [7]}}},
    "b": {"type": "u", "attributes": {}, "arrays": {}}}})");
  CHECK(file.problems.empty());
  CHECK(file.graph == "g");
  REQUIRE(file.records.size() == 2);
  const Record& a = file.records[0];
  CHECK(a.key == "a");
  CHECK(a.number("n") == 3.0);
  CHECK(a.text("name") == "x");
  CHECK(a.texts("list") == std::vector<std::string>{"p", "q"});
  CHECK(a.array("r")->unit == "V");
  CHECK(std::isnan(a.array("r")->re[2]));
  CHECK(a.array("c")->is_complex());
  CHECK(a.array("c")->im[1] == 4.0);
  CHECK(std::isnan(a.array("c")->re[1]));
  CHECK(a.array("s")->re == std::vector<double>{7.0});
  CHECK(a.array("r", {2, 2}) != nullptr);
  CHECK(a.array("r", {4}) == nullptr);
  CHECK(a.array("c", {2}) == nullptr);
}

TEST_CASE("report input: an array whose values don't fit its shape is left out and named") {
  for (const char* array :
       {R"({"unit": "", "shape": [3], "data": [1, 2]})", R"({"unit": "", "shape": [1], "data": ["x"]})",
        R"({"unit": "", "shape": [-1], "data": [1]})", R"({"unit": "", "shape": [2], "data": [1, [2, 3]]})",
        R"({"unit": "", "shape": [1], "data": [[1, 2, 3]]})", R"({"unit": "", "shape": [1], "data": [[[1]]]})",
        R"({"unit": "", "shape": [4294967296, 4294967296, 16], "data": []})", R"([1, 2])", R"({"data": [1, 2]})"}) {
    const ResultFile file = read(one_array(array));
    INFO(array);
    REQUIRE(file.records.size() == 1);
    CHECK(file.records[0].arrays.empty());
    REQUIRE(file.problems.size() == 1);
    CHECK_THAT(file.problems[0], Catch::Matchers::Contains("'a': array 'x' is left out"));
  }
}

TEST_CASE("report input: a file that is cut off gives the records before that place") {
  const std::string whole = bodeflow::test::result_with(bodeflow::test::results_of_all_types()).dump();
  std::size_t least = 0;
  for (std::size_t cut = 0; cut < whole.size(); cut += whole.size() / 60) {
    const ResultFile file = read(whole.substr(0, cut));
    CHECK(file.problems.size() == 1);
    CHECK(file.records.size() >= least);
    least = file.records.size();
  }
  CHECK(least > 8);
  CHECK(read(whole).problems.empty());
}

TEST_CASE("report input: what is no result file gives problems or nothing, never an end of the program") {
  for (const char* text : {"", "[]", "null", "{}", R"({"results": 3})", R"({"results": {"a": 3, "b": [1], "c": {}}})",
                           "\xff\xfe\x00", R"({"results": {"a": {"type": 3, "arrays": {"x": 1}, "attributes": [1, 2]}}})",
                           R"({"results": {"a": {"type": "t", "attributes": {"deep": {"er": [1]}}, "arrays": []}}})"})
    CHECK_NOTHROW(read(text));
  CHECK(read(std::string(100'000, '[')).problems.size() == 1);
  CHECK_FALSE(read_result("/absent/result.json"));
}
