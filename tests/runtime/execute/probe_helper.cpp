// The hidden command `probe-plugin FILE` for tests.
#include <string_view>

#include "plugins/probe.hpp"

int main(int count, char** arguments) {
  if (count != 3 || std::string_view(arguments[1]) != "probe-plugin") return 2;
  return bodeflow::probe_main(arguments[2]);
}
