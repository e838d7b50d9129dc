#include "quantiser.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "sampling.hpp"

namespace bodeflow::acquisition {

numerics::Expected<Quantiser> Quantiser::make(const ConverterSpec& spec) {
  Quantiser q;
  q.spec_ = spec;
  if (!(spec.high > spec.low) || !std::isfinite(spec.high - spec.low))
    return numerics::refused("the range " + number_text(spec.low) + " to " + number_text(spec.high) + " does not rise");
  if (!spec.bits) {
    if (!spec.missing_codes.empty()) return numerics::refused("missing codes without bits");
    if (!spec.nonlinearity_lsb.empty()) return numerics::refused("an integral nonlinearity without bits; it counts in LSB");
    return q;
  }
  const std::int64_t codes = std::int64_t{1} << *spec.bits;
  q.step_ = (spec.high - spec.low) / static_cast<double>(codes);
  q.highest_ = static_cast<double>(codes - 1);
  if (spec.nonlinearity_lsb.size() == 1)
    return numerics::refused("an integral nonlinearity of one point; at least two, over the range");
  for (const double lsb : spec.nonlinearity_lsb) {
    if (!std::isfinite(lsb)) return numerics::refused("an integral nonlinearity that is not finite");
  }
  std::vector<std::int64_t> missing = spec.missing_codes;
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  for (const std::int64_t code : missing) {
    if (code < 0 || code >= codes)
      return numerics::refused("missing code " + std::to_string(code) + "; codes are 0 to " + std::to_string(codes - 1));
  }
  if (static_cast<std::int64_t>(missing.size()) == codes) return numerics::refused("all codes are missing");
  for (const std::int64_t code : missing) {
    const bool joined = !q.missing_.empty() && q.missing_.back().code == static_cast<double>(code - 1);
    q.missing_.push_back({static_cast<double>(code), joined ? q.missing_.back().lower : static_cast<double>(code - 1), 0.0});
  }
  for (std::size_t i = q.missing_.size(); i-- > 0;) {
    const bool joined = i + 1 < q.missing_.size() && q.missing_[i + 1].code == q.missing_[i].code + 1;
    q.missing_[i].upper = joined ? q.missing_[i + 1].upper : q.missing_[i].code + 1;
  }
  return q;
}

/// In LSB, at a position of the range counted in codes.
double Quantiser::nonlinearity(double position) const {
  const std::vector<double>& table = spec_.nonlinearity_lsb;
  if (table.empty()) return 0.0;
  const double last = static_cast<double>(table.size() - 1);
  const double at = std::clamp(position / (highest_ + 1.0), 0.0, 1.0) * last;
  const auto i = static_cast<std::size_t>(std::min(std::floor(at), last - 1.0));
  const double t = at - static_cast<double>(i);
  return (1.0 - t) * table[i] + t * table[i + 1];
}

/// The code, or where it is missing the nearest that is not.
double Quantiser::available(double code, double position) const {
  const auto found =
      std::lower_bound(missing_.begin(), missing_.end(), code, [](const Missing& m, double c) { return m.code < c; });
  if (found == missing_.end() || found->code > code) return code;
  if (found->lower < 0.0) return found->upper;
  if (found->upper > highest_) return found->lower;
  return position - found->lower < found->upper - position ? found->lower : found->upper;
}

Converted Quantiser::convert(double v) const {
  const double analog = (1.0 + spec_.gain_error) * v + spec_.offset_error;
  if (!spec_.bits) return {std::clamp(analog, spec_.low, spec_.high), analog < spec_.low || analog > spec_.high};
  double position = (analog - spec_.low) / step_;
  position += nonlinearity(position);
  const double code = std::floor(position + 0.5), limited = std::clamp(code, 0.0, highest_);
  const bool clipped = code < limited || code > limited;
  return {spec_.low + available(limited, position) * step_, clipped};
}

}  // namespace bodeflow::acquisition
