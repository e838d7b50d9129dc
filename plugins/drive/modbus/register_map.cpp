#include "register_map.hpp"

#include <cstdio>

namespace bodeflow::drive::modbus {

int TraceBuffer::words_per_sample() const {
  int words = 0;
  for (const Register& channel : channels) words += channel.words();
  return words;
}

std::optional<std::size_t> RegisterMap::find(const std::string& name) const {
  for (std::size_t i = 0; i < registers.size(); ++i) {
    if (registers[i].name == name) return i;
  }
  return std::nullopt;
}

std::vector<std::string> RegisterMap::names(bool writable) const {
  std::vector<std::string> all;
  for (const Register& r : registers) {
    if (writable ? r.writable() : r.readable()) all.push_back(r.name);
  }
  return all;
}

std::string name_of(const Register& r) {
  char place[48];
  std::snprintf(place, sizeof place, " (%s register 0x%04x)", r.table == Table::holding ? "holding" : "input",
                static_cast<unsigned>(r.address));
  return r.name + place;
}

const char* name_of(Encoding encoding) {
  switch (encoding) {
    case Encoding::int16:
      return "int16";
    case Encoding::uint16:
      return "uint16";
    case Encoding::int32:
      return "int32";
    case Encoding::uint32:
      return "uint32";
    case Encoding::float32:
      break;
  }
  return "float32";
}

}  // namespace bodeflow::drive::modbus
