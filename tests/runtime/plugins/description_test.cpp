#include <limits>
#include <random>

#include "catch.hpp"
#include "plugins/description_check.hpp"
#include "plugins/description_json.hpp"
#include "support.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using Json = nlohmann::ordered_json;

namespace {

const BlockDescription& gain() {
  static const Registry registry(options({fixture("good")}));
  return *registry.find("fixture.gain");
}

std::string error_of(const char* json) {
  const auto block = from_json(Json::parse(json));
  return block ? "accepted" : block.error();
}

/// All places in a JSON value.
void collect(Json& json, std::vector<Json*>& places) {
  places.push_back(&json);
  if (json.is_structured()) {
    for (Json& entry : json) collect(entry, places);
  }
}

}  // namespace

TEST_CASE("a description holds what the plugin says") {
  const BlockDescription& b = gain();
  CHECK(b.summary == "Multiplies a stream by a constant.");
  CHECK(b.realtime_safe);
  CHECK(b.in_place);
  CHECK_FALSE(b.asynchronous);
  CHECK(b.count(BF_STREAM, BF_IN) == 1);
  CHECK(b.count(BF_MESSAGE, BF_OUT) == 0);
  REQUIRE(b.port(BF_IN, "in") != nullptr);
  CHECK(b.port(BF_IN, "in")->doc == "what is multiplied");
  CHECK(b.port(BF_IN, "out") == nullptr);
  CHECK(&b.port_at(BF_STREAM, BF_OUT, 0) == b.port(BF_OUT, "out"));
  CHECK(b.parameter("factor") == b.parameter("gain"));
  CHECK(b.parameter("peroids") == -1);
  const ParameterDescription& p = b.parameters.at(static_cast<std::size_t>(b.parameter("gain")));
  CHECK(p.live);
  CHECK(p.minimum == -1e6);
  CHECK(p.maximum == 1e6);
  CHECK(p.fallback.numbers == std::vector<double>{1.5});
  const ParameterDescription& cut_off = b.parameters.at(static_cast<std::size_t>(b.parameter("cut_off")));
  CHECK(cut_off.exclusive_minimum);
  CHECK(cut_off.fallback.rows == 0);
  CHECK(cut_off.maximum == std::numeric_limits<double>::infinity());
  CHECK(b.parameters.at(static_cast<std::size_t>(b.parameter("file"))).required);
}

TEST_CASE("message ports and stream ports of one direction are counted apart") {
  const Registry registry(options({fixture("plain")}));
  const BlockDescription& b = *registry.find("plain.scale");
  CHECK(b.port(BF_OUT, "out")->index == 0);
  CHECK(b.port(BF_OUT, "sums")->index == 0);
  CHECK(b.port(BF_OUT, "sums")->record_type == "sum");
  CHECK(b.parameters[0].aliases == std::vector<std::string>{"gain", "amplification"});
}

TEST_CASE("a description survives the way through JSON text") {
  CHECK(from_json(Json::parse(to_json(gain()).dump())).value() == gain());
  BlockDescription edge = gain();
  edge.parameters[0].fallback.numbers = {std::numeric_limits<double>::denorm_min()};
  edge.parameters[0].minimum = -0.1;
  edge.doc = "\xC3\xA4 \"quoted\"\n\xE2\x88\x9E";
  ParameterDescription matrix;
  matrix.name = "a.b";
  matrix.type = BF_MATRIX;
  matrix.fallback = {BF_MATRIX, false, 2, 3, 0, {1, 2, 3, 4, std::numeric_limits<double>::infinity(), 6}, {}, {}};
  edge.parameters.push_back(matrix);
  CHECK(from_json(Json::parse(to_json(edge).dump())).value() == edge);
}

TEST_CASE("the JSON of a description speaks the graph's words") {
  const Json json = to_json(gain());
  CHECK(json["ports"][0] ==
        Json::parse(R"({"name": "in", "kind": "stream", "direction": "in", "element": "f64", "doc": "what is multiplied"})"));
  CHECK(json["parameters"][0] == Json::parse(R"({"name": "gain", "type": "number", "live": true, "unit": "1", "default": 1.5,
      "minimum": -1e6, "maximum": 1e6, "aliases": ["factor"], "doc": "y = gain x"})"));
  CHECK(json["parameters"][7]["default"] == Json::parse("[[-1.0, 2.0], [-1.0, -2.0]]"));
}

TEST_CASE("wrong JSON of a description is refused with what is wrong") {
  CHECK(error_of("[]") == "a block is an object");
  CHECK(error_of("{}") == "a block's id is ''; allowed: family.name of letters, digits, _");
  CHECK(error_of(R"({"id": "a b.c"})") == "a block's id is 'a b.c'; allowed: family.name of letters, digits, _");
  CHECK(error_of(R"({"id": 3})") == "a text is expected");
  CHECK(error_of(R"({"id": "a.b", "ports": [{"name": "x", "kind": "pipe"}]})") == "ports: unknown kind 'pipe'");
  CHECK(error_of(R"({"id": "a.b", "ports": [{"name": "x", "kind": "stream", "direction": "in", "element": "u8"}]})") ==
        "block 'a.b': port 'x': element type 4 can't be a stream's; allowed: f64, c64, any");
  CHECK(error_of(R"({"id": "a.b", "parameters": [{"name": "x", "type": "integer", "default": 1.5}]})") ==
        "parameters: default: an integer is expected");
  CHECK(error_of(R"({"id": "a.b", "parameters": [{"name": "x", "type": "choice", "choices": ["p"], "default": "q"}]})") ==
        "block 'a.b': parameter 'x': the default 'q' is none of the choices");
  CHECK(error_of(R"({"id": "a.b", "parameters": [{"name": "x", "type": "matrix", "default": [[1, 2], [3]]}]})") ==
        "parameters: default: rows of one length are expected");
  CHECK(error_of(R"({"id": "a.b", "parameters": [{"name": "x", "type": "number", "minimum": 2, "maximum": 1}]})") ==
        "block 'a.b': parameter 'x': the range 2 .. 1 is empty");
  CHECK(error_of(
            R"({"id": "a.b", "parameters": [{"name": "x", "type": "bool"}, {"name": "y", "type": "bool", "aliases": ["x"]}]})") ==
        "block 'a.b': two parameters are named 'x'");
}

TEST_CASE("hostile JSON of a description never throws, and what is accepted is sound") {
  std::mt19937_64 random(11);
  const std::vector<Json> poison = {nullptr,
                                    true,
                                    -1,
                                    1e300,
                                    "",
                                    "inf",
                                    std::string(300, 'a'),
                                    Json::array(),
                                    Json::object(),
                                    Json::array({Json::array({1})}),
                                    std::numeric_limits<std::uint64_t>::max(),
                                    "stream",
                                    "matrix"};
  const Json good = to_json(gain());
  int accepted = 0;
  for (int round = 0; round < 3000; ++round) {
    Json json = good;
    for (int k = 0; k < 2; ++k) {
      std::vector<Json*> places;
      collect(json, places);
      *places[random() % places.size()] = poison[random() % poison.size()];
    }
    const auto block = from_json(json);
    if (!block) continue;
    ++accepted;
    CHECK(check(*block).empty());
    CHECK(from_json(to_json(*block)).value() == *block);
  }
  CHECK(accepted > 0);
}

TEST_CASE("a plugin's description survives the way through JSON, refused or not") {
  PluginDescription plugin{"/a.so", "a", "1", "gcc", std::string(64, '0'), {gain()}, "", {}, {}};
  const auto back = plugin_from_json(to_json(plugin));
  REQUIRE(back);
  CHECK(back->blocks == plugin.blocks);
  CHECK(back->file == "/a.so");
  plugin.refused = "crashes";
  CHECK(plugin_from_json(to_json(plugin)).value().refused == "crashes");
  CHECK(plugin_from_json(Json::object()).error() == "neither blocks nor a reason why it is refused");
}

TEST_CASE("the C view of a value points at its entries") {
  ParameterValue value;
  value.type = BF_STRINGS;
  value.given = true;
  value.rows = 2;
  value.strings = {"one", "two"};
  ParameterView first(value);
  const ParameterView view = std::move(first);
  CHECK(view.c().struct_size == sizeof(bf_parameter_value));
  CHECK(view.c().given == 1);
  CHECK(view.c().rows == 2);
  CHECK(std::string(view.c().strings[1]) == "two");
}
