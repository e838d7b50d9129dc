#pragma once

#include <bodeflow/block.hpp>
#include <cstdint>
#include <memory>

#include "axis.hpp"

namespace bodeflow::drive {

/// drive.axis: motor and load with a coupling between them.
class AxisBlock final : public Block {
 public:
  static constexpr In<double> torque{0, "torque"};
  static constexpr In<double> compensation{1, "compensation"};
  static constexpr In<double> load_torque{2, "load_torque"};
  static constexpr Out<double> speed{0, "speed"};
  static constexpr Out<double> position{1, "position"};
  static constexpr Out<double> load_speed{2, "load_speed"};
  static constexpr Out<double> load_position{3, "load_position"};
  static constexpr MessageIn properties{0, "properties"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void process(Io& io) override;
  void reset() override;

 private:
  struct Setup {
    AxisParameters parameters;
    AxisPhysics physics;
    double flutter = 0.0;
  };
  void make_axis();
  void advance(Io& io, std::size_t n);

  Setup given_, setup_;
  double flutter_hz_ = 0.7;
  double sample_s_ = 1e-3;
  std::unique_ptr<Axis> axis_;
  std::uint64_t samples_ = 0;
};

}  // namespace bodeflow::drive
