#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "catch.hpp"
#include "system/command.hpp"

/// What a tracer finds in the battery proves something only if the battery has nothing of it.

namespace fs = std::filesystem;

namespace {

const fs::path kBattery = fs::path(BODEFLOW_SOURCE_DIR) / "tests/battery";
const std::vector<fs::path> kPrograms{BATTERY_GENERATE, BATTERY_SCORE};

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> sources() {
  std::vector<fs::path> files;
  for (const char* part : {"common", "generate", "score"}) {
    for (const auto& entry : fs::directory_iterator(kBattery / part)) files.push_back(entry.path());
  }
  return files;
}

}  // namespace

TEST_CASE("battery: its sources include the standard library and each other, nothing else") {
  const std::set<std::string> standard{"algorithm", "array",      "atomic",      "bit",        "charconv", "chrono",
                                       "cmath",     "complex",    "cstddef",     "cstdint",    "cstdio",   "cstdlib",
                                       "exception", "filesystem", "fstream",     "functional", "iterator", "limits",
                                       "map",       "memory",     "mutex",       "numbers",    "set",      "sstream",
                                       "stdexcept", "string",     "string_view", "thread",     "utility",  "vector"};
  REQUIRE(sources().size() > 30);
  for (const fs::path& file : sources()) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      if (line.find("#include") == std::string::npos) continue;
      INFO(file << ": " << line);
      const auto open = line.find_first_of("<\""), close = line.find_last_of(">\"");
      REQUIRE(open < close);
      const std::string name = line.substr(open + 1, close - open - 1);
      if (line[open] == '<') {
        CHECK(standard.count(name) == 1);
      } else {
        CHECK(name.find("..") == std::string::npos);
        CHECK(fs::is_regular_file(kBattery / name));
      }
    }
  }
}

TEST_CASE("battery: its sources name no part of this project") {
  for (const fs::path& file : sources()) {
    INFO(file);
    const std::string text = text_of(file);
    for (const char* word : {"bodeflow::", "bodeflow/", "plugins/", "Eigen", "dlopen"})
      CHECK(text.find(word) == std::string::npos);
  }
}

TEST_CASE("battery: no object of this project is linked into its programs") {
  for (const char* program : {"battery_generate", "battery_score"}) {
    std::ifstream map(fs::path(BATTERY_MAPS) / (std::string(program) + ".map"));
    INFO(program);
    REQUIRE(map);
    int objects = 0;
    for (std::string line; std::getline(map, line);) {
      if (line.rfind("LOAD ", 0) != 0) continue;
      ++objects;
      INFO(line);
      const std::string file = fs::path(line.substr(5)).filename();
      // Objects of the program, the battery's libraries, the compiler's and the C library's start and end.
      const bool own = line.find("battery_") != std::string::npos || line.find("tests/battery") != std::string::npos;
      const bool system =
          file.rfind("crt", 0) == 0 || file == "Scrt1.o" || file.rfind("lib", 0) == 0 || file.rfind("ld-linux", 0) == 0;
      CHECK((own || system));
      CHECK(file.find("bodeflow") == std::string::npos);
    }
    CHECK(objects > 3);
  }
}

TEST_CASE("battery: its programs need the libraries of C and C++ at run time, nothing else") {
  for (const fs::path& program : kPrograms) {
    const auto ended = bodeflow::test::run_program({"ldd", program.string()});
    REQUIRE(ended.exit_code == 0);
    std::istringstream lines(ended.out);
    for (std::string line; std::getline(lines, line);) {
      INFO(line);
      bool known = false;
      for (const char* name : {"linux-vdso", "libstdc++", "libm.so", "libgcc_s", "libc.so", "libpthread", "ld-linux", "libasan",
                               "libubsan", "libtsan", "libdl", "librt"})
        known = known || line.find(name) != std::string::npos;
      CHECK(known);
    }
    CHECK(text_of(program).find("8bodeflow") == std::string::npos);  // the project's namespace, as compilers write it
  }
}
