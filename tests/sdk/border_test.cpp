#include <bodeflow/block.hpp>
#include <functional>

#include "catch.hpp"
#include "probe_host.hpp"

using namespace bodeflow;

namespace {

/// What the block below does when it is called: set by the tests.
std::function<void(const std::string&, Io*)> behaviour;
std::string calls;

class Probe final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr In<Any> side{1, "side"};
  static constexpr Out<double> out{0, "out"};
  static constexpr MessageIn message{0, "message"};
  static constexpr MessageOut report{0, "report"};

  static void describe(Describe& d) {
    d.id("example.probe").summary("Does what a test tells it.");
    d.stream_in(in);
    d.stream_in(side).optional();
    d.stream_out(out).same_as(in);
    d.message_in(message);
    d.message_out(report);
    d.parameter("gain", 1.5).live();
    d.parameter("names", std::vector<std::string>{"a"});
    d.optional<Matrix>("matrix");
    d.parameter("count", 3);
  }
  void configure(const Parameters& p) override {
    parameters = p;
    does("configure");
  }
  void resolve(Facts& f) override {
    facts = &f;
    does("resolve");
  }
  void activate(const Activation& a) override {
    activation = a;
    does("activate");
  }
  void process(Io& io) override { does("process", &io); }
  void receive(int port, const RecordView& record, Io& io) override {
    does("receive " + std::to_string(port) + " " + std::string(record.type()), &io);
  }
  void change(const Parameters& p) override { does("change " + std::to_string(p.number("gain"))); }
  void finish(Io& io) override { does("finish", &io); }
  void reset() override { does("reset"); }
  void deactivate() override { does("deactivate"); }

  using Block::log_warning;
  using Block::note_input;
  using Block::output_path;

  void does(const std::string& what, Io* io = nullptr) {
    calls += what + "\n";
    current = this;
    if (behaviour) behaviour(what, io);
  }

  std::optional<Parameters> parameters;
  Facts* facts = nullptr;
  Activation activation;
  static Probe* current;
};
Probe* Probe::current = nullptr;

struct Made {
  Made() {
    calls.clear();
    behaviour = {};
    std::uint32_t count = 0;
    const bf_factory* const* factories = plugin_factories<Probe>(&host.host, &count);
    REQUIRE(factories != nullptr);
    REQUIRE(count == 1);
    REQUIRE(factories[0]->create(factories[0], &host.host, &block) == BF_OK);
    for (const Default& v : defaults) values.push_back(v.value);
  }
  ~Made() { block.destroy(block.self); }
  Made(const Made&) = delete;
  Made& operator=(const Made&) = delete;

  std::int32_t configure() { return block.configure(block.self, values.data(), static_cast<std::uint32_t>(values.size())); }

  struct Default {
    bf_parameter_value value;
  };
  double gain = 1.5;
  const char* names[2] = {"x", "y"};
  std::vector<Default> defaults = {
      {{sizeof(bf_parameter_value), BF_NUMBER, 0, 1, 1, 0, &gain, nullptr, nullptr}},
      {{sizeof(bf_parameter_value), BF_STRINGS, 1, 2, 1, 0, nullptr, nullptr, names}},
      {{sizeof(bf_parameter_value), BF_MATRIX, 0, 0, 0, 0, nullptr, nullptr, nullptr}},
      {{sizeof(bf_parameter_value), BF_INTEGER, 1, 1, 1, 9, nullptr, nullptr, nullptr}},
  };
  ProbeHost host;
  bf_block block{};
  std::vector<bf_parameter_value> values;
};

/// A call of one firing with one channel each, and what was sent during it.
struct Call {
  Call() {
    in[0] = {&in_place, 0, 1, 1, BF_F64};
    in[1] = {nullptr, 0, 0, 0, BF_F64};
    out[0] = {&out_place, 0, 1, 1, BF_F64};
    p.struct_size = sizeof p;
    p.inputs = in;
    p.outputs = out;
    p.count = p.done = 1;
    p.position = 5;
    p.context = this;
    p.emit = [](bf_process* process, std::uint32_t port, bf_record* record, std::uint64_t offset) {
      auto& call = *static_cast<Call*>(process->context);
      call.sent += std::to_string(port) + "@" + std::to_string(offset) + " " + std::string(RecordView(*record).type()) + "\n";
      ProbeHost::drop(record);
    };
  }
  double x = 2.0, y = 0.0;
  void *in_place = &x, *out_place = &y;
  bf_stream in[2]{}, out[1]{};
  bf_process p{};
  std::string sent;
};

}  // namespace

TEST_CASE("every function of the border turns exceptions of any type into an error with its text") {
  struct Row {
    std::function<void()> thrown;
    const char* text;
  };
  const Row rows[] = {
      {[] { fail("the reason"); }, "the reason"},
      {[] { throw std::out_of_range("a standard exception"); }, "a standard exception"},
      {[] { throw 42; }, "an exception that is not derived from std::exception"},
      {[] { throw std::bad_alloc(); }, "std::bad_alloc"},
  };
  for (const Row& row : rows) {
    Made made;
    REQUIRE(made.configure() == BF_OK);
    behaviour = [&](const std::string&, Io*) { row.thrown(); };
    const bf_block& b = made.block;
    const auto expect_failure = [&](std::int32_t result) {
      CHECK(result == BF_FAILED);
      CHECK(made.host.error == row.text);
      made.host.error.clear();
    };
    bf_activation activation{};
    Call call;
    bf_stream_facts in[2]{}, out[1]{};
    bf_flow in_flow[2]{}, out_flow[1]{};
    bf_resolution resolution{sizeof(bf_resolution), 2, 1, in, out, in_flow, out_flow};
    expect_failure(made.configure());
    expect_failure(b.resolve(b.self, &resolution));
    expect_failure(b.activate(b.self, &activation));
    expect_failure(b.process(b.self, &call.p));
    expect_failure(b.change(b.self, 0, made.values.data()));
    expect_failure(b.finish(b.self, &call.p));
    expect_failure(b.reset(b.self));
    b.deactivate(b.self);
    CHECK(made.host.error == row.text);
    behaviour = {};
  }
}

TEST_CASE("a block that throws while it is made is not made") {
  class Throws final : public Block {
   public:
    Throws() { throw 1; }
    static void describe(Describe& d) { d.id("example.throws").summary("s"); }
  };
  ProbeHost host;
  std::uint32_t count = 0;
  const bf_factory* const* factories = plugin_factories<Throws>(&host.host, &count);
  REQUIRE(factories != nullptr);
  bf_block block{};
  CHECK(factories[0]->create(factories[0], &host.host, &block) == BF_FAILED);
  CHECK(host.error == "an exception that is not derived from std::exception");
  CHECK(block.self == nullptr);
}

TEST_CASE("a plugin with a wrong description has no factories and says why, at every call") {
  class Wrong final : public Block {
   public:
    static void describe(Describe& d) { d.id("wrong").summary("s"); }
  };
  class Twin final : public Block {
   public:
    static void describe(Describe& d) { d.id("example.twin").summary("s"); }
  };
  class OtherTwin final : public Block {
   public:
    static void describe(Describe& d) { d.id("example.twin").summary("s"); }
  };
  for (int i = 0; i < 2; ++i) {
    ProbeHost host;
    std::uint32_t count = 7;
    CHECK((plugin_factories<Probe, Wrong, Twin, OtherTwin>(&host.host, &count)) == nullptr);
    CHECK(count == 0);
    CHECK(host.error ==
          "block 'wrong': id has not the form family.name (lower-case letters, digits, _)\nid 'example.twin' stands twice");
  }
}

TEST_CASE("a block reads its parameters by name and type") {
  Made made;
  std::vector<std::string> refusals;
  behaviour = [&](const std::string&, Io*) {
    const Parameters& p = *Probe::current->parameters;
    CHECK(p.number("gain") == 1.5);
    CHECK_FALSE(p.given("gain"));
    CHECK(p.has("gain"));
    CHECK(p.texts("names") == std::vector<std::string>{"x", "y"});
    CHECK(p.given("names"));
    CHECK_FALSE(p.has("matrix"));
    CHECK(p.integer("count") == 9);
    CHECK_THROWS_WITH(p.number("volume"), "the block reads a parameter 'volume' that it does not describe");
    CHECK_THROWS_WITH(p.number("count"), "the block reads parameter 'count' as another type than it describes");
  };
  CHECK(made.configure() == BF_OK);
  behaviour = {};
  made.values[3].type = BF_NUMBER;
  CHECK(made.configure() == BF_FAILED);
  CHECK(made.host.error == "the host gives parameter 'count' as another type than described");
  made.values.pop_back();
  CHECK(made.configure() == BF_FAILED);
  CHECK(made.host.error == "the host gives 3 parameters; described: 4");
}

TEST_CASE("a change hands over all current values, and reset takes them back") {
  Made made;
  REQUIRE(made.configure() == BF_OK);
  const double gain = 4.0;
  bf_parameter_value value = made.values[0];
  value.numbers = &gain;
  calls.clear();
  CHECK(made.block.change(made.block.self, 0, &value) == BF_OK);
  CHECK(made.block.reset(made.block.self) == BF_OK);
  CHECK(made.block.reset(made.block.self) == BF_OK);
  CHECK(calls == "change 4.000000\nchange 1.500000\nreset\nreset\n");
  CHECK(made.block.change(made.block.self, 99, &value) == BF_FAILED);
}

TEST_CASE("records reach a block before the samples, and what it sends then stands at the first of them") {
  Made made;
  REQUIRE(made.configure() == BF_OK);
  const RecordBuilder builder("note");
  bf_record* record = made.host.host.record_create(&made.host.host, builder.size());
  builder.write(record->bytes);
  const bf_message message{0, 0, 0.25, record};
  Call call;
  call.p.messages = &message;
  call.p.message_count = 1;
  behaviour = [&](const std::string& what, Io* io) {
    if (what == "receive 0 note") CHECK(io->record_time() == 0.25);
    io->emit(Probe::report, RecordBuilder(what.substr(0, 7)));
    if (what == "process") io->emit(Probe::report, RecordBuilder("at_zero"), 0);
  };
  calls.clear();
  CHECK(made.block.process(made.block.self, &call.p) == BF_OK);
  CHECK(calls == "receive 0 note\nprocess\n");
  CHECK(call.sent == "0@0 receive\n0@1 process\n0@0 at_zero\n");
  calls.clear();
  call.p.count = 0;
  CHECK(made.block.process(made.block.self, &call.p) == BF_OK);
  CHECK(calls == "receive 0 note\n");
  ProbeHost::drop(record);
}

TEST_CASE("Io gives samples, counts and facts of a call") {
  Made made;
  REQUIRE(made.configure() == BF_OK);
  behaviour = [&](const std::string&, Io* io) {
    CHECK(io->count() == 1);
    CHECK(io->position() == 5);
    CHECK(io->connected(Probe::in));
    CHECK_FALSE(io->connected(Probe::side));
    CHECK(io->channels(Probe::in) == 1);
    CHECK(io->element(Probe::in) == BF_F64);
    io->write(Probe::out, 0)[0] = 3.0 * io->read(Probe::in, 0)[0];
    io->end_after(0);
    CHECK_THROWS_WITH(io->end_after(2), "the stream ends after 2 of 1 firings");
    CHECK_THROWS_WITH(io->emit(Probe::report, RecordBuilder("x"), 2), "record on 'report' is placed beyond the end of the call");
  };
  Call call;
  CHECK(made.block.process(made.block.self, &call.p) == BF_OK);
  CHECK(call.y == 6.0);
  CHECK(call.p.done == 0);
}

TEST_CASE("a record for which there is no memory ends the call with that reason") {
  Made made;
  REQUIRE(made.configure() == BF_OK);
  made.host.out_of_memory = true;
  behaviour = [&](const std::string&, Io* io) { io->emit(Probe::report, RecordBuilder("x")); };
  Call call;
  CHECK(made.block.process(made.block.self, &call.p) == BF_FAILED);
  CHECK(made.host.error == "no memory for a record of 128 bytes");
}

TEST_CASE("facts follow same_as, keep the port's type, and outlive the call") {
  Made made;
  REQUIRE(made.configure() == BF_OK);
  bf_stream_facts in[2]{}, out[1]{};
  bf_flow in_flow[2]{{sizeof(bf_flow), 1, 0, nullptr}, {sizeof(bf_flow), 1, 0, nullptr}},
      out_flow[1]{{sizeof(bf_flow), 1, 0, nullptr}};
  const char* names[2] = {"left", "right"};
  in[0] = {sizeof(bf_stream_facts), 1, BF_F64, 2, {1000, 1}, -1, "V", "", names, nullptr, nullptr, 0};
  in[1] = {sizeof(bf_stream_facts), 0, 0, 0, {0, 0}, -1, nullptr, nullptr, nullptr, nullptr, nullptr, 0};
  bf_resolution r{sizeof(bf_resolution), 2, 1, in, out, in_flow, out_flow};
  behaviour = [](const std::string&, Io*) {
    Facts& f = *Probe::current->facts;
    f.out(Probe::out).unit = "A";
    f.out(Probe::out).element = BF_C64;
    f.samples(Probe::in, 4);
    f.delay(Probe::in, 1, {0.5, -0.5});
  };
  REQUIRE(made.block.resolve(made.block.self, &r) == BF_OK);
  CHECK(out[0].known == 1);
  CHECK(out[0].element == BF_F64);
  CHECK(out[0].channels == 2);
  CHECK(out[0].rate.num == 1000);
  CHECK(std::string(out[0].unit) == "A");
  CHECK(std::string(out[0].channel_names[1]) == "right");
  CHECK(in_flow[0].samples == 4);
  CHECK(in_flow[0].delay == 1);
  CHECK(in_flow[0].initial[1] == -0.5);

  behaviour = [](const std::string&, Io*) { Probe::current->facts->delay(Probe::in, 3, {1.0}); };
  CHECK(made.block.resolve(made.block.self, &r) == BF_FAILED);
  CHECK(made.host.error == "input 'in' has 1 initial values; needed: 6 (delay x channels)");
  behaviour = [](const std::string&, Io*) { Probe::current->facts->samples(Probe::in, 0); };
  CHECK(made.block.resolve(made.block.self, &r) == BF_FAILED);
  CHECK(made.host.error == "a firing with 0 samples on port 'in'; allowed: 1 to 2147483647");
}

TEST_CASE("services of the host reach a block, and its refusals keep the host's words") {
  Made made;
  std::optional<std::string> path, in_check;
  behaviour = [&](const std::string&, Io*) {
    Probe::current->log_warning("careful");
    Probe::current->note_input("data.csv");
    path = Probe::current->output_path("file");
    in_check = Probe::current->output_path("check");
  };
  CHECK(made.configure() == BF_OK);
  CHECK(made.host.log == std::to_string(BF_LOG_WARNING) + " careful\n");
  CHECK(path == "/run/file");
  CHECK_FALSE(in_check);
  behaviour = [](const std::string&, Io*) { Probe::current->output_path("/etc/passwd"); };
  CHECK(made.configure() == BF_FAILED);
  CHECK(made.host.error == "an absolute path");
  behaviour = [](const std::string&, Io*) { Probe::current->note_input(""); };
  CHECK(made.configure() == BF_FAILED);
  CHECK(made.host.error == "an empty path");
}

TEST_CASE("an Expected holds a value or the reason why not") {
  const Expected<int, Error> good = 3, bad = unexpected("no number");
  CHECK(good);
  CHECK(*good == 3);
  CHECK_FALSE(bad);
  CHECK(bad.error().text == "no number");
  CHECK(bad.value_or(7) == 7);
  CHECK_THROWS_WITH(*bad, "no number");
  Expected<std::unique_ptr<int>, Error> owner = std::make_unique<int>(5);
  CHECK(*std::move(owner).value() == 5);
  const Expected<void, Error> done, failed = unexpected("why");
  CHECK(done);
  CHECK(failed.error() == Error{"why"});
}
