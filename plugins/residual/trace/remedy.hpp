#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bodeflow::residual {

/// What a drive can do against an effect that was found.
struct RemedyKind {
  const char* effect;     ///< "dead_time"
  const char* value;      ///< the parameter of the effect that says how much
  const char* parameter;  ///< live parameter of the block that remedies it
  bool positive;          ///< a value below 0 is nothing that it can do
  /// An effect that acts like it behind the plant's steady gain, with a parameter of the same name; "": none.
  const char* twin = "";
};

inline constexpr RemedyKind kRemedies[] = {
    {"delay", "delay", "lead", true},
    {"dead_time", "dead_time_voltage", "compensation_time", true},
    {"offset", "offset", "correction", false, "input_offset"},
    {"coulomb_friction", "coulomb_friction", "torque", true},
};

/// An effect that was named, as far as a remedy asks.
struct NamedEffect {
  std::string name;  ///< without its place
  std::string place;
  std::vector<std::string> parameter_names;
  std::vector<double> values;
};

/// How much the remedy has to do for what was named, `factor` times the effect's parameter; nothing where that effect was not
/// named, stands in another place than `place` ("" for any), or is beyond what the remedy can do.
std::optional<double> remedy_value(const RemedyKind& kind, const std::vector<NamedEffect>& named, double factor,
                                   const std::string& place);

/// What is remedied, and by how much.
struct Remedied {
  std::string effect;  ///< as it was named
  double value = 0.0;
};
/// The same where the twin of the effect may have been named in its stead: its parameter times `steady_gain`, of the output by a
/// constant input. Nothing of a twin where that gain is 0 or not finite (a plant that integrates).
std::optional<Remedied> remedied(const RemedyKind& kind, const std::vector<NamedEffect>& named, double factor,
                                 const std::string& place, double steady_gain);

/// "1.02 us", "0.0131 Nm": times below a millisecond in us.
std::string amount_text(double value, const std::string& unit);

/// "dead-time compensation of 1.02 us" ...: what is switched on, as a part of a sentence.
std::string remedy_words(const RemedyKind& kind, double value, const std::string& unit);

}  // namespace bodeflow::residual
