#pragma once

#include <optional>

#include "topic_parameters.hpp"

namespace bodeflow::dds {

/// dds.publish: a stream becomes a topic.
class PublishBlock final : public Block {
 public:
  static constexpr In<Any> in{0, "in"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void deactivate() override;

 private:
  Topic topic_;
  StreamFacts facts_;
  std::vector<bf_part> parts_;
  std::optional<Transport::Writer> writer_;
};

}  // namespace bodeflow::dds
