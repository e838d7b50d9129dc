// The only file that includes cpp-httplib.
#include "live/server.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <httplib.h>
#include <signal.h>

#include "live/connection.hpp"
#include "live/pool.hpp"

namespace bodeflow::tools::live {
namespace {

constexpr std::size_t kThreads = 4, kMostWaiting = 16;
constexpr int kBadRequest = 400, kForbidden = 403, kNotAllowed = 405, kUnsupported = 415, kServerError = 500;

/// A bounded connection as httplib takes it.
class HttpStream final : public httplib::Stream {
 public:
  explicit HttpStream(Connection& connection) : connection_(connection) {}
  bool is_readable() const override { return connection_.readable(); }
  bool is_writable() const override { return true; }
  ssize_t read(char* to, std::size_t size) override { return connection_.read(to, size); }
  ssize_t write(const char* from, std::size_t size) override { return connection_.write(from, size); }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return connection_.socket(); }

 private:
  Connection& connection_;
};

class HttpPool final : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> job) override { pool_.add(std::move(job)); }
  void shutdown() override { pool_.finish(); }

 private:
  Pool pool_{kThreads, kMostWaiting};
};

/// httplib's own reading of a socket has no end: a byte now and then keeps a thread for good.
class HttpServer final : public httplib::Server {
 public:
  void close_connections() { closing_ = true; }

 private:
  bool process_and_close_socket(socket_t socket) override {
    Connection connection(socket, live::Server::kMostRequest, live::Server::kMostTime_s, closing_);
    HttpStream stream(connection);
    bool closed = false;
    return process_request(stream, true, closed, nullptr);
  }

  std::atomic<bool> closing_{false};
};

/// httplib ignores SIGPIPE for the whole process; our connections need no such thing.
std::unique_ptr<HttpServer> make_server() {
  struct sigaction before = {};
  sigaction(SIGPIPE, nullptr, &before);
  auto server = std::make_unique<HttpServer>();
  sigaction(SIGPIPE, &before, nullptr);
  return server;
}

/// One listener a port: httplib lets several share one otherwise.
void own_port(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  fcntl(socket, F_SETFD, FD_CLOEXEC);
}

void reply_with(httplib::Response& response, Reply reply) {
  response.status = reply.status;
  response.set_header("Cache-Control", "no-store");
  response.set_header("X-Content-Type-Options", "nosniff");
  response.set_header("Referrer-Policy", "no-referrer");
  response.set_header("Cross-Origin-Resource-Policy", "same-origin");
  response.set_header(
      "Content-Security-Policy",
      fmt::format("default-src 'none'; script-src {}; style-src 'unsafe-inline'; img-src data:; connect-src 'self'; "
                  "base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
                  reply.script_nonce.empty() ? "'none'" : "'nonce-" + reply.script_nonce + "'"));
  if (reply.body.empty()) return;
  // What has a provider is not compressed: that would cost more than it saves on the way to the same machine.
  auto body = std::make_shared<std::string>(std::move(reply.body));
  response.set_content_provider(body->size(), reply.type, [body](std::size_t at, std::size_t count, httplib::DataSink& sink) {
    return sink.write(body->data() + at, count);
  });
}

void refuse(httplib::Response& response, int status, const std::string& text) {
  reply_with(response, {status, "text/plain; charset=utf-8", text + "\n", ""});
}

/// False, and refused: not a request of ours.
bool is_ours(const httplib::Request& request, httplib::Response& response, int port) {
  const auto no = [&](int status, const std::string& text) {
    refuse(response, status, text);
    return false;
  };
  const std::string local = fmt::format("127.0.0.1:{}", port), name = fmt::format("localhost:{}", port);
  const std::string host = request.get_header_value("Host"), origin = request.get_header_value("Origin");
  if (request.get_header_value_count("Host") != 1 || (host != local && host != name))
    return no(kForbidden, "this server answers to " + local + " and " + name + " alone");
  if (request.has_header("Origin") && origin != "http://" + local && origin != "http://" + name)
    return no(kForbidden, "pages of another origin are not answered");
  if (request.method != "GET" && request.method != "POST") return no(kNotAllowed, "allowed: GET, POST");
  if (request.has_header("Range")) return no(kBadRequest, "no ranges");
  if (request.has_header("Content-Encoding")) return no(kUnsupported, "no compressed bodies");
  if (request.method == "POST" && request.get_header_value("Content-Type") != "application/json")
    return no(kUnsupported, "Content-Type: allowed is application/json");
  return true;
}

}  // namespace

struct Server::State {
  std::unique_ptr<HttpServer> http = make_server();
  std::unique_ptr<HttpPool> pool = std::make_unique<HttpPool>();
  int port = 0;
  std::thread thread;

  void configure(const std::vector<Route>& routes) {
    http->new_task_queue = [this] { return pool.release(); };  // httplib owns it from then on
    http->set_address_family(AF_INET);
    http->set_socket_options(own_port);
    http->set_payload_max_length(kMostRequest);
    http->set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      return is_ours(request, response, port) ? httplib::Server::HandlerResponse::Unhandled
                                              : httplib::Server::HandlerResponse::Handled;
    });
    for (const Route& route : routes) {
      const auto handler = [answer = route.answer](const httplib::Request& request, httplib::Response& response) {
        reply_with(response, answer({request.has_param("key") ? request.get_param_value("key") : "",
                                     request.get_header_value("X-Bodeflow-Token"), request.body}));
      };
      if (route.method == std::string("POST"))
        http->Post(route.path, handler);
      else
        http->Get(route.path, handler);
    }
    http->set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
      refuse(response, kServerError, "this request failed");
    });
  }

  bool bind(int wanted) {
    if (wanted == 0)
      port = http->bind_to_any_port("127.0.0.1");
    else
      port = http->bind_to_port("127.0.0.1", wanted) ? wanted : -1;
    return port > 0;
  }
};

Server::Server() : state_(new State) {}

tl::expected<std::unique_ptr<Server>, std::string> Server::open(int port, const std::vector<Route>& routes) {
  try {
    std::unique_ptr<Server> server(new Server);
    State& state = *server->state_;
    state.configure(routes);
    if (!state.bind(port))
      return tl::unexpected(port == 0 ? std::string("no port of 127.0.0.1 can be had")
                                      : fmt::format("port {} of 127.0.0.1 is taken, or not allowed to this user", port));
    state.thread = std::thread([&state] { state.http->listen_after_bind(); });
    while (!state.http->is_running()) std::this_thread::yield();  // only then can it be stopped
    return server;
  } catch (const std::exception& error) {
    return tl::unexpected(fmt::format("no server can be started: {}", error.what()));
  }
}

Server::~Server() {
  if (!state_->thread.joinable()) return;
  state_->http->close_connections();
  state_->http->stop();
  state_->thread.join();
}

int Server::port() const { return state_->port; }

}  // namespace bodeflow::tools::live
