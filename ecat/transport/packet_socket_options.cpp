#include "ecat/transport/packet_socket_options.hpp"

#include <fmt/format.h>
#include <linux/ethtool.h>
#include <linux/if_packet.h>
#include <linux/net_tstamp.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#ifndef PACKET_IGNORE_OUTGOING  // Linux 4.20; older headers lack it
#define PACKET_IGNORE_OUTGOING 23
#endif

namespace taktwerk::ecat {

namespace {

class Request {
public:
    Request(int socket, RawSocketReport& report) : socket_(socket), report_(report) {}
    bool operator()(int level, int option, int value, std::string_view without, std::string_view costs) {
        if (::setsockopt(socket_, level, option, &value, sizeof value) == 0) return true;
        report_.refused.push_back(fmt::format("no {} ({}): {}", without, std::strerror(errno), costs));
        return false;
    }

private:
    int socket_;
    RawSocketReport& report_;
};

/// A hardware stamp would be of the NIC's own clock, which nothing here follows.
bool offers_hardware_stamps(int socket, std::string_view interface) {
    ifreq ifr{};
    std::copy_n(interface.begin(), std::min<std::size_t>(interface.size(), IFNAMSIZ - 1), ifr.ifr_name);
    ethtool_ts_info info{};
    info.cmd = ETHTOOL_GET_TS_INFO;
    ifr.ifr_data = reinterpret_cast<char*>(&info);
    return ::ioctl(socket, SIOCETHTOOL, &ifr) == 0 && (info.so_timestamping & SOF_TIMESTAMPING_RX_HARDWARE) != 0;
}

}  // namespace

RawSocketReport apply(const RawSocketOptions& options, int socket, std::string_view interface) {
    RawSocketReport report;
    Request ask{socket, report};
    report.sees_own_frames = !ask(SOL_PACKET, PACKET_IGNORE_OUTGOING, 1, "filter for outgoing frames",
                                  "each frame costs one more system call (the kernel is older than 4.20)");
    if (options.skip_queueing)
        ask(SOL_PACKET, PACKET_QDISC_BYPASS, 1, "queue bypass", "frames pass the queueing discipline, some us later");
    ask(SOL_SOCKET, SO_PRIORITY, options.priority, fmt::format("socket priority {}", options.priority),
        "other traffic of this interface may go first; give the process CAP_NET_ADMIN");
    if (options.busy_poll > Duration{})
        ask(SOL_SOCKET, SO_BUSY_POLL, static_cast<int>(options.busy_poll / std::chrono::microseconds{1}), "busy poll",
            "answers wait for the NIC's interrupt; give the process CAP_NET_ADMIN");

    int stamps = SOF_TIMESTAMPING_SOFTWARE;
    if (options.receive_stamps) stamps |= SOF_TIMESTAMPING_RX_SOFTWARE;
    if (options.send_stamps) stamps |= SOF_TIMESTAMPING_TX_SOFTWARE | SOF_TIMESTAMPING_OPT_ID | SOF_TIMESTAMPING_OPT_TSONLY;
    const bool stamped = (options.receive_stamps || options.send_stamps) &&
                         ask(SOL_SOCKET, SO_TIMESTAMPING, stamps, "kernel time stamps", "an arrival is dated when the cycle asks for it");
    report.stamps_receipt = stamped && options.receive_stamps;
    report.stamps_sending = stamped && options.send_stamps;
    report.time_stamps = stamped ? "kernel, software" : "none";
    if (offers_hardware_stamps(socket, interface)) report.time_stamps += "; the NIC offers hardware stamps of its own clock, not used";
    return report;
}

}  // namespace taktwerk::ecat
