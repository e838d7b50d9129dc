#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "transport/link.hpp"

namespace bodeflow::lab {

/// What the launcher of a run and one host's part of it say to each other: JSON in both directions, in order, and bytes of files.
class Channel {
 public:
  /// The launcher's side, or the part's. `run` and `host` name the channel.
  static tl::expected<std::unique_ptr<Channel>, std::string> open(const std::shared_ptr<transport::Participant>& participant,
                                                                  const std::string& run, const std::string& host, bool launcher);

  /// Waits until the other side is there. Error: why not.
  tl::expected<void, std::string> connect(const transport::GoOn& go_on);

  struct Heard {
    nlohmann::json said;  ///< null: bytes
    std::vector<std::byte> bytes;
  };
  /// What came, or nothing after `seconds`. Error: the other side is lost.
  tl::expected<std::optional<Heard>, std::string> hear(double seconds);
  tl::expected<void, std::string> say(const nlohmann::json& message, const transport::GoOn& go_on);
  tl::expected<void, std::string> send(std::span<const std::byte> bytes, const transport::GoOn& go_on);
  /// Waits until all that was said is taken.
  void drain(double seconds);

 private:
  tl::expected<void, std::string> give(transport::Kind kind, std::span<const std::byte> bytes, const transport::GoOn& go_on);

  std::unique_ptr<transport::Outlet> outlet_;
  std::unique_ptr<transport::Inlet> inlet_;
};

/// Processes for one host's part of a run, at most: the first and those that go on for a lost one.
inline constexpr int kMostParts = 4;
/// The name of a part's process: that of the run, and its epoch: how often parts of the run had been started again then.
std::string part_name(const std::string& run, int epoch);

/// The links of a run between its parts: a name for all of them, and how often a part was started again before.
struct LinksName {
  std::string name;
  std::uint32_t epoch = 0;
};

/// The edge of a cut: phase and repetition count on.
transport::Edge edge_of(const LinksName& links, const std::string& phase, int repeat, std::size_t cut, double tolerance_s,
                        std::uint64_t queue_bytes);

}  // namespace bodeflow::lab
