#pragma once

#include <bodeflow/block.hpp>

namespace bodeflow::drive {

/// drive.encoder: position in counts and speed by differences.
class Encoder final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr MessageIn properties{0, "properties"};
  static constexpr Out<double> counts{0, "counts"};
  static constexpr Out<double> speed{1, "speed"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation&) override { reset(); }
  void receive(int port, const RecordView& record, Io& io) override;
  void process(Io& io) override;
  void reset() override;

 private:
  double counts_per_rad_ = 1.0;
  double declared_index_rad_ = 0.0, index_rad_ = 0.0;
  double rate_hz_ = 0.0;
  bool started_ = false;
  double last_ = 0.0;  // counts at the sample before
};

}  // namespace bodeflow::drive
