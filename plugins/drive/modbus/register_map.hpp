#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace bodeflow::drive::modbus {

enum class Encoding { int16, uint16, int32, uint32, float32 };
/// Which word of a value of 32 bits stands at the lower address.
enum class WordOrder { high_first, low_first };
enum class Table { holding, input };
enum class Access { read, write, both };

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// One quantity of a drive: value = scale x number in the registers.
struct Register {
  std::string name;
  std::string unit = "1";
  int address = 0;  ///< as on the wire, from 0
  Table table = Table::holding;
  Encoding encoding = Encoding::uint16;
  WordOrder order = WordOrder::high_first;
  Access access = Access::read;
  double scale = 1.0;
  double minimum = -kUnlimited;  ///< limits, in the unit
  double maximum = kUnlimited;
  double safe = 0.0;  ///< written while the drive is not enabled

  int words() const { return encoding == Encoding::int16 || encoding == Encoding::uint16 ? 1 : 2; }
  bool readable() const { return access != Access::write; }
  bool writable() const { return access != Access::read; }
};

/// A register, by its place in RegisterMap::registers, and a value in its unit.
struct RegisterValue {
  std::size_t place = 0;
  double value = 0.0;
};

/// The buffer in which a drive records by itself: `samples` times one value a channel, sample by sample.
struct TraceBuffer {
  std::optional<std::size_t> arm;  ///< 1 is written to it to begin
  std::size_t done = 0;            ///< reads 1 when the buffer is full
  double rate_hz = 0.0;
  std::int64_t samples = 0;
  int address = 0;
  Table table = Table::holding;
  std::vector<Register> channels;  ///< addresses are not used

  int words_per_sample() const;
};

/// What the registers of a drive mean.
struct RegisterMap {
  std::string file;  ///< for messages
  std::string device;
  double fastest_poll_hz = 0.0;
  std::vector<Register> registers;
  std::vector<RegisterValue> identity;      ///< what these registers must read
  std::vector<RegisterValue> setup;         ///< written and read back before the drive is enabled
  std::optional<RegisterValue> standstill;  ///< below that magnitude the motor stands
  std::optional<TraceBuffer> trace;

  /// The register of that name, or nothing.
  std::optional<std::size_t> find(const std::string& name) const;
  /// Names of the registers that can be written, or read.
  std::vector<std::string> names(bool writable) const;
};

/// Names of registers with a meaning of their own.
inline constexpr const char* kControlword = "controlword";
inline constexpr const char* kStatusword = "statusword";
inline constexpr const char* kFaultCode = "fault_code";
inline constexpr const char* kWatchdog = "watchdog";

/// "speed (holding register 0x0032)".
std::string name_of(const Register& r);
const char* name_of(Encoding encoding);

}  // namespace bodeflow::drive::modbus
