#include "lab/link_slot.hpp"

#include <thread>

#include "catch.hpp"

namespace bodeflow::test {
namespace {

using Used = tl::expected<int, transport::Failure>;

const transport::GoOn kAlways = [] { return true; };

TEST_CASE("link slot: a call that waits on a link that is taken out goes on with the next one") {
  lab::LinkSlot<int> slot(std::make_unique<int>(1));
  std::atomic<bool> waits{false};
  Used used = 0;
  std::thread block([&] {
    used = slot.use(kAlways, [&](int& link, const transport::GoOn& go_on) -> Used {
      if (link == 2) return link;
      for (waits = true; go_on();) std::this_thread::yield();
      return tl::unexpected(transport::Failure{transport::Failure::Kind::stopped, "stopped"});
    });
  });
  while (!waits) std::this_thread::yield();
  CHECK(slot.take_out([](int* link) { return *link; }) == 1);
  slot.put_in(std::make_unique<int>(2), [](int&) { return 0; });
  block.join();
  CHECK(used.value() == 2);
}

TEST_CASE("link slot: a call without a link ends where its caller does not go on") {
  lab::LinkSlot<int> slot(std::make_unique<int>(1));
  slot.take_out([](int* link) { return *link; });
  CHECK(slot.take_out([](int* link) { return link == nullptr; }));
  int asked = 0;
  const Used used = slot.use([&] { return ++asked < 3; }, [](int& link, const transport::GoOn&) -> Used { return link; });
  REQUIRE_FALSE(used);
  CHECK(used.error().kind == transport::Failure::Kind::stopped);
}

TEST_CASE("link slot: no tolerance ends in a pause, nor one that began in it") {
  lab::LinkSlot<int> slot(std::make_unique<int>(1));
  int calls = 0;
  const auto use = [&] {
    calls = 0;
    return slot.use(kAlways, [&](int& link, const transport::GoOn&) -> Used {
      if (++calls == 3) slot.pause(false);
      if (calls == 4) return link;
      return tl::unexpected(transport::Failure{transport::Failure::Kind::tolerance, "nothing came"});
    });
  };
  CHECK_FALSE(use());
  CHECK(calls == 1);
  slot.pause(true);
  CHECK(use());
  CHECK(calls == 4);
}

}  // namespace
}  // namespace bodeflow::test
