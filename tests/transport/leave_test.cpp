// Work that never ends is left behind.
#include "transport/leave.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "catch.hpp"

using bodeflow::transport::leave;

TEST_CASE("work that ends is waited for and gone afterwards") {
  auto owned = std::make_shared<int>(1);
  std::weak_ptr<int> seen = owned;
  bool done = false;
  leave([owned = std::move(owned), &done] { done = *owned == 1; });
  CHECK(done);
  CHECK(seen.expired());
}

TEST_CASE("work that hangs is left after two seconds and the process still ends with its own code", "[long]") {
  const auto begun = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) {
    leave([] { std::this_thread::sleep_for(std::chrono::hours(1)); });
    std::exit(7);
  }
  int status = 0;
  waitpid(child, &status, 0);
  const auto taken = std::chrono::steady_clock::now() - begun;
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 7);
  CHECK(taken > std::chrono::milliseconds(1900));
  CHECK(taken < std::chrono::seconds(4));
}
