#pragma once

#include <bodeflow/block.hpp>
#include <optional>
#include <string>

#include "measured.hpp"
#include "method.hpp"

namespace bodeflow::sanathanan_koerner {

/// What the blocks have in common that fit all responses with one denominator: ports, and the way from record to record.
class IdentifierBlock : public Block {
 public:
  static constexpr MessageIn response{0, "response"};
  static constexpr MessageIn repeat{1, "repeat"};
  static constexpr MessageOut model{0, "model"};
  static constexpr MessageOut order_scan{1, "order_scan"};
  static constexpr MessageOut residual{2, "residual"};

  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 protected:
  /// Ports, and the parameters of read_common.
  static void describe_common(Describe& d);
  void read_common(const Parameters& p, Settings& s);

  virtual std::string id() const = 0;
  virtual Settings settings_for(const Measured& measured) const = 0;

 private:
  Selection selection_;
  std::optional<Measured> measured_, repeated_;
};

}  // namespace bodeflow::sanathanan_koerner
