#include "tests/troubles/own_network.hpp"

#include <sched.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace taktwerk::troubles {

namespace {

bool enter() {
    if (::unshare(CLONE_NEWNET) == 0) return true;
    const auto user = ::getuid();
    const auto group = ::getgid();
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
    std::ofstream{"/proc/self/setgroups"} << "deny";
    std::ofstream{"/proc/self/uid_map"} << "0 " << user << " 1";
    std::ofstream{"/proc/self/gid_map"} << "0 " << group << " 1";
    return true;
}

}  // namespace

bool shell(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

bool own_network_possible() {
    static const bool possible = enter() && shell("ip link add port0 type veth peer name port1");
    return possible;
}

void lay_cable() {
    for (const char* left : {"port0", "enp3s0"}) shell(std::string{"ip link del "} + left);
    shell("ip link add port0 type veth peer name port1 && ip link set port0 up && ip link set port1 up");
}

void put_behind_port(Bench& bench) {
    lay_cable();
    auto opened = ecat::RawSocketTransport::open("port0", {.exclusive = false});
    if (!opened) return;
    for (int i = 0; i < 1000 && !(*opened)->link_up(); ++i) {  // the kernel reports carrier a moment later
        std::this_thread::sleep_for(std::chrono::milliseconds{1});
        (*opened)->refresh();
    }
    bench.port = std::make_unique<NamedPort>(bench.transport, std::move(*opened));
    bench.master = std::make_unique<ecat::Master>(*bench.port, bench.config);
}

}  // namespace taktwerk::troubles
