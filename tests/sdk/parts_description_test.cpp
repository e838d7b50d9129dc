#include <bodeflow/parts.hpp>

#include "catch.hpp"
#include "probe_host.hpp"

using namespace bodeflow;

namespace {

std::string problems_of(const EffectDescription& d) {
  try {
    (void)EffectType(d);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "none";
}

EffectDescription law() {
  EffectDescription d;
  DescribeEffect(d).id("example.drag").summary("Brakes.").acts(Acts::law, {"bearing"});
  return d;
}

class Silent final : public Effect {
 public:
  static void describe(DescribeEffect& d) { d.id("example.silent"); }
  std::vector<FitParameter> parameters(const Situation&) const override { return {}; }
  std::vector<std::vector<double>> starts(const Situation&) const override { return {{}}; }
  std::string sentence(std::span<const double>, std::span<const double>, const Situation&) const override { return "s"; }
};

class WithPort final : public BaseModel {
 public:
  static void describe(Describe& d) {
    d.id("example.silent").summary("Has a port.");
    d.message_in(MessageIn{0, "in"});
  }
  std::vector<FitParameter> parameters() const override { return {}; }
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse>) const override { return {{}}; }
};

}  // namespace

TEST_CASE("all that is wrong with the description of an effect is told at once") {
  CHECK(problems_of(law()) == "none");
  EffectDescription d = law();
  d.id = "drag";
  d.summary.clear();
  d.memory = kMostEffectMemory + 1;
  d.steps_per_sample = 0;
  d.kinds = {"bearing", "Bearing", "bearing"};
  d.equivalents = {"a b"};
  CHECK(problems_of(d) ==
        "effect 'drag': id has not the form family.name (lower-case letters, digits, _)\n"
        "effect 'drag': summary is missing\n"
        "effect 'drag': memory of 65537 numbers; allowed: at most 65536\n"
        "effect 'drag': steps_per_sample is 0; allowed: 1 to 4096\n"
        "effect 'drag': kind of place 'Bearing' is not a word of lower-case letters, digits and _\n"
        "effect 'drag': kind of place 'bearing' stands twice\n"
        "effect 'drag': equivalent 'a b' is not a word of lower-case letters, digits and _");
}

TEST_CASE("kinds of places and memory belong to those ways to act that have them") {
  EffectDescription d = law();
  d.kinds.clear();
  CHECK(problems_of(d) == "effect 'example.drag': acts as law, but names no kind of place: acts(Acts::law, {\"bearing\"})");
  d = law();
  d.acts = Acts::series;
  d.memory = 1;
  CHECK(problems_of(d) ==
        "effect 'example.drag': acts as series: only laws and immittances have kinds of places\n"
        "effect 'example.drag': acts as series: only laws, inputs and outputs have a memory");
}

TEST_CASE("a description survives the way into its C struct and back") {
  EffectDescription d;
  DescribeEffect(d)
      .id("a.b")
      .summary("S")
      .doc("D")
      .reference("one")
      .reference("two")
      .acts(Acts::output)
      .memory(7)
      .steps_per_sample(3);
  DescribeEffect(d).rough().nonstationary().constant().equivalent_to({"x", "y"}, "a level");
  const EffectType type(d);
  const EffectDescription back = effect_description(type.c());
  CHECK(back.id == d.id);
  CHECK(back.references == "one\ntwo");
  CHECK(back.acts == Acts::output);
  CHECK(back.memory == 7);
  CHECK(back.steps_per_sample == 3);
  CHECK(back.rough);
  CHECK(back.nonstationary);
  CHECK(back.memoryless_linear);
  CHECK(back.equivalents == d.equivalents);
  CHECK(back.separation == "a level");
}

TEST_CASE("a plugin with a broken effect or base model gives no factories, and says why") {
  ProbeHost host;
  std::uint32_t count = 7;
  CHECK(plugin_factories<Silent, WithPort>(&host.host, &count) == nullptr);
  CHECK(count == 0);
  CHECK(host.error ==
        "effect 'example.silent': summary is missing\n"
        "effect 'example.silent': acts as law, but names no kind of place: acts(Acts::law, {\"bearing\"})\n"
        "base model 'example.silent': base models have no ports");
}

TEST_CASE("values of parameters are read as people write them") {
  const auto numbers = [](std::uint32_t type, const char* unit, const char* text) {
    const auto value = parse_value(type, unit, text);
    return value ? value->numbers : std::vector<double>{};
  };
  CHECK(numbers(BF_NUMBER, "s", " 1.5 us ") == std::vector<double>{1.5e-6});
  CHECK(numbers(BF_NUMBERS, "Hz", "[1 kHz, 2]") == std::vector<double>{1000.0, 2.0});
  CHECK(numbers(BF_COMPLEX_LIST, "", "[[1, 2], 3]") == std::vector<double>{1.0, 2.0, 3.0, 0.0});
  const auto matrix = parse_value(BF_MATRIX, "", "[[1, 2, 3], [4, 5, 6]]");
  REQUIRE(matrix);
  CHECK(matrix->rows == 2);
  CHECK(matrix->columns == 3);
  CHECK(parse_value(BF_BOOL, "", "true")->integer == 1);
  CHECK(parse_value(BF_STRINGS, "", "[a, \"b, c\"]")->strings == std::vector<std::string>{"a", "b, c"});
  CHECK(parse_value(BF_MATRIX, "", "[[1, 2], [3]]").error().text == "rows of a matrix differ in length");
  CHECK(parse_value(BF_INTEGER, "", "1e3")->integer == 1000);
  CHECK(parse_value(BF_INTEGER, "", "one").error().text == "'one' is not a number");
  CHECK(parse_value(BF_NUMBERS, "", "[1, 2").error().text == "'[1, 2' is not a list in brackets");
}
