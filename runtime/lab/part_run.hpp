#pragma once

#include <map>

#include "lab/remote_blocks.hpp"
#include "phases/services.hpp"
#include "record/run_directory.hpp"

namespace bodeflow::lab {

/// One phase of a run on one host: its blocks are made, resolved one by one as the launcher asks, then run.
class PartPhase {
 public:
  /// Makes and configures the blocks of `phase` that lie on `host`.
  static tl::expected<std::unique_ptr<PartPhase>, Problems> make(const graph::Phase& phase, const std::string& host,
                                                                 Registry& registry, const phases::Services& services);

  tl::expected<Resolution, std::string> resolve(const std::string& block, const std::vector<StreamFacts>& inputs);

  /// Lays the phase out, plans this host's part. What its blocks have to say goes to `services`.
  tl::expected<void, Problems> prepare(const plan::Facts& facts, const plan::PlanOptions& options,
                                       const phases::Services& services);

  /// Opens the links to the other hosts; returns when all of them are there. Error: who is not.
  tl::expected<void, std::string> connect(const std::shared_ptr<transport::Participant>& participant, const std::string& run,
                                          int repeat, const transport::GoOn& go_on);

  /// Runs the part to its end. `initial` names inputs in the whole phase; what its limits tell goes to `services`.
  execute::Outcome run(const std::vector<execute::InitialRecord>& initial, record::RunDirectory& directory,
                       const HostServices& services, int repeat, execute::Options options);

  /// Waits until the other hosts have what was sent to them, or are lost.
  void drain(const transport::GoOn& go_on);
  /// The links as they are, for people: name, direction and state.
  nlohmann::json links() const;
  /// Message outputs of this host's blocks, as block and port names.
  std::vector<std::pair<std::string, std::string>> outputs() const;
  const std::string& name(int block) const { return part_.phase.blocks[static_cast<std::size_t>(block)].name; }
  /// A thread hangs in a block: its instances must not be destroyed.
  void abandon();

 private:
  struct Link {
    std::string name, host;
    bool sends = false;
    transport::Outlet* outlet = nullptr;
    const transport::Inlet* inlet = nullptr;
  };

  tl::expected<void, std::string> open(const PartEnd& end, const std::shared_ptr<transport::Participant>& participant,
                                       const transport::Edge& edge, const transport::GoOn& go_on);

  graph::Phase whole_;
  std::string host_;
  std::map<std::string, std::unique_ptr<Instance>> made_;
  Layout layout_;
  Part part_;
  plan::Plan plan_;
  std::vector<std::unique_ptr<Instance>> instances_;
  std::map<int, std::shared_ptr<execute::RemoteEnd>> ends_;
  std::vector<Link> links_;
};

}  // namespace bodeflow::lab
