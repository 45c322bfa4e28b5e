// The master's own network port: interfaces of the kernel, in a network of the test's own.

#include <string>

#include "ecat/transport/raw_socket.hpp"
#include "tests/troubles/own_network.hpp"
#include "tests/troubles/trouble.hpp"

namespace taktwerk::troubles {

namespace {

using namespace ecat;

Said said_at_opening(const std::string& interface) {
    const auto opened = RawSocketTransport::open(interface);
    if (opened) return {};
    const Error& error = opened.error();
    return {error.code, error.subject, error.what, error.remedy, {}};
}

/// As udev does with a card in another slot.
Said renamed_at_start() {
    lay_cable();
    shell("ip link set port0 down && ip link set port0 name enp3s0");
    return said_at_opening("port0");
}

Said switched_off_at_start() {
    lay_cable();
    shell("ip link set port0 down");
    return said_at_opening("port0");
}

Said taken_at_start() {
    lay_cable();
    const auto first = RawSocketTransport::open("port0");
    return said_at_opening("port0");
}

}  // namespace

Chapter network_port() {
    return {"The network port of the controller",
            "`run` and every `bus` command open it first.",
            {{.name = "Interface renamed or gone before the start",
              .staged = "port0 is called enp3s0 now",
              .teller = Teller::port,
              .opens = renamed_at_start,
              .id = "transport.no_such_interface",
              .place = "network interface port0",
              .cause = "there is no network interface of this name",
              .remedy = "enp3s0"},
             {.name = "Interface switched off before the start",
              .staged = "`ip link set port0 down`",
              .teller = Teller::port,
              .opens = switched_off_at_start,
              .id = "transport.interface_down",
              .place = "network interface port0",
              .cause = "it is switched off",
              .remedy = "ip link set port0 up"},
             {.name = "Interface taken by another process",
              .staged = "a master of ours works on it already",
              .teller = Teller::port,
              .opens = taken_at_start,
              .id = "transport.in_use",
              .place = "network interface port0",
              .cause = "another Taktwerk is the master on it (process",
              .remedy = "end that process"}}};
}

}  // namespace taktwerk::troubles
