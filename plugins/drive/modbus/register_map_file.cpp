#include "register_map_file.hpp"

#include <bodeflow/units.hpp>
#include <bodeflow/words.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "records/signals.hpp"
#include "register_value.hpp"
#include "yaml_reader.hpp"

namespace bodeflow::drive::modbus {
namespace {

using numerics::Expected;
using numerics::refused;

constexpr long long kLastAddress = 0xFFFF;
constexpr double kFastestPoll = 10e3;  // Hz; a question and its answer take longer on any wire
constexpr long long kMostTraceSamples = 1 << 20;
constexpr std::streamoff kLongestFile = 1 << 20;

/// Reads a map out of its nodes.
class MapReader {
 public:
  MapReader(const std::string& file, YamlReader& yaml) : y_(yaml) { map_.file = file; }

  RegisterMap read(const YAML::Node& root) {
    const auto f = y_.fields(
        root, "the map",
        {"bodeflow_drive", "device", "poll_rate", "word_order", "registers", "identity", "setup", "standstill", "trace"});
    if (root.IsMap()) read_head(root, f);
    if (!f[4].IsNull()) read_registers(f[4]);
    if (!f[5].IsNull()) map_.identity = values(f[5], "identity", false);
    if (!f[6].IsNull()) map_.setup = values(f[6], "setup", true);
    if (!f[7].IsNull()) read_standstill(f[7]);
    if (!f[8].IsNull()) read_trace(f[8]);
    if (!f[4].IsNull()) check_words(f[4]);
    return std::move(map_);
  }

 private:
  void read_head(const YAML::Node& root, const std::vector<YAML::Node>& f) {
    const char* const needed[] = {"bodeflow_drive", "device", "poll_rate", nullptr, "registers"};
    for (std::size_t i = 0; i < std::size(needed); ++i) {
      if (needed[i] != nullptr && f[i].IsNull()) y_.wrong(root, std::string("the map has no '") + needed[i] + "'");
    }
    if (!f[0].IsNull()) y_.integer(f[0], "bodeflow_drive", 1, 1);
    if (!f[1].IsNull()) map_.device = y_.text(f[1], "device");
    if (!f[2].IsNull()) map_.fastest_poll_hz = positive(f[2], "poll_rate", "Hz", kFastestPoll);
    if (!f[3].IsNull()) order_ = word_order(f[3]);
  }

  double positive(const YAML::Node& node, const std::string& what, const std::string& unit, double most) {
    const auto value = y_.number(node, what, unit);
    if (!value || (*value > 0.0 && *value <= most)) return value.value_or(1.0);
    y_.wrong(node, what + " is " + records::short_number(*value) + " " + unit + ", allowed: above 0, at most " +
                       records::short_number(most) + " " + unit);
    return 1.0;
  }

  WordOrder word_order(const YAML::Node& node) {
    return y_.choice(node, "word_order", {"high_first", "low_first"}).value_or(0) == 1 ? WordOrder::low_first
                                                                                       : WordOrder::high_first;
  }

  Table table(const YAML::Node& node) {
    return y_.choice(node, "table", {"holding", "input"}).value_or(0) == 1 ? Table::input : Table::holding;
  }

  void read_registers(const YAML::Node& node) {
    for (const auto& [key, value] : y_.entries(node, "registers")) {
      if (!bodeflow::detail::is_word(key.Scalar())) {
        y_.wrong(key, "register '" + key.Scalar() + "', allowed: lower-case letters, digits, _");
        continue;
      }
      map_.registers.push_back(read_register(key, value));
    }
  }

  Register read_register(const YAML::Node& key, const YAML::Node& node) {
    Register r;
    r.name = key.Scalar();
    r.order = order_;
    const std::string what = "register '" + r.name + "'";
    const auto f = y_.fields(node, what, {"address", "table", "type", "word_order", "access", "scale", "unit", "limits", "safe"});
    if (f[0].IsNull() && node.IsMap()) y_.wrong(key, what + " has no 'address'");
    if (!f[1].IsNull()) r.table = table(f[1]);
    read_type(f[2], f[3], f[5], f[6], what, r);
    if (!f[0].IsNull()) {
      r.address = static_cast<int>(y_.integer(f[0], what + ": address", 0, kLastAddress + 1 - r.words()).value_or(0));
    }
    if (!f[4].IsNull()) {
      constexpr Access kinds[] = {Access::read, Access::write, Access::both};
      r.access = kinds[y_.choice(f[4], what + ": access", {"read", "write", "both"}).value_or(0)];
      if (r.writable() && r.table == Table::input) y_.wrong(f[4], what + ": an input register can only be read");
    }
    if (!f[7].IsNull()) {
      if (const auto limits = y_.range(f[7], what + ": limits", r.unit)) std::tie(r.minimum, r.maximum) = *limits;
    }
    if (!f[8].IsNull()) r.safe = y_.number(f[8], what + ": safe", r.unit).value_or(0.0);
    const YAML::Node& place = f[8].IsNull() ? node : f[8];
    if (r.writable() && (r.safe < r.minimum || r.safe > r.maximum))
      y_.wrong(place, what + ": the safe value " + records::short_number(r.safe) + " is outside of the limits");
    return r;
  }

  /// What a number in a register or in the trace means.
  void read_type(const YAML::Node& type, const YAML::Node& order, const YAML::Node& scale, const YAML::Node& unit,
                 const std::string& what, Register& r) {
    constexpr Encoding kinds[] = {Encoding::int16, Encoding::uint16, Encoding::int32, Encoding::uint32, Encoding::float32};
    if (!type.IsNull())
      r.encoding = kinds[y_.choice(type, what + ": type", {"int16", "uint16", "int32", "uint32", "float32"}).value_or(1)];
    if (!order.IsNull()) r.order = word_order(order);
    if (!scale.IsNull()) {
      r.scale = y_.number(scale, what + ": scale", "1").value_or(1.0);
      if (!(std::abs(r.scale) > 0.0)) {
        y_.wrong(scale, what + ": scale is 0, allowed: any other number");
        r.scale = 1.0;
      }
    }
    if (unit.IsNull()) return;
    r.unit = y_.text(unit, what + ": unit");
    if (r.unit.empty() || !bodeflow::is_known_unit(r.unit)) {
      y_.wrong(unit, what + ": unit '" + r.unit + "' is not known");
      r.unit = "1";
    }
  }

  std::optional<std::size_t> place_of(const YAML::Node& node, const std::string& what, bool writable) {
    const std::string name = y_.text(node, what);
    if (name.empty()) return std::nullopt;
    const auto place = map_.find(name);
    const auto names = map_.names(writable);
    if (!place || (writable ? !map_.registers[*place].writable() : !map_.registers[*place].readable())) {
      const std::string why = place ? (writable ? " can't be written" : " can't be read") : " is no register";
      y_.wrong(node, what + ": '" + name + "'" + why + bodeflow::detail::meant(name, names) +
                         ", allowed: " + bodeflow::detail::listed(names));
      return std::nullopt;
    }
    return place;
  }

  std::vector<RegisterValue> values(const YAML::Node& node, const std::string& what, bool writable) {
    std::vector<RegisterValue> all;
    for (const auto& [key, value] : y_.entries(node, what)) {
      const auto place = place_of(key, what, writable);
      if (!place) continue;
      const Register& r = map_.registers[*place];
      const bool whole = r.unit == "1" && r.encoding != Encoding::float32;
      std::optional<double> number;
      if (whole) {
        const auto found = y_.integer(value, what + ": " + r.name, -0x80000000LL, 0xFFFFFFFFLL);
        if (found) number = static_cast<double>(*found);
      } else {
        number = y_.number(value, what + ": " + r.name, r.unit);
      }
      if (!number) continue;
      if (const auto words = encoded(r, *number); !words) y_.wrong(value, what + ": " + words.error().text);
      if (writable && (*number < r.minimum || *number > r.maximum))
        y_.wrong(value, what + ": " + r.name + " is " + quantity(*number, r) +
                            ", allowed by its limits: " + records::short_number(r.minimum) + " to " + quantity(r.maximum, r));
      all.push_back({*place, *number});
    }
    return all;
  }

  void read_standstill(const YAML::Node& node) {
    const auto all = values(node, "standstill", false);
    if (all.size() == 1 && all[0].value > 0.0) {
      map_.standstill = all[0];
    } else if (node.IsMap()) {
      y_.wrong(node, "standstill, allowed: one register and the magnitude below which the motor stands");
    }
  }

  void read_trace(const YAML::Node& node) {
    const auto f = y_.fields(node, "trace", {"arm", "done", "rate", "samples", "address", "table", "channels"});
    if (!node.IsMap()) return;
    TraceBuffer t;
    const char* const needed[] = {"done", "rate", "samples", "address"};
    for (std::size_t i = 0; i < std::size(needed); ++i) {
      if (f[i + 1].IsNull()) y_.wrong(node, std::string("trace has no '") + needed[i] + "'");
    }
    if (f[6].IsNull()) y_.wrong(node, "trace has no 'channels'");
    if (!f[0].IsNull()) t.arm = place_of(f[0], "trace: arm", true);
    if (!f[1].IsNull()) t.done = place_of(f[1], "trace: done", false).value_or(0);
    if (!f[2].IsNull()) t.rate_hz = positive(f[2], "trace: rate", "Hz", 1e7);
    if (!f[3].IsNull()) t.samples = y_.integer(f[3], "trace: samples", 1, kMostTraceSamples).value_or(1);
    if (!f[4].IsNull()) t.address = static_cast<int>(y_.integer(f[4], "trace: address", 0, kLastAddress).value_or(0));
    if (!f[5].IsNull()) t.table = table(f[5]);
    if (!f[6].IsNull()) read_channels(f[6], t);
    const long long end = t.address + t.samples * t.words_per_sample();
    if (end > kLastAddress + 1) y_.wrong(node, "trace ends at register " + std::to_string(end) + ", allowed: below 65536");
    map_.trace = std::move(t);
  }

  void read_channels(const YAML::Node& node, TraceBuffer& t) {
    for (const auto& [key, value] : y_.entries(node, "trace: channels")) {
      Register r;
      r.name = key.Scalar();
      r.order = order_;
      const std::string what = "trace channel '" + r.name + "'";
      const auto f = y_.fields(value, what, {"type", "word_order", "scale", "unit"});
      read_type(f[0], f[1], f[2], f[3], what, r);
      t.channels.push_back(std::move(r));
    }
    if (t.channels.empty() && node.IsMap()) y_.wrong(node, "trace: channels is empty, allowed: at least one");
  }

  /// The registers whose names have a meaning.
  void check_words(const YAML::Node& node) {
    const auto check = [&](const char* name, bool needed, bool writable, bool word) {
      const auto place = map_.find(name);
      if (!place) {
        if (needed) y_.wrong(node, std::string("registers: '") + name + "' is missing");
        return;
      }
      const Register& r = map_.registers[*place];
      if (writable ? !r.writable() : !r.readable())
        y_.wrong(node, std::string("register '") + name + "' can't be " + (writable ? "written" : "read"));
      if (word && (r.encoding != Encoding::uint16 || r.scale != 1.0))
        y_.wrong(node, std::string("register '") + name + "', allowed: type uint16 without scale");
    };
    check(kControlword, true, true, true);
    check(kStatusword, true, false, true);
    check(kFaultCode, false, false, true);
    check(kWatchdog, false, false, false);
    const auto watchdog = map_.find(kWatchdog);
    if (!watchdog) return;
    const std::string& unit = map_.registers[*watchdog].unit;
    if (unit != "s" && unit != "ms" && unit != "us")
      y_.wrong(node, "register 'watchdog' has the unit " + unit + ", allowed: s, ms, us");
  }

  YamlReader& y_;
  RegisterMap map_;
  WordOrder order_ = WordOrder::high_first;
};

}  // namespace

Expected<RegisterMap> parse_register_map(const std::string& text, const std::string& file) {
  YamlReader yaml(file);
  RegisterMap map;
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() != 1)
      return refused(file + ": " + records::counted(static_cast<std::int64_t>(documents.size()), "document") + ", allowed: one");
    map = MapReader(file, yaml).read(documents[0]);
  } catch (const YAML::Exception& e) {
    return refused(file + ":" + std::to_string(e.mark.line + 1) + ":" + std::to_string(e.mark.column + 1) +
                   ": no YAML: " + e.msg);
  }
  if (yaml.problems().empty()) return map;
  std::string all;
  for (const std::string& problem : yaml.problems()) all += (all.empty() ? "" : "\n") + problem;
  return refused(all);
}

Expected<RegisterMap> read_register_map(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return refused(path + ": can't be read");
  std::ostringstream text;
  text << stream.rdbuf();
  if (stream.bad() || text.fail()) return refused(path + ": can't be read");
  if (text.tellp() > kLongestFile) return refused(path + ": is longer than 1 MiB, which no register map is");
  return parse_register_map(text.str(), path);
}

}  // namespace bodeflow::drive::modbus
