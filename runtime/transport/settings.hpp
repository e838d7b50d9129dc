#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bodeflow::transport {

/// Why a call of the transport did not do what it was asked.
struct Failure {
  enum class Kind {
    stopped,    ///< the caller's GoOn said no
    tolerance,  ///< nothing came or went for the edge's tolerance
    peer,       ///< the other side has gone for good, or said why it ends
    refused,    ///< what came does not belong to this edge: another stream, element, channels, rate
    library     ///< Fast DDS refused
  };
  Kind kind = Kind::library;
  std::string text;
};

/// Asked at least every 50 ms while a call waits. False: the call returns with Failure::Kind::stopped.
using GoOn = std::function<bool()>;

/// Files of DDS-Security for one participant, in PEM; see `bodeflow trust`.
struct Security {
  std::filesystem::path authority;    ///< certificate of the lab's authority: identities and permissions
  std::filesystem::path certificate;  ///< of this participant
  std::filesystem::path key;
  std::filesystem::path governance;   ///< signed (smime)
  std::filesystem::path permissions;  ///< signed (smime)
  std::filesystem::path revocations;  ///< list of certificates that are no longer trusted, read once at the join; empty: none
};

/// With security, UDP datagrams may be this large at least, whatever Settings::datagram says: Fast DDS 2.9 sends each message of
/// the handshake, with certificate and permissions, in one piece, and never matches where that does not fit.
inline constexpr std::uint32_t kSmallestSecureDatagram = 7300;

/// How a process takes part.
struct Settings {
  enum class Discovery { multicast, peers, server };
  enum class Carrier { automatic, udp, tcp, shared_memory };  ///< automatic: shared memory on a host, UDP between hosts

  std::string name = "bodeflow";  ///< of the participant, shown by others
  std::uint32_t domain = 0;
  Discovery discovery = Discovery::multicast;
  /// `address` or `address:port`; with Discovery::server the servers (port 11811). Over TCP a process listens on the first free
  /// of 5100 + 8 * domain and the seven ports after it; a peer without a port is the first. Fast DDS never
  /// connects two that name each other at the same time over TCP, and now and then not to one that is just joining; peers see
  /// those only whom they name or who name them, so that more than two processes need a server there.
  std::vector<std::string> peers;
  Carrier carrier = Carrier::automatic;
  std::vector<std::string> interfaces;  ///< IP addresses of the interfaces to use; empty: all
  std::uint32_t datagram = 1400;        ///< bytes in a UDP datagram, at most: larger ones do not live through loss
  double lease_s = 30.0;                ///< a participant that is silent for this long has gone; beyond every edge's tolerance
  std::optional<Security> security;
};

}  // namespace bodeflow::transport
