#include "graph/schema.hpp"

#include <algorithm>

#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

using Json = nlohmann::ordered_json;

/// The parameters of a block as the schema has them.
Json parameters(const Json& schema, const std::string& id) {
  for (const auto& rule : schema["definitions"]["block"]["allOf"])
    if (rule["if"]["properties"]["block"]["const"] == id) return rule["then"];
  return {};
}

}  // namespace

TEST_CASE("schema: is draft-07 and lists every block with its summary") {
  const Json s = schema(test_registry());
  CHECK(s["$schema"] == "http://json-schema.org/draft-07/schema#");
  const Json& ids = s["definitions"]["block"]["properties"]["block"]["oneOf"];
  REQUIRE(ids.size() == test_registry().ids().size());
  CHECK(ids[0]["const"] == test_registry().ids().front());
  CHECK(ids[0]["description"] == "A block for tests.");
  CHECK(s["definitions"]["block"]["required"] == Json::array({"block"}));
}

TEST_CASE("schema: its keys are the loader's keys") {
  const Json s = schema(test_registry());
  for (const char* key : {"bodeflow", "title", "run", "include", "requires", "variables", "blocks", "connections", "schedule",
                          "record", "phases", "hosts"})
    CHECK(s["properties"].contains(key));
  CHECK(s["properties"].size() == 14);
  CHECK(s["additionalProperties"] == false);
  CHECK(s["definitions"]["run"]["properties"].size() == 14);
  CHECK(s["definitions"]["phases"]["items"]["properties"].size() == 10);
}

TEST_CASE("schema: a parameter has its type, range, default, unit and live flag") {
  const Json s = schema(test_registry());
  const Json gain = parameters(s, "filters.gain")["properties"]["gain"];
  CHECK(gain["default"] == 1.0);
  CHECK(gain["anyOf"][0]["type"] == "number");
  CHECK(gain["anyOf"][0]["minimum"] == -1e6);
  CHECK(gain["anyOf"][0]["maximum"] == 1e6);
  CHECK(gain["description"] ==
        "y[n] = gain * x[n]\na number\nat least -1000000 and at most 1000000\nlive: may change while the graph runs");
  CHECK(parameters(s, "filters.gain")["properties"].contains("factor"));
  const Json rate = parameters(s, "generators.multisine")["properties"]["sample_rate"];
  CHECK(rate["anyOf"][0]["exclusiveMinimum"] == 0.0);
  CHECK(rate["description"] == "a number [Hz]\nabove 0 Hz");
  CHECK_FALSE(rate.contains("default"));
}

TEST_CASE("schema: required parameters, choices and nested names") {
  const Json multisine = parameters(schema(test_registry()), "generators.multisine");
  CHECK(multisine["required"] == Json::array({"sample_rate", "period"}));
  CHECK(multisine["properties"]["phases"]["anyOf"][0]["enum"] == Json::array({"schroeder", "random"}));
  CHECK(multisine["properties"]["phases"]["default"] == "schroeder");
  const Json& lines = multisine["properties"]["lines"];
  CHECK(lines["type"] == Json::array({"object", "string"}));
  CHECK(lines["properties"]["first"]["default"] == 1);
  CHECK(lines["properties"]["last"]["anyOf"][0]["maximum"] == 1e6);
  CHECK(lines["additionalProperties"] == false);
  CHECK(multisine["additionalProperties"] == false);
}

}  // namespace bodeflow::graph
