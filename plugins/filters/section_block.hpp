#pragma once

#include <bodeflow/block.hpp>
#include <optional>
#include <string>
#include <vector>

#include "filter_bank.hpp"

namespace bodeflow::filters {

/// A block whose filters are sections: what such blocks share. A block says which filters it has at a sample rate; each of them
/// goes over each channel of the input.
class SectionBlock : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};
  static constexpr MessageOut filter{0, "filter"};

  void resolve(Facts& f) final;
  void advise(const Facts& f, Advice& a) final;
  void activate(const Activation& a) final;
  void process(Io& io) final;
  void finish(Io& io) final;
  void reset() final;

 protected:
  /// Ports and claims.
  static void describe_ports(Describe& d);

  /// The filters for streams of that rate, at least one. Fails with what is wrong and what is allowed.
  virtual std::vector<BankFilter> design(double rate_hz) const = 0;
  /// Of the design, for its record: "elliptic band pass of order 8".
  virtual std::string kind() const = 0;

 private:
  void name_outputs(const StreamFacts& x, StreamFacts& y) const;

  std::vector<BankFilter> filters_;
  double rate_hz_ = 0.0;
  std::size_t channels_ = 0;
  int vector_level_ = 1;
  std::optional<FilterBank> bank_;
  std::vector<const double*> x_;
  std::vector<double*> y_;
};

/// "edges: 600 Hz lies above ..." where a frequency is not between 0 and half the rate; all is well: nothing.
void require_below_nyquist(const std::string& parameter, double frequency_hz, double rate_hz);

}  // namespace bodeflow::filters
