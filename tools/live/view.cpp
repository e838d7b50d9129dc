#include "live/view.hpp"

#include <fmt/format.h>
#include <openssl/crypto.h>

#include <algorithm>
#include <random>
#include <thread>

#include "live/fragments.hpp"
#include "live/page.hpp"
#include "live/state_json.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::live {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostMessages = 100, kMostText = 2000;
/// Who has not asked for so long does not look on any more.
constexpr std::chrono::seconds kGone{3};
constexpr const char* kHtml = "text/html; charset=utf-8";
constexpr int kBadRequest = 400, kForbidden = 403, kNotFound = 404, kConflict = 409;

/// 128 bits from the system.
std::string random_word() {
  std::random_device random;
  std::string word;
  for (int i = 0; i < 4; ++i) word += fmt::format("{:08x}", random());
  return word;
}

bool same(const std::string& a, const std::string& b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

/// Names and messages may hold any bytes.
Reply json_reply(const ordered_json& json, int status = 200) {
  return {status, "application/json", json.dump(-1, ' ', false, ordered_json::error_handler_t::replace), ""};
}

Reply refused(int status, const std::string& why) { return json_reply({{"error", why}}, status); }

const char* clock_word(graph::Clock clock) {
  switch (clock) {
    case graph::Clock::realtime:
      return "realtime";
    case graph::Clock::hardware:
      return "hardware";
    default:
      return "simulated";
  }
}

}  // namespace

View::View(const graph::Graph& graph)
    : title_(graph.title.empty() ? std::filesystem::path(graph.file).stem().string() : graph.title),
      clock_(graph.phases.empty() ? "" : clock_word(graph.phases.front().run.clock)),
      token_(random_word()),
      nonce_(random_word()) {}

tl::expected<std::unique_ptr<View>, std::string> View::open(int port, const graph::Graph& graph) {
  std::unique_ptr<View> view(new View(graph));
  auto server = Server::open(port, view->routes());
  if (!server) return tl::unexpected(server.error());
  view->server_ = std::move(*server);
  return view;
}

View::~View() {
  const auto until = Clock::now() + kGrace;
  const auto awaited = [this] {
    const std::lock_guard lock(mutex_);
    return ended_ && !end_seen_ && asked_ && Clock::now() - *asked_ < kGone;
  };
  while (server_ && awaited() && Clock::now() < until) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

std::string View::address() const { return fmt::format("http://127.0.0.1:{}/#{}", server_->port(), token_); }

void View::begins(const std::filesystem::path& directory) {
  const std::lock_guard lock(mutex_);
  status_ = "running";
  directory_ = directory.string();
}

void View::log(const std::string& source, int level, const std::string& text) {
  if (level < BF_LOG_INFO) return;
  const std::lock_guard lock(mutex_);
  const char* word = level >= BF_LOG_ERROR ? "bad" : level >= BF_LOG_WARNING ? "warning" : "info";
  log_.push_back({source, report::shortened(text, kMostText), word});
  if (log_.size() > kMostMessages) log_.pop_front();
}

void View::ends(const std::string& status, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  status_ = status;
  reason_ = reason;
  ended_ = true;
}

std::vector<Route> View::routes() {
  return {{"GET", "/", [this](const Request&) { return page(); }},
          {"GET", "/state", [this](const Request& request) { return state(request); }},
          {"GET", "/graph", [this](const Request&) { return graph_drawing(); }},
          {"GET", "/record", [this](const Request& request) { return record(request); }},
          {"POST", "/change", [this](const Request& request) { return change(request); }}};
}

Reply View::page() const { return {200, kHtml, page_html(title_, nonce_), nonce_}; }

Reply View::state(const Request& request) {
  ordered_json json;
  {
    const std::lock_guard lock(mutex_);
    asked_ = Clock::now();
    if (ended_ && request.key == "seen") {
      end_seen_ = true;
      return json_reply(ordered_json::object());
    }
    json["title"] = title_;
    json["status"] = status_;
    json["reason"] = reason_;
    json["ended"] = ended_;
    json["directory"] = directory_;
    json["clock"] = clock_;
    json["wall_s"] = std::chrono::duration<double>(Clock::now() - opened_).count();
    json["log"] = ordered_json::array();
    for (const Message& message : log_)
      json["log"].push_back({{"source", message.source}, {"level", message.level}, {"text", message.text}});
  }
  json.update(to_json(watch_.look()));
  for (auto& record : json["records"]) record["kind"] = report::kind_of(record["type"].get<std::string>());
  return json_reply(json);
}

Reply View::graph_drawing() {
  const observe::Look look = watch_.look();
  if (!look.facts) return refused(kNotFound, "no phase has begun");
  return {200, kHtml, graph_fragment(*look.facts->phase), ""};
}

Reply View::record(const Request& request) {
  const observe::Look look = watch_.look();
  const auto found =
      std::find_if(look.records.begin(), look.records.end(), [&](const auto& record) { return record.key == request.key; });
  if (found == look.records.end()) return refused(kNotFound, "no such record");
  {
    const std::lock_guard lock(mutex_);
    const auto drawn = drawn_.find(found->key);
    if (drawn != drawn_.end() && drawn->second.version == found->version) return {200, kHtml, drawn->second.html, ""};
  }
  std::string html = record_fragment(found->key, found->record);
  const std::lock_guard lock(mutex_);
  drawn_[found->key] = {found->version, html};
  return {200, kHtml, std::move(html), ""};
}

Reply View::change(const Request& request) {
  if (!same(request.token, token_)) return refused(kForbidden, "no right to change: open the address that the command printed");
  const auto json = ordered_json::parse(request.body, nullptr, false);
  const auto is_text = [&](const char* key) { return json.contains(key) && json[key].is_string(); };
  if (!json.is_object() || json.size() != 4 || !json.contains("generation") || !json["generation"].is_number_unsigned() ||
      !is_text("block") || !is_text("parameter") || !is_text("value"))
    return refused(kBadRequest, "allowed: {\"generation\": number, \"block\": text, \"parameter\": text, \"value\": text}");
  const auto accepted = watch_.ask(json["generation"].get<std::uint64_t>(), json["block"].get<std::string>(),
                                   json["parameter"].get<std::string>(), json["value"].get<std::string>());
  if (!accepted) return refused(kConflict, accepted.error());
  return json_reply({{"accepted", true}});
}

}  // namespace bodeflow::tools::live
