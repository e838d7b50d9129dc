#pragma once

#include <array>
#include <bodeflow/block.hpp>

namespace bodeflow::filters {

/// y[n] = the weighted sum of two to four streams.
class Sum final : public Block {
 public:
  static constexpr In<Any> a{0, "a"};
  static constexpr In<Any> b{1, "b"};
  static constexpr In<Any> c{2, "c"};
  static constexpr In<Any> d{3, "d"};
  static constexpr std::array<In<Any>, 4> inputs{a, b, c, d};
  static constexpr Out<Any> out{0, "out"};

  static void describe(Describe& description);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;

 private:
  template <class T>
  void add(Io& io) const;

  std::array<double, 4> weights_{1.0, 1.0, 1.0, 1.0};
};

}  // namespace bodeflow::filters
