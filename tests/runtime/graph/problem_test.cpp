#include "graph/problem.hpp"

#include "catch.hpp"

namespace bodeflow {

TEST_CASE("problem: a place is printed as compilers do, without the parts that are unknown") {
  CHECK(to_string(Problem{{"a.yaml", 3, 7}, "wrong"}) == "a.yaml:3:7: wrong");
  CHECK(to_string(Problem{{"a.yaml", 3, 0}, "wrong"}) == "a.yaml:3: wrong");
  CHECK(to_string(Problem{{"a.yaml", 0, 0}, "wrong"}) == "a.yaml: wrong");
  CHECK(to_string(Problem{{}, "wrong"}) == "wrong");
}

TEST_CASE("problem: a list is printed by file, line and column, each problem once") {
  const Problems problems = {{{"b.yaml", 9, 1}, "b9"}, {{"a.yaml", 10, 1}, "a10"}, {{"b.yaml", 2, 5}, "b2"},
                             {{"a.yaml", 9, 4}, "a9"}, {{"b.yaml", 9, 1}, "b9"},   {{"b.yaml", 2, 3}, "b2 first"}};
  CHECK(to_string(problems) == "b.yaml:2:3: b2 first\nb.yaml:2:5: b2\nb.yaml:9:1: b9\na.yaml:9:4: a9\na.yaml:10:1: a10");
  CHECK(to_string(Problems{}).empty());
}

TEST_CASE("did you mean: the nearest name is offered, and none when nothing is near") {
  const std::vector<std::string> names = {"period", "periods", "skip", "generators.multisine"};
  CHECK(did_you_mean("peroids", names) == " (did you mean 'periods'?)");
  CHECK(did_you_mean("Period", names) == " (did you mean 'period'?)");
  CHECK(did_you_mean("multisine", names) == " (did you mean 'generators.multisine'?)");
  CHECK(did_you_mean("generator.multisine", names) == " (did you mean 'generators.multisine'?)");
  CHECK(did_you_mean("gain", names).empty());
  CHECK(did_you_mean("a", {"b"}).empty());
  CHECK(did_you_mean("", names).empty());
  CHECK(did_you_mean(std::string(100'000, 'x'), {std::string(100'000, 'x')}).empty());
}

}  // namespace bodeflow
