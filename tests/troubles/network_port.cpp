// The master's own network port: interfaces of the kernel, in a network of the test's own.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "ecat/transport/link_speed.hpp"
#include "tests/troubles/own_network.hpp"

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

/// What the kernel shows of a card whose cable goes to an office switch.
Said switch_in_between() {
    namespace fs = std::filesystem;
    const fs::path sysfs = fs::temp_directory_path() / ("taktwerk-switch-" + std::to_string(::getpid()));
    fs::create_directories(sysfs / "eth1" / "device");
    std::ofstream{sysfs / "eth1" / "speed"} << "1000\n";
    std::ofstream{sysfs / "eth1" / "duplex"} << "full\n";
    const auto trouble = link_speed_trouble("eth1", sysfs);
    fs::remove_all(sysfs);
    return trouble ? Said{trouble->code, trouble->subject, trouble->what, trouble->remedy, {}} : Said{};
}

void change_port(Bench& bench, const char* command) {
    shell(command);
    static_cast<NamedPort&>(*bench.port).refresh();
}

}  // namespace

Chapter network_port() {
    return {"The network port of the controller",
            "`run` and every `bus` command open it first. In operation a link that is gone by the interface itself is told from one whose "
            "cable is out.",
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
              .remedy = "end that process"},
             {.name = "A switch between controller and slaves",
              .staged = "the link has 1000 Mbit, as the kernel shows it",
              .teller = Teller::scan,
              .opens = switch_in_between,
              .id = "transport.link_speed",
              .place = "network interface eth1",
              .cause = "its link has 1000 Mbit, and an EtherCAT slave has 100",
              .remedy = "plug the cable straight into the IN port of the first slave"},
             {.name = "Interface switched off in operation",
              .staged = "`ip link set port0 down` while the machine runs",
              .teller = Teller::alarm,
              .before = put_behind_port,
              .strikes = [](Bench& bench) { change_port(bench, "ip link set port0 down"); },
              .id = "link_down",
              .place = "network interface port0: it is switched off; switch it on: ip link set port0 up",
              .cause = "No link on the EtherCAT port",
              .remedy = "read what stands with the port"},
             {.name = "Interface renamed or gone in operation",
              .staged = "somebody gives port0 another name while the machine runs",
              .teller = Teller::alarm,
              .before = put_behind_port,
              .strikes = [](Bench& bench) { change_port(bench, "ip link set port0 down && ip link set port0 name enp3s0"); },
              .id = "link_down",
              .place = "network interface port0: there is no network interface of this name",
              .cause = "No link on the EtherCAT port",
              .remedy = "read what stands with the port"}}};
}

}  // namespace taktwerk::troubles
