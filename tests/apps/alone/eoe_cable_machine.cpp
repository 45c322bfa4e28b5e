// Ping through the mailbox of a slave: `taktwerk sim` on one end of a cable, `taktwerk bus eoe` with a TAP on the other, the kernel's own network
// stack behind it. Needs root, namespaces and /dev/net/tun; skipped otherwise.

#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/alone/cable.hpp"
#include "tests/apps/gauge_files.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

/// How many of so many ICMP echo requests from this namespace to 192.168.7.2 are answered. ICMP: RFC 792; identifier 1234h.
int pings_answered(const std::string& name_space, int count) {
    int answered = 0;
    std::thread host{[&] {
        const int there = ::open(("/var/run/netns/" + name_space).c_str(), O_RDONLY | O_CLOEXEC);
        if (there < 0 || ::setns(there, CLONE_NEWNET) != 0) return;
        ::close(there);
        const int raw = ::socket(AF_INET, SOCK_RAW | SOCK_CLOEXEC, IPPROTO_ICMP);
        if (raw < 0) return;
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_addr.s_addr = htonl(0xC0A80702);
        for (int n = 0; n < count; ++n) {
            // Type 8, code 0, checksum, identifier, sequence; no data: the sum of the rest is 0800h + 1234h + n.
            const auto sum = static_cast<std::uint16_t>(~(0x0800 + 0x1234 + n));
            const auto sequence = static_cast<std::uint8_t>(n);
            const std::array<std::uint8_t, 8> question{
                8, 0, static_cast<std::uint8_t>(sum >> 8), static_cast<std::uint8_t>(sum & 0xFF), 0x12, 0x34, 0, sequence};
            if (::sendto(raw, question.data(), question.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to) < 0) break;
            const auto give_up = std::chrono::steady_clock::now() + 3s;
            for (bool waiting = true; waiting && std::chrono::steady_clock::now() < give_up;) {
                pollfd ready{raw, POLLIN, 0};
                if (::poll(&ready, 1, 100) <= 0) continue;
                std::array<std::uint8_t, 2048> packet{};
                const auto size = ::recv(raw, packet.data(), packet.size(), 0);
                const bool its = size >= 28 && packet[20] == 0 && packet[24] == 0x12 && packet[25] == 0x34 && packet[27] == sequence;
                if (its) ++answered, waiting = false;
            }
        }
        ::close(raw);
    }};
    host.join();
    return answered;
}

TEST(EthernetOnACable, ASlaveIsPingedThroughItsMailbox) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    if (::access("/dev/net/tun", R_OK | W_OK) != 0) GTEST_SKIP() << "this system has no /dev/net/tun: no TAP can be made";
    const GaugeFiles files;
    const Cable cable;
    if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
    Child slaves(cable.at_slaves({taktwerk, "sim", files.machine, "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says("slaves of 'gauges'", 20s)) << slaves.text();

    Child eoe(cable.at_master({taktwerk, "bus", "eoe", "1", "--tap", "eoe0", "--ip", "192.168.7.2/24", "--nic", "twk0"}));
    if (eoe.says("no /dev/net/tun", 0s)) GTEST_SKIP() << "this system has no TAP";
    ASSERT_TRUE(eoe.says("carries the Ethernet of 1 slave", 20s)) << eoe.text();
    ASSERT_EQ(run(cable.at_master({"ip", "addr", "add", "192.168.7.1/24", "dev", "eoe0"})), 0);

    EXPECT_EQ(pings_answered(cable.master_end(), 10), 10);

    eoe.signal(SIGTERM);
    EXPECT_EQ(eoe.wait(10s), exit_ok) << eoe.text();
    EXPECT_THAT(eoe.text(), HasSubstr("frames to it"));
    EXPECT_NE(run(cable.at_master({"ip", "link", "show", "eoe0"})), 0) << "the interface is gone with the command";
    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
}

// Somebody deletes the interface: the command says so and ends, instead of carrying nothing for ever.
TEST(EthernetOnACable, AnInterfaceThatIsDeletedEndsTheCommand) {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    if (::access("/dev/net/tun", R_OK | W_OK) != 0) GTEST_SKIP() << "this system has no /dev/net/tun: no TAP can be made";
    const GaugeFiles files;
    const Cable cable;
    if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
    Child slaves(cable.at_slaves({taktwerk, "sim", files.machine, "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says("slaves of 'gauges'", 20s)) << slaves.text();
    std::string said;
    EXPECT_EQ(
        run(cable.at_master({taktwerk, "bus", "eoe", "1", "gauge", "--tap", "eoe0", "--nic", "twk0", "--machine", files.machine}), &said),
        exit_usage);
    EXPECT_THAT(said, HasSubstr("is named twice"));
    EXPECT_EQ(run(cable.at_master({taktwerk, "bus", "eoe", "1", "--tap", "eoe%d", "--nic", "twk0", "--for", "1s"}), &said), exit_bus);
    EXPECT_THAT(said, HasSubstr("check its name"));
    Child eoe(cable.at_master({taktwerk, "bus", "eoe", "1", "--tap", "eoe0", "--nic", "twk0"}));
    if (eoe.says("no /dev/net/tun", 0s)) GTEST_SKIP() << "this system has no TAP";
    ASSERT_TRUE(eoe.says("carries the Ethernet of 1 slave", 20s)) << eoe.text();
    ASSERT_EQ(run(cable.at_master({"ip", "link", "del", "eoe0"})), 0);
    EXPECT_EQ(eoe.wait(10s), exit_bus) << eoe.text();
    EXPECT_THAT(eoe.text(), HasSubstr("somebody deleted it"));
    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
}

TEST(EthernetOnACable, ASlaveWithoutEthernetAndABadAddressAreRefused) {
    const GaugeFiles files;
    std::string said;
    EXPECT_EQ(run({taktwerk, "bus", "eoe", "gauge", "--tap", "eoe0", "--ip", "192.168.7", "--machine", files.machine, "--simulate"}, &said),
              exit_usage);
    EXPECT_THAT(said, HasSubstr("'192.168.7' is no address"));
    EXPECT_NE(run({taktwerk, "bus", "eoe", "gauge", "--tap", "eoe0", "--machine", files.machine, "--simulate"}, &said), exit_ok);
    EXPECT_THAT(said, HasSubstr("in virtual time"));
}

}  // namespace
}  // namespace taktwerk::apps
