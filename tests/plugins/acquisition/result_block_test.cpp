#include "acquisition/result_block.hpp"

#include <cmath>
#include <complex>

#include "catch.hpp"
#include "plugins/block_driver.hpp"
#include "read_whole.hpp"

using namespace bodeflow;
using acquisition::ResultBlock;
using test::BlockDriver;
using test::failure_of;
using test::TemporaryFile;

namespace {

const char* const kTwo = R"({"bodeflow": 1, "graph": "g", "status": "complete", "results": {
  "identify": {"type": "model", "attributes": {"order": 2, "delay": 0.0, "cost": null, "stable": true, "method": "a.b",
      "parameter_names": ["a", "b"], "warnings": [], "lines": [1, 2], "band": [0.5, 3], "flags": [true, false]},
    "arrays": {"parameters": {"unit": "", "shape": [2], "data": [1.5, -2.25]},
      "covariance": {"unit": "V^2", "shape": [2, 2], "data": [1.0, null, 0.1, 2.0]},
      "poles": {"unit": "rad/s", "shape": [2], "data": [[-1.0, 2.0], [-1.0, -2.0]]},
      "line": {"unit": "", "shape": [2], "data": [3, 4]},
      "zeros": {"unit": "rad/s", "shape": [0], "element": "c64", "data": []}}},
  "data": {"type": "frequency_response", "attributes": {}, "arrays": {}}}})";

std::string refusal(const std::string& text, const std::string& name = "", const std::string& type = "") {
  const TemporaryFile file(".json", text);
  BlockDriver<ResultBlock> block;
  block.set("file", file.path()).set("name", name).set("type", type);
  std::string said = failure_of([&] { block.configure(); });
  if (said.rfind(file.path(), 0) == 0) said = "F" + said.substr(file.path().size());
  return said;
}

std::string with_array(const std::string& array) {
  return R"({"bodeflow": 1, "results": {"r": {"type": "t", "arrays": {"a": )" + array + "}}}}";
}

}  // namespace

TEST_CASE("result block: a record comes back as the run left it") {
  const TemporaryFile file(".json", kTwo);
  BlockDriver<ResultBlock> block;
  block.set("file", file.path()).set("type", "model");
  block.configure();
  block.resolve({});
  block.activate(1, {});
  block.finish();
  REQUIRE(block.records().size() == 1);
  const RecordView r(*block.records()[0]);
  CHECK(r.type() == "model");
  CHECK(r.integer("order") == 2);
  CHECK(r.number("delay") == 0.0);
  CHECK(std::isnan(*r.number("cost")));
  CHECK(r.boolean("stable") == true);
  CHECK(r.texts("parameter_names") == std::vector<std::string_view>{"a", "b"});
  CHECK(r.texts("warnings")->empty());
  CHECK(r.integers("lines") == std::vector<std::int64_t>{1, 2});
  CHECK(r.numbers("band") == std::vector<double>{0.5, 3.0});
  CHECK(r.booleans("flags") == std::vector<bool>{true, false});
  CHECK(r.array("parameters")->as<double>()[1] == -2.25);
  CHECK(std::isnan(r.array("covariance")->as<double>()[1]));
  CHECK(r.array("covariance")->unit == "V^2");
  CHECK(r.array("poles")->as<std::complex<double>>()[1] == std::complex<double>(-1, -2));
  CHECK(r.array("line")->as<std::int64_t>()[1] == 4);
  CHECK(r.array("zeros")->as<std::complex<double>>().empty());
}

TEST_CASE("result block: a run that did not end is told") {
  const TemporaryFile file(".json", R"({"bodeflow": 1, "status": "partial", "results": {"r": {"type": "t"}}})");
  BlockDriver<ResultBlock> block;
  block.set("file", file.path());
  block.configure();
  REQUIRE(block.log().size() == 2);
  CHECK(block.log()[1] == "warning: " + file.path() + ": the run is partial: its results may not be its last");
}

TEST_CASE("result block: the record that is meant must be clear") {
  CHECK(refusal(R"({"bodeflow": 1, "results": {"a": {"type": "t"}, "b": {"type": "t"}, "c": {"type": "s"}}})", "", "t") ==
        "F: more than one record of type 't'; say which by its name: a (t), b (t), c (s)");
  CHECK(refusal(kTwo) == "no failure");  // identify
  CHECK(refusal(kTwo, "x") == "F: no result 'x'; it has identify (model), data (frequency_response)");
  CHECK(refusal(kTwo, "data", "model") == "F: result 'data' is of type 'frequency_response'; needed: model");
  CHECK(refusal(kTwo, "", "trace") == "F: no record of type 'trace'; it has identify (model), data (frequency_response)");
  CHECK(refusal(R"({"bodeflow": 1, "results": {}})") == "F: no record; it has nothing");
}

TEST_CASE("result block: files that are no results of a run are refused by name and place") {
  CHECK(refusal("") == "F:1:1: is no JSON");
  CHECK(refusal("{\"bodeflow\": 1,\n  \"results\": {]}") == "F:2:15: is no JSON");
  CHECK(refusal("[1, 2]") == "F: is no result.json of a run: 'bodeflow' and 'results' are missing");
  CHECK(refusal(R"({"bodeflow": 1, "results": 3})") == "F: is no result.json of a run: 'bodeflow' and 'results' are missing");
  CHECK(refusal(R"({"bodeflow": 2, "results": {}})") == "F: results of version 2; read is 1");
  CHECK(refusal(std::string(200000, '[')).rfind("F:1:", 0) == 0);
  CHECK(refusal(R"({"bodeflow": 1, "results": {"r": 5}})") == "F: result 'r': is no record: 'type' is missing");
  CHECK(refusal(R"({"bodeflow": 1, "results": {"r": {"type": "t", "attributes": {"x": [1, "a"]}}}})") ==
        "F: result 'r': attribute 'x': found string where a number is needed");
  CHECK(refusal(R"({"bodeflow": 1, "results": {"r": {"type": "t", "attributes": {"x": {}}}}})") ==
        "F: result 'r': attribute 'x': found object where a number is needed");
  CHECK(refusal(R"({"bodeflow": 1, "results": {"r": {"type": "t", "attributes": {"x": 18446744073709551615}}}})") ==
        "F: result 'r': attribute 'x': an integer is beyond 64 bits");
  CHECK(refusal(R"({"bodeflow": 1, "results": {"r": {"type": "t", "arrays": 7}}})") == "F: result 'r': 'arrays' is no object");
  CHECK(refusal(with_array("[]")) == "F: result 'r': array 'a': 'unit' is missing");
  CHECK(refusal(with_array(R"({"unit": "", "shape": [3], "data": [1]})")) ==
        "F: result 'r': array 'a': its shape needs 3 values, 'data' has 1");
  CHECK(refusal(with_array(R"({"unit": "", "shape": [-1], "data": []})")) ==
        "F: result 'r': array 'a': its shape has a negative extent");
  CHECK(refusal(with_array(R"({"unit": "", "shape": [4294967296, 4294967296, 16], "data": []})")) ==
        "F: result 'r': array 'a': its shape is too large");
  CHECK(refusal(with_array(R"({"unit": "", "shape": [2], "data": [[1, 2], 3]})")) ==
        "F: result 'r': array 'a': a complex number is [re, im]");
  CHECK(refusal(with_array(R"({"unit": "", "shape": [1], "element": "f16", "data": [1]})")) ==
        "F: result 'r': array 'a': unknown elements 'f16'");
}

TEST_CASE("result block: folders and files that are not there") {
  BlockDriver<ResultBlock> block;
  block.set("file", std::string("/nowhere/at/all"));
  CHECK(failure_of([&] { block.configure(); }).rfind("/nowhere/at/all: can't be read: ", 0) == 0);
  block.set("file", std::string("/"));
  CHECK(failure_of([&] { block.configure(); }) == "/: a folder without result.json; needed: a run directory");
}
