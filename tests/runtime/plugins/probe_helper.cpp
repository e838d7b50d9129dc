// The hidden command `probe-plugin FILE` for tests. Notes each start in the file BODEFLOW_PROBE_LOG.
#include <cstdlib>
#include <fstream>
#include <string_view>

#include "plugins/probe.hpp"

int main(int count, char** arguments) {
  if (count != 3 || std::string_view(arguments[1]) != "probe-plugin") return 2;
  if (const char* log = std::getenv("BODEFLOW_PROBE_LOG")) std::ofstream(log, std::ios::app) << arguments[2] << '\n';
  return bodeflow::probe_main(arguments[2]);
}
