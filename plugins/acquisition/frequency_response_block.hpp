#pragma once

#include <bodeflow/block.hpp>

#include "response_record.hpp"

namespace bodeflow::acquisition {

/// acquisition.frequency_response: one record with the frequency response that stands in a file.
class FrequencyResponseBlock final : public Block {
 public:
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void finish(Io& io) override;

 private:
  std::string path_;
  Response response_;
  ResponseCertainty certainty_;
};

}  // namespace bodeflow::acquisition
