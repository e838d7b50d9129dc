#include <algorithm>
#include <bodeflow/testing/conformance.hpp>

#include "../../sdk/testing/source/sanitized.hpp"
#include "catch.hpp"

using namespace bodeflow::testing;

namespace {

Options only(const std::string& block) {
  Options options;
  options.block = block;
  return options;
}

/// The reason of the first failure of that check, "passes" or "not made".
std::string finding(const Report& report, const std::string& name) {
  std::string found = "not made";
  for (const Check& c : report.checks) {
    if (c.name != name) continue;
    if (c.status == Status::fail) return c.reason;
    found = c.status == Status::pass ? "passes" : "skipped: " + c.reason;
  }
  return found;
}

bool begins(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

constexpr const char* kBits = "gives the same bits and records for every size and boundary of calls";
constexpr const char* kReset = "is as fresh after reset";
constexpr const char* kRealtime = "neither allocates, locks nor does input or output in process, as it claims";
constexpr const char* kMemory = "writes every sample of its outputs and nothing else";

}  // namespace

TEST_CASE("a plugin that keeps the contract passes every check") {
  Options options;
  options.settings =
      *parse_settings("good.mean: length = 10\ngood.mean: length = 333  # longer than a call\ngood.cart: delay = 1 ms\n");
  const Report report = check_plugin(BODEFLOW_GOOD_PLUGIN, options);
  INFO(to_text(report));
  CHECK(report.passed());
#if defined(BODEFLOW_SANITIZED)
  CHECK(finding(report, kRealtime) == "skipped: the test program has no hook");
#else
  CHECK(report.count(Status::skip) == 0);
  CHECK(finding(report, kRealtime) == "passes");
#endif
  CHECK(finding(report, "works in place as it claims") == "passes");
  CHECK(finding(report, "survives records without content") == "passes");
  CHECK(std::any_of(report.checks.begin(), report.checks.end(), [](const Check& c) { return c.setting == "@element = c64"; }));
}

TEST_CASE("a block that runs in none of its settings has not passed") {
  const Report report = check_plugin(BODEFLOW_GOOD_PLUGIN, only("good.mean"));
  CHECK(finding(report, "can be set up") == "skipped: parameter 'length' is required");
  CHECK(finding(report, "runs in some setting") ==
        "it refused all of them: parameter 'length' is required; give one in a settings file");
}

TEST_CASE("a block that the plugin does not have is not passed over") {
  const std::string there = "the plugin has good.";
  CHECK(finding(check_plugin(BODEFLOW_GOOD_PLUGIN, only("good.maen")), "is in the plugin").rfind(there, 0) == 0);
  Options options = only("good.mean");
  options.settings = *parse_settings("good.mean: length = 10\ngood.maen: length = 333\n");
  CHECK(finding(check_plugin(BODEFLOW_GOOD_PLUGIN, options), "is in the plugin").rfind(there, 0) == 0);
}

TEST_CASE("a setting that does not fit is a failure of the setting") {
  Options options = only("good.mean");
  options.settings = *parse_settings("good.mean: lenght = 10\n");
  CHECK(finding(check_plugin(BODEFLOW_GOOD_PLUGIN, options), "can be set up") == "unknown parameter 'lenght'");
  options.settings = *parse_settings("good.mean: length = ten\n");
  CHECK(finding(check_plugin(BODEFLOW_GOOD_PLUGIN, options), "can be set up") == "parameter 'length': 'ten' is not a number");
}

TEST_CASE("what a setting says of one input must name one that the block has") {
  const auto of = [](const std::string& feed) {
    Options options = only("good.mean");
    options.settings = *parse_settings("good.mean: length = 10, " + feed + "\n");
    return finding(check_plugin(BODEFLOW_GOOD_PLUGIN, options), "can be set up");
  };
  CHECK(of("@channels.in = 3, @note.in.noise.std = [0.1, 0.2]") == "passes");
  CHECK(of("@channels.inn = 3") == "@channels.inn: the block has no stream input 'inn'");
  CHECK(of("@note.out.noise.std = [1]") == "@note.out.noise.std: the block has no stream input 'out'");
  CHECK(of("@note.in.noise.std = 1") == "@note.in.noise.std: '1' has not the form [1, 2]");
  CHECK(of("@unconnected = in") == "@unconnected: the block has no optional stream input 'in'");
}

TEST_CASE("each breach of the contract is found by its check") {
  const auto of = [](const char* block, const char* name) {
    return finding(check_plugin(BODEFLOW_BAD_PLUGIN, only(block)), name);
  };
  CHECK(begins(of("bad.chunk_mean", kBits), "output 'out', channel 0, value 0 is "));
  CHECK(begins(of("bad.no_reset", kReset), "output 'out', channel 0, value 0 is "));
  CHECK(begins(of("bad.shared", "gives the same bits in a second instance"), "output 'out', channel 0, value 0 is "));
  CHECK(begins(of("bad.gaps", kMemory),
               "leaves samples of an output unwritten, or reads them: output 'out', channel 0, value 100 is 0 with "));
  CHECK(begins(of("bad.beyond", kMemory), "writes outside of output 'out', channel 0"));
  CHECK(of("bad.scribbler", kMemory) == "changes samples of an input");
  CHECK(begins(of("bad.in_place", "works in place as it claims"), "output 'out', channel 0, value 1 is "));
  CHECK(of("bad.impure_resolve", "resolve is pure and copes with inputs that are not known yet") ==
        "gives other facts when asked again");
  CHECK(of("bad.eager_resolve", "resolve is pure and copes with inputs that are not known yet") ==
        "resolve fails: the input has no rate");
  CHECK(of("bad.late_record", kBits) ==
        "record 0 on 'note' is sent at firing 1000 with calls of 1000, at 501 with calls of 1 (give emit the offset)");
  CHECK(
      begins(of("bad.crashes_on_nan", "survives NaN, infinite, denormal and huge samples"), "crashes: Segmentation fault (NaN"));
  CHECK(begins(of("bad.stuck_on_nan", "survives NaN, infinite, denormal and huge samples"),
               "output 'out', channel 0, value 0 is "));
  CHECK(of("bad.wild_parameter", "takes or refuses extreme values of parameter 'length'") == "crashes: Aborted (-1)");
  CHECK(begins(of("bad.exits", "passes through its life cycle in order"), "ends the process with exit code 3"));
  CHECK(begins(of("bad.live_jump", "gives the same bits for every cut when a live parameter changes"),
               "output 'out', channel 0, value 10"));
  CHECK(begins(of("bad.unknown_unit", "has a sound descriptor"), "parameter 'speed': unit 'furlong/fortnight' is unknown"));
}

TEST_CASE("each breach of the contract of an effect or a base model is found by its check") {
  const auto of = [](const char* part, const char* name) { return finding(check_plugin(BODEFLOW_BAD_PLUGIN, only(part)), name); };
  constexpr const char* kLaw = "reacts finitely, from its arguments alone, and writes its own memory";
  CHECK(of("bad.law_throws", kLaw) ==
        "the reaction or a slope is not finite: effect 'bad.law_throws': react failed and gives no "
        "number: too fast (told once)");
  CHECK(of("bad.law_beyond", kLaw) == "writes beyond its memory of 2 numbers");
  CHECK(of("bad.law_unwritten", kLaw) == "leaves numbers of its memory unwritten, or reads them");
  CHECK(of("bad.law_crashes", kLaw) == "crashes: Segmentation fault (flow nan)");
  CHECK(of("bad.start_outside", "states sound parameters and starts inside their bounds") ==
        "starts 'k' at 1.000000, outside of its bounds");
  CHECK(of("bad.impure_map", "maps samples finitely, and the same ones alike") ==
        "gives other samples when the same ones come again");
  CHECK(begins(of("bad.one_sided", "has a finite and real transfer at every frequency"), "is no real law: at -0.001 Hz"));
  CHECK(of("bad.other_response", "has the response of its state space") == "the response is not that of its state space");
  CHECK(of("bad.other_response", "gives starts from a measured response") == "gives a start of 2 values for 1 parameters");
  CHECK(of("bad.wrong_sizes", "gives a finite plant of the sizes that it states") ==
        "gives no plant: base model 'bad.wrong_sizes': state_space failed and gives no number: a matrix does not have the size "
        "that "
        "the plant states (told once)");
}

#if !defined(BODEFLOW_SANITIZED)
TEST_CASE("a false claim of real-time safety is found, with the function that was called") {
  const auto of = [](const char* block) { return finding(check_plugin(BODEFLOW_BAD_PLUGIN, only(block)), kRealtime); };
  CHECK(begins(of("bad.allocates"), "process calls malloc at firing 0 "));
  CHECK(begins(of("bad.locks"), "process calls pthread_mutex_lock at firing 0 "));
  CHECK(begins(of("bad.prints"), "process calls fflush at firing 0 "));
}
#endif

TEST_CASE("a file that is no plugin is refused with the reason") {
  const Report none = check_plugin("/no/such/file.so");
  CHECK(finding(none, "has an ELF note that tells what it is") == "/no/such/file.so: can't be read");
  const Report text = check_plugin(std::string(BODEFLOW_SOURCE_DIR) + "/CMakeLists.txt");
  CHECK(finding(text, "has an ELF note that tells what it is") == "is no 64-bit ELF file");
  const Report foreign = check_plugin("/proc/self/exe");
  CHECK(finding(foreign, "has an ELF note that tells what it is") == "has no ELF note 'bodeflow'");
  CHECK_FALSE(none.passed());
}

TEST_CASE("the settings file is read, with the line of what can't be") {
  const auto settings =
      parse_settings("# comment\n\nfamily.block: gain = 2.5, list = [1, 2], text = \"a, b # c\"  # why\nfamily.block:\n");
  REQUIRE(settings);
  REQUIRE(settings->at("family.block").size() == 2);
  CHECK(settings->at("family.block")[0] == Setting{{"gain", "2.5"}, {"list", "[1, 2]"}, {"text", "\"a, b # c\""}});
  CHECK(settings->at("family.block")[1].empty());
  CHECK(parse_settings("\nfamily.block gain").error().text == "2: no ':' behind the block's id");
  CHECK(parse_settings("a.b: gain").error().text == "1: 'gain' has not the form name = value");
  CHECK(parse_settings("a.b: x = [1, 2").error().text == "1: '[' is not closed");
  CHECK(read_settings("/no/such/file").error().text == "/no/such/file: can't be read");
}
