#include "broken.hpp"
#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

// clang-format off
const Broken kBroken[] = {
{"connections is a map",
R"y(bodeflow: 1
blocks: {a: {block: generators.sine}}
connections: {a: b}
)y",
R"y(g.yaml:3:14: connections: found a map, allowed: a list such as [a -> b])y"},

{"connection without arrow",
R"y(bodeflow: 1
blocks: {a: {block: generators.sine}}
connections: [a b]
)y",
R"y(g.yaml:3:15: connections: found 'a b', allowed: 'a -> b')y"},

{"connection end missing",
R"y(bodeflow: 1
blocks: {a: {block: generators.sine}}
connections:
  - a ->
)y",
R"y(g.yaml:4:9: an end is missing in 'a ->', allowed: 'a -> b')y"},

{"unknown block in connection",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  gain: {block: filters.gain}
connections:
  - sine -> gian
)y",
R"y(g.yaml:6:13: unknown block 'gian' (did you mean 'gain'?))y"},

{"unknown port",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  motor: {block: plants.motor}
connections:
  - sine.out -> motor.volage
)y",
R"y(g.yaml:6:17: block 'motor' has no input 'volage' (did you mean 'voltage'?))y"},

{"unknown output",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  gain: {block: filters.gain}
connections:
  - sine.y -> gain
)y",
R"y(g.yaml:6:5: block 'sine' has no output 'y'; outputs: out)y"},

{"wrong direction",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  gain: {block: filters.gain}
connections:
  - gain.in -> sine.out
)y",
R"y(g.yaml:4:3: block 'gain': input 'in' is not connected
g.yaml:6:5: 'gain.in' is an input, allowed: an output
g.yaml:6:16: 'sine.out' is an output, allowed: an input)y"},

{"no inputs",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  gain: {block: filters.gain}
connections:
  - sine -> gain -> sine
)y",
R"y(g.yaml:6:21: block 'sine' (generators.sine) has no inputs)y"},

{"ambiguous output",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  motor: {block: plants.motor}
  gain: {block: filters.gain}
connections:
  - sine -> motor.voltage
  - motor -> gain
)y",
R"y(g.yaml:8:5: block 'motor' has several outputs: current, angle; write 'motor.current' or another)y"},

{"ambiguous input",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  sum: {block: filters.sum}
connections:
  - sine -> sum
)y",
R"y(g.yaml:6:13: block 'sum' has several inputs: a, b, c; write 'sum.a' or another)y"},

{"stream to message",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  log: {block: output.records}
connections:
  - sine -> log
)y",
R"y(g.yaml:6:5: 'sine.out' is a stream, 'log.in' takes records)y"},

{"message to stream",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  dft: {block: spectrum.dft, period: 8}
  gain: {block: filters.gain}
connections:
  - sine -> dft.input
  - sine -> dft.output
  - dft -> gain
)y",
R"y(g.yaml:9:5: 'dft.response' sends records, 'gain.in' takes a stream)y"},

{"record type",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  dft: {block: spectrum.dft, period: 8}
  tuner: {block: control.tuner}
connections:
  - sine -> dft.input
  - sine -> dft.output
  - dft -> tuner
)y",
R"y(g.yaml:9:5: 'dft.response' sends records of type 'frequency_response', 'tuner.model' takes 'model')y"},

{"element type",
R"y(bodeflow: 1
blocks:
  phasor: {block: generators.phasor}
  hold: {block: filters.hold}
connections:
  - phasor -> hold
)y",
R"y(g.yaml:6:5: 'phasor.out' gives c64, 'hold.in' takes f64)y"},

{"input twice",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine}
  b: {block: generators.sine}
  gain: {block: filters.gain}
connections:
  - a -> gain
  - b -> gain
)y",
R"y(g.yaml:8:10: input 'gain.in' is connected twice (first at g.yaml:7:5))y"},

{"message edge twice",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  dft: {block: spectrum.dft, period: 8}
  log: {block: output.records}
connections:
  - sine -> dft.input
  - sine -> dft.output
  - dft -> log
  - dft.response -> log.in
)y",
R"y(g.yaml:10:21: this connection is there twice (first at g.yaml:9:5))y"},

{"unconnected",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  sum: {block: filters.sum}
  fit: {block: identify.fit}
connections:
  - sine -> sum.a
)y",
R"y(g.yaml:4:3: block 'sum': input 'b' is not connected
g.yaml:5:3: block 'fit': message input 'data' is not connected)y"},

{"latency on a stream",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  gain: {block: filters.gain}
connections:
  - {from: sine, to: gain, latency: 2 ms}
)y",
R"y(g.yaml:6:37: connection: latency: only connections of records have one; use a delay block)y"},

{"latency negative",
R"y(bodeflow: 1
blocks:
  tuner: {block: control.tuner}
  log: {block: output.records}
connections:
  - {from: tuner, to: log, latency: -2 ms}
)y",
R"y(g.yaml:6:37: connection: latency: found '-2 ms', allowed: 0 s or more, or whole samples)y"},

{"latency half a sample",
R"y(bodeflow: 1
blocks:
  tuner: {block: control.tuner}
  log: {block: output.records}
connections:
  - {from: tuner, to: log, latency: 1.5 samples}
)y",
R"y(g.yaml:6:37: connection: latency: found '1.5', allowed: a whole number)y"},

{"connection map keys",
R"y(bodeflow: 1
blocks:
  tuner: {block: control.tuner}
  log: {block: output.records}
connections:
  - {form: tuner, to: log}
)y",
R"y(g.yaml:6:5: connection: key 'from' is missing
g.yaml:6:6: connection: unknown key 'form' (did you mean 'from'?))y"},

{"parameters of a block without live ones",
R"y(bodeflow: 1
blocks:
  tuner: {block: control.tuner}
  sine: {block: generators.sine}
connections:
  - tuner -> sine.parameters
)y",
R"y(g.yaml:6:14: block 'sine' (generators.sine) has no live parameters, nothing can change them)y"},

{"stream to parameters",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  gain: {block: filters.gain}
connections:
  - sine -> gain -> gain.parameters
)y",
R"y(g.yaml:6:13: 'gain.out' gives a stream, 'gain.parameters' takes records)y"},

{"port in both directions in a chain",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine}
  b: {block: filters.through}
  c: {block: filters.gain}
connections:
  - a -> b.x -> c
)y",
R"y(g.yaml:7:10: 'b.x' is an input and an output: write two connections)y"},

{"reference without phases",
R"y(bodeflow: 1
blocks:
  log: {block: output.records}
connections:
  - $identify.fit.model -> log
)y",
R"y(g.yaml:5:5: 'identify' is no earlier phase; earlier phases: none)y"},

{"a bare dollar in a connection",
R"y(bodeflow: 1
blocks: {tuner: {block: control.tuner}}
connections: [$.model -> tuner]
)y",
R"y(g.yaml:3:15: found '$.model', allowed: block, block.port or $phase.block.port)y"},

};
// clang-format on

}  // namespace

TEST_CASE("graph: wrong connections are refused with their exact message") {
  for (const auto& broken : kBroken) {
    INFO(broken.kind);
    CHECK(problems(broken.text) == broken.expected);
  }
}

}  // namespace bodeflow::graph
