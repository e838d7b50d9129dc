#pragma once

#include <bodeflow/block.hpp>

#include "link.hpp"
#include "register_map.hpp"

namespace bodeflow::drive::modbus {

/// drive.modbus_trace: what a drive has recorded in its trace buffer, as a stream that ends.
class ModbusTraceBlock final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void reset() override { done_ = 0; }
  void deactivate() override { samples_.clear(); }

 private:
  RegisterMap map_;
  Endpoint endpoint_;
  std::vector<std::vector<double>> samples_;  // by channel
  std::int64_t done_ = 0;
};

}  // namespace bodeflow::drive::modbus
