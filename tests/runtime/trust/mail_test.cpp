// What the engine's own transport makes of a folder of trust.
#include <unistd.h>

#include <future>

#include "catch.hpp"
#include "runtime/trust/folder.hpp"
#include "system/command.hpp"

namespace {

namespace fs = std::filesystem;
using namespace bodeflow::trust;
using bodeflow::test::kDay;
using bodeflow::test::must;

std::future<std::string> mail(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{BODEFLOW_TRUST_MAIL};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return std::async(std::launch::async, [command] { return bodeflow::test::run_program(command).out; });
}

}  // namespace

TEST_CASE("the transport joins with a folder of trust: texts come from hosts of the lab only") {
  const bodeflow::test::TrustFolder folder;
  const fs::path lab = folder.path() / "lab", before = folder.path() / "before";
  const Time now = std::chrono::system_clock::now();
  must(init(lab, {}, now));
  for (const char* name : {"bench", "motor", "stolen"}) {
    NewHost host;
    host.name = name;
    host.bundle = folder.path() / (std::string(name) + ".tar");
    must(add(lab, host, now));
  }
  fs::copy(lab, before, fs::copy_options::recursive);
  must(revoke(lab, "stolen", now));

  const std::string domain = std::to_string(20 + ::getpid() % 80);
  auto bench = mail({"receive", lab.string(), "bench", domain, "20"});
  auto motor = mail({"post", lab.string(), "motor", domain, "20", "m"});
  auto stranger = mail({"post", "-", "x", domain, "2", "x"});
  auto stolen = mail({"post", before.string(), "stolen", domain, "2", "s"});
  auto revoked = mail({"post", lab.string(), "stolen", domain, "2", "r"});
  CHECK(motor.get() == "posted\n");
  CHECK(stranger.get() == "nothing\n");
  CHECK(stolen.get() == "nothing\n");
  CHECK(revoked.get() == "'" + (lab / "revoked.pem").string() + "': the certificate of host 'stolen' is revoked\n");
  CHECK(bench.get() == "m \n");
}
