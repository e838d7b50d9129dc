#include "broken.hpp"
#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

// clang-format off
const Broken kBroken[] = {
{"blocks is a list",
R"y(bodeflow: 1
blocks:
  - a
)y",
R"y(g.yaml:3:3: blocks: found a list, allowed: a map of names and blocks)y"},

{"block is text",
R"y(bodeflow: 1
blocks:
  a: generators.sine
)y",
R"y(g.yaml:3:6: block 'a': found 'generators.sine', allowed: a map such as {block: filters.gain, gain: 2})y"},

{"block name",
R"y(bodeflow: 1
blocks:
  a.b: {block: generators.sine}
)y",
R"y(g.yaml:3:3: block 'a.b' is not a name: letters, digits, _ and -)y"},

{"block id missing",
R"y(bodeflow: 1
blocks:
  a: {frequency: 2}
)y",
R"y(g.yaml:3:3: block 'a': key 'block' is missing: which block is it?)y"},

{"unknown block",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sin}
)y",
R"y(g.yaml:3:14: block 'a': unknown block 'generators.sin' (did you mean 'generators.sine'?))y"},

{"unknown block without family",
R"y(bodeflow: 1
blocks:
  a: {block: multisine}
)y",
R"y(g.yaml:3:14: block 'a': unknown block 'multisine' (did you mean 'generators.multisine'?))y"},

{"block of a refused plugin",
R"y(bodeflow: 1
blocks:
  a: {block: frisch.motor_noise}
)y",
R"y(g.yaml:3:14: block 'a': unknown block 'frisch.motor_noise'; plugin 'frisch' can't be used: needs ABI 1.0, this is 0.1)y"},

{"unknown parameter",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine, frequenzy: 3 Hz}
)y",
R"y(g.yaml:3:31: block 'a': unknown parameter 'frequenzy' (did you mean 'frequency'?))y"},

{"unknown parameter far",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine, zzz: 3 Hz}
)y",
R"y(g.yaml:3:31: block 'a': unknown parameter 'zzz'; parameters: frequency)y"},

{"unknown nested parameter",
R"y(bodeflow: 1
blocks:
  a: {block: generators.multisine, sample_rate: 1 kHz, period: 100, lines: {frist: 3}}
)y",
R"y(g.yaml:3:77: block 'a': unknown parameter 'lines.frist' (did you mean 'lines.first'?))y"},

{"required parameters",
R"y(bodeflow: 1
blocks:
  a: {block: generators.multisine, amplitude: 2 V}
)y",
R"y(g.yaml:3:3: block 'a': parameter 'sample_rate' is missing: a number [Hz]
g.yaml:3:3: block 'a': parameter 'period' is missing: a whole number)y"},

{"wrong dimension",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine, frequency: 3 V}
)y",
R"y(g.yaml:3:42: block 'a': parameter 'frequency': 3 V is a voltage; allowed: a frequency in Hz)y"},

{"unknown unit",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine, frequency: 3 kHzz}
)y",
R"y(g.yaml:3:42: block 'a': parameter 'frequency': '3 kHzz': unknown unit 'kHzz' (did you mean 'kHz'?))y"},

{"not a number",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine, frequency: fast}
)y",
R"y(g.yaml:3:42: block 'a': parameter 'frequency': 'fast' is not a number)y"},

{"octal",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine, frequency: 010}
)y",
R"y(g.yaml:3:42: block 'a': parameter 'frequency': found '010', which YAML reads as octal; write it without the leading zero)y"},

{"infinite",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine, frequency: .inf}
)y",
R"y(g.yaml:3:42: block 'a': parameter 'frequency': '.inf' is not allowed: a finite number is needed)y"},

{"nan",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine, frequency: .nan}
)y",
R"y(g.yaml:3:42: block 'a': parameter 'frequency': '.nan' is not a number)y"},

{"list for a number",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine, frequency: [1, 2]}
)y",
R"y(g.yaml:3:42: block 'a': parameter 'frequency': found a list, allowed: a number [Hz])y"},

{"no value",
R"y(bodeflow: 1
blocks:
  a:
    block: generators.sine
    frequency:
)y",
R"y(g.yaml:5:5: block 'a': parameter 'frequency': found nothing, allowed: a number [Hz])y"},

{"out of range",
R"y(bodeflow: 1
blocks:
  a: {block: plants.linear, delay: 20 s}
)y",
R"y(g.yaml:3:3: block 'a': input 'u' is not connected
g.yaml:3:36: block 'a': parameter 'delay': found '20 s', allowed: at least 0 and at most 10 s)y"},

{"exclusive range",
R"y(bodeflow: 1
blocks:
  a: {block: generators.multisine, sample_rate: 0 Hz, period: 100}
)y",
R"y(g.yaml:3:49: block 'a': parameter 'sample_rate': found '0 Hz', allowed: above 0 Hz)y"},

{"not whole",
R"y(bodeflow: 1
blocks:
  a: {block: filters.hold, factor: 2.5}
)y",
R"y(g.yaml:3:3: block 'a': input 'in' is not connected
g.yaml:3:36: block 'a': parameter 'factor': found '2.5', allowed: a whole number)y"},

{"too large for 64 bits",
R"y(bodeflow: 1
blocks:
  a: {block: filters.hold, factor: 99999999999999999999}
)y",
R"y(g.yaml:3:3: block 'a': input 'in' is not connected
g.yaml:3:36: block 'a': parameter 'factor': found '99999999999999999999', which does not fit into 64 bits)y"},

{"choice",
R"y(bodeflow: 1
blocks:
  a: {block: generators.multisine, sample_rate: 1 Hz, period: 9, phases: shroeder}
)y",
R"y(g.yaml:3:74: block 'a': parameter 'phases': found 'shroeder', allowed: schroeder, random (did you mean 'schroeder'?))y"},

{"boolean",
R"y(bodeflow: 1
blocks:
  a: {block: acquisition.file, file: x.csv, header: yes}
)y",
R"y(g.yaml:3:53: block 'a': parameter 'header': found 'yes', allowed: true, false)y"},

{"matrix flat",
R"y(bodeflow: 1
blocks:
  a: {block: plants.linear, A: [1, 2]}
)y",
R"y(g.yaml:3:3: block 'a': input 'u' is not connected
g.yaml:3:33: block 'a': parameter 'A': found '1', allowed: a row such as [1, 2] (a matrix is a list of rows))y"},

{"matrix ragged",
R"y(bodeflow: 1
blocks:
  a: {block: plants.linear, A: [[1, 2], [3]]}
)y",
R"y(g.yaml:3:3: block 'a': input 'u' is not connected
g.yaml:3:41: block 'a': parameter 'A': found a row of 1 numbers, allowed: 2 as in the first row)y"},

{"complex",
R"y(bodeflow: 1
blocks:
  a: {block: plants.linear, poles: [-1+2k]}
)y",
R"y(g.yaml:3:3: block 'a': input 'u' is not connected
g.yaml:3:37: block 'a': parameter 'poles': '-1+2k' is not a number)y"},

{"complex pair",
R"y(bodeflow: 1
blocks:
  a: {block: plants.linear, poles: [[1, 2, 3]]}
)y",
R"y(g.yaml:3:3: block 'a': input 'u' is not connected
g.yaml:3:37: block 'a': parameter 'poles': found a list, allowed: [real, imaginary])y"},

{"parameter by name and alias",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine}
  g: {block: filters.gain, gain: 2, factor: 3}
connections: [a -> g]
)y",
R"y(g.yaml:4:37: block 'g': parameter 'gain' is given twice (first in line 4))y"},

{"blocks without a value",
R"y(bodeflow: 1
blocks:
)y",
R"y(g.yaml:2:1: blocks: found nothing, allowed: a map of names and blocks)y"},

{"columns count characters, not bytes",
R"y(bodeflow: 1
blocks:
  a: {block: acquisition.file, note: "µΩ°", file: x, heeder: true}
)y",
R"y(g.yaml:3:54: block 'a': unknown parameter 'heeder' (did you mean 'header'?))y"},

{"five kinds of problems at once",
R"y(bodeflow: 1
title: [a]
blocks:
  sine: {block: generators.sine, frequency: 3 V}
  gain: {block: filters.gain, gian: 2}
  hold: {block: filters.hld}
connections:
  - sine -> gain.inn
  - sin -> hold
run: {seed: x}
)y",
R"y(g.yaml:2:8: title: found a list, allowed: a text
g.yaml:4:45: block 'sine': parameter 'frequency': 3 V is a voltage; allowed: a frequency in Hz
g.yaml:5:31: block 'gain': unknown parameter 'gian' (did you mean 'gain'?)
g.yaml:6:17: block 'hold': unknown block 'filters.hld' (did you mean 'filters.hold'?)
g.yaml:8:13: block 'gain' has no input 'inn' (did you mean 'in'?)
g.yaml:9:5: unknown block 'sin' (did you mean 'sine'?)
g.yaml:10:13: run: seed: found 'x', allowed: a whole number from 0 to 18446744073709551615)y"},

};
// clang-format on

}  // namespace

TEST_CASE("graph: wrong blocks and parameters are refused with their exact message") {
  for (const auto& broken : kBroken) {
    INFO(broken.kind);
    CHECK(problems(broken.text) == broken.expected);
  }
}

}  // namespace bodeflow::graph
