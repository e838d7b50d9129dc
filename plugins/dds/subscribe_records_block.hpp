#pragma once

#include <optional>

#include "topic_parameters.hpp"

namespace bodeflow::dds {

/// dds.subscribe_records: messages of a topic become records.
class SubscribeRecordsBlock final : public Block {
 public:
  static constexpr In<Any> pace{0, "pace"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;
  void deactivate() override;

 private:
  void hand_over(const bf_topic_message& message, Io& io);

  Topic topic_;
  std::int64_t limit_ = 0;
  std::optional<Transport::Reader> reader_;
  std::int64_t count_ = 0;
  bool ended_ = false;
};

}  // namespace bodeflow::dds
