#include "broken.hpp"
#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

// clang-format off
const Broken kBroken[] = {
{"an empty file",
R"y(
)y",
R"y(g.yaml:1:1: the file is empty; a graph file begins with 'bodeflow: 1')y"},

{"only a comment",
R"y(# nothing here
)y",
R"y(g.yaml:1:1: the file is empty; a graph file begins with 'bodeflow: 1')y"},

{"a list at the top",
R"y(- a
- b
)y",
R"y(g.yaml:1:1: a graph file is a map of keys, found a list)y"},

{"the version is missing",
R"y(blocks: {}
)y",
R"y(g.yaml:1:1: key 'bodeflow' is missing: a graph file begins with 'bodeflow: 1')y"},

{"a version of the future",
R"y(bodeflow: 2
blocks: {}
)y",
R"y(g.yaml:1:11: bodeflow: found '2', allowed: 1 (the version of the format))y"},

{"octal version",
R"y(bodeflow: 01
blocks: {}
)y",
R"y(g.yaml:1:11: bodeflow: found '01', allowed: 1 (the version of the format))y"},

{"no blocks",
R"y(bodeflow: 1
)y",
R"y(g.yaml:1:1: key 'blocks' is missing: a graph has blocks (or phases))y"},

{"unknown key",
R"y(bodeflow: 1
bloks: {}
)y",
R"y(g.yaml:1:1: key 'blocks' is missing: a graph has blocks (or phases)
g.yaml:2:1: unknown key 'bloks' (did you mean 'blocks'?))y"},

{"unknown key far from all",
R"y(bodeflow: 1
blocks: {}
colour: red
)y",
R"y(g.yaml:3:1: unknown key 'colour'; allowed: bodeflow, title, run, include, requires, variables, blocks, connections, schedule, record, limits, phases, hosts, summary)y"},

{"limits that are no list",
R"y(bodeflow: 1
blocks: {}
limits: {}
)y",
R"y(g.yaml:3:9: limits: found a map, allowed: a list such as [{signal: drive.current, max: 12 A}])y"},

{"duplicate key",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine}
  a: {block: generators.sine}
)y",
R"y(g.yaml:4:3: key 'a' stands here twice (first in line 3))y"},

{"second document",
R"y(bodeflow: 1
blocks: {}
---
bodeflow: 1
)y",
R"y(g.yaml:3:1: a second document ('---'): a graph file has one)y"},

{"cyclic alias",
R"y(bodeflow: 1
blocks: &all
  a: *all
)y",
R"y(g.yaml:3:6: alias '*all' stands inside the value that it names)y"},

{"unknown alias",
R"y(bodeflow: 1
blocks: *all
)y",
R"y(g.yaml:2:9: not valid YAML: an alias for a value that is not there)y"},

{"tag",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine, frequency: !!float 5}
)y",
R"y(g.yaml:3:42: tag 'tag:yaml.org,2002:float': a graph file has no tags, write the value alone)y"},

{"own tag",
R"y(bodeflow: 1
blocks: !fancy {}
)y",
R"y(g.yaml:2:9: tag '!fancy': a graph file has no tags, write the value alone)y"},

{"merge key",
R"y(bodeflow: 1
blocks:
  a: &a {block: generators.sine}
  b: {<<: *a}
)y",
R"y(g.yaml:4:7: merge key '<<' is not supported: use 'variables' or 'include')y"},

{"tab",
R"y(bodeflow: 1
blocks:
	a: {block: generators.sine}
	b: {block: generators.sine}
)y",
R"y(g.yaml:3:1: a tab in the indentation (in 2 lines): use spaces)y"},

{"unclosed flow",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine
)y",
R"y(g.yaml:4:1: not valid YAML: '}' or ',' is missing)y"},

{"unclosed list",
R"y(bodeflow: 1
blocks: {}
connections: [a -> b
)y",
R"y(g.yaml:4:1: not valid YAML: ']' or ',' is missing)y"},

{"unclosed quote",
R"y(bodeflow: 1
title: "never ends
blocks: {}
)y",
R"y(g.yaml:2:8: not valid YAML: the closing quote is missing)y"},

{"wrong indentation",
R"y(bodeflow: 1
blocks:
  a: {block: generators.sine}
   b: {block: generators.sine}
)y",
R"y(g.yaml:4:4: not valid YAML: a key, at the same indentation as the keys before it, is missing)y"},

{"colon in text",
R"y(bodeflow: 1
title: a: b
blocks: {}
)y",
R"y(g.yaml:2:9: not valid YAML: ':' where no key can be (wrong indentation, or a text that needs quotes))y"},

{"unquoted variable in braces",
R"y(bodeflow: 1
variables: {f: 3}
blocks:
  a: {block: generators.sine, frequency: ${f}}
)y",
R"y(g.yaml:4:43: not valid YAML: '}' or ',' is missing (inside {} and [], put "${name}" in quotes))y"},

{"key is a list",
R"y(bodeflow: 1
blocks:
  [a, b]: {block: generators.sine}
)y",
R"y(g.yaml:3:3: a key must be a word, found a list)y"},

{"null in text",
R"y(bodeflow: 1
title: "a\0b"
blocks: {}
)y",
R"y(g.yaml:2:8: a NUL character in a text)y"},

{"unknown escape",
R"y(bodeflow: 1
title: "C:\data"
blocks: {}
)y",
R"y(g.yaml:2:13: not valid YAML: unknown escape character: d)y"},

{"at sign",
R"y(bodeflow: 1
title: @home
blocks: {}
)y",
R"y(g.yaml:2:8: not valid YAML: a character that begins no value: put the text in quotes)y"},

{"a variable in an include",
R"y(bodeflow: 1
include: ["${x}.yaml"]
blocks: {}
)y",
R"y(g.yaml:2:11: include: a variable can't stand in the name of a file)y"},

{"include of a missing file",
R"y(bodeflow: 1
include: [parts/none.yaml]
blocks: {}
)y",
R"y(g.yaml:2:11: can't read 'parts/none.yaml': there is no such file)y"},

{"include of a folder",
R"y(bodeflow: 1
include: ["/"]
blocks: {}
)y",
R"y(g.yaml:2:11: can't read '/': it is a folder)y"},

{"include is a text",
R"y(bodeflow: 1
include: a.yaml
blocks: {}
)y",
R"y(g.yaml:2:10: include: found 'a.yaml', allowed: a list of files)y"},

{"a file that includes itself",
R"y(bodeflow: 1
include: [g.yaml]
blocks: {}
)y",
R"y(g.yaml:2:11: files include each other: g.yaml -> g.yaml)y"},

{"the file begins with a byte order mark",
"\xEF\xBB\xBF" R"y(bodeflow: 1
blocks: {a: {block: generators.sine, frequency: 3 V}}
)y",
R"y(g.yaml:2:49: block 'a': parameter 'frequency': 3 V is a voltage; allowed: a frequency in Hz)y"},

};
// clang-format on

}  // namespace

TEST_CASE("graph: a file that is no graph file is refused with its exact message") {
  for (const auto& broken : kBroken) {
    INFO(broken.kind);
    CHECK(problems(broken.text) == broken.expected);
  }
}

}  // namespace bodeflow::graph
