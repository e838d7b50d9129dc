#include "plugins/host.hpp"

#include <stdexcept>
#include <string>

#include "catch.hpp"

using namespace bodeflow;

namespace {

const bf_files& files_of(const bf_host& host) { return *static_cast<const bf_files*>(host.extension(&host, BF_EXTENSION_FILES)); }

}  // namespace

TEST_CASE("the host's services are found by id, others are not there") {
  const Host host("b", nullptr);
  const bf_host& c = host.c();
  CHECK(c.extension(&c, "bodeflow.log/1") != nullptr);
  CHECK(c.extension(&c, "bodeflow.files/1") != nullptr);
  CHECK(c.extension(&c, "bodeflow.log/2") == nullptr);
  CHECK(c.extension(&c, nullptr) == nullptr);
}

TEST_CASE("an output path lives as long as the block, a refused one gives the reason, a check has an empty one") {
  auto services = std::make_shared<HostServices>();
  services->output_path = [](const std::string& block, const std::string& name) -> tl::expected<std::string, std::string> {
    if (name == "../x") return tl::unexpected(block + ": '../x' leaves the run directory");
    return "/run/" + name;
  };
  Host host("b", services);
  const bf_files& files = files_of(host.c());
  const char* first = files.output_path(&host.c(), "a.csv");
  for (int i = 0; i < 100; ++i) CHECK(files.output_path(&host.c(), std::to_string(i).c_str()) != nullptr);
  CHECK(std::string(first) == "/run/a.csv");
  CHECK(files.output_path(&host.c(), "../x") == nullptr);
  CHECK(host.take_error() == "b: '../x' leaves the run directory");
  CHECK(files.output_path(&host.c(), nullptr) == nullptr);
  CHECK(host.take_error() == "output_path: the name is a null pointer");

  Host check("b", nullptr);
  CHECK(std::string(files_of(check.c()).output_path(&check.c(), "a.csv")).empty());
}

TEST_CASE("what the host's own services throw becomes an error, and never passes through a plugin") {
  auto services = std::make_shared<HostServices>();
  services->note_input = [](const std::string&, const std::string&) { throw std::runtime_error("the disk is full"); };
  services->log = [](const std::string&, int, const std::string&) { throw std::runtime_error("no terminal"); };
  Host host("b", services);
  CHECK(files_of(host.c()).note_input(&host.c(), "/a") == BF_FAILED);
  CHECK(host.take_error() == "the disk is full");
  static_cast<const bf_log*>(host.c().extension(&host.c(), BF_EXTENSION_LOG))->write(&host.c(), BF_LOG_INFO, "hello");
}

TEST_CASE("an error text without end is cut, a null one is no reason") {
  Host host("b", nullptr);
  host.c().error(&host.c(), std::string(1U << 20U, 'x').c_str());
  CHECK(host.take_error().size() == 65536);
  host.c().error(&host.c(), nullptr);
  CHECK(host.take_error() == "failed without a reason");
  host.c().error(&host.c(), "first");
  host.c().error(&host.c(), "second");
  CHECK(host.take_error() == "second");
}
