// A ring over two real interfaces: two veth pairs in a network namespace of the test's own, and a simulated ring of slaves behind their far
// ends. Skipped where that is not permitted.
#include "ecat/ring/bus_interfaces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "ecat/transport/network_interface.hpp"
#include "tests/ecat/ring/ring_probe.hpp"

namespace taktwerk::ecat::test {
namespace {

bool shell(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

/// As root, or as root of a user namespace of our own. Once for this binary.
const std::string& two_cables() {
    static const std::string problem = [] {
        if (::unshare(CLONE_NEWNET) != 0) {
            const auto uid = ::getuid();
            const auto gid = ::getgid();
            if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return std::string{"network namespaces are not permitted here"};
            std::ofstream{"/proc/self/setgroups"} << "deny";
            std::ofstream{"/proc/self/uid_map"} << "0 " << uid << " 1";
            std::ofstream{"/proc/self/gid_map"} << "0 " << gid << " 1";
        }
        for (const std::string pair : {"a", "b"}) {
            if (!shell("ip link add master_" + pair + " type veth peer name slaves_" + pair))
                return std::string{"veth pairs are not permitted here, or `ip` is missing"};
            shell("sysctl -w net.ipv6.conf.master_" + pair + ".disable_ipv6=1 net.ipv6.conf.slaves_" + pair + ".disable_ipv6=1");
            shell("ip link set master_" + pair + " up && ip link set slaves_" + pair + " up");
        }
        return std::string{};
    }();
    return problem;
}

struct RealRing : ::testing::TestWithParam<BusTransport> {
    static constexpr std::size_t count = 5;
    void SetUp() override {
        if (!two_cables().empty()) GTEST_SKIP() << two_cables();
        ASSERT_TRUE(shell("ip link set slaves_b up"));
        for (std::size_t i = 0; i < count; ++i) network.add(bare_slave(), std::make_unique<Idle>());
        auto opened = BusInterfaces::open("master_a", "master_b", 20ms, GetParam());
        if (!opened && (opened.error().what.find("lacks a privilege") != std::string::npos ||
                        opened.error().what.find("built without it") != std::string::npos))
            GTEST_SKIP() << opened.error().text();
        ASSERT_TRUE(opened.ok()) << opened.error().text();
        master = std::move(*opened);
        for (auto* end : {&near, &far}) {
            auto nic = RawSocketTransport::open(end == &near ? "slaves_a" : "slaves_b");
            ASSERT_TRUE(nic.ok()) << nic.error().text();
            *end = std::move(*nic);
        }
        second_end = &network.close_ring(network.slave(count - 1));
        master->refresh();
    }
    /// The slaves take what has arrived at either end, and send it out where it leaves.
    void play() {
        std::array<std::byte, max_frame_size> frame{};
        for (auto* end : {near.get(), far.get()})
            while (const auto received = end->receive(frame, now)) {
                const auto bytes = std::span{frame}.first(received->size);
                FrameSink& sink = end == near.get() ? static_cast<FrameSink&>(network) : *second_end;
                if (!sink.process(bytes, now)) continue;
                const bool here = !sink.came_out_elsewhere();
                (void)((end == near.get()) == here ? near : far)->send(bytes, now);
            }
    }
    /// Working counter of a BRD; nothing within a second: nullopt.
    std::optional<std::uint16_t> brd() {
        FrameBuilder builder{buffer, master->bus().mac()};
        builder.add(Command::BRD, ++index, Address::physical(0, reg::type), 1);
        if (!master->bus().send(builder.finish(), now)) return std::nullopt;
        for (int i = 0; i < 1000; ++i) {
            now += 1ms;
            play();
            if (const auto received = master->bus().receive(buffer, now)) {
                FrameReader reader{std::span<const std::byte>{buffer}.first(received->size)};
                return reader.next()->working_counter();
            }
            std::this_thread::sleep_for(1ms);  // a veth pair delivers in another context of the kernel
        }
        return std::nullopt;
    }
    [[nodiscard]] RingShape shape() { return master->bus().ring()->state().shape; }

    sim::SimNetwork network{Instant{}};
    FrameSink* second_end = nullptr;
    std::unique_ptr<BusInterfaces> master;
    std::unique_ptr<RawSocketTransport> near, far;
    std::array<std::byte, max_frame_size> buffer{};
    std::uint8_t index = 0;
    Instant now{1s};
};
INSTANTIATE_TEST_SUITE_P(Doors, RealRing, ::testing::Values(BusTransport::packet, BusTransport::xdp));

TEST_P(RealRing, AllSlavesAnswerAtEveryBreak) {
    ASSERT_EQ(brd(), count);
    EXPECT_EQ(shape(), RingShape::closed);
    for (std::size_t place = 1; place < count; ++place) {
        network.set_cable(place, false);
        EXPECT_EQ(brd(), count) << place;
        EXPECT_EQ(shape(), RingShape::open);
        EXPECT_EQ(master->bus().ring()->state().before_break, place);
        network.set_cable(place, true);
        EXPECT_EQ(brd(), count) << place;
        EXPECT_EQ(shape(), RingShape::closed);
    }
}

TEST_P(RealRing, OneInterfaceWithoutCarrierIsABrokenRing) {
    ASSERT_EQ(brd(), count);
    ASSERT_TRUE(shell("ip link set slaves_b down"));
    network.set_ring_cable(false);
    for (int i = 0; i < 1000 && master->bus().ring()->link_up(1); ++i) {
        master->refresh();
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_FALSE(master->bus().ring()->link_up(1));
    EXPECT_TRUE(master->bus().link_up());
    EXPECT_EQ(brd(), count);
    EXPECT_EQ(shape(), RingShape::second_silent);
}

TEST_P(RealRing, BothInterfacesAreTheMasters) {
    EXPECT_EQ(RawSocketTransport::open("master_b").error().code, "transport.in_use");
    EXPECT_EQ(BusInterfaces::open("slaves_a", "master_b", 20ms).error().code, "transport.in_use");
    EXPECT_EQ(BusInterfaces::open("lo", "master_b", 20ms).error().code, "transport.not_ethernet");
}

TEST_P(RealRing, ItIsSaidByWhichDoorFramesGo) {
    const auto said = master->remarks();
    if (GetParam() == BusTransport::packet) EXPECT_THAT(said, ::testing::Not(::testing::Contains(::testing::HasSubstr("AF_XDP"))));
    else
        EXPECT_THAT(said, ::testing::IsSupersetOf({::testing::StartsWith("master_a: AF_XDP in the driver"),
                                                   ::testing::StartsWith("master_b: AF_XDP in the driver")}));
    EXPECT_THAT(master->news(), ::testing::IsEmpty());
}

// Somebody's own program is on the port. Who leaves the choice gets a packet socket and is told; who insists is refused.
TEST_P(RealRing, WhereAfXdpIsNotToBeHadTheWordSaysWhyAndWhatIsUsedInstead) {
    master.reset();
    auto theirs = XdpProgram::load("master_a");
    if (!theirs) GTEST_SKIP() << theirs.error().text();
    ASSERT_TRUE(theirs->attach(find_interface("master_a")->index, XdpProgram::Places::driver_or_stack).ok());

    const auto refused = BusInterfaces::open("master_a", "master_b", 20ms, BusTransport::xdp);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, "transport.xdp_taken");

    auto opened = BusInterfaces::open("master_a", "master_b", 20ms, BusTransport::automatic);
    ASSERT_TRUE(opened.ok()) << opened.error().text();
    master = std::move(*opened);
    EXPECT_THAT(master->remarks(),
                ::testing::ElementsAre("master_a: no AF_XDP: another XDP program is on it; a packet socket (AF_PACKET) is used instead",
                                       ::testing::StartsWith("master_b: AF_XDP in the driver")));
    master->refresh();
    EXPECT_EQ(brd(), count) << "one half by each";
}

}  // namespace
}  // namespace taktwerk::ecat::test
