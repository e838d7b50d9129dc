#include <bodeflow/block.hpp>
#include <functional>

#include "catch.hpp"

using namespace bodeflow;

namespace {

/// What is wrong with a description that begins well and goes on as told; "" if nothing is.
std::string problems(const std::function<void(Describe&)>& rest) {
  BlockDraft draft;
  Describe d(draft);
  d.id("example.block").summary("Does something.");
  rest(d);
  try {
    const BlockType type(std::move(draft));
    return "";
  } catch (const Failure& failure) {
    return failure.what();
  }
}

constexpr In<double> kIn{0, "in"};
constexpr Out<double> kOut{0, "out"};

}  // namespace

TEST_CASE("a complete description becomes the C descriptor") {
  BlockDraft draft;
  Describe d(draft);
  d.id("example.block")
      .summary("Does something.")
      .doc("More.")
      .reference("A, B, 1999")
      .reference("C, D, 2001")
      .role("source")
      .role("test");
  d.realtime_safe().in_place().cost_ns(7.5);
  d.stream_in(In<Any>{0, "in"}).optional().doc("input");
  d.stream_out(Out<Any>{0, "out"}).same_as(In<Any>{0, "in"});
  d.message_in(MessageIn{0, "model"}).record_type("model");
  d.message_out(MessageOut{0, "report"});
  d.parameter("gain", 2.0).unit("V").range(0.0, 5.0).live().alias("amplification").alias("k").doc("factor");
  d.parameter("mode", "fast").choices({"fast", "slow"});
  d.required<std::int64_t>("lines.first").above(0);
  d.optional<std::vector<std::complex<double>>>("poles");
  const BlockType type(std::move(draft));
  const bf_block_descriptor& c = type.c();
  CHECK(c.struct_size == sizeof(bf_block_descriptor));
  CHECK(c.flags == (BF_BLOCK_REALTIME_SAFE | BF_BLOCK_IN_PLACE));
  CHECK(std::string(c.references) == "A, B, 1999\nC, D, 2001");
  CHECK(std::string(c.roles) == "source test");
  CHECK(c.cost_ns == 7.5);
  REQUIRE(c.port_count == 4);
  CHECK(c.ports[0]->flags == BF_PORT_OPTIONAL);
  CHECK(c.ports[0]->element == BF_ANY);
  CHECK(std::string(c.ports[2]->record_type) == "model");
  CHECK(c.ports[3]->record_type == nullptr);
  REQUIRE(c.parameter_count == 4);
  const bf_parameter_descriptor& gain = *c.parameters[0];
  CHECK(gain.type == BF_NUMBER);
  CHECK(gain.flags == BF_PARAMETER_LIVE);
  CHECK(std::string(gain.aliases) == "amplification k");
  CHECK(gain.maximum == 5.0);
  CHECK(gain.fallback.rows == 1);
  CHECK(gain.fallback.numbers[0] == 2.0);
  CHECK(c.parameters[1]->type == BF_CHOICE);
  CHECK(std::string(c.parameters[1]->choices[1]) == "slow");
  CHECK(std::string(c.parameters[1]->fallback.strings[0]) == "fast");
  CHECK(c.parameters[2]->flags == (BF_PARAMETER_REQUIRED | BF_PARAMETER_EXCLUSIVE_MIN));
  CHECK(c.parameters[3]->type == BF_COMPLEX_LIST);
  CHECK(c.parameters[3]->fallback.rows == 0);
}

TEST_CASE("a port whose index is not its place is named") {
  CHECK(problems([](Describe& d) {
          d.stream_in(In<double>{1, "in"});
        }) == "block 'example.block': stream input 'in' has index 1, but stands at place 0 among the stream inputs");
  CHECK(problems([](Describe& d) {
          d.message_out(MessageOut{0, "a"});
          d.message_out(MessageOut{0, "b"});
        }) == "block 'example.block': message output 'b' has index 0, but stands at place 1 among the message outputs");
  CHECK(problems([](Describe& d) {
          d.stream_in(kIn);
          d.stream_out(kOut);
          d.message_in(MessageIn{0, "message"});
        }) == "");
}

TEST_CASE("ids, names and ranges that do not fit are named") {
  CHECK(problems([](Describe& d) { d.id("Example.block"); }).find("id has not the form family.name") != std::string::npos);
  CHECK(problems([](Describe& d) { d.id("block"); }).find("id has not the form family.name") != std::string::npos);
  CHECK(problems([](Describe& d) { d.id("a.b.c"); }).find("id has not the form family.name") != std::string::npos);
  CHECK(problems([](Describe& d) { d.summary(""); }) == "block 'example.block': summary is missing");
  CHECK(problems([](Describe& d) {
          d.stream_in(kIn);
          d.message_in(MessageIn{0, "in"});
        }) == "block 'example.block': message input 'in': name stands twice");
  CHECK(problems([](Describe& d) { d.parameter("gain", 2.0).range(0.0, 1.0); }) ==
        "block 'example.block': parameter 'gain': default is out of its range");
  CHECK(problems([](Describe& d) { d.parameter("gain", 0.0).above(0.0); }) ==
        "block 'example.block': parameter 'gain': default is out of its range");
  CHECK(problems([](Describe& d) {
          d.parameter("list", std::vector<double>{1.0, 9.0}).range(0.0, 5.0);
        }) == "block 'example.block': parameter 'list': default is out of its range");
  CHECK(problems([](Describe& d) { d.parameter("gain", std::nan("")); }) ==
        "block 'example.block': parameter 'gain': default is out of its range");
  CHECK(problems([](Describe& d) {
          d.parameter("mode", "c").choices({"a", "b"});
        }) == "block 'example.block': parameter 'mode': default 'c' is none of the choices");
  CHECK(problems([](Describe& d) { d.parameter("n", 1).range(5, 1); }).find("range is empty") != std::string::npos);
  CHECK(problems([](Describe& d) { d.parameter("n", 1).unit("Hz"); }) ==
        "block 'example.block': parameter 'n': only numbers have a unit");
  CHECK(problems([](Describe& d) {
          d.parameter("gain", 1.0);
          d.parameter("factor", 1.0).alias("gain");
        }) == "block 'example.block': parameter name 'gain' stands twice");
  CHECK(problems([](Describe& d) {
          d.parameter("lines", 1.0);
          d.parameter("lines.first", 1.0);
        }) == "block 'example.block': parameter 'lines.first' and 'lines': one is a group in the other's name");
  CHECK(problems([](Describe& d) { d.parameter("Gain", 1.0); }).find("name is not made of words") != std::string::npos);
  CHECK(problems([](Describe& d) { d.asynchronous().stream_in(kIn); }) ==
        "block 'example.block': asynchronous is for blocks with message ports alone");
  CHECK(problems([](Describe& d) { d.stream_out(kOut).same_as(kIn); }) ==
        "block 'example.block': stream output 'out': same_as names a stream input that is not described");
  CHECK(problems([](Describe& d) {
          d.stream_in(kIn);
          d.stream_out(Out<std::complex<double>>{0, "out"}).same_as(kIn);
        }) == "block 'example.block': stream output 'out' is same_as 'in', but carries c64, not f64");
}

TEST_CASE("all that is wrong with a description is told at once") {
  const std::string found = problems([](Describe& d) {
    d.summary("").id("x");
    d.parameter("gain", 2.0).range(0.0, 1.0);
  });
  CHECK(found ==
        "block 'x': id has not the form family.name (lower-case letters, digits, _)\n"
        "block 'x': summary is missing\n"
        "block 'x': parameter 'gain': default is out of its range");
}

TEST_CASE("a block's descriptor stays in place when the type is made from a moved draft") {
  BlockDraft draft;
  Describe d(draft);
  d.id("example.block").summary("s");
  for (int i = 0; i < 50; ++i)
    d.parameter("parameter_with_a_long_name_" + std::to_string(i), std::vector<std::string>{"x", std::to_string(i)});
  const BlockType type(std::move(draft));
  for (int i = 0; i < 50; ++i) {
    const bf_parameter_descriptor& p = *type.c().parameters[i];
    CHECK(std::string(p.name) == "parameter_with_a_long_name_" + std::to_string(i));
    CHECK(std::string(p.fallback.strings[1]) == std::to_string(i));
  }
}
