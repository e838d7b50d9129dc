#include "catch.hpp"
#include "support.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

std::vector<double> counted(Instance& instance) {
  const Call call(instance, {}, 1);
  CHECK(call.result == BF_OK);
  return call.output(0);
}

}  // namespace

TEST_CASE("equally named statics of two plugins do not mix") {
  Registry registry(options({fixture("twin_one"), fixture("twin_two")}));
  const auto one = Instance::make(registry, "twin_one.counter", "one", nullptr).value();
  const auto two = Instance::make(registry, "twin_two.counter", "two", nullptr).value();
  REQUIRE(one->configure({}));
  REQUIRE(two->configure({}));
  // Four variables, each counted up by itself: 1 + 10 + 100 + 1000, and 4 x 0.5 where twin two starts.
  CHECK(counted(*one) == std::vector<double>{1111, 2222, 3333, 4444});
  CHECK(counted(*two) == std::vector<double>{1113, 2224, 3335, 4446});
  CHECK(counted(*one) == std::vector<double>{5555, 6666, 7777, 8888});
}

TEST_CASE("two blocks of one plugin share its library, and outlive the registry") {
  std::unique_ptr<Instance> first, second;
  {
    Registry registry(options({fixture("plain")}));
    first = std::move(*Instance::make(registry, "plain.scale", "first", nullptr));
    second = std::move(*Instance::make(registry, "plain.scale", "second", nullptr));
  }
  REQUIRE(first->configure(defaults(first->type())));
  first.reset();
  REQUIRE(second->configure(defaults(second->type())));
  CHECK(Call(*second, {{21.0}}, 1).output(0) == std::vector<double>{42.0});
}
