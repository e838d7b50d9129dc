// The published IDL: a program made from it by fastddsgen reads what an outlet writes.
#include <filesystem>

#include "catch.hpp"
#include "transport/processes.hpp"

TEST_CASE("a program made by fastddsgen reads a stream sample by sample", "[long]") {
  if (shell("command -v fastddsgen > /dev/null") != 0) {
    WARN("not tested: fastddsgen is not installed");
    return;
  }
  const std::string source = BODEFLOW_SOURCE_DIR "/tests/transport/generated_reader";
  const std::string build = BODEFLOW_BUILD_DIR "/generated_reader";
  REQUIRE(shell("cmake -S " + source + " -B " + build +
                " -DBODEFLOW_IDL=" BODEFLOW_SOURCE_DIR "/runtime/transport/bodeflow.idl > /dev/null") == 0);
  REQUIRE(shell("cmake --build " + build + " > /dev/null") == 0);
  Process reader({build + "/generated_reader", std::to_string(test_domain()), "published", "3"});
  Process sender(peer("send", {"topic=published", "open=1", "count=3", "bytes=80", "stream=77"}));
  CHECK(sender.wait() == 0);
  CHECK(reader.wait() == 0);
  INFO(reader.output());
  CHECK(reader.output().find("sequence=0\nstream=77\nposition=0\ncount=10\nrate=1000/1\nclock=\nsum=45\n") != std::string::npos);
  CHECK(reader.output().find("sequence=2\nstream=77\nposition=20\ncount=10\nrate=1000/1\nclock=\nsum=245\n") !=
        std::string::npos);
}
