#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "phases/excitation.hpp"

namespace bodeflow::tools {

/// What of a phase is outside of the run: devices and topics of the network with their parameters, the signals that they get and
/// give, the limits of these, and the largest excitation of each input; then the limits of other signals. Its arguments outlive
/// it.
class DeviceList {
 public:
  DeviceList(const graph::Phase& phase, const phases::Prepared& prepared, phases::Excitations excitations)
      : phase_(phase), prepared_(prepared), excitations_(std::move(excitations)) {}

  /// Whether anything is outside.
  bool any() const;
  /// "" where there is nothing to tell.
  std::string text() const;
  /// {"devices": [...], "limits": [...]}: all limits of the phase.
  nlohmann::ordered_json json() const;

 private:
  bool is_outside(std::size_t block) const { return phases::is_outside(phase_.blocks[block]); }
  const StreamFacts& stream(const graph::End& end, bool input) const;
  std::string signal_text(const graph::End& end, bool input) const;
  std::string limits_text(const graph::End& end, bool input) const;
  std::string input_text(const phases::DeviceInput& input) const;
  std::string extremes_text(const phases::Excitation& excitation) const;
  std::string bounded_text(const graph::End& end) const;
  std::string device_text(std::size_t block) const;
  nlohmann::ordered_json device_json(std::size_t block) const;
  nlohmann::ordered_json signal_json(const graph::End& end, bool input) const;
  nlohmann::ordered_json input_json(const phases::DeviceInput& input) const;
  const phases::DeviceInput* input_of(const graph::End& end) const;

  const graph::Phase& phase_;
  const phases::Prepared& prepared_;
  phases::Excitations excitations_;
};

}  // namespace bodeflow::tools
