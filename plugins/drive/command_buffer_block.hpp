#pragma once

#include <bodeflow/block.hpp>
#include <vector>

namespace bodeflow::drive {

/// drive.command_buffer: commands out of a buffer, earlier by a time that can be set.
class CommandBuffer final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void change(const Parameters& p) override;
  void reset() override;

 private:
  std::size_t samples_ = 1;
  double lead_s_ = 0.0;
  double rate_hz_ = 1.0;
  std::vector<std::vector<double>> past_;  // rings of samples_ + 2, one a channel
  std::size_t newest_ = 0;
};

}  // namespace bodeflow::drive
