#pragma once

#include <bodeflow/block.hpp>
#include <string>

namespace bodeflow::filters {

/// y[n] = gain x[n], channel by channel.
class Gain final : public Block {
 public:
  static constexpr In<Any> in{0, "in"};
  static constexpr Out<Any> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override { vector_level_ = a.vector_level; }
  void process(Io& io) override;
  void change(const Parameters& p) override;

 private:
  template <class T>
  void multiply(Io& io) const;

  double gain_ = 1.0;
  int vector_level_ = 1;
  bool has_unit_ = false;
  std::string unit_;
};

}  // namespace bodeflow::filters
