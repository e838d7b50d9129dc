#pragma once

#include <optional>

#include "topic_parameters.hpp"

namespace bodeflow::dds {

/// dds.publish_records: records become messages of a topic.
class PublishRecordsBlock final : public Block {
 public:
  static constexpr MessageIn in{0, "in"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void receive(int message_port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void deactivate() override;

 private:
  Topic topic_;
  std::optional<Transport::Writer> writer_;
};

}  // namespace bodeflow::dds
