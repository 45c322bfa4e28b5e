// Ethernet through the mailbox of a simulated slave, with a socket pair in the place of a TAP, in virtual time. ARP: RFC 826; ICMP echo: RFC 792.
#include <sys/socket.h>

#include <gmock/gmock.h>

#include "ecat/eoe/ethernet_bridge.hpp"
#include "ecat/eoe/ip_settings.hpp"
#include "tests/ecat/coe/coe_bench.hpp"
#include "tests/ecat/eoe/host_frames.hpp"

namespace taktwerk::ecat::test {
namespace {

DeviceDescription drive_with_ethernet() {
    auto d = sim::small_drive();
    d.mailbox->eoe = true;
    return d;
}

class SlaveOnTheNet : public ::testing::Test {
protected:
    SlaveOnTheNet() {
        int ends[2] = {-1, -1};
        EXPECT_EQ(::socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends), 0);
        bridge_end.emplace(Descriptor{ends[0]});
        host.emplace(Descriptor{ends[1]});
        bridge.emplace(*bridge_end);
        bridge->add(bench.mailbox);
    }
    Result<void> tell_ip(std::uint32_t ip) {
        EoeAddress address;
        address.ip = ip;
        address.subnet = 0xFFFFFF00;
        return bench.run(set_ip(*bench.port, bench.mailbox, address));
    }
    /// Lets the bridge carry for a while.
    testing::AssertionResult carry(Duration time) {
        const auto carried = bench.run(bridge->carry(*bench.port, bench.now + time));
        return carried ? testing::AssertionSuccess() : testing::AssertionFailure() << carried.error().text();
    }
    std::optional<HostBytes> heard() {
        std::array<std::byte, 2048> buffer{};
        const auto size = host->receive(buffer);
        if (!size) return std::nullopt;
        return HostBytes(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(*size));
    }

    CoeBench bench{drive_with_ethernet()};
    std::optional<HostPort> bridge_end, host;
    std::optional<EthernetBridge> bridge;
    static constexpr std::uint32_t slave_ip = 0xC0A80702, own_ip = 0xC0A80701;
};

TEST_F(SlaveOnTheNet, TakesItsAddress) {
    ASSERT_TRUE(tell_ip(slave_ip));
    EXPECT_EQ(bench.slave->ethernet()->ip(), slave_ip);
}

TEST_F(SlaveOnTheNet, IsFoundByArpAndAnswersPing) {
    ASSERT_TRUE(tell_ip(slave_ip));
    host->send(arp_question(own_ip, slave_ip));
    ASSERT_TRUE(carry(50ms));
    const auto arp = heard();
    ASSERT_TRUE(arp);
    EXPECT_EQ(arp_answer_mac(*arp, slave_ip), bench.slave->ethernet()->mac());
    // Short, over several pieces of 96 bytes, and as long as Ethernet has them.
    for (const std::size_t size : {8u, 56u, 96u, 500u, 1472u}) {
        const auto ping = echo_question(bench.slave->ethernet()->mac(), own_ip, slave_ip, size, 1);
        host->send(ping);
        ASSERT_TRUE(carry(200ms));
        const auto pong = heard();
        ASSERT_TRUE(pong) << size;
        EXPECT_TRUE(answers_echo(*pong, ping)) << size;
    }
    EXPECT_EQ(bench.slave->ethernet()->echoes(), 5u);
    EXPECT_EQ(bridge->link(0).counts().sent, 6u);
    EXPECT_EQ(bridge->link(0).counts().received, 6u);
}

TEST_F(SlaveOnTheNet, ObjectsAreReadWhileFramesAreCarried) {
    ASSERT_TRUE(tell_ip(slave_ip));
    const auto ping = echo_question(bench.slave->ethernet()->mac(), own_ip, slave_ip, 1400, 1);
    std::optional<Result<void>> carried;
    Runner carrier{keep(bridge->carry(*bench.port, bench.now + 2s), carried)};
    std::size_t values = 0, pongs = 0;
    std::optional<Result<Bytes>> value;
    std::optional<Runner> reader;
    for (int i = 0; i < 3000 && !carrier.done(); ++i) {
        if (i % 100 == 0) host->send(ping);
        if (!reader || reader->done()) {
            if (value) {
                ASSERT_TRUE(*value) << value->error().text();
                ++values;
            }
            value.reset();
            reader.emplace(keep(sdo_upload(*bench.port, bench.mailbox, 0x1000, 0), value));
        }
        bench.step();
        reader->step(bench.now);
        carrier.step(bench.now);
        bench.pack();
        while (heard()) ++pongs;
    }
    EXPECT_GT(values, 50u);
    EXPECT_GE(pongs, 15u);
}

TEST_F(SlaveOnTheNet, ALostFrameCostsAtMostThatPing) {
    ASSERT_TRUE(tell_ip(slave_ip));
    const auto ping = echo_question(bench.slave->ethernet()->mac(), own_ip, slave_ip, 300, 1);
    for (std::size_t n = 1; n < 30; ++n) {
        bench.lose_answer = bench.frames + n;
        host->send(ping);
        ASSERT_TRUE(carry(100ms));
        bench.lose_answer = 0;
        while (heard()) {}
        host->send(ping);
        ASSERT_TRUE(carry(100ms));
        const auto pong = heard();
        ASSERT_TRUE(pong && answers_echo(*pong, ping)) << n;
    }
}

TEST_F(SlaveOnTheNet, ASlaveThatIsGoneEndsTheCarrying) {
    ASSERT_TRUE(tell_ip(slave_ip));
    bench.probe.network.set_power(0, false);
    const auto carried = bench.run(bridge->carry(*bench.port, bench.now + 5s));
    ASSERT_FALSE(carried);
    EXPECT_TRUE(carried.error().code == "bus.no_frame" || carried.error().code == "bus.no_slave") << carried.error().text();
}

TEST(EthernetAddress, IsWrittenWithItsNetwork) {
    EXPECT_EQ(parse_ip_and_subnet("192.168.7.2/24"), (IpAndSubnet{0xC0A80702, 0xFFFFFF00}));
    EXPECT_EQ(parse_ip_and_subnet("10.0.0.1/8"), (IpAndSubnet{0x0A000001, 0xFF000000}));
    EXPECT_EQ(parse_ip_and_subnet("0.0.0.0/0"), (IpAndSubnet{0, 0}));
    for (const char* bad :
         {"", "192.168.7.2", "192.168.7/24", "192.168.7.256/24", "192.168.7.2/33", "192.168.7.2/24x", "a.b.c.d/8", "-1.0.0.0/8"})
        EXPECT_FALSE(parse_ip_and_subnet(bad)) << bad;
    EXPECT_EQ(ip_text(0xC0A80702), "192.168.7.2");
}

}  // namespace
}  // namespace taktwerk::ecat::test
