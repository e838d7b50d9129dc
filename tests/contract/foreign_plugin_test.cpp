#include <bodeflow/record.hpp>
#include <cstring>
#include <iostream>

#include "catch.hpp"
#include "plugins/instance.hpp"
#include "plugins/registry.hpp"

using bodeflow::Instance;
using bodeflow::Registry;
using bodeflow::SharedRecord;

namespace {

struct Echo {
  std::vector<std::string> said;
  std::unique_ptr<Instance> block;
  std::string build;
};

/// The block of the foreign plugin, configured and active; nothing where there is no clang with libc++.
std::unique_ptr<Echo> echo() {
  const std::filesystem::path file = BODEFLOW_FOREIGN_PLUGIN;
  if (file.empty()) {
    std::cout << "skipped: clang++-14 with libc++ is not installed\n";
    return nullptr;
  }
  auto made = std::make_unique<Echo>();
  Registry::Options options;
  options.path = {file};
  options.probe_command = BODEFLOW_PROBE_HELPER;
  Registry registry(options);
  REQUIRE(registry.plugins().size() == 1);
  REQUIRE(registry.plugins()[0].refused.empty());
  made->build = registry.plugins()[0].build;
  auto services = std::make_shared<bodeflow::HostServices>();
  services->log = [said = &made->said](const std::string&, int, const std::string& text) { said->push_back(text); };
  made->block = std::move(Instance::make(registry, "foreign.echo", "echo", services).value());
  std::vector<bodeflow::ParameterValue> values;
  for (const auto& parameter : made->block->type().parameters) values.push_back(parameter.fallback);
  REQUIRE(made->block->configure(values));
  bodeflow::StreamFacts facts;
  facts.known = true;
  facts.channels = 1;
  facts.rate = bodeflow::Rate(48000, 1);
  facts.unit = "V";
  const auto resolved = made->block->resolve({facts});
  REQUIRE(resolved);
  CHECK(resolved->outputs.at(0) == facts);
  bf_activation activation{};
  activation.max_count = 16;
  activation.rate = {48000, 1};
  REQUIRE(made->block->activate(activation));
  return made;
}

/// One process call on one channel, with one record before it if given.
struct Call {
  Call(const Instance& block, std::vector<double> input, const SharedRecord& record = {}) : x(std::move(input)), y(x.size()) {
    void* in_place = x.data();
    void* out_place = y.data();
    const bf_stream in{&in_place, 0, x.size(), 1, BF_F64}, out{&out_place, 0, y.size(), 1, BF_F64};
    const bf_message message{0, 0, 0.0, record.c()};
    bf_process process{sizeof process, record ? 1U : 0U, &message, &in, &out, 0, x.size(), x.size(), this, &Call::emit};
    result = block.c().process(block.c().self, &process);
  }
  static void emit(bf_process* process, std::uint32_t, bf_record* record, std::uint64_t) {
    static_cast<Call*>(process->context)->records.push_back(SharedRecord::adopt(record));
  }
  std::vector<double> x, y;
  std::vector<SharedRecord> records;
  std::int32_t result = BF_FAILED;
};

}  // namespace

TEST_CASE("a plugin built with clang and libc++ loads, and samples pass both ways") {
  const auto foreign = echo();
  if (!foreign) return;
  CHECK(foreign->build.find("clang 14") != std::string::npos);
  CHECK(foreign->build.find("libc++") != std::string::npos);
  CHECK(foreign->said == std::vector<std::string>{"built with " + foreign->build});
  const Call call(*foreign->block, {1, 2, 3});
  CHECK(call.result == BF_OK);
  CHECK(call.y == std::vector<double>{2, 4, 6});
}

TEST_CASE("records pass both ways between libstdc++ and libc++") {
  const auto foreign = echo();
  if (!foreign) return;
  bodeflow::RecordBuilder question("question");
  question.set("text", "how many?");
  auto values = question.array<double>("values", "A", {3});
  for (std::size_t i = 0; i < 3; ++i) values[i] = static_cast<double>(i) + 0.5;
  const auto bytes = question.bytes();
  const Call call(*foreign->block, {1}, SharedRecord::copy(bytes.data(), bytes.size()));
  REQUIRE(call.result == BF_OK);
  REQUIRE(call.records.size() == 1);
  const bodeflow::RecordView answer(*call.records[0].c());
  CHECK(answer.type() == "answer");
  CHECK(answer.text("to") == "how many?");
  CHECK(answer.integer("words") == 2);
  const auto array = answer.array("values");
  REQUIRE(array);
  CHECK(array->unit == "V");
  const auto numbers = array->as<double>();
  CHECK(std::vector<double>(numbers.begin(), numbers.end()) == std::vector<double>{1, 3, 5});
}

TEST_CASE("an exception inside a libc++ plugin is caught there, and its words arrive") {
  const auto foreign = echo();
  if (!foreign) return;
  for (int i = 0; i < 100; ++i) {  // many times: a mix of the two libraries' exceptions would corrupt memory
    CHECK(Call(*foreign->block, {1, 13}).result == BF_FAILED);
    CHECK(foreign->block->take_error() == "thirteen brings bad luck (13)");
  }
  CHECK(Call(*foreign->block, {14}).result == BF_FAILED);
  CHECK(foreign->block->take_error() == "fourteen is not allowed");
  CHECK(Call(*foreign->block, {7}).y == std::vector<double>{14});
}
