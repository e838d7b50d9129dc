#pragma once

#include <deque>
#include <map>

#include "lab/channel.hpp"
#include "record/run_directory.hpp"

namespace bodeflow::lab {

/// One host of a run in the eyes of its launcher: what was asked, answered and told.
class HostPart {
 public:
  using Log = std::function<void(const std::string& host, const std::string& block, int level, const std::string& text)>;

  /// A host that says nothing for `lost_s` is lost: it says something twice a second.
  HostPart(std::string name, std::unique_ptr<Channel> channel, double lost_s, Log log);

  const std::string& name() const { return name_; }
  /// "host 'bench'", or "this machine".
  std::string title() const;

  /// Hears for at most `seconds`. Error: the host is lost, with the reason.
  tl::expected<void, std::string> hear(double seconds);
  /// Each wish is numbered: an answer to an earlier one is dropped.
  tl::expected<void, std::string> say(nlohmann::json message);
  tl::expected<void, std::string> send(std::span<const std::byte> bytes);
  /// The answer to what was asked last, once it is there.
  std::optional<nlohmann::json> take_answer();
  Channel& channel() { return *channel_; }

  /// The last state that it told: time, links.
  const nlohmann::json& state() const { return state_; }
  /// How its phase ended, once it has; with the last records of its outputs.
  const nlohmann::json& ended() const { return ended_; }
  bool has_ended() const { return !ended_.is_null() && records_.size() >= ended_["records"].size(); }
  const std::vector<SharedRecord>& records() const { return records_; }
  /// Before a phase runs.
  void forget_end();
  /// It has said something.
  bool was_heard() const { return was_heard_; }
  /// Seconds since it said something, or since it is waited for.
  double silent_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - heard_).count(); }
  /// Samples that are missing on its connections, told since the last call: {"connection", "first", "count", "from_s",
  /// "to_s", "epoch"}.
  std::vector<nlohmann::json> take_gaps() { return std::exchange(gaps_, {}); }

  /// Files that come are written below this folder, which is made.
  void collect_into(std::filesystem::path folder) { folder_ = std::move(folder); }
  bool collected() const { return closed_ && next_file_ == files_.size(); }
  /// Names of the files, relative.
  std::vector<std::string> files() const;
  const std::string& close_error() const { return close_error_; }

 private:
  struct File {
    std::string name;
    std::uint64_t size = 0, written = 0;
  };

  tl::expected<void, std::string> take(Channel::Heard heard);
  tl::expected<void, std::string> take_bytes(std::span<const std::byte> bytes);
  void begin_files(const nlohmann::json& list);
  void skip_empty();

  std::string name_;
  std::unique_ptr<Channel> channel_;
  double lost_s_;
  Log log_;
  std::chrono::steady_clock::time_point heard_;
  bool was_heard_ = false;
  std::int64_t wishes_ = 0;
  std::optional<nlohmann::json> answer_;
  nlohmann::json state_, ended_;
  std::vector<SharedRecord> records_;
  std::vector<nlohmann::json> gaps_;
  std::filesystem::path folder_;
  std::vector<File> files_;
  std::size_t next_file_ = 0;
  bool closed_ = false;
  std::string close_error_;
};

}  // namespace bodeflow::lab
