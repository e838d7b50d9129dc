#pragma once

namespace bodeflow::graph {

/// One way in which a graph can be wrong.
struct Broken {
  const char* kind;
  const char* text;      ///< of g.yaml
  const char* expected;  ///< all of what the user sees
};

}  // namespace bodeflow::graph
