#pragma once

#include <algorithm>
#include <map>
#include <mutex>

#include "lab/channel.hpp"
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
  tl::expected<void, std::string> connect(const std::shared_ptr<transport::Participant>& participant, const LinksName& links,
                                          int repeat, const transport::GoOn& go_on);

  /// Before it runs, of a part that goes on for a lost one: it begins at this period of the phase, as if that were the first.
  tl::expected<void, Problems> begin_at(std::int64_t period);
  /// Called by the run's threads when samples of a connection are missing.
  void on_gap(std::function<void(const std::string& connection, const Gap&)> tell) { tell_gap_ = std::move(tell); }

  /// [while it runs] Lets go of the links to a lost host, and is patient with all others until go_on: the first period of the
  /// phase at which a new part of the lost one can begin. Error: why it can't.
  tl::expected<std::int64_t, std::string> leave(const std::string& host);
  /// [while it runs] Opens links to the new part of the host; returns when they are there.
  tl::expected<void, std::string> rejoin(const std::string& host, const std::shared_ptr<transport::Participant>& participant,
                                         const LinksName& links, int repeat, const transport::GoOn& go_on);
  /// [while it runs] Uses them: the new part begins at that period.
  tl::expected<void, std::string> go_on(const std::string& host, std::int64_t period, const transport::GoOn& go_on);
  bool is_linked_to(const std::string& host) const {
    return std::any_of(links_.begin(), links_.end(), [&](const Link& link) { return link.host == host; });
  }
  std::int64_t periods_of_a_chunk() const { return layout_.periods; }
  double seconds_of(std::int64_t period) const { return static_cast<double>(period) * part_.facts.period.hz(); }

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
    PartEnd end;
    std::shared_ptr<StreamEnd> stream;  ///< null: of records
    NewLink next;                       ///< to a part that is started again, until it begins
  };

  transport::Edge edge(const PartEnd& end, const LinksName& links, int repeat) const;
  tl::expected<NewLink, std::string> new_link(const PartEnd& end, const std::shared_ptr<transport::Participant>& participant,
                                              const transport::Edge& edge, const transport::GoOn& go_on) const;
  tl::expected<void, std::string> open(const PartEnd& end, const std::shared_ptr<transport::Participant>& participant,
                                       const transport::Edge& edge, const transport::GoOn& go_on);
  /// Samples in a period of the phase.
  std::int64_t samples_of(const PartEnd& end) const {
    return std::max<std::int64_t>(1, part_.facts.blocks[static_cast<std::size_t>(end.block)].repetitions);
  }

  graph::Phase whole_;
  std::string host_;
  std::map<std::string, std::unique_ptr<Instance>> made_;
  Layout layout_;
  Part part_;
  plan::Plan plan_;
  std::vector<std::unique_ptr<Instance>> instances_;
  std::map<int, std::shared_ptr<execute::RemoteEnd>> ends_;
  mutable std::mutex links_mutex_;  ///< of links_ while the phase runs
  std::vector<Link> links_;
  std::function<void(const std::string&, const Gap&)> tell_gap_;
};

}  // namespace bodeflow::lab
