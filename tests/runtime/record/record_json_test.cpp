#include <limits>

#include "catch.hpp"
#include "record/json_text.hpp"
#include "recording_fixture.hpp"

using namespace bodeflow;
using namespace bodeflow::record_tests;
using nlohmann::ordered_json;

namespace {

SharedRecord of_every_kind() {
  RecordBuilder r("every_kind");
  r.set("accepted", true);
  r.set("order", std::int64_t{-9007199254740993});  // beyond what a double holds
  r.set("whole", 3.0);
  r.set("tenth", 0.1);
  r.set("reason", std::string("stable: \"yes\", µ"));
  r.set("flags", std::vector<bool>{true, false});
  r.set("orders", std::vector<std::int64_t>{1, 2});
  r.set("levels", std::vector<double>{1.0, 2.5});
  r.set("names", std::vector<std::string>{"R1", ""});
  auto f = r.array<double>("numerator", "rad/A", {2, 2});
  f[0] = 1.0, f[1] = 5e-324, f[2] = 1.7976931348623157e308, f[3] = -0.0;
  auto z = r.array<std::complex<double>>("response", "1", {1, 2, 1});
  z[0] = {0.1, -2.0}, z[1] = {3.0, 1e-20};
  auto i = r.array<std::int64_t>("index", "", {2});
  i[0] = std::numeric_limits<std::int64_t>::min(), i[1] = std::numeric_limits<std::int64_t>::max();
  auto u = r.array<std::uint8_t>("mask", "", {3});
  u[0] = 0, u[1] = 255, u[2] = 7;
  (void)r.array<std::complex<double>>("none", "V", {0, 4});
  auto scalar = r.array<double>("scalar", "s", {});
  scalar[0] = 2.0;
  return finished(r);
}

bool same_bytes(const SharedRecord& a, const SharedRecord& b) {
  return a.size() == b.size() && std::equal(a.bytes(), a.bytes() + a.size(), b.bytes());
}

std::string refusal(const char* text) {
  const auto record = record::record_from_json(ordered_json::parse(text));
  return record ? "accepted" : record.error();
}

}  // namespace

TEST_CASE("a record survives JSON text and back bit for bit, whatever it holds that is finite") {
  const SharedRecord record = of_every_kind();
  const std::string text = record::json_text(record::to_json(record));
  const auto back = record::record_from_json(ordered_json::parse(text));
  REQUIRE(back);
  CHECK(same_bytes(record, *back));
}

TEST_CASE("a record's JSON has the shape that scripts rely on") {
  RecordBuilder r("frequency_response");
  r.set("form", std::string("known_input")).set("periods", std::int64_t{7});
  auto y = r.array<std::complex<double>>("response", "rad/A", {2, 1, 1});
  y[0] = {1.5, -2.0}, y[1] = {0.1, 1e-20};
  auto v = r.array<double>("variance", "", {2});
  v[0] = std::numeric_limits<double>::infinity(), v[1] = 4.0;
  auto n = r.array<std::int64_t>("lines", "", {2});
  n[0] = 3, n[1] = 5;
  CHECK(record::json_line(record::to_json(finished(r))) ==
        R"({"type": "frequency_response", "attributes": {"form": "known_input", "periods": 7}, "arrays": {)"
        R"("response": {"unit": "rad/A", "shape": [2, 1, 1], "data": [[1.5, -2.0], [0.1, 1e-20]]}, )"
        R"("variance": {"unit": "", "shape": [2], "data": [null, 4.0]}, )"
        R"("lines": {"unit": "", "shape": [2], "data": [3, 5]}}})");
}

TEST_CASE("null in a record's JSON reads back as not a number") {
  const auto record = record::record_from_json(
      ordered_json::parse(R"({"type": "trace", "attributes": {"error_remedied": null, "levels": [1.0, null]}, "arrays": {
                              "share": {"unit": "1", "shape": [2], "data": [null, 0.5]}}})"));
  REQUIRE(record);
  const RecordView view(record->bytes());
  CHECK(std::isnan(view.number("error_remedied").value()));
  CHECK(std::isnan(view.numbers("levels").value().at(1)));
  CHECK(std::isnan(view.array("share")->as<double>()[0]));
  CHECK(view.array("share")->as<double>()[1] == 0.5);
}

TEST_CASE("JSON that is not a record is refused with the reason") {
  CHECK(refusal("[]") == "not a record: 'type' is missing");
  CHECK(refusal(R"({"type": "a", "arrays": {"x": {"unit": "", "data": []}}})") == "not a record: array 'x': 'shape' is missing");
  CHECK(refusal(R"({"type": "a", "arrays": {"x": {"unit": "", "shape": [3], "data": [1.0]}}})") ==
        "not a record: array 'x': its shape needs 3 values, 'data' has 1");
  CHECK(refusal(R"({"type": "a", "arrays": {"x": {"unit": "", "shape": [-1], "data": []}}})") ==
        "not a record: array 'x': its shape has a negative extent");
  CHECK(refusal(R"({"type": "a", "arrays": {"x": {"unit": "", "shape": [4294967296, 4294967296], "data": []}}})") ==
        "not a record: array 'x': its shape is too large");
  CHECK(refusal(R"({"type": "a", "arrays": {"x": {"unit": "", "shape": [2], "data": [[1.0, 2.0], [1.0]]}}})") ==
        "not a record: array 'x': a complex value is [re, im]");
  CHECK(refusal(R"({"type": "a", "arrays": {"x": {"unit": "", "shape": [1], "element": "u8", "data": [256]}}})") ==
        "not a record: array 'x': 256 is not a byte");
  CHECK(refusal(R"({"type": "a", "arrays": {"x": {"unit": "", "shape": [1], "element": "f32", "data": [1.0]}}})") ==
        "not a record: array 'x': unknown element type \"f32\"");
  CHECK(refusal(R"({"type": "a", "attributes": {"n": 18446744073709551615}})") ==
        "not a record: attribute 'n': an integer is beyond 64 bits");
  CHECK(refusal(R"({"type": "a", "attributes": {"n": {}}})") ==
        "not a record: attribute 'n': found object where a number is needed");
}

TEST_CASE("JSON text writes every double as the shortest decimal that reads back, and lists on one line") {
  const ordered_json json = {
      {"x", {0.1, 1.0 / 3.0, 1e16, -0.0, 100.0}}, {"rows", {{{"k", 1}}, {{"k", 2}}}}, {"none", ordered_json::object()}};
  CHECK(record::json_text(json) ==
        "{\n"
        "  \"x\": [0.1, 0.3333333333333333, 1e+16, -0.0, 100.0],\n"
        "  \"rows\": [\n    {\n      \"k\": 1\n    },\n    {\n      \"k\": 2\n    }\n  ],\n"
        "  \"none\": {}\n"
        "}\n");
}
