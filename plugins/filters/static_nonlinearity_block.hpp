#pragma once

#include <bodeflow/block.hpp>
#include <string>
#include <vector>

namespace bodeflow::filters {

/// filters.static_nonlinearity: a polynomial of each sample, then limits.
class StaticNonlinearity final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;

 private:
  std::vector<double> coefficients_;
  double least_ = 0.0, greatest_ = 0.0;
  std::string unit_;
  bool has_unit_ = false;
};

}  // namespace bodeflow::filters
