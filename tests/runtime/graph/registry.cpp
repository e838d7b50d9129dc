#include "registry.hpp"

#include <stdexcept>

namespace bodeflow::graph {
namespace {

PortDescription port(std::uint32_t kind, std::uint32_t direction, int index, std::string name, std::uint32_t element = BF_F64,
                     std::string record_type = "", bool optional = false) {
  PortDescription p;
  p.kind = kind;
  p.direction = direction;
  p.index = index;
  p.name = std::move(name);
  p.element = kind == BF_STREAM ? element : std::uint32_t{BF_ANY};
  p.record_type = std::move(record_type);
  p.optional = optional;
  return p;
}

PortDescription in(int index, std::string name, std::uint32_t element = BF_F64, bool optional = false) {
  return port(BF_STREAM, BF_IN, index, std::move(name), element, "", optional);
}
PortDescription out(int index, std::string name, std::uint32_t element = BF_F64) {
  return port(BF_STREAM, BF_OUT, index, std::move(name), element);
}
PortDescription message_in(int index, std::string name, std::string type, bool optional = false) {
  return port(BF_MESSAGE, BF_IN, index, std::move(name), BF_ANY, std::move(type), optional);
}
PortDescription message_out(int index, std::string name, std::string type) {
  return port(BF_MESSAGE, BF_OUT, index, std::move(name), BF_ANY, std::move(type));
}

ParameterDescription parameter(std::string name, std::uint32_t type, std::string unit = "") {
  ParameterDescription p;
  p.name = std::move(name);
  p.type = type;
  p.unit = std::move(unit);
  p.fallback.type = type;
  return p;
}

ParameterDescription required(ParameterDescription p) {
  p.required = true;
  return p;
}

ParameterDescription live(ParameterDescription p) {
  p.live = true;
  return p;
}

ParameterDescription number(std::string name, std::string unit, double value) {
  ParameterDescription p = parameter(std::move(name), BF_NUMBER, std::move(unit));
  p.fallback.rows = 1;
  p.fallback.numbers = {value};
  return p;
}

ParameterDescription whole(std::string name, std::int64_t value) {
  ParameterDescription p = parameter(std::move(name), BF_INTEGER);
  p.fallback.rows = 1;
  p.fallback.integer = value;
  return p;
}

ParameterDescription range(ParameterDescription p, double minimum, double maximum) {
  p.minimum = minimum;
  p.maximum = maximum;
  return p;
}

ParameterDescription above(ParameterDescription p, double minimum) {
  p.minimum = minimum;
  p.exclusive_minimum = true;
  return p;
}

ParameterDescription choice(std::string name, std::vector<std::string> choices) {
  ParameterDescription p = parameter(std::move(name), BF_CHOICE);
  p.fallback.rows = 1;
  p.fallback.strings = {choices.front()};
  p.choices = std::move(choices);
  return p;
}

ParameterDescription gain() {
  ParameterDescription p = live(range(number("gain", "1", 1.0), -1e6, 1e6));
  p.aliases = {"factor"};
  p.doc = "y[n] = gain * x[n]";
  return p;
}

BlockDescription block(std::string id, std::vector<PortDescription> ports, std::vector<ParameterDescription> parameters) {
  BlockDescription b;
  b.id = std::move(id);
  b.summary = "A block for tests.";
  b.ports = std::move(ports);
  b.parameters = std::move(parameters);
  return b;
}

std::vector<BlockDescription> generators() {
  return {block("generators.multisine", {out(0, "out")},
                {above(required(parameter("sample_rate", BF_NUMBER, "Hz")), 0.0),
                 required(range(parameter("period", BF_INTEGER), 2, 1e9)), whole("lines.first", 1),
                 range(whole("lines.last", 10), 1, 1e6), range(whole("lines.step", 1), 1, 1e6), number("amplitude", "V", 1.0),
                 choice("phases", {"schroeder", "random"})}),
          block("generators.phasor", {out(0, "out", BF_C64)}, {}),
          block("generators.sine", {out(0, "out")}, {number("frequency", "Hz", 1.0)})};
}

std::vector<BlockDescription> filters() {
  return {block("filters.gain", {in(0, "in", BF_ANY), out(0, "out", BF_ANY)},
                {gain(), number("offset", "", 0.0), parameter("unit", BF_STRING)}),
          block("filters.hold", {in(0, "in"), out(0, "out")}, {whole("factor", 1)}),
          block("filters.sum", {in(0, "a"), in(1, "b"), in(2, "c", BF_F64, true), out(0, "out")}, {}),
          block("filters.through", {in(0, "x"), out(0, "x")}, {})};
}

std::vector<BlockDescription> plants() {
  return {block("plants.linear", {in(0, "u"), out(0, "y")},
                {parameter("numerator", BF_NUMBERS), parameter("poles", BF_COMPLEX_LIST), parameter("A", BF_MATRIX),
                 range(number("delay", "s", 0.0), 0.0, 10.0)}),
          block("plants.motor", {in(0, "voltage"), in(1, "load", BF_F64, true), out(0, "current"), out(1, "angle")},
                {number("rs", "ohm", 6.6)})};
}

BlockDescription card() {
  BlockDescription b = block("acquisition.card", {out(0, "out")}, {});
  b.roles = {"source", "device"};
  return b;
}

BlockDescription log_book() {
  BlockDescription b = block("acquisition.log_book", {message_out(0, "entries", "trace")}, {});
  b.roles = {"device"};
  return b;
}

std::vector<BlockDescription> others() {
  ParameterDescription header = parameter("header", BF_BOOL);
  header.fallback.rows = 1;
  header.fallback.integer = 1;
  return {card(),
          log_book(),
          block("acquisition.file", {out(0, "out")},
                {required(parameter("file", BF_FILE)), header, parameter("columns", BF_STRINGS), parameter("rows", BF_INTEGERS),
                 parameter("note", BF_STRING)}),
          block("spectrum.dft", {in(0, "input"), in(1, "output"), message_out(0, "response", "frequency_response")},
                {required(range(parameter("period", BF_INTEGER), 1, 1e9)), whole("skip", 0)}),
          block("identify.fit",
                {message_in(0, "data", "frequency_response"), message_out(0, "model", "model"), message_out(1, "trace", "trace")},
                {}),
          block("control.tuner", {message_in(0, "model", "model", true), message_out(0, "changes", "parameter_change")}, {}),
          block("output.records", {message_in(0, "in", "")}, {})};
}

PluginDescription plugin(std::string name, std::vector<BlockDescription> blocks) {
  PluginDescription p;
  p.file = "/plugins/" + name + ".so";
  p.name = std::move(name);
  p.version = "1.2.3";
  p.blocks = std::move(blocks);
  return p;
}

}  // namespace

const Registry& test_registry() {
  static const Registry registry = [] {
    std::vector<PluginDescription> plugins = {plugin("generators", generators()), plugin("filters", filters()),
                                              plugin("plants", plants()), plugin("others", others()), plugin("frisch", {})};
    plugins.back().refused = "needs ABI 1.0, this is 0.1";
    return Registry::with(std::move(plugins));
  }();
  return registry;
}

tl::expected<Graph, std::string> load_test(const std::string& text, const LoadOptions& options) {
  auto graph = load_text(text, "g.yaml", options, test_registry());
  if (!graph) return tl::unexpected(to_string(graph.error()));
  return std::move(*graph);
}

Graph good(const std::string& text, const LoadOptions& options) {
  auto graph = load_test(text, options);
  if (!graph) throw std::runtime_error(graph.error());
  return std::move(*graph);
}

std::string problems(const std::string& text, const LoadOptions& options) {
  const auto graph = load_test(text, options);
  return graph ? "no problems" : graph.error();
}

}  // namespace bodeflow::graph
