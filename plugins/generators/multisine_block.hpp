#pragma once

#include <bodeflow/block.hpp>
#include <string>
#include <vector>

#include "multisine.hpp"

namespace bodeflow::generators {

/// A periodic sum of cosines on chosen lines, computed once and played back.
class Multisine final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;

 private:
  std::vector<std::int64_t> lines_of(const Parameters& p) const;
  void require_within(std::int64_t line) const;

  Rate rate_;
  std::string unit_;
  std::int64_t period_length_ = 0;
  std::int64_t length_ = -1;
  std::vector<Line> lines_;
  bool random_phases_ = false;
  bool own_seed_ = false;
  std::uint64_t seed_ = 0;
  std::vector<double> period_;
};

}  // namespace bodeflow::generators
