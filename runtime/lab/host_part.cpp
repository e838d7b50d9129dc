#include "lab/host_part.hpp"

#include <fmt/format.h>

#include <fstream>

namespace bodeflow::lab {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Clock = std::chrono::steady_clock;
using Done = tl::expected<void, std::string>;

/// What a host may need to take what it is told.
constexpr double kTake_s = 10.0;

/// A relative path that stays below its folder.
bool stays_inside(const fs::path& name) {
  if (name.empty() || name.is_absolute()) return false;
  for (const fs::path& part : name)
    if (part == "..") return false;
  return true;
}

}  // namespace

HostPart::HostPart(std::string name, std::unique_ptr<Channel> channel, double lost_s, Log log)
    : name_(std::move(name)), channel_(std::move(channel)), lost_s_(lost_s), log_(std::move(log)), heard_(Clock::now()) {}

std::string HostPart::title() const { return name_.empty() ? "this machine's part" : fmt::format("host '{}'", name_); }

Done HostPart::hear(double seconds) {
  auto heard = channel_->hear(seconds);
  if (!heard) return tl::unexpected(fmt::format("{}: {}", title(), heard.error()));
  if (*heard) {
    heard_ = Clock::now();
    was_heard_ = true;
    return take(std::move(**heard));
  }
  if (silent_s() > lost_s_)
    return tl::unexpected(fmt::format("{} is lost: nothing was heard of it for {:.0f} s", title(), silent_s()));
  return {};
}

Done HostPart::take(Channel::Heard heard) {
  if (heard.said.is_null()) return take_bytes(heard.bytes);
  const json& said = heard.said;
  if (said.contains("answer")) {
    if (said["answer"] == "close") {
      close_error_ = said.value("error", "");
      begin_files(said.value("files", json::array()));
    } else if (said.value("number", std::int64_t{0}) == wishes_) {
      answer_ = said;
    }
    return {};
  }
  const std::string event = said.value("event", "");
  if (event == "log") {
    log_(name_, said.value("block", ""), said.value("level", 1), said.value("text", ""));
  } else if (event == "state") {
    state_ = said;
  } else if (event == "gap") {
    gaps_.push_back(said);
    gaps_.back().erase("event");
  } else if (event == "ended") {
    if (!said.contains("records") || !said["records"].is_array())
      return tl::unexpected(title() + " ended a phase without records");
    ended_ = said;
  }
  return {};
}

Done HostPart::take_bytes(std::span<const std::byte> bytes) {
  if (!closed_) {
    records_.push_back(SharedRecord::copy(bytes.data(), bytes.size()));
    return {};
  }
  skip_empty();
  if (next_file_ == files_.size()) return tl::unexpected(title() + " sent more than its files");
  File& file = files_[next_file_];
  const fs::path path = folder_ / file.name;
  std::ofstream out(path, std::ios::binary | (file.written == 0 ? std::ios::trunc : std::ios::app));
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) return tl::unexpected(fmt::format("can't write '{}'", path.string()));
  file.written += bytes.size();
  if (file.written > file.size) return tl::unexpected(fmt::format("{} sent more of '{}' than it has", title(), file.name));
  if (file.written == file.size) ++next_file_;
  skip_empty();
  return {};
}

void HostPart::begin_files(const json& list) {
  closed_ = true;
  for (const json& item : list) {
    if (!item.is_array() || item.size() != 2 || !item[0].is_string() || !item[1].is_number_unsigned()) continue;
    if (!stays_inside(item[0].get<std::string>())) continue;
    files_.push_back({item[0].get<std::string>(), item[1].get<std::uint64_t>()});
    std::error_code error;
    fs::create_directories((folder_ / files_.back().name).parent_path(), error);
  }
  skip_empty();
}

void HostPart::skip_empty() {
  while (next_file_ < files_.size() && files_[next_file_].size == 0) {
    std::ofstream(folder_ / files_[next_file_].name, std::ios::binary);
    ++next_file_;
  }
}

std::vector<std::string> HostPart::files() const {
  std::vector<std::string> names;
  for (const File& file : files_) names.push_back(file.name);
  return names;
}

Done HostPart::say(json message) {
  if (message["do"] != "beat") {
    message["number"] = ++wishes_;
    answer_.reset();
  }
  const auto until = Clock::now() + std::chrono::duration<double>(kTake_s);
  auto said = channel_->say(message, [&] { return Clock::now() < until; });
  if (!said) return tl::unexpected(fmt::format("{}: {}", title(), said.error()));
  return {};
}

Done HostPart::send(std::span<const std::byte> bytes) {
  const auto until = Clock::now() + std::chrono::duration<double>(kTake_s);
  auto sent = channel_->send(bytes, [&] { return Clock::now() < until; });
  if (!sent) return tl::unexpected(fmt::format("{}: {}", title(), sent.error()));
  return {};
}

std::optional<json> HostPart::take_answer() { return std::exchange(answer_, std::nullopt); }

void HostPart::forget_end() {
  ended_ = nullptr;
  records_.clear();
}

}  // namespace bodeflow::lab
