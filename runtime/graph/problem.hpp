#pragma once

#include <string>
#include <vector>

namespace bodeflow {

/// Where something stands in a file; line and column count from one, 0 where unknown.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

/// One thing that is wrong with a graph or a data file: what, found, allowed, nearest valid name.
struct Problem {
  Place place;
  std::string text;
};

/// All that is wrong, in file order; empty: nothing.
using Problems = std::vector<Problem>;

/// "file:line:column: text", as compilers print it; parts that are unknown are left out.
std::string to_string(const Problem& problem);

/// The problems a line each, sorted by place, without repeats.
std::string to_string(const Problems& problems);

/// " (did you mean 'x'?)" for the candidate nearest to `found`, or "" when none is near.
std::string did_you_mean(const std::string& found, const std::vector<std::string>& candidates);

}  // namespace bodeflow
