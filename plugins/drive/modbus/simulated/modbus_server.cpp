#include "modbus_server.hpp"

#include <modbus/modbus.h>
#include <netinet/in.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace bodeflow::drive::simulated {
namespace {

using numerics::Expected;
using numerics::refused;

constexpr int kRegisters = 65536;
constexpr int kMostRead = 125, kMostWritten = 123;
constexpr int kClients = 8;
constexpr double kLongestStep = 0.05;  // s
constexpr int kTick = 1;               // ms between two looks at the clock
constexpr auto kSlow = std::chrono::milliseconds(30);

int word_at(const std::uint8_t* bytes) { return bytes[0] << 8 | bytes[1]; }

}  // namespace

ModbusServer::ModbusServer(_modbus* context, int unit_id, bool is_tcp)
    : context_(context), mapping_(modbus_mapping_new(0, 0, kRegisters, 0)), unit_id_(unit_id), is_tcp_(is_tcp) {
  if (mapping_ == nullptr) throw std::bad_alloc();
  modbus_set_slave(context_, unit_id);
}

ModbusServer::~ModbusServer() {
  close_all();
  if (other_end_ >= 0) ::close(other_end_);
  modbus_set_socket(context_, -1);
  modbus_mapping_free(mapping_);
  modbus_free(context_);
}

Expected<std::unique_ptr<ModbusServer>> ModbusServer::tcp(const std::string& address, int port, int unit_id) {
  _modbus* context = modbus_new_tcp(address.c_str(), port);
  if (context == nullptr) return refused("address " + address + ": " + modbus_strerror(errno));
  std::unique_ptr<ModbusServer> server(new ModbusServer(context, unit_id, true));
  server->listener_ = modbus_tcp_listen(context, kClients);
  if (server->listener_ < 0) return refused(address + ":" + std::to_string(port) + ": " + modbus_strerror(errno));
  sockaddr_in name{};
  socklen_t size = sizeof name;
  if (::getsockname(server->listener_, reinterpret_cast<sockaddr*>(&name), &size) == 0) server->port_ = ntohs(name.sin_port);
  return server;
}

Expected<std::unique_ptr<ModbusServer>> ModbusServer::rtu(int unit_id) {
  int ours = -1, theirs = -1;
  char path[64] = {};
  termios raw{};
  cfmakeraw(&raw);
  cfsetspeed(&raw, B19200);
  if (::openpty(&ours, &theirs, path, &raw, nullptr) != 0)
    return refused(std::string("pseudo terminal: ") + std::strerror(errno));
  _modbus* context = modbus_new_rtu(path, 19200, 'N', 8, 1);
  if (context == nullptr) return refused(std::string("pseudo terminal: ") + modbus_strerror(errno));
  std::unique_ptr<ModbusServer> server(new ModbusServer(context, unit_id, false));
  server->sockets_ = {ours};
  server->other_end_ = theirs;
  server->line_ = path;
  return server;
}

void ModbusServer::disturb(Disturbance kind, int count) {
  const std::lock_guard lock(mutex_);
  kind_ = kind;
  left_ = count;
}

void ModbusServer::close_all() {
  for (const int socket : sockets_) ::close(socket);
  sockets_.clear();
  if (listener_ >= 0) ::close(listener_);
  listener_ = -1;
}

/// Lets as much time pass for the drive as has passed. Where this process did not run for long the drive stood still with it:
/// else its watchdog would trip on questions that lie here unread.
void ModbusServer::catch_up() {
  const auto now = Clock::now();
  drive_.advance(std::min(std::chrono::duration<double>(now - now_).count(), kLongestStep));
  now_ = now;
}

void ModbusServer::serve(const std::atomic<bool>& stop) {
  now_ = Clock::now();
  while (!stop) {
    {
      const std::lock_guard lock(mutex_);
      catch_up();
      if (kind_ == Disturbance::gone) close_all();
    }
    wait(kTick);
  }
}

void ModbusServer::wait(int milliseconds) {
  std::vector<pollfd> looked;
  if (listener_ >= 0) looked.push_back({listener_, POLLIN, 0});
  for (const int socket : sockets_) looked.push_back({socket, POLLIN, 0});
  if (::poll(looked.data(), looked.size(), milliseconds) <= 0) return;
  for (const pollfd& one : looked) {
    if (one.revents == 0) continue;
    if (one.fd == listener_) {
      accept_client();
    } else {
      answer(one.fd);
    }
  }
}

void ModbusServer::accept_client() {
  const int socket = modbus_tcp_accept(context_, &listener_);
  if (socket < 0) return;
  if (sockets_.size() < kClients) {
    sockets_.push_back(socket);
  } else {
    ::close(socket);
  }
}

void ModbusServer::drop(int socket) {
  ::close(socket);
  sockets_.erase(std::remove(sockets_.begin(), sockets_.end(), socket), sockets_.end());
}

void ModbusServer::answer(int socket) {
  std::uint8_t question[MODBUS_MAX_ADU_LENGTH];
  modbus_set_socket(context_, socket);
  const int length = modbus_receive(context_, question);
  if (length < 0 && is_tcp_) return drop(socket);
  if (length <= 0) return;
  const std::lock_guard lock(mutex_);
  catch_up();
  if (!disturbed(socket, question, length)) reply(question, length);
}

void ModbusServer::reply(const std::uint8_t* question, int length) {
  const int header = modbus_get_header_length(context_);
  const std::uint8_t* body = question + header;  // function, address, count or value
  const auto refuse = [&](unsigned code) { modbus_reply_exception(context_, question, code); };
  if (is_tcp_ && question[header - 1] != unit_id_) return refuse(MODBUS_EXCEPTION_GATEWAY_TARGET);
  drive_.heard();
  const int function = body[0], address = word_at(body + 1);
  std::uint16_t words[kMostWritten];
  int count = 1;
  if (function == MODBUS_FC_READ_HOLDING_REGISTERS) {
    if (const int code = read_exception(address, word_at(body + 3)); code != 0) return refuse(static_cast<unsigned>(code));
  } else if (function == MODBUS_FC_WRITE_SINGLE_REGISTER || function == MODBUS_FC_WRITE_MULTIPLE_REGISTERS) {
    const std::uint8_t* values = body + 3;
    if (function == MODBUS_FC_WRITE_MULTIPLE_REGISTERS) {
      count = word_at(body + 3);
      values = body + 6;
    }
    if (count < 1 || count > kMostWritten || values + 2 * count > question + length)
      return refuse(MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE);
    for (int i = 0; i < count; ++i) words[i] = static_cast<std::uint16_t>(word_at(values + 2 * i));
    const auto written = drive_.write(address, words, count);
    if (written == SimulatedDrive::Written::no_such_register) return refuse(MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS);
    if (written == SimulatedDrive::Written::bad_value) return refuse(MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE);
  } else {
    return refuse(MODBUS_EXCEPTION_ILLEGAL_FUNCTION);
  }
  modbus_reply(context_, question, length, mapping_);
}

/// The exception of a question for registers, 0 where they are in the mapping now.
int ModbusServer::read_exception(int address, int count) {
  if (count < 1 || count > kMostRead) return MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;
  for (int at = address; at < address + count; ++at) {
    const auto word = drive_.read(at);
    if (!word || at >= kRegisters) return MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS;
    mapping_->tab_registers[at] = *word;
  }
  return 0;
}

void ModbusServer::send_raw(int socket, const std::uint8_t* bytes, std::size_t count) const {
  if (is_tcp_) {
    [[maybe_unused]] const auto sent = ::send(socket, bytes, count, MSG_NOSIGNAL);
  } else {
    [[maybe_unused]] const auto sent = ::write(socket, bytes, count);
  }
}

/// An answer of the right length whose checksum (RTU) or number of the question (TCP) is wrong.
void ModbusServer::send_damaged(int socket, const std::uint8_t* question) const {
  const int header = modbus_get_header_length(context_);
  const std::uint8_t* body = question + header;
  std::vector<std::uint8_t> answer;
  if (body[0] == MODBUS_FC_READ_HOLDING_REGISTERS) {
    answer = {body[0], static_cast<std::uint8_t>(2 * body[4])};
    answer.resize(2 + 2 * static_cast<std::size_t>(body[4]));
  } else {
    answer.assign(body, body + 5);
  }
  answer.insert(answer.begin(), question[header - 1]);
  if (is_tcp_) {
    const std::uint8_t front[] = {question[0], static_cast<std::uint8_t>(question[1] ^ 0x55U), 0, 0,
                                  0,           static_cast<std::uint8_t>(answer.size())};
    answer.insert(answer.begin(), std::begin(front), std::end(front));
  } else {
    answer.insert(answer.end(), {0x12, 0x34});
  }
  send_raw(socket, answer.data(), answer.size());
}

bool ModbusServer::disturbed(int socket, const std::uint8_t* question, int) {
  if (kind_ == Disturbance::none || left_ == 0) return false;
  if (left_ > 0) --left_;
  const int header = modbus_get_header_length(context_);
  const std::uint8_t unit = question[header - 1], function = question[header];
  switch (kind_) {
    case Disturbance::slow:
      std::this_thread::sleep_for(kSlow);
      return false;
    case Disturbance::exception:
      modbus_reply_exception(context_, question, MODBUS_EXCEPTION_SLAVE_OR_SERVER_FAILURE);
      return true;
    case Disturbance::half_frame: {
      const std::uint8_t tcp[] = {question[0], question[1], 0, 0, 0, 9, unit, function, 6}, rtu[] = {unit, function, 6, 1};
      send_raw(socket, is_tcp_ ? tcp : rtu, is_tcp_ ? sizeof tcp : sizeof rtu);
      return true;
    }
    case Disturbance::damaged:
      send_damaged(socket, question);
      return true;
    case Disturbance::reset: {
      if (!is_tcp_) return true;
      const linger at_once{1, 0};
      ::setsockopt(socket, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
      drop(socket);
      return true;
    }
    default:
      return true;
  }
}

}  // namespace bodeflow::drive::simulated
