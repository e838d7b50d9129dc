#pragma once

#include <optional>

#include "topic_parameters.hpp"

namespace bodeflow::dds {

/// dds.subscribe: a topic becomes a stream.
class SubscribeBlock final : public Block {
 public:
  static constexpr Out<Any> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;
  void deactivate() override;

 private:
  void take();
  void check_shape() const;
  void check_place();
  void copy(Io& io, std::size_t done, std::size_t samples);

  Topic topic_;
  StreamFacts facts_;
  std::optional<Transport::Reader> reader_;
  bf_topic_message message_{};
  std::uint64_t used_ = 0;                // samples of the message that were given out
  std::optional<std::int64_t> expected_;  // position of the next message
  std::int64_t skipped_ = 0;
  bool ended_ = false;
};

}  // namespace bodeflow::dds
