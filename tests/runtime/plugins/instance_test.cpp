#include "plugins/instance.hpp"

#include <cstring>

#include "catch.hpp"
#include "support.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

std::unique_ptr<Instance> made(const std::string& file, const std::string& id,
                               std::shared_ptr<const HostServices> services = nullptr) {
  Registry registry(options({fixture(file)}));
  auto instance = Instance::make(registry, id, "b", std::move(services));
  INFO((instance ? "" : instance.error()));
  REQUIRE(instance);
  return std::move(*instance);  // the registry goes, the library stays
}

std::string refusal(const std::string& file, const std::string& id) {
  Registry registry(options({fixture(file)}));
  const auto instance = Instance::make(registry, id, "b", nullptr);
  REQUIRE_FALSE(instance);
  const std::string place = "plugin 'broken' (" + std::filesystem::canonical(fixture(file)).string() + "): ";
  CHECK(instance.error().rfind(place, 0) == 0);
  return instance.error().substr(place.size());
}

bf_activation activation() {
  bf_activation a{};
  a.max_count = 1024;
  a.rate = {1000, 1};
  a.vector_level = 1;
  return a;
}

std::vector<ParameterValue> thrower_values(const std::string& where) {
  ParameterValue value;
  value.type = BF_CHOICE;
  value.given = true;
  value.rows = 1;
  value.strings = {where};
  return {value};
}

ParameterValue number(double value) {
  ParameterValue v;
  v.type = BF_NUMBER;
  v.given = true;
  v.rows = 1;
  v.numbers = {value};
  return v;
}

}  // namespace

TEST_CASE("a block of a plugin in plain C takes samples, parameters and gives records") {
  const auto scale = made("plain", "plain.scale");
  CHECK(scale->name() == "b");
  CHECK(scale->type().roles == std::vector<std::string>{"filter", "example"});
  REQUIRE(scale->configure(defaults(scale->type())));
  const auto resolved = scale->resolve({real_stream(2)});
  REQUIRE(resolved);
  CHECK(resolved->outputs == std::vector<StreamFacts>{real_stream(2)});
  CHECK(resolved->input_flows == std::vector<Flow>{Flow{}});
  REQUIRE(scale->activate(activation()));
  const Call first(*scale, {{1, 2, 3}, {10, 20, 30}}, 2);
  CHECK(first.result == BF_OK);
  CHECK(first.output(0) == std::vector<double>{2, 4, 6});
  CHECK(first.output(1) == std::vector<double>{20, 40, 60});
  REQUIRE(first.records.size() == 1);
  double sum = 0;
  REQUIRE(first.records[0].size() == sizeof sum);
  std::memcpy(&sum, first.records[0].bytes(), sizeof sum);
  CHECK(sum == 66);
  REQUIRE(scale->change(0, number(-0.5)));
  CHECK(Call(*scale, {{1, 2}}, 1).output(0) == std::vector<double>{-0.5, -1});
  const Call negative(*scale, {{1, -2}}, 1);
  CHECK(negative.result == BF_FAILED);
  CHECK(scale->take_error() == "the input is negative");
  CHECK(scale->take_error() == "failed without a reason");
  CHECK(scale->reset());
  scale->deactivate();
}

TEST_CASE("parameters of every type arrive in a block, and its log, input and output files at the host") {
  std::vector<std::string> said;
  auto services = std::make_shared<HostServices>();
  services->log = [&](const std::string& block, int level, const std::string& text) {
    said.push_back(block + " " + std::to_string(level) + " " + text);
  };
  services->note_input = [&](const std::string& block, const std::string& path) { said.push_back(block + " reads " + path); };
  services->output_path = [&](const std::string& block, const std::string& name) -> tl::expected<std::string, std::string> {
    said.push_back(block + " writes " + name);
    return "/run/" + name;
  };
  const auto gain = made("good", "fixture.gain", services);
  auto values = defaults(gain->type());
  ParameterValue& file = values.at(static_cast<std::size_t>(gain->type().parameter("file")));
  file.given = true;
  file.rows = 1;
  file.strings = {"/data/a.csv"};
  const auto configured = gain->configure(values);
  INFO((configured ? "" : configured.error()));
  REQUIRE(configured);
  StreamFacts noisy = real_stream(1);
  noisy.length = 500;
  noisy.notes = {{"noise.std", {2.0}}, {"excitation.period", {0.5}}};
  const auto resolved = gain->resolve({noisy});
  REQUIRE(resolved);
  CHECK(resolved->outputs[0].notes ==
        std::map<std::string, std::vector<double>>{{"noise.std", {3.0}}, {"excitation.period", {0.5}}});
  const auto advice = gain->advise({noisy}, resolved->outputs);
  REQUIRE(advice);
  REQUIRE(advice->size() == 2);
  CHECK(advice->at(0).text == "500 samples");
  CHECK(advice->at(1).level == BF_LOG_WARNING);
  CHECK(advice->at(1).text == "noisy; give gain below 1");
  REQUIRE(gain->activate(activation()));
  CHECK(Call(*gain, {{2, 4}}, 1).output(0) == std::vector<double>{3, 6});
  bf_process last{};
  last.struct_size = sizeof last;
  CHECK(gain->c().finish(gain->c().self, &last) == BF_OK);
  CHECK(said ==
        std::vector<std::string>{"b 1 gain is 1.500000", "b reads /data/a.csv", "b writes gain.txt", "b 2 wrote /run/gain.txt"});
}

TEST_CASE("an exception in a block becomes the error of that call, in the block's words") {
  const auto failure = [](const std::string& where, auto&& call) {
    const auto thrower = made("good", "fixture.thrower");
    const auto configured = thrower->configure(thrower_values(where));
    if (where == "configure") return configured ? std::string("no error") : configured.error();
    REQUIRE(configured);
    return call(*thrower);
  };
  const auto error_of = [](const auto& result) { return result ? std::string("no error") : result.error(); };
  CHECK(failure("configure", [](Instance&) { return std::string(); }) == "the lines do not fit the period");
  CHECK(failure("resolve", [&](Instance& i) { return error_of(i.resolve({real_stream(1)})); }) == "the rates differ");
  CHECK(failure("activate", [&](Instance& i) { return error_of(i.activate(activation())); }) == "the file is gone");
  CHECK(failure("reset", [&](Instance& i) { return error_of(i.reset()); }) ==
        "an exception that is not derived from std::exception");
  const std::string at = failure("process", [&](Instance& i) {
    REQUIRE(i.resolve({real_stream(1)}));
    REQUIRE(i.activate(activation()));
    CHECK(Call(i, {{1.0}}, 1).result == BF_FAILED);
    return i.take_error();
  });
  CHECK(at.find("vector::_M_range_check") != std::string::npos);
}

TEST_CASE("a block that can't be made is refused in the plugin's words") {
  CHECK(refusal("refuses", "broken.block") == "there is no device");
  CHECK(refusal("refuses_silently", "broken.block") == "failed without a reason");
  CHECK(refusal("no_process", "broken.block") == "made a block without the function 'process'");
  CHECK(refusal("small_block", "broken.block") == "made a bf_block of 16 bytes, at least 96 expected");
  Registry registry(options({fixture("good")}));
  CHECK(Instance::make(registry, "fixture.gian", "b", nullptr).error() == "no plugin gives block 'fixture.gian'");
}

TEST_CASE("the number of values and inputs must be the described one") {
  const auto scale = made("plain", "plain.scale");
  CHECK(scale->configure({}).error() == "0 parameter values for 1 parameters");
  CHECK(scale->resolve({}).error() == "facts of 0 inputs for 1");
}

TEST_CASE("a block that gives no advice has nothing to say") {
  const auto scale = made("plain", "plain.scale");
  CHECK(scale->advise({real_stream(1)}, {real_stream(1)})->empty());
}
