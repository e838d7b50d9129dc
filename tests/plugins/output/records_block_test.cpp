#include "output/records_block.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "folder.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using output::RecordsBlock;
using test::BlockDriver;
using test::Folder;

TEST_CASE("output.records: each record is a line of JSON with its time, attributes and arrays") {
  const Folder folder;
  RecordBuilder first("frequency_response"), second("note \"two\"");
  first.set("form", "known_input").set("periods", 7).set("done", true).set("rate", 2.5e3);
  first.set("names", std::vector<std::string>{"a\n", "\u00B5\x01"})
      .set("limits", std::vector<double>{-1.0, std::numeric_limits<double>::infinity()});
  auto response = first.array<std::complex<double>>("response", "rad/A", {2, 1, 1});
  response[0] = {0.1, -2.0};
  response[1] = {std::numeric_limits<double>::quiet_NaN(), 1.0};
  first.array<std::int64_t>("line", "", {1})[0] = -9007199254740993;
  first.array<std::uint8_t>("bytes", "", {2})[1] = 255;
  first.array<double>("none", "", {0, 3});

  BlockDriver<RecordsBlock> block;
  block.write_to(folder.path());
  block.configure();
  block.resolve({});
  block.activate(0, Rate());
  block.receive(first, 1.5);
  CHECK(folder.text("records.jsonl").back() == '\n');
  block.receive(second, 2.0);
  block.finish();

  const std::string text = folder.text("records.jsonl");
  const std::size_t end = text.find('\n');
  const auto one = nlohmann::json::parse(text.substr(0, end));
  const auto expected = nlohmann::json::parse(R"json({
    "time": 1.5, "type": "frequency_response",
    "attributes": {"form": "known_input", "periods": 7, "done": true, "rate": 2500.0, "names": ["a\n", "\u00b5\u0001"], "limits": [-1.0, null]},
    "arrays": {
      "response": {"unit": "rad/A", "shape": [2, 1, 1], "data": [[0.1, -2.0], [null, 1.0]]},
      "line": {"unit": "", "shape": [1], "data": [-9007199254740993]},
      "bytes": {"unit": "", "shape": [2], "data": [0, 255]},
      "none": {"unit": "", "shape": [0, 3], "data": []}}})json");
  CHECK(one == expected);
  CHECK(text.substr(end + 1) == "{\"time\": 2, \"type\": \"note \\\"two\\\"\", \"attributes\": {}, \"arrays\": {}}\n");
}
