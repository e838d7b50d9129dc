#include <cstdlib>
#include <new>

#include "adaptive_control/self_tuning.hpp"
#include "catch.hpp"
#include "loop.hpp"

namespace {

long allocations = 0;

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

using namespace bodeflow::test;

TEST_CASE("a step of the adaptive controller allocates nothing, whatever the nets do") {
  Example e = example_1_third_order();
  e.design.desired = ac::scaled(e.design.desired, 2.0);  // so fast that the ladder acts
  ac::AdaptiveController controller(*ac::EstimatorBank::make(e.bank), *ac::Designer::make(e.design), ac::RstController(-2, 2));
  bodeflow::numerics::Random random(1);
  std::vector<double> y;
  for (int k = 0; k < 3000; ++k) y.push_back(random.normal());
  const long before = allocations;
  double sum = 0.0;
  for (const double value : y) sum += controller.step(value, 1.0);
  CHECK(allocations == before);
  CHECK(std::isfinite(sum));
  CHECK(controller.designer().acted(ac::Net::ladder) + controller.designer().acted(ac::Net::kept) > 0);
}
