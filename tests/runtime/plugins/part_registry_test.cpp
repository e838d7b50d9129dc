// Effects and base models as the host sees them: probed, kept, refused.
#include "catch.hpp"
#include "plugins/description_json.hpp"
#include "support.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using Json = nlohmann::ordered_json;

namespace {

std::string reason(const std::string& name) {
  const Registry registry(options({fixture(name)}));
  return registry.plugins().at(0).refused;
}

std::string refusal(const Json& json) {
  const auto effect = effect_from_json(json);
  return effect ? "accepted" : effect.error();
}

}  // namespace

TEST_CASE("a plugin gives blocks, effects and base models at once") {
  const Registry registry(options({fixture("parts")}));
  CHECK(registry.plugins()[0].refused.empty());
  CHECK(registry.ids() == std::vector<std::string>{"parts.asker"});
  CHECK(registry.effects() == std::vector<std::string>{"parts.drag", "parts.gain", "parts.lag"});
  CHECK(registry.base_models() == std::vector<std::string>{"parts.mass"});
  REQUIRE(registry.find_effect("parts.drag") != nullptr);
  CHECK(registry.plugin_of("parts.drag") == &registry.plugins()[0]);
  CHECK(registry.find_effect("parts.mass") == nullptr);
  REQUIRE(registry.find_base_model("parts.mass") != nullptr);
  CHECK(registry.find_base_model("parts.mass")->parameters.size() == 4);
}

TEST_CASE("a plugin of effects alone is usable") {
  const Registry registry(options({fixture("only_effect")}));
  CHECK(registry.plugins()[0].refused.empty());
  CHECK(registry.ids().empty());
  CHECK(registry.effects() == std::vector<std::string>{"lone.offset"});
}

TEST_CASE("of two plugins with the same effect, or an effect named as a block, the later is refused") {
  const Registry registry(options({fixture("only_effect"), fixture("same_effect"), fixture("parts"), fixture("like_a_block")}));
  CHECK(registry.plugins()[1].refused ==
        "gives effect 'lone.offset', which " + std::filesystem::canonical(fixture("only_effect")).string() + " gives already");
  CHECK(registry.plugins()[3].refused ==
        "gives effect 'parts.asker', which " + std::filesystem::canonical(fixture("parts")).string() + " gives already");
}

TEST_CASE("a plugin with a broken effect or base model is refused") {
  CHECK(reason("part_plain").empty());
  CHECK(reason("part_unknown_acts") == "effect 'broken.part': unknown way to act 77");
  CHECK(reason("part_huge_memory") == "effect 'broken.part': memory of 1099511627776 numbers; allowed: at most 65536");
  CHECK(reason("part_no_kind") ==
        "effect 'broken.part': acts as law, but names no kind of place: acts(Acts::law, {\"bearing\"})");
  CHECK(reason("part_null_kinds") == "the kinds of places of effect 'broken.part' are a null pointer");
  CHECK(reason("part_twice") == "gives effect 'broken.part' twice");
  CHECK(reason("part_base_with_ports") == "base model 'broken.part': has ports");
  CHECK(reason("part_base_without_summary") == "base model 'broken.part': summary is missing");
}

TEST_CASE("kinds of a later host are ignored") {
  const Registry registry(options({fixture("part_unknown_kind")}));
  CHECK(registry.plugins()[0].refused.empty());
  CHECK(registry.effects().empty());
}

TEST_CASE("descriptions of effects and base models survive JSON, and the cache gives them again") {
  const Folder folder;
  Registry::Options with_cache = options({fixture("parts")});
  with_cache.cache = folder / "cache.json";
  const Json first = to_json(Registry(with_cache).plugins()[0]);
  CHECK(text_of(folder / "cache.json").find("parts.drag") != std::string::npos);
  with_cache.probe_command = "/bin/false";  // whoever probes now fails
  const Registry again(with_cache);
  CHECK(to_json(again.plugins()[0]) == first);
  CHECK(first["effects"][0]["acts"] == "law");
  CHECK(first["base_models"][0]["id"] == "parts.mass");
  CHECK_FALSE(first["base_models"][0].contains("ports"));
  for (const Json& entry : first["effects"]) CHECK(to_json(effect_from_json(entry).value()) == entry);
}

TEST_CASE("a broken JSON description of an effect is refused, never trusted") {
  const Json good = {{"id", "a.b"}, {"summary", "S."}, {"acts", "output"}, {"memory", 3}};
  CHECK(refusal(good) == "accepted");
  const auto with = [&](const char* name, const Json& value) {
    Json changed = good;
    changed[name] = value;
    return refusal(changed);
  };
  CHECK(with("id", "b") == "effect 'b': id has not the form family.name (lower-case letters, digits, _)");
  CHECK(with("acts", "magic") == "unknown way to act 'magic'");
  CHECK(with("memory", -1) == "memory: found -1, allowed: 0 to 65536");
  CHECK(with("memory", 1e300) == "an integer is expected");
  CHECK(with("steps_per_sample", 0) == "effect 'a.b': steps_per_sample is 0; allowed: 1 to 4096");
  CHECK(with("kinds", 7) == "a list is expected");
  CHECK(with("equivalents", Json::array({"x y"})) ==
        "effect 'a.b': equivalent 'x y' is not a word of lower-case letters, digits and _");
  CHECK(with("summary", "\xff") == "effect 'a.b': a text is not UTF-8");
  CHECK(refusal(Json::array()) == "an effect is an object");
}

TEST_CASE("a block makes parts of other plugins, in the words of whoever refuses") {
  Registry registry(options({fixture("parts"), fixture("only_effect"), fixture("part_refuses")}));
  std::vector<std::string> said;
  auto services = std::make_shared<HostServices>();
  services->log = [&said](const std::string& block, int level, const std::string& text) {
    said.push_back(block + " " + std::to_string(level) + " " + text);
  };
  const auto asker = Instance::make(registry, "parts.asker", "curious", services).value();
  std::vector<ParameterValue> values = defaults(asker->type());
  REQUIRE(asker->configure(values));
  CHECK(said == std::vector<std::string>{"curious 1 effect broken.part", "curious 1 effect lone.offset",
                                         "curious 1 effect parts.drag", "curious 1 effect parts.gain",
                                         "curious 1 effect parts.lag", "curious 1 base model parts.mass",
                                         "curious 1 drag of 6.000000",
                                         "curious 2 effect 'parts.drag': react failed and gives no number: thirteen (told once)",
                                         "curious 1 filter at 2000.000000"});
  values[0].strings = {"broken.part"};
  CHECK(asker->configure(values).error() == "plugin 'broken_part' (" +
                                                std::filesystem::canonical(fixture("part_refuses")).string() +
                                                "): the table of materials is missing");
  values[0].strings = {"parts.lagg"};
  CHECK(asker->configure(values).error() == "no plugin gives the effect 'parts.lagg' (did you mean 'parts.lag'?)");
  values[0].strings = {"parts.drag"};
  values[1].strings = {"corner=2 kV"};
  CHECK(asker->configure(values).error() == "base model 'parts.mass': corner: 2 kV is a voltage; allowed: a frequency in Hz");
}
