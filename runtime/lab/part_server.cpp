// The process of one host's part: answers its launcher, runs its phases on a thread of their own.
#include "lab/part_server.hpp"

#include <fmt/format.h>

#include <deque>
#include <mutex>
#include <thread>

#include "graph/load.hpp"
#include "lab/channel.hpp"
#include "lab/facts_json.hpp"
#include "lab/look.hpp"
#include "lab/part_files.hpp"
#include "lab/part_run.hpp"
#include "phases/run.hpp"
#include "record/pacing.hpp"
#include "transport/service.hpp"

namespace bodeflow::lab {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr double kPoll_s = 0.05;
/// How often a side says that it is there.
constexpr double kBeat_s = 0.2;
/// A launcher that says nothing for so long is lost, until it has told the graph's tolerance.
constexpr double kLost_s = 10.0;

json problems_answer(const Problems& problems) { return {{"problems", to_json(problems)}}; }

class PartServer {
 public:
  PartServer(const PartTask& task, Registry& registry, const std::atomic<bool>& stop)
      : task_(task),
        registry_(registry),
        stop_(stop),
        topics_(task.settings, [this] { return !stop_ && !stop_phase_; }),
        services_([this](const std::string& block, int level, const std::string& text) {
          const std::lock_guard lock(mutex_);
          news_.push_back({{"event", "log"}, {"block", block}, {"level", level}, {"text", text}});
        }) {}

  ~PartServer() {
    stop_phase_ = true;
    join_work();
  }
  PartServer(const PartServer&) = delete;
  PartServer& operator=(const PartServer&) = delete;

  tl::expected<void, std::string> serve() {
    auto participant = transport::join(task_.settings);
    if (!participant) return tl::unexpected(participant.error());
    participant_ = *participant;
    services_.provide(BF_EXTENSION_TRANSPORT, &topics_.c());
    auto channel = Channel::open(participant_, task_.run, task_.host, false);
    if (!channel) return tl::unexpected(channel.error());
    channel_ = std::move(*channel);
    heard_ = Clock::now();
    if (auto connected = channel_->connect([this] { return here(); }); !connected)
      return tl::unexpected("the launcher is not there: " + connected.error());
    while (!dismissed_) {
      auto heard = channel_->hear(kPoll_s);
      if (!heard) return lost(heard.error());
      if (*heard) {
        heard_ = Clock::now();
        if (auto done = take(**heard); !done) return done;
      }
      if (auto told = tell(); !told) return lost(told.error());
      if (since_heard() > lost_s_) return lost(fmt::format("nothing was heard of the launcher for {} s", lost_s_));
    }
    if (fetched_) remove_folders(task_.directory);
    channel_->drain(2.0);
    return {};
  }

  bool hung() const { return hung_; }

 private:
  using Done = tl::expected<void, std::string>;

  double since_heard() const { return std::chrono::duration<double>(Clock::now() - heard_).count(); }
  bool here() const { return !stop_ && since_heard() < lost_s_; }
  Done say(const json& message) {
    return channel_->say(message, [this] { return here(); });
  }

  Done take(const Channel::Heard& heard) {
    if (heard.said.is_null()) {
      initial_.push_back(SharedRecord::copy(heard.bytes.data(), heard.bytes.size()));
      return {};
    }
    const std::string wish = heard.said.value("do", "");
    if (wish == "beat") return {};
    if (wish == "stop") {
      stop_phase_ = true;
      return {};
    }
    json answer;
    try {
      answer = answer_to(wish, heard.said);
    } catch (const std::exception& error) {
      answer = {{"error", fmt::format("host '{}': {}", task_.host, error.what())}};
    }
    if (answer.is_null()) return {};
    answer["answer"] = wish;
    answer["number"] = number_of(heard.said);
    return say(answer);
  }

  json answer_to(const std::string& wish, const json& said) {
    if (wish == "begin") return begin(said);
    if (wish == "bye") {
      dismissed_ = true;
      fetched_ = said.value("fetched", false);
      return nullptr;
    }
    if (wish == "close") return close(said);
    if (!directory_) return {{"error", fmt::format("host '{}' has no run to do '{}' for", task_.host, wish)}};
    if (wish == "phase") return make_phase(said);
    if (!part_) return {{"error", fmt::format("host '{}' has no phase to do '{}' for", task_.host, wish)}};
    if (wish == "resolve") return resolve(said);
    if (wish == "prepare") return prepare(said);
    if (wish == "connect") return connect(said);
    if (wish == "begin_at") return begin_at(said);
    if (wish == "leave") return leave(said);
    if (wish == "rejoin") return rejoin(said);
    if (wish == "go_on") return go_on(said);
    if (wish == "run") return run(said);
    return {{"error", fmt::format("host '{}' does not know what '{}' is", task_.host, wish)}};
  }

  json begin(const json& said) {
    auto graph = graph::load_text(said.at("graph").get<std::string>(), said.at("file").get<std::string>(), {}, registry_);
    if (!graph) return problems_answer(graph.error());
    graph_ = std::move(*graph);
    auto directory =
        record::RunDirectory::create({task_.directory, said.at("name").get<std::string>(), said.at("manifest")}, *graph_);
    if (!directory) return {{"error", directory.error()}};
    directory_ = std::move(*directory);
    services_.attach(*directory_);
    lost_s_ = said.at("tolerance_s").get<double>();
    vector_level_ = said.at("vector_level").get<std::uint32_t>();
    if (said.contains("chunk")) plan_.chunk = said["chunk"].get<std::int64_t>();
    if (said.contains("threads")) plan_.threads = said["threads"].get<int>();
    return {{"ok", true}};
  }

  json make_phase(const json& said) {
    phase_ = &graph_->phases.at(said.at("phase").get<std::size_t>());
    repeat_ = said.at("repeat").get<int>();
    complete_ = false;
    begin_s_ = 0.0;
    auto made = PartPhase::make(*phase_, task_.host, registry_, services_);
    if (!made) return problems_answer(made.error());
    part_ = std::move(*made);
    part_->on_gap([this](const std::string& connection, const Gap& gap) {
      const auto time_s = [&](std::uint64_t sample) { return static_cast<double>(sample) / gap.rate.hz(); };
      const std::lock_guard lock(mutex_);
      news_.push_back({{"event", "gap"},
                       {"connection", connection},
                       {"first", gap.first},
                       {"count", gap.count},
                       {"from_s", time_s(gap.first)},
                       {"to_s", time_s(gap.first + gap.count)},
                       {"epoch", gap.epoch}});
    });
    return {{"ok", true}};
  }

  json resolve(const json& said) {
    auto resolution = part_->resolve(said.at("block").get<std::string>(), stream_facts_from(said.at("inputs")));
    if (!resolution) return {{"refused", resolution.error()}};
    return {{"resolution", to_json(*resolution)}};
  }

  json prepare(const json& said) {
    auto prepared = part_->prepare(facts_from(said.at("facts")), phases::plan_options(*phase_, plan_), services_);
    if (!prepared) return problems_answer(prepared.error());
    return {{"chunk", part_->periods_of_a_chunk()}, {"period_s", part_->seconds_of(1)}};
  }

  json connect(const json& said) {
    join_work();
    stop_phase_ = false;
    work_ = in_background(said, [this, links = links_of(said)] {
      return part_->connect(participant_, links, repeat_, [this] { return !stop_ && !stop_phase_; });
    });
    return nullptr;
  }

  static std::int64_t number_of(const json& said) { return said.value("number", std::int64_t{0}); }

  /// The launcher is answered when it is done.
  template <class Work>
  std::thread in_background(const json& said, Work work) {
    return std::thread([this, wish = said.at("do"), number = number_of(said), work = std::move(work)] {
      const auto done = work();
      json answer = {{"answer", wish}, {"number", number}, {"ok", true}};
      if (!done) answer = {{"answer", wish}, {"number", number}, {"error", done.error()}};
      const std::lock_guard lock(mutex_);
      news_.push_back(std::move(answer));
    });
  }

  static LinksName links_of(const json& said) {
    return {said.at("links").get<std::string>(), said.at("epoch").get<std::uint32_t>()};
  }

  /// Of a part that goes on for a lost one.
  json begin_at(const json& said) {
    const auto period = said.at("period").get<std::int64_t>();
    if (auto begun = part_->begin_at(period); !begun) return problems_answer(begun.error());
    begin_s_ = part_->seconds_of(period);
    directory_->note_restart({{"phase", phase_->name}, {"host", task_.host}, {"begin_s", begin_s_}});
    return {{"begin_s", begin_s_}};
  }

  json leave(const json& said) {
    const auto host = said.at("host").get<std::string>();
    end_rejoining();
    if (!running_ && part_->is_linked_to(host)) return {{"error", "its phase has ended there"}};
    const auto period = part_->leave(host);
    if (!period) return {{"error", period.error()}};
    return {{"period", *period}};
  }

  json rejoin(const json& said) {
    end_rejoining();
    rejoining_ = in_background(said, [this, host = said.at("host").get<std::string>(), links = links_of(said)] {
      return part_->rejoin(host, participant_, links, repeat_, [this] { return !stop_ && !stop_phase_ && !rejoins_no_more_; });
    });
    return nullptr;
  }

  /// Waits no longer for a part that may have been lost itself.
  void end_rejoining() {
    rejoins_no_more_ = true;
    if (rejoining_.joinable()) rejoining_.join();
    rejoins_no_more_ = false;
  }

  json go_on(const json& said) {
    if (rejoining_.joinable()) rejoining_.join();
    const auto gone_on = part_->go_on(said.at("host").get<std::string>(), said.at("period").get<std::int64_t>(),
                                      [this] { return !stop_ && !stop_phase_; });
    if (!gone_on) return {{"error", gone_on.error()}};
    return {{"ok", true}};
  }

  json run(const json& said) {
    join_work();
    std::vector<execute::InitialRecord> initial;
    for (const json& to : said.at("initial")) {
      const std::size_t index = initial.size();
      initial.push_back({{to.at(0).get<int>(), to.at(1).get<int>()}, initial_.at(index)});
    }
    initial_.clear();
    execute::Options options = phases::execution_of(*phase_, *services_.host());
    options.seed = said.at("seed").get<std::uint64_t>();
    options.vector_level = vector_level_;
    options.stop = &stop_phase_;
    options.observer = &look_;
    options.progress = [this](const execute::Progress& now) {
      const std::lock_guard lock(mutex_);
      progress_ = now;
    };
    running_ = true;
    work_ = std::thread([this, initial = std::move(initial), options = std::move(options)] {
      execute::Outcome outcome = part_->run(initial, *directory_, *services_.host(), repeat_, options);
      if (const std::string kept = record::pacing_text(record::pacing_json(phase_->run, outcome)); !kept.empty())
        services_.host()->log("clock", BF_LOG_INFO, kept);
      const std::lock_guard lock(mutex_);
      outcome_ = std::move(outcome);
    });
    return nullptr;
  }

  void join_work() {
    if (work_.joinable()) work_.join();
    if (rejoining_.joinable()) rejoining_.join();
  }

  /// News, the end of a phase, and five times a second how things stand.
  Done tell() {
    std::deque<json> news;
    std::optional<execute::Outcome> outcome;
    execute::Progress progress;
    {
      const std::lock_guard lock(mutex_);
      news.swap(news_);
      outcome.swap(outcome_);
      progress = progress_;
    }
    if (stop_) stop_phase_ = true;
    for (const json& one : news)
      if (auto said = say(one); !said) return said;
    if (outcome) return tell_end(*outcome);
    if (std::chrono::duration<double>(Clock::now() - told_).count() < kBeat_s) return {};
    told_ = Clock::now();
    json state = {{"event", "state"},
                  {"time_s", begin_s_ + progress.time_s},
                  {"total_s", begin_s_ + progress.total_s},
                  {"rate", progress.rate}};
    if (running_) {
      state["links"] = part_->links();
      state["pacing"] = pacing();
    }
    return say(state);
  }

  /// How the phase has kept time so far.
  json pacing() const {
    const auto now = look_.state();
    if (!now) return nullptr;
    execute::Outcome so_far;
    so_far.overruns = now->overruns;
    so_far.skipped = now->skipped;
    so_far.lateness = now->lateness;
    return record::pacing_json(phase_->run, so_far);
  }

  Done tell_end(const execute::Outcome& outcome) {
    join_work();
    running_ = false;
    complete_ = outcome.status == execute::Outcome::Status::complete;
    if (outcome.hung) part_->abandon();
    hung_ = hung_ || outcome.hung;
    json ended = {{"event", "ended"},
                  {"complete", outcome.status == execute::Outcome::Status::complete},
                  {"interrupted", outcome.interrupted},
                  {"limit", outcome.limit >= 0},
                  {"block", outcome.failed_block < 0 ? "" : part_->name(outcome.failed_block)},
                  {"reason", outcome.reason},
                  {"time_s", begin_s_ + outcome.time_s},
                  {"wall_s", outcome.wall_s},
                  {"pacing", record::pacing_json(phase_->run, outcome)},
                  {"links", part_->links()}};
    std::vector<SharedRecord> records;
    ended["records"] = json::array();
    for (const auto& [block, port] : part_->outputs()) {
      SharedRecord last = directory_->last_record(phase_->name, block, port);
      if (!last) continue;
      ended["records"].push_back({block, port});
      records.push_back(std::move(last));
    }
    if (auto said = say(ended); !said) return said;
    for (const SharedRecord& record : records) {
      const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(record.bytes()), record.size());
      if (auto sent = channel_->send(bytes, [this] { return here(); }); !sent) return sent;
    }
    return {};
  }

  /// Closes the run directory and sends its files. All hosts have ended their phases: nobody reads from our links any more.
  json close(const json& said) {
    if (!directory_) return {{"files", json::array()}};
    part_.reset();
    const auto closed = directory_->close(said.at("status").get<std::string>(), said.at("reason").get<std::string>());
    const std::vector<PartFile> files = files_of(task_.directory);
    json list = json::array();
    for (const PartFile& file : files) list.push_back({file.name, file.size});
    json answer = {{"answer", "close"}, {"files", list}};
    if (!closed) answer["error"] = closed.error();
    if (!say(answer)) return nullptr;
    const auto send = [this](std::span<const std::byte> piece) {
      heard_ = Clock::now();
      return channel_->send(piece, [this] { return here(); }).has_value();
    };
    for (const PartFile& file : files)
      if (!read_in_pieces(file, send)) break;
    return nullptr;
  }

  /// What a part does that nobody leads any more: it ends its phase, or lets it end, and keeps what there is.
  Done lost(const std::string& why) {
    if (running_ && !phase_->run.survives_launcher) stop_phase_ = true;
    join_work();
    if (outcome_) complete_ = outcome_->status == execute::Outcome::Status::complete;
    const bool complete = complete_ && phase_ == &graph_->phases.back();
    if (part_ && complete_) part_->drain([this] { return !stop_; });
    if (directory_) (void)directory_->close(complete ? "complete" : "partial", "the launcher was lost: " + why);
    return tl::unexpected(fmt::format("{}; what was recorded is in '{}'", why, task_.directory.string()));
  }

  const PartTask& task_;
  Registry& registry_;
  const std::atomic<bool>& stop_;
  std::mutex mutex_;  ///< of news, outcome, progress
  std::deque<json> news_;
  std::optional<execute::Outcome> outcome_;
  execute::Progress progress_;
  Look look_;
  transport::Service topics_;  ///< of blocks; outlives them
  phases::Services services_;
  std::shared_ptr<transport::Participant> participant_;
  std::unique_ptr<Channel> channel_;
  Clock::time_point heard_, told_;
  double lost_s_ = kLost_s;
  bool dismissed_ = false, running_ = false, hung_ = false;
  bool fetched_ = false;  ///< the launcher has all files of the run

  phases::PlanSettings plan_;
  std::uint32_t vector_level_ = 1;
  std::optional<graph::Graph> graph_;
  std::unique_ptr<record::RunDirectory> directory_;
  const graph::Phase* phase_ = nullptr;
  int repeat_ = 0;
  bool complete_ = false;  ///< the phase
  std::vector<SharedRecord> initial_;
  std::atomic<bool> stop_phase_{false}, rejoins_no_more_{false};
  std::thread work_, rejoining_;
  double begin_s_ = 0.0;  ///< in the phase: later than its begin for a part that goes on for a lost one
  std::unique_ptr<PartPhase> part_;
};

}  // namespace

int serve_part(const PartTask& task, Registry& registry, const std::atomic<bool>& stop) {
  PartServer server(task, registry, stop);
  const auto served = server.serve();
  if (!served) fmt::print(stderr, "{}\n", served.error());
  if (server.hung()) std::_Exit(1);
  return served ? 0 : 1;
}

}  // namespace bodeflow::lab
