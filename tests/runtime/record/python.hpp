#pragma once

#include <stdio.h>

#include <filesystem>
#include <string>

namespace bodeflow::record_tests {

/// What a shell command prints, on both of its outputs.
inline std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return "can't start: " + command;
  char buffer[4096];
  while (const std::size_t got = std::fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, got);
  ::pclose(pipe);
  return text;
}

/// A Python with h5py, or "": Debian's own, or the first in the path.
inline std::string python_with_h5py() {
  for (const char* python : {"/usr/bin/python3", "python3"})
    if (output_of(std::string(python) + " -c 'import h5py; print(1)'") == "1\n") return python;
  return "";
}

inline bool h5py_present() { return !python_with_h5py().empty(); }

/// What check_data.py says of a data.h5: "ok\n" or why not.
inline std::string check_data(const std::filesystem::path& file, const std::string& arguments) {
  return output_of(python_with_h5py() + " " BODEFLOW_SOURCE_DIR "/tests/runtime/record/check_data.py '" + file.string() + "' " +
                   arguments);
}

}  // namespace bodeflow::record_tests
