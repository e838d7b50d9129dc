#pragma once

#include <bodeflow/abi.h>

#include <bodeflow/base_model.hpp>
#include <bodeflow/effect.hpp>
#include <cstddef>

/// Situations, parameters and places on their way across the border of a plugin: `borrowed` gives the C struct that points into a
/// value, `owned` copies one.
namespace bodeflow::detail {

inline std::string text(const char* c) { return c == nullptr ? std::string() : std::string(c); }

inline bf_numbers borrowed(std::span<const double> values) { return {values.data(), values.size()}; }
inline bf_numbers borrowed(const std::vector<double>& values) { return {values.data(), values.size()}; }
inline bf_numbers borrowed(const std::vector<std::complex<double>>& values) {
  return {reinterpret_cast<const double*>(values.data()), 2 * values.size()};
}
inline std::vector<double> owned(const bf_numbers& c) {
  return c.count == 0 ? std::vector<double>() : std::vector<double>(c.values, c.values + c.count);
}
inline std::vector<std::complex<double>> owned_complex(const bf_numbers& c) {
  std::vector<std::complex<double>> values(c.count / 2);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = {c.values[2 * i], c.values[2 * i + 1]};
  return values;
}

inline bf_fit_parameter borrowed(const FitParameter& p) {
  const std::uint32_t flags =
      (p.logarithmic ? std::uint32_t{BF_FIT_LOGARITHMIC} : 0u) | (p.each_record ? std::uint32_t{BF_FIT_EACH_RECORD} : 0u);
  return {sizeof(bf_fit_parameter), flags, p.name.c_str(), p.unit.c_str(), p.doc.c_str(), p.low, p.high, p.scale};
}
inline FitParameter owned(const bf_fit_parameter& c) {
  FitParameter p;
  p.name = text(c.name);
  p.unit = text(c.unit);
  p.doc = text(c.doc);
  p.low = c.low;
  p.high = c.high;
  p.scale = c.scale;
  p.logarithmic = (c.flags & BF_FIT_LOGARITHMIC) != 0;
  p.each_record = (c.flags & BF_FIT_EACH_RECORD) != 0;
  return p;
}

inline bf_place borrowed(const Place& p) {
  return {sizeof(bf_place),
          0,
          p.name.c_str(),
          p.kind.c_str(),
          p.flow_unit.c_str(),
          p.stored_unit.c_str(),
          p.reaction_unit.c_str(),
          p.coefficient,
          p.flow,
          p.stored,
          p.effort};
}
inline Place owned(const bf_place& c) {
  Place p;
  p.name = text(c.name);
  p.kind = text(c.kind);
  p.flow_unit = text(c.flow_unit);
  p.stored_unit = text(c.stored_unit);
  p.reaction_unit = text(c.reaction_unit);
  p.coefficient = c.coefficient;
  p.flow = c.flow;
  p.stored = c.stored;
  p.effort = c.effort;
  return p;
}

// Handed over as they are: a copy would cost more than many a law.
static_assert(sizeof(Signals) == sizeof(bf_signals) && sizeof(Reaction) == sizeof(bf_reaction),
              "the same doubles in the same order");
static_assert(offsetof(Signals, stored) == offsetof(bf_signals, stored) &&
                  offsetof(Signals, time_s) == offsetof(bf_signals, time_s) &&
                  offsetof(Signals, step_s) == offsetof(bf_signals, step_s) &&
                  offsetof(Signals, gain) == offsetof(bf_signals, gain) &&
                  offsetof(Reaction, by_flow) == offsetof(bf_reaction, by_flow) &&
                  offsetof(Reaction, by_stored) == offsetof(bf_reaction, by_stored),
              "the same doubles in the same order");
inline const bf_signals* borrowed(const Signals& s) { return reinterpret_cast<const bf_signals*>(&s); }
inline const Signals& owned(const bf_signals& c) { return reinterpret_cast<const Signals&>(c); }
inline bf_reaction* borrowed(Reaction& r) { return reinterpret_cast<bf_reaction*>(&r); }

inline bf_measured_response borrowed(const MeasuredResponse& m) {
  return {sizeof(bf_measured_response), 0, borrowed(m.frequency_hz), borrowed(m.response), borrowed(m.weight), borrowed(m.known)};
}
inline MeasuredResponse owned(const bf_measured_response& c) {
  return {owned(c.frequency_hz), owned_complex(c.response), owned(c.weight), owned(c.known)};
}

/// The C struct of a situation, which lives unchanged at least as long.
class BorrowedSituation {
 public:
  explicit BorrowedSituation(const Situation& s)
      : place_(borrowed(s.place)),
        c_{sizeof(bf_situation),
           0,
           s.input_unit.c_str(),
           s.output_unit.c_str(),
           s.sample_time_s,
           s.duration_s,
           s.input_peak,
           s.input_rms,
           s.output_peak,
           s.output_rms,
           s.residual_mean,
           s.residual_rms,
           &place_,
           borrowed(s.line_hz),
           borrowed(s.response),
           borrowed(s.missing),
           borrowed(s.missing_std),
           borrowed(s.peaks_hz),
           borrowed(s.jumps_s)} {}
  BorrowedSituation(const BorrowedSituation&) = delete;
  BorrowedSituation& operator=(const BorrowedSituation&) = delete;
  const bf_situation* c() const { return &c_; }

 private:
  bf_place place_;
  bf_situation c_;
};

inline Situation owned(const bf_situation& c) {
  Situation s;
  s.input_unit = text(c.input_unit);
  s.output_unit = text(c.output_unit);
  s.sample_time_s = c.sample_time_s;
  s.duration_s = c.duration_s;
  s.input_peak = c.input_peak;
  s.input_rms = c.input_rms;
  s.output_peak = c.output_peak;
  s.output_rms = c.output_rms;
  s.residual_mean = c.residual_mean;
  s.residual_rms = c.residual_rms;
  if (c.place != nullptr) s.place = owned(*c.place);
  s.line_hz = owned(c.line_hz);
  s.response = owned_complex(c.response);
  s.missing = owned_complex(c.missing);
  s.missing_std = owned(c.missing_std);
  s.peaks_hz = owned(c.peaks_hz);
  s.jumps_s = owned(c.jumps_s);
  return s;
}

}  // namespace bodeflow::detail
