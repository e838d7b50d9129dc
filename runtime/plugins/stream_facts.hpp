#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "plugins/instance.hpp"

namespace bodeflow {

/// The bf_stream_facts of owned facts; valid while these live unchanged.
class FactsView {
 public:
  explicit FactsView(const std::vector<StreamFacts>& facts);
  const bf_stream_facts* data() const { return c_.data(); }

 private:
  std::vector<bf_stream_facts> c_;
  std::vector<std::vector<const char*>> names_;
  std::vector<std::vector<bf_note>> notes_;
};

/// An owned copy of what a block filled in for stream output `port`. Error: what is impossible about it.
tl::expected<StreamFacts, std::string> owned(const bf_stream_facts& facts, const std::string& port);

/// An owned copy of how a block says that a port moves data. `facts`: of an input, null for an output (which has no delay).
tl::expected<Flow, std::string> owned(const bf_flow& flow, const StreamFacts* facts, const std::string& port);

}  // namespace bodeflow
