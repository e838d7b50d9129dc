#pragma once

#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "plan/facts.hpp"
#include "plan/plan.hpp"

namespace bodeflow::test {

/// A phase made of stand-ins: blocks that only have ports and a resolve function.
class Net {
 public:
  using Resolve = std::function<tl::expected<Resolution, std::string>(const std::vector<StreamFacts>&)>;

  graph::Phase phase;
  /// Samples of delay that stream inputs have beyond what their blocks say.
  std::vector<std::pair<graph::End, std::uint64_t>> more_delay;

  /// A block with stream inputs, stream outputs, message inputs, message outputs; the line of its place counts from 1.
  int add(const std::string& name, std::vector<std::string> in, std::vector<std::string> out, Resolve resolve,
          std::vector<std::string> message_in = {}, std::vector<std::string> message_out = {});

  int source(const std::string& name, Rate rate, std::int64_t length = -1, std::uint32_t channels = 1);
  /// y[n] = f(x[n]).
  int gain(const std::string& name);
  /// Strictly proper: reads `delay` samples behind.
  int lag(const std::string& name, std::uint64_t delay = 1, std::vector<double> initial = {});
  int hold(const std::string& name, std::uint32_t factor);
  int decimate(const std::string& name, std::uint32_t factor);
  /// Two inputs, `in` and `feedback`; the output has the facts of the first that is known.
  int sum(const std::string& name);
  int sink(const std::string& name);
  /// One stream input, one message output `model`.
  int estimator(const std::string& name);
  /// One message input `model`, one message output `controller`.
  int designer(const std::string& name);

  BlockDescription& type(int block) { return types_[static_cast<std::size_t>(block)]; }

  /// "a.out" to "b.in", or "a" to "b" for the first ports.
  void connect(const std::string& from, const std::string& to);
  /// Message output to message input, or to "b.parameters".
  void tell(const std::string& from, const std::string& to, graph::Latency latency = {});

  tl::expected<plan::Facts, Problems> try_facts() const;
  /// Facts of a net that must have some.
  plan::Facts facts() const;
  tl::expected<plan::Plan, Problems> try_plan(const plan::PlanOptions& options = {}) const;
  plan::Plan plan(const plan::PlanOptions& options = {}) const;
  plan::Plan plan(std::int64_t chunk) const;

 private:
  graph::End find(const std::string& text, std::uint32_t kind, std::uint32_t direction) const;

  std::deque<BlockDescription> types_;
  std::vector<Resolve> resolves_;
};

/// A stream of f64.
StreamFacts stream(Rate rate, std::int64_t length = -1, std::uint32_t channels = 1);

/// One input, one output: `up` samples out for `down` in.
Net::Resolve siso(std::uint32_t up = 1, std::uint32_t down = 1, std::uint64_t delay = 0, std::vector<double> initial = {});

/// Runs the plan's steps on sample counts alone, for some chunks: every read must find its samples written, every write its
/// room, and after each chunk every block must have made its firings. Fails the test that calls it otherwise.
void check_order_of_work(const graph::Phase& phase, const plan::Facts& facts, const plan::Plan& plan);

/// The arena places of two buffers that live at the same time never overlap, unless one is an in-place output of the other.
void check_memory(const graph::Phase& phase, const plan::Plan& plan, const std::vector<graph::End>& kept = {});

/// The schedule of a loop as text: "a x2, b x2".
std::string text_of(const graph::Phase& phase, const plan::Step& step);

}  // namespace bodeflow::test
