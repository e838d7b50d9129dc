#include "broken.hpp"
#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

// clang-format off
const Broken kBroken[] = {
{"requires missing",
R"y(bodeflow: 1
requires: {filter: ">=1"}
blocks: {}
)y",
R"y(g.yaml:2:12: requires: plugin 'filter' is not installed (did you mean 'filters'?))y"},

{"requires newer",
R"y(bodeflow: 1
requires: {filters: ">=1.10"}
blocks: {}
)y",
R"y(g.yaml:2:21: requires: plugin 'filters': found version 1.2.3, the graph needs >=1.10)y"},

{"requires unreadable",
R"y(bodeflow: 1
requires: {filters: newest}
blocks: {}
)y",
R"y(g.yaml:2:21: requires: plugin 'filters': found 'newest', allowed: comparisons such as '>=1.2' or '>=1.2, <2')y"},

{"requires refused",
R"y(bodeflow: 1
requires: {frisch: ">=1"}
blocks: {}
)y",
R"y(g.yaml:2:12: requires: plugin 'frisch' can't be used: needs ABI 1.0, this is 0.1)y"},

{"schedule",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  gain: {block: filters.gain}
connections: [sine -> gain]
schedule:
  - {at: 1 V, block: gain, set: {gain: 2}}
  - {at: -1 s, block: gain, set: {gain: 2}}
  - {at: 1 s, block: gian, set: {gain: 2}}
  - {at: 1 s, block: gain, set: {offset: 2}}
  - {at: 1 s, block: gain, set: {gain: 1e7}}
  - {at: 1 s, block: gain, set: {gian: 1}}
  - {block: gain, sets: {gain: 1}}
  - at 2 s
)y",
R"y(g.yaml:7:10: schedule: at: 1 V is a voltage; allowed: a time in s
g.yaml:8:10: schedule: at: found '-1 s', allowed: 0 s or later
g.yaml:9:22: unknown block 'gian' (did you mean 'gain'?)
g.yaml:10:42: schedule: block 'gain': parameter 'offset' can't change while the graph runs; live parameters: gain
g.yaml:11:40: schedule: block 'gain': parameter 'gain': found '1e7', allowed: at least -1000000 and at most 1000000
g.yaml:12:34: schedule: block 'gain': unknown parameter 'gian' (did you mean 'gain'?)
g.yaml:13:5: schedule: key 'at' is missing
g.yaml:13:5: schedule: key 'set' is missing
g.yaml:13:19: schedule: unknown key 'sets' (did you mean 'set'?)
g.yaml:14:5: schedule: found 'at 2 s', allowed: a map such as {at: 0.5 s, block: gain, set: {gain: 2}})y"},

{"record",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
  gain: {block: filters.gain}
  log: {block: output.records}
  tuner: {block: control.tuner}
connections: [sine -> gain, tuner -> log]
record:
  - sinus
  - gain.outt
  - gain.in
  - log
  - [gain]
)y",
R"y(g.yaml:9:5: unknown block 'sinus'; blocks: sine, gain, log, tuner
g.yaml:10:5: block 'gain' has no output 'outt' (did you mean 'out'?)
g.yaml:11:5: 'gain.in' is an input, allowed: an output
g.yaml:12:5: record: block 'log' (output.records) has no outputs
g.yaml:13:5: record: found a list, allowed: a text)y"},

{"record text",
R"y(bodeflow: 1
blocks:
  sine: {block: generators.sine}
record: everything
)y",
R"y(g.yaml:4:9: record: found 'everything', allowed: all, or a list of blocks and block.port)y"},

{"run settings",
R"y(bodeflow: 1
run: {clock: real, duration: 0 s, seed: -1, chunk: 0, latency: 3 m, threads: 1000, watchdog: off, speed: 3}
blocks:
  sine: {block: generators.sine}
)y",
R"y(g.yaml:2:14: run: clock: found 'real', allowed: simulated, realtime, hardware
g.yaml:2:30: run: duration: found '0 s', allowed: a time above 0 s
g.yaml:2:41: run: seed: found '-1', allowed: a whole number from 0 to 18446744073709551615
g.yaml:2:52: run: chunk: found 0, allowed: 1 to 1048576
g.yaml:2:64: run: latency: 3 m is a length; allowed: a time in s
g.yaml:2:78: run: threads: found 1000, allowed: 1 to 256
g.yaml:2:94: run: watchdog: 'off' is not a number
g.yaml:2:99: run: unknown key 'speed' (did you mean 'seed'?))y"},

{"run settings of real time",
R"y(bodeflow: 1
run: {clock: realtime, on_overrun: panic, priority: 100, cores: [0, -1, many]}
blocks:
  sine: {block: generators.sine}
)y",
R"y(g.yaml:2:36: run: on_overrun: found 'panic', allowed: count, skip, stop
g.yaml:2:53: run: priority: found 100, allowed: 1 to 99
g.yaml:2:69: run: cores: found -1, allowed: 0 to 1023
g.yaml:2:73: run: cores: found 'many', allowed: a whole number)y"},

{"cores that are no list",
R"y(bodeflow: 1
run: {cores: 2}
blocks:
  sine: {block: generators.sine}
)y",
R"y(g.yaml:2:14: run: cores: found '2', allowed: a list of cores such as [2, 3])y"},

{"a hardware clock without hardware",
R"y(bodeflow: 1
run: {clock: hardware}
blocks:
  sine: {block: generators.sine}
  book: {block: acquisition.log_book}
)y",
R"y(g.yaml:1:1: run: clock 'hardware': no block of this graph paces the run (a device with streams, such as acquisition.alsa_capture); allowed: simulated, realtime)y"},

{"a priority in a run as fast as possible",
R"y(bodeflow: 1
phases:
  - name: one
    blocks: {sine: {block: generators.sine}}
    run: {priority: 50}
)y",
R"y(g.yaml:3:5: phase 'one': run: priority: a run as fast as possible would take the machine from everything else; allowed with clock: realtime, hardware)y"},

{"summary",
R"y(bodeflow: 1
phases:
  - {name: one, blocks: {tuner: {block: control.tuner}, sine: {block: generators.sine}}}
summary: {show: [one.tuner, one.tunr, one.sine, 3], then: x, next: [1]}
)y",
R"y(g.yaml:4:29: summary: show: no block gives a result 'one.tunr' (did you mean 'one.tuner'?); results: one.tuner
g.yaml:4:39: summary: show: no block gives a result 'one.sine'; results: one.tuner
g.yaml:4:49: summary: show: no block gives a result '3'; results: one.tuner
g.yaml:4:53: summary: unknown key 'then'; allowed: show, next
g.yaml:4:68: summary: next: found a list, allowed: a text)y"},

{"hosts",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine}
  b: {block: generators.sine}
hosts: {bench: [a, c], desk: [a], "my host": [b], x: b}
)y",
R"y(g.yaml:5:20: hosts: 'bench': unknown block 'c'
g.yaml:5:31: hosts: 'desk': block 'a' is on host 'bench' already
g.yaml:5:35: hosts: 'my host' is not a name: letters, digits, _ and -
g.yaml:5:54: hosts: 'x': found 'b', allowed: a list of blocks)y"},

{"phases beside blocks",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine}
phases:
  - {name: one, blocks: {a: {block: generators.sine}}}
)y",
R"y(g.yaml:2:1: 'blocks' can't stand beside 'phases': put it into a phase)y"},

{"phases",
R"y(bodeflow: 1
phases:
  - {blocks: {a: {block: generators.sine}}}
  - {name: two, block: {}}
  - {name: two, blocks: {a: {block: generators.sine}}}
  - {name: the third, blocks: {a: {block: generators.sine}}}
  - nothing
)y",
R"y(g.yaml:3:5: phase: key 'name' is missing
g.yaml:4:5: phase 'two': key 'blocks' is missing
g.yaml:4:17: phase 'two': unknown key 'block' (did you mean 'blocks'?)
g.yaml:5:12: phase 'two' is there twice (first in line 4)
g.yaml:6:12: phase: 'the third' is not a name: letters, digits, _ and -
g.yaml:7:5: phase: found 'nothing', allowed: a map such as {name: identify, blocks: ...})y"},

{"no phases",
R"y(bodeflow: 1
phases: []
)y",
R"y(g.yaml:2:9: phases: an empty list, allowed: at least one phase)y"},

{"references",
R"y(bodeflow: 1
phases:
  - name: one
    blocks: {tuner: {block: control.tuner}, sine: {block: generators.sine}, fit: {block: identify.fit}}
    connections:
      - $two.fit.model -> fit
      - $one.tuner.changes -> fit
  - name: two
    blocks: {log: {block: output.records}, fit: {block: identify.fit}, gain: {block: filters.gain}}
    connections:
      - $oen.tuner.changes -> log
      - $one.tunr.changes -> log
      - $one.fit -> log
      - $one.sine -> log
      - $one.sine.out -> log
      - $one.tuner.changes -> fit
      - $one.tuner.changes -> gain.in
      - {from: $one.tuner, to: log, latency: 1 s}
      - log -> $one.tuner.model
)y",
R"y(g.yaml:6:9: 'two' is no earlier phase; earlier phases: none
g.yaml:7:9: phase 'one' can't refer to itself here; earlier phases: none
g.yaml:11:9: 'oen' is no earlier phase (did you mean 'one'?); earlier phases: one
g.yaml:12:9: unknown block 'tunr' (did you mean 'tuner'?)
g.yaml:14:9: block 'sine' sends no records
g.yaml:15:9: 'sine.out' is a stream: only records pass from phase to phase
g.yaml:16:9: '$one.tuner.changes' sends records of type 'parameter_change', 'fit.data' takes 'frequency_response'
g.yaml:17:31: 'gain.in' takes a stream, only records pass from phase to phase
g.yaml:18:46: connection: latency: a record of an earlier phase is there from the beginning
g.yaml:19:16: a record of an earlier phase stands at the beginning of a connection)y"},

{"conditions",
R"y(bodeflow: 1
phases:
  - name: one
    blocks: {tuner: {block: control.tuner}}
    when: $zero.tuner.ok
  - name: two
    blocks: {tuner: {block: control.tuner}}
    when: one.tuner.ok == true
    repeat: {max: 0, until: "$two.tuner.changes.quality > good"}
  - name: three
    blocks: {tuner: {block: control.tuner}}
    when: $one.tuner.ok =
    repeat: {until: $four.tuner.ok, times: 3}
  - name: four
    blocks: {tuner: {block: control.tuner}}
    when: $one.tuner.ok = true
    repeat: 3
)y",
R"y(g.yaml:5:11: 'zero' is no earlier phase; earlier phases: none
g.yaml:8:11: when: found 'one.tuner.ok == true', allowed: $phase.block.attribute or $phase.block.port.attribute, then ==, !=, <, <=, > or >= and a value
g.yaml:9:19: repeat: max: found 0, allowed: 1 to 1000000
g.yaml:9:29: until: > compares numbers, found 'good'
g.yaml:12:11: when: found '$one.tuner.ok =', allowed: $phase.block.attribute or $phase.block.port.attribute, then ==, !=, <, <=, > or >= and a value
g.yaml:13:13: repeat: key 'max' is missing: how often at most?
g.yaml:13:21: 'four' is no earlier phase; earlier phases: one, two, three
g.yaml:13:37: repeat: unknown key 'times'; allowed: max, until
g.yaml:16:11: when: found '$one.tuner.ok = true', allowed: $phase.block.attribute or $phase.block.port.attribute, then ==, !=, <, <=, > or >= and a value
g.yaml:17:13: repeat: found '3', allowed: a map such as {max: 5, until: ...})y"},

{"references to a swept phase", R"y(bodeflow: 1
phases:
  - name: runs
    run: {duration: 1 s}
    sweep: {seed: 1..3}
    blocks: {tuner: {block: control.tuner}, sine: {block: generators.sine}}
  - name: after
    blocks: {fit: {block: identify.fit}, log: {block: output.records}}
    connections:
      - $runs.tuner.changes -> log
      - $runs.tuner.changes -> fit
)y",
R"y(g.yaml:11:9: '$runs.tuner.changes' sends records of type 'sweep', 'fit.data' takes 'frequency_response')y"},

{"sweep",
R"y(bodeflow: 1
phases:
  - name: one
    blocks: {a: {block: generators.sine}}
    sweep:
      seed: 1..x
      a.frequency: [1 Hz, 2 V]
      a.frequenzy: [1]
      b.frequency: [1]
      run.sped: [1]
      run.duration: [1 s, -1 s]
      amplitude: [1]
  - name: two
    blocks: {a: {block: generators.sine}}
    sweep: {seed: 1..99999999}
  - name: three
    blocks: {a: {block: generators.sine}}
    sweep: {seed: []}
    repeat: {max: 2}
)y",
R"y(g.yaml:6:13: sweep: seed: found '1..x', allowed: a range such as 1..100, the lower number first
g.yaml:7:27: sweep: a.frequency: 2 V is a voltage; allowed: a frequency in Hz
g.yaml:8:7: sweep: block 'a': unknown parameter 'frequenzy' (did you mean 'frequency'?)
g.yaml:9:7: unknown block 'b'; blocks: a
g.yaml:10:7: sweep: run: unknown key 'sped' (did you mean 'seed'?)
g.yaml:11:27: run: duration: found '-1 s', allowed: a time above 0 s
g.yaml:12:7: sweep: 'amplitude' is no path; allowed: seed, block.parameter, run.key
g.yaml:15:19: sweep: seed: more than 1000000 values
g.yaml:18:5: phase 'three': 'sweep' can't stand beside 'repeat'
g.yaml:18:19: sweep: seed: an empty list, allowed: at least one value)y"},

{"variables",
R"y(bodeflow: 1
variables: {rate: 1 kHz, data: , loop: "${pool}", pool: "${loop}", "a b": 3, lines: {first: 3}}
title: ${rat} ${lines} ${open
blocks:
  a: {block: generators.sine, frequency: "${zzz}"}
)y",
R"y(g.yaml:2:26: variable 'data' has no value: give one with --set data=VALUE
g.yaml:2:57: variables refer to each other: loop -> pool -> loop
g.yaml:2:68: variables: 'a b' is not a name: letters, digits, _ and -
g.yaml:3:8: unknown variable 'rat' (did you mean 'rate'?)
g.yaml:3:8: variable 'lines' is a map: it can't stand inside a text
g.yaml:3:8: '${' without '}' in '${rat} ${lines} ${open'
g.yaml:5:42: unknown variable 'zzz'; declared: rate, data, loop, pool, lines)y"},

{"variables no map",
R"y(bodeflow: 1
variables: [a]
blocks:
  a: {block: generators.sine}
)y",
R"y(g.yaml:2:12: variables: found a list, allowed: a map of names and values)y"},

};
// clang-format on

}  // namespace

TEST_CASE("graph: wrong phases, settings and lists are refused with their exact message") {
  for (const auto& broken : kBroken) {
    INFO(broken.kind);
    CHECK(problems(broken.text) == broken.expected);
  }
}

}  // namespace bodeflow::graph
