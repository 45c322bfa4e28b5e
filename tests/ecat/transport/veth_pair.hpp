#pragma once
// A network of this process alone with a virtual cable in it: ecat0 is the master's end, ecat1 the slaves'.

#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace taktwerk::ecat::test {

inline bool shell(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

/// Leaves the machine's network for an empty one: as root, or as root of a user namespace of our own.
inline bool enter_own_network() {
    if (::unshare(CLONE_NEWNET) == 0) return true;
    const auto uid = ::getuid();
    const auto gid = ::getgid();
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
    std::ofstream{"/proc/self/setgroups"} << "deny";
    std::ofstream{"/proc/self/uid_map"} << "0 " << uid << " 1";
    std::ofstream{"/proc/self/gid_map"} << "0 " << gid << " 1";
    return true;
}

/// The pair anew, both ends switched on, without IPv6: nothing but the test's frames is on it. Takes away what bears the names already.
inline bool lay_veth_pair() {
    shell("ip link del ecat0; ip link del enp3s0");
    if (!shell("ip link add ecat0 address 02:00:00:00:00:01 type veth peer name ecat1 address 02:00:00:00:00:02")) return false;
    shell("sysctl -w net.ipv6.conf.ecat0.disable_ipv6=1 net.ipv6.conf.ecat1.disable_ipv6=1");
    return shell("ip link set ecat0 up && ip link set ecat1 up");
}

/// One namespace for all tests of a binary, made at the first. Why there is none; empty: there is.
inline const std::string& veth_network() {
    static const std::string problem = [] {
        if (!enter_own_network()) return std::string{"network namespaces are not permitted here"};
        if (!lay_veth_pair()) return std::string{"veth pairs are not permitted here, or `ip` is missing"};
        shell("ip link set lo up");
        return std::string{};
    }();
    return problem;
}

}  // namespace taktwerk::ecat::test
