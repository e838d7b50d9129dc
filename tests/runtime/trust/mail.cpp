// Sends or takes one text through the transport, as a host of a lab: `mail post|receive FOLDER HOST DOMAIN SECONDS [TEXT]`;
// FOLDER - is a stranger without security. Prints the text, "posted", "nothing", or why it could not join.
#include <algorithm>
#include <cstdio>
#include <string>

#include "transport/link.hpp"
#include "trust/security.hpp"

using namespace bodeflow;

namespace {

std::string run(const std::string& what, const std::string& folder, const std::string& host, unsigned domain, double seconds,
                const std::string& text) {
  transport::Settings settings;
  settings.domain = domain;
  settings.carrier = transport::Settings::Carrier::udp;
  settings.discovery = transport::Settings::Discovery::peers;
  settings.peers = {"127.0.0.1"};
  settings.interfaces = {"127.0.0.1"};
  settings.datagram = transport::kSmallestSecureDatagram;
  if (folder != "-") {
    auto security = trust::security_of(folder, host);
    if (!security) return security.error();
    settings.security = *security;
  }
  const auto participant = transport::join(settings);
  if (!participant) return participant.error();
  const std::string topic = "bodeflow/mail";
  if (what == "post") {
    const auto posted = transport::post(*participant, topic, text, seconds);
    return posted ? "posted" : "nothing";
  }
  const auto mailbox = transport::open_mailbox(*participant, topic);
  if (!mailbox) return mailbox.error().text;
  std::string all;
  int left = static_cast<int>(seconds * 10);
  while (left-- > 0)
    if (const auto received = (*mailbox)->receive(0.1)) {
      all += *received + " ";
      left = std::min(left, 10);  // others have another second
    }
  return all.empty() ? "nothing" : all;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) return 2;
  const std::string said =
      run(argv[1], argv[2], argv[3], static_cast<unsigned>(std::stoi(argv[4])), std::stod(argv[5]), argc > 6 ? argv[6] : "");
  std::printf("%s\n", said.c_str());
}
