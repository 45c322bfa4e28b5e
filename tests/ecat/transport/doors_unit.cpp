// The same asked of AF_PACKET and of AF_XDP in either place: frames over a veth pair in a network of the test's own, and everything that can
// happen to a port.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/clock.hpp"
#include "ecat/transport/network_interface.hpp"
#include "tests/ecat/transport/doors.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

struct AnyDoor : ::testing::TestWithParam<Door> {
    void SetUp() override {
        if (!veth_network().empty()) GTEST_SKIP() << veth_network();
        ASSERT_TRUE(lay_veth_pair());
        open();
    }
    void open() {
        master = open_door(GetParam());
        if (not_to_be_had(master)) GTEST_SKIP() << master.why;
        ASSERT_EQ(master.why, "");
        auto other = RawSocketTransport::open("ecat1");
        ASSERT_TRUE(other.ok()) << other.error().text();
        slaves = std::move(*other);
        ASSERT_TRUE(link_becomes(true));
    }
    static std::vector<std::byte> frame(std::size_t size = 60, std::uint8_t mark = 0x5A) {
        std::vector<std::byte> bytes(size, std::byte{mark});
        std::fill_n(bytes.begin(), 6, std::byte{0xFF});
        bytes[12] = std::byte{0x88};
        bytes[13] = std::byte{0xA4};
        return bytes;
    }
    /// The mark of the frame that comes within `patience`; nothing: none does.
    std::optional<std::uint8_t> heard(Transport& by, std::chrono::milliseconds patience = 1s) {
        for (auto left = patience; left >= 0ms; left -= 1ms) {
            if (const auto got = by.receive(buffer, now)) return size = got->size, std::to_integer<std::uint8_t>(buffer[size - 1]);
            std::this_thread::sleep_for(1ms);
        }
        return std::nullopt;
    }
    bool link_becomes(bool up) {
        for (int i = 0; i < 1000; ++i) {
            master.refresh();
            if (master.transport().link_up() == up) return true;
            std::this_thread::sleep_for(1ms);
        }
        return false;
    }

    OpenDoor master;
    std::unique_ptr<RawSocketTransport> slaves;
    std::array<std::byte, 2048> buffer{};
    std::size_t size = 0;
    const Instant now{1s};
};
INSTANTIATE_TEST_SUITE_P(Doors, AnyDoor, every_door(), door_name);

TEST_P(AnyDoor, FramesOfEverySizeGoThereAndComeBack) {
    EXPECT_EQ(master.transport().mac(), (MacAddress{2, 0, 0, 0, 0, 1}));
    for (const std::size_t bytes : {60u, 61u, 777u, 1514u}) {
        const auto sent = frame(bytes, static_cast<std::uint8_t>(bytes));
        ASSERT_TRUE(master.transport().send(sent, now));
        ASSERT_TRUE(heard(*slaves)) << bytes;
        EXPECT_TRUE(size == bytes && std::equal(sent.begin(), sent.end(), buffer.begin())) << bytes;
        ASSERT_TRUE(slaves->send(sent, now));
        ASSERT_TRUE(heard(master.transport())) << bytes;
        EXPECT_TRUE(size == bytes && std::equal(sent.begin(), sent.end(), buffer.begin())) << bytes;
    }
    EXPECT_FALSE(heard(master.transport(), 0ms)) << "nobody hears himself";
    EXPECT_EQ(master.packet->statistics().received, 0u);
    master.refresh();
    if (master.xdp) {
        EXPECT_EQ(master.xdp->passed_by(), 0u) << "all of them came by AF_XDP";
    }
}

// Ten times as many as there are places for frames, eight under way at a time.
TEST_P(AnyDoor, NoPlaceIsLostOverManyFrames) {
    for (int burst = 0; burst < 320; ++burst) {
        const auto mark = [&](int i) { return static_cast<std::uint8_t>((8 * burst + i) % 251); };
        for (int i = 0; i < 8; ++i) ASSERT_TRUE(master.transport().send(frame(60, mark(i)), now)) << burst;
        for (int i = 0; i < 8; ++i) ASSERT_EQ(heard(*slaves), mark(i)) << burst;
        for (int i = 0; i < 8; ++i) ASSERT_TRUE(slaves->send(frame(60, mark(i)), now)) << burst;
        for (int i = 0; i < 8; ++i) ASSERT_EQ(heard(master.transport()), mark(i)) << burst;
    }
    master.refresh();
    EXPECT_EQ(master.dropped(), 0u);
}

// ssh, ping and what else uses the port.
TEST_P(AnyDoor, OtherTrafficGoesWhereItWent) {
    auto other = open_packet_socket("ecat0");
    const auto port = find_interface("ecat0");
    ASSERT_TRUE(other.ok() && port.ok() && bind_packet_socket(other->get(), *port, 0x88B5));
    auto foreign = frame(60, 0x77);
    foreign[13] = std::byte{0xB5};
    foreign[12] = std::byte{0x88};
    ASSERT_TRUE(slaves->send(foreign, now));
    ssize_t got = -1;
    for (int i = 0; i < 1000 && got < 0; ++i) {
        got = ::recv(other->get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(got, 60);
    EXPECT_FALSE(heard(master.transport(), 0ms));
}

// A set-point that could not leave must not leave later, when the cable is in again.
TEST_P(AnyDoor, WhatCouldNotLeaveIsForgotten) {
    for (const char* end : {"ecat1", "ecat0"}) {
        ASSERT_TRUE(shell(std::string{"ip link set "} + end + " down"));
        ASSERT_TRUE(link_becomes(false)) << end;
        for (std::uint8_t old = 1; old < 100; ++old) EXPECT_FALSE(master.transport().send(frame(60, old), now)) << end;
        ASSERT_TRUE(shell(std::string{"ip link set "} + end + " up"));
        ASSERT_TRUE(link_becomes(true)) << end;
        for (int i = 0; i < 1000 && !master.transport().send(frame(60, 200), now); ++i) std::this_thread::sleep_for(1ms);
        EXPECT_EQ(heard(*slaves), 200) << end;
        EXPECT_FALSE(heard(*slaves, 20ms)) << end << ": and no other";
        for (int i = 0; i < 1000 && !slaves->send(frame(60, 201), now); ++i) std::this_thread::sleep_for(1ms);
        EXPECT_EQ(heard(master.transport()), 201) << end;
    }
}

TEST_P(AnyDoor, ARenamedPortHasNoLink) {
    ASSERT_TRUE(shell("ip link set ecat0 down && ip link set ecat0 name enp3s0 && ip link set enp3s0 up"));
    EXPECT_TRUE(link_becomes(false));
}

// No cable is to blame where somebody switched the interface off, or renamed it: the socket stays bound to it, its name leads nowhere.
TEST_P(AnyDoor, ALinkThatTheInterfaceItselfHasTakenAwayIsToldFromACable) {
    const auto trouble_when = [&](bool up) {
        EXPECT_TRUE(link_becomes(up));
        const auto trouble = master.transport().link_trouble();
        return trouble ? trouble->code : std::string{"none"};
    };
    EXPECT_EQ(trouble_when(true), "none");
    ASSERT_TRUE(shell("ip link set ecat1 down"));
    EXPECT_EQ(trouble_when(false), "none") << "the other end: a cable";
    ASSERT_TRUE(shell("ip link set ecat1 up && ip link set ecat0 down"));
    EXPECT_EQ(trouble_when(false), "transport.interface_down");
    ASSERT_TRUE(shell("ip link set ecat0 name ecat9"));
    EXPECT_EQ(trouble_when(false), "transport.no_such_interface");
    ASSERT_TRUE(shell("ip link set ecat9 name ecat0"));
}

TEST_P(AnyDoor, APortThatIsGoneTakesNothingAndGivesNothing) {
    ASSERT_TRUE(slaves->send(frame(), now));
    ASSERT_TRUE(shell("ip link del ecat0"));
    EXPECT_TRUE(link_becomes(false));
    while (heard(master.transport(), 5ms)) {}  // what had come already
    for (int i = 0; i < 200; ++i) {
        EXPECT_FALSE(master.transport().send(frame(), now));
        EXPECT_FALSE(master.transport().receive(buffer, now));
    }
    EXPECT_FALSE(link_becomes(true) && master.transport().send(frame(), now)) << "one of that name that comes later is another one";
}

TEST_P(AnyDoor, NothingLongerThanTheMtuLeaves) {
    ASSERT_TRUE(shell("ip link set ecat0 mtu 200"));
    master.refresh();
    EXPECT_TRUE(master.transport().send(frame(214), now));
    EXPECT_FALSE(master.transport().send(frame(215), now));
    EXPECT_TRUE(heard(*slaves));
    EXPECT_FALSE(heard(*slaves, 20ms));
}

// Some switches put one around a frame. The kernel takes it off before a packet socket sees it.
TEST_P(AnyDoor, AFrameWithAVlanTagArrivesWithoutIt) {
    auto other = open_packet_socket("ecat1");
    const auto port = find_interface("ecat1");
    ASSERT_TRUE(other.ok() && port.ok() && bind_packet_socket(other->get(), *port, ETH_P_ALL));
    auto tagged = frame(60, 0x33);
    const std::array tag{std::byte{0x81}, std::byte{0x00}, std::byte{0xE0}, std::byte{0x00}};  // priority 7, no VLAN (802.1Q)
    tagged.insert(tagged.begin() + 12, tag.begin(), tag.end());
    ASSERT_EQ(::send(other->get(), tagged.data(), tagged.size(), 0), 64);
    EXPECT_EQ(heard(master.transport()), 0x33);
    EXPECT_EQ(size, 60u);
    EXPECT_TRUE(std::equal(buffer.begin(), buffer.begin() + 60, frame(60, 0x33).begin()));
    master.refresh();
    if (master.xdp) {
        EXPECT_THAT(master.xdp->news(), HasSubstr("ecat0: frames come past queue 0"));
        EXPECT_EQ(master.xdp->news(), "") << "once";
    }
}

// A card with two queues that puts EtherCAT into the second one (veth: the queue by which the other end sent it, that of its processor).
TEST_P(AnyDoor, FramesOfAnotherQueueArriveAllTheSame) {
    cpu_set_t before, second;
    ::sched_getaffinity(0, sizeof before, &before);
    if (!CPU_ISSET(1, &before)) GTEST_SKIP() << "needs a second processor";
    slaves.reset();
    master = {};
    ASSERT_TRUE(shell("ip link del ecat0"));
    ASSERT_TRUE(shell("ip link add ecat0 numrxqueues 2 numtxqueues 2 type veth peer name ecat1 numrxqueues 2 numtxqueues 2"));
    ASSERT_TRUE(shell("ip link set ecat0 up && ip link set ecat1 up"));
    open();
    CPU_ZERO(&second);
    CPU_SET(1, &second);
    ASSERT_EQ(::sched_setaffinity(0, sizeof second, &second), 0);
    for (std::uint8_t mark = 1; mark <= 20; ++mark) {
        EXPECT_TRUE(slaves->send(frame(60, mark), now));
        EXPECT_EQ(heard(master.transport()), mark);
        EXPECT_TRUE(master.transport().send(frame(60, mark), now));
        EXPECT_EQ(heard(*slaves), mark);
    }
    ::sched_setaffinity(0, sizeof before, &before);
    master.refresh();
    if (GetParam() == Door::xdp_driver) {  // before the stack veth has not yet said which queue it was
        EXPECT_EQ(master.xdp->passed_by(), 20u);
        EXPECT_THAT(master.xdp->news(), HasSubstr("ethtool -L ecat0 combined 1"));
    }
}

TEST_P(AnyDoor, AnArrivalIsDatedWhenItCameAndNotWhenItIsAskedFor) {
    SystemClock clock;
    master = {};
    master = open_door(GetParam(), &clock);
    ASSERT_EQ(master.why, "");
    Instant before{}, asked{}, at{};
    for (int i = 0; i < 200 && at == asked; ++i) {  // the kernel begins to stamp a moment after a packet socket asked for it
        before = clock.now();
        ASSERT_TRUE(slaves->send(frame(), before));
        clock.sleep_until(clock.now() + 5ms);
        asked = clock.now();
        const auto received = master.transport().receive(buffer, asked);
        ASSERT_TRUE(received);
        at = received->at;
    }
    EXPECT_GE(at, before);
    EXPECT_LE(at, asked - 4ms);

    const Instant sending = clock.now();
    ASSERT_TRUE(master.transport().send(frame(), Instant{}));
    EXPECT_GE(master.transport().departure(Instant{}), sending);
    EXPECT_LE(master.transport().departure(Instant{}), clock.now());
}

TEST_P(AnyDoor, FramesThatNobodyFetchesInTimeAreCounted) {
    std::uint64_t sent = 0, fetched = 0;
    for (int i = 0; i < 3000; ++i) sent += slaves->send(frame(), now) ? 1 : 0;
    std::this_thread::sleep_for(20ms);
    while (heard(master.transport(), 5ms)) ++fetched;
    master.refresh();
    EXPECT_GT(master.dropped(), 0u);
    EXPECT_EQ(fetched + master.dropped(), sent);
    ASSERT_TRUE(slaves->send(frame(60, 9), now));
    EXPECT_EQ(heard(master.transport()), 9) << "and it goes on";
}

TEST_P(AnyDoor, ASecondMasterIsRefused) {
    const auto second = RawSocketTransport::open("ecat0");
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.error().code, "transport.in_use");
}

}  // namespace
}  // namespace taktwerk::ecat::test
