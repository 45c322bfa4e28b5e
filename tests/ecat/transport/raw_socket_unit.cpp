// The raw socket on a veth pair in a network namespace of the test's own. Skipped where that is not permitted.
#include "ecat/transport/raw_socket.hpp"

#include <gmock/gmock.h>
#include <linux/capability.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <thread>

#include "core/clock.hpp"
#include "tests/ecat/transport/veth_pair.hpp"

namespace taktwerk::ecat {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

class RawSocket : public ::testing::Test {
protected:
    void SetUp() override {
        if (!test::veth_network().empty()) GTEST_SKIP() << test::veth_network();
        ASSERT_TRUE(test::shell("ip link set ecat0 up") && test::shell("ip link set ecat1 up"));
    }
    const Instant now{1s};
    std::array<std::byte, max_frame_size> buffer{};

    static std::vector<std::byte> frame(std::uint16_t type = ethertype) {
        std::vector<std::byte> bytes(60, std::byte{0x5A});
        for (std::size_t i = 0; i < 6; ++i) bytes[i] = std::byte{0xFF};
        bytes[12] = static_cast<std::byte>(type >> 8);
        bytes[13] = static_cast<std::byte>(type & 0xFF);
        return bytes;
    }
    /// A veth pair delivers in another context of the kernel: wait for the event, at most a second.
    std::optional<ReceivedFrame> wait_for_frame(RawSocketTransport& transport) {
        for (int i = 0; i < 1000; ++i) {
            if (auto received = transport.receive(buffer, now)) return received;
            std::this_thread::sleep_for(1ms);
        }
        return std::nullopt;
    }
};

TEST_F(RawSocket, FrameCrossesTheCableAndTheSenderDoesNotHearItself) {
    auto master = RawSocketTransport::open("ecat0");
    auto slave = RawSocketTransport::open("ecat1");
    ASSERT_TRUE(master.ok()) << master.error().text();
    ASSERT_TRUE(slave.ok()) << slave.error().text();
    EXPECT_EQ((*master)->mac(), (MacAddress{2, 0, 0, 0, 0, 1}));
    EXPECT_FALSE((*slave)->receive(buffer, now)) << "nothing sent yet, and no waiting";

    ASSERT_TRUE((*master)->send(frame(), now));

    const auto received = wait_for_frame(**slave);
    ASSERT_TRUE(received);
    EXPECT_EQ(received->size, 60u);
    EXPECT_EQ(received->at, now);
    EXPECT_TRUE(std::equal(buffer.begin(), buffer.begin() + 60, frame().begin()));
    EXPECT_FALSE((*master)->receive(buffer, now));
}

TEST_F(RawSocket, OtherEtherTypesAreNotReceived) {
    auto master = RawSocketTransport::open("ecat0");
    auto slave = RawSocketTransport::open("ecat1");
    ASSERT_TRUE(master.ok() && slave.ok());
    ASSERT_TRUE((*master)->send(frame(0x88B5), now));
    ASSERT_TRUE((*master)->send(frame(), now));
    ASSERT_TRUE(wait_for_frame(**slave));
    EXPECT_EQ(buffer[13], std::byte{0xA4});
    EXPECT_FALSE((*slave)->receive(buffer, now));
}

TEST_F(RawSocket, SecondMasterOnAnInterfaceIsRefusedWithTheFirstOnesProcessId) {
    auto first = RawSocketTransport::open("ecat0");
    ASSERT_TRUE(first.ok()) << first.error().text();
    {
        const auto second = RawSocketTransport::open("ecat0");
        ASSERT_FALSE(second.ok());
        EXPECT_EQ(second.error().code, "transport.in_use");
        EXPECT_THAT(second.error().what, HasSubstr("process " + std::to_string(::getpid())));
    }
    EXPECT_TRUE(RawSocketTransport::open("ecat0", {.exclusive = false}).ok()) << "a listener may";
    *first = nullptr;
    EXPECT_TRUE(RawSocketTransport::open("ecat0").ok()) << "free again";
}

TEST_F(RawSocket, LinkStateFollowsTheCableWhenRefreshed) {
    auto master = RawSocketTransport::open("ecat0");
    ASSERT_TRUE(master.ok()) << master.error().text();
    const auto follows = [&](bool up) {  // the kernel reports carrier a moment later
        for (int i = 0; i < 1000 && (*master)->link_up() != up; ++i) {
            (*master)->refresh();
            std::this_thread::sleep_for(1ms);
        }
        return (*master)->link_up() == up;
    };
    EXPECT_TRUE(follows(true));
    ASSERT_TRUE(test::shell("ip link set ecat1 down"));
    EXPECT_TRUE(follows(false));
}

TEST_F(RawSocket, ErrorsSayWhatToDo) {
    const auto missing = RawSocketTransport::open("ecat7");
    ASSERT_FALSE(missing.ok());
    EXPECT_EQ(missing.error().code, "transport.no_such_interface");
    EXPECT_THAT(missing.error().text(), HasSubstr("ecat7"));
    EXPECT_THAT(missing.error().remedy, HasSubstr("ecat0"));
    EXPECT_EQ(RawSocketTransport::open("").error().code, "transport.no_such_interface");
    EXPECT_EQ(RawSocketTransport::open("a_name_longer_than_sixteen").error().code, "transport.no_such_interface");
    EXPECT_EQ(RawSocketTransport::open("lo").error().code, "transport.not_ethernet");

    ASSERT_TRUE(test::shell("ip link set ecat0 down"));
    const auto down = RawSocketTransport::open("ecat0");
    ASSERT_FALSE(down.ok());
    EXPECT_EQ(down.error().code, "transport.interface_down");
    EXPECT_THAT(down.error().remedy, HasSubstr("ip link set ecat0 up"));
}

// A frame lies in the socket for 5 ms before anybody asks: its stamp says when it came. (The kernel starts to stamp a moment
// after it was asked to: the first frames may have none.)
TEST_F(RawSocket, AnArrivalIsDatedByTheKernelAndNotByTheQuestion) {
    SystemClock clock;
    auto master = RawSocketTransport::open("ecat0");
    auto slave = RawSocketTransport::open("ecat1");
    ASSERT_TRUE(master.ok() && slave.ok());
    ASSERT_TRUE((*slave)->report().stamps_receipt) << (*slave)->report().time_stamps;
    Instant before{}, asked{}, at{};
    for (int i = 0; i < 200 && at == asked; ++i) {
        before = clock.now();
        ASSERT_TRUE((*master)->send(frame(), before));
        clock.sleep_until(clock.now() + 5ms);
        asked = clock.now();
        const auto received = (*slave)->receive(buffer, asked);
        ASSERT_TRUE(received);
        at = received->at;
    }
    EXPECT_GE(at, before);
    EXPECT_LE(at, asked - 4ms);
}

TEST_F(RawSocket, SendStampsMeasureTheWayToTheDriver) {
    SystemClock clock;
    auto master = RawSocketTransport::open("ecat0", {.send_stamps = true});
    ASSERT_TRUE(master.ok()) << master.error().text();
    ASSERT_TRUE((*master)->send(frame(), clock.now()));
    for (int i = 0; i < 1000 && (*master)->statistics().stamped == 0; ++i) {
        (*master)->refresh();
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ((*master)->statistics().stamped, 1u);
    EXPECT_GT((*master)->statistics().send_delay, 0ns);
    EXPECT_LT((*master)->statistics().send_delay, 1s);
    EXPECT_FALSE((*master)->receive(buffer, now)) << "stamps are no frames";
}

// The socket's buffer holds some hundred short frames.
TEST_F(RawSocket, FramesThatNobodyFetchedInTimeAreCounted) {
    auto master = RawSocketTransport::open("ecat0");
    auto slave = RawSocketTransport::open("ecat1");
    ASSERT_TRUE(master.ok() && slave.ok());
    std::uint64_t sent = 0;
    for (int i = 0; i < 3000; ++i) sent += (*master)->send(frame(), now) ? 1 : 0;
    for (int i = 0; i < 1000 && (*slave)->statistics().received + (*slave)->statistics().dropped < sent; ++i) {
        (*slave)->refresh();
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_GT((*slave)->statistics().dropped, 0u);
    EXPECT_EQ((*slave)->statistics().received + (*slave)->statistics().dropped, sent);
}

// A socket that is no packet socket refuses what only those have; stamps and priority it grants.
TEST_F(RawSocket, WhatTheKernelRefusedIsSaidOnceInWords) {
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const auto report = apply({.priority = 6}, socket, "ecat0");
    ::close(socket);
    EXPECT_THAT(report.refused, ::testing::ElementsAre(::testing::StartsWith("no filter for outgoing frames ("),
                                                       ::testing::StartsWith("no queue bypass (")));
    EXPECT_THAT(report.refused[1], HasSubstr("): frames pass the queueing discipline, some us later"));
    EXPECT_TRUE(report.sees_own_frames);

    const auto opened = RawSocketTransport::open("ecat0", {.priority = 6});
    ASSERT_TRUE(opened.ok()) << opened.error().text();
    EXPECT_TRUE((*opened)->report().refused.empty()) << "bypass, priority 6 and stamps need no privilege";
}

// Any local user may have an abstract socket of that name. He holds nobody up, and two masters still exclude each other.
TEST_F(RawSocket, WhoHoldsTheNameOfTheLockWithoutBeingAMasterHoldsNobodyUp) {
    const int squatter = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = "taktwerk.nic.ecat0";
    std::copy(name.begin(), name.end(), address.sun_path + 1);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    ASSERT_EQ(::bind(squatter, reinterpret_cast<const sockaddr*>(&address), size), 0);
    ASSERT_EQ(::listen(squatter, 1), 0);

    const auto first = RawSocketTransport::open("ecat0");
    ASSERT_TRUE(first.ok()) << first.error().text();
    EXPECT_THAT((*first)->report().refused, ::testing::Contains(HasSubstr("process " + std::to_string(::getpid()))));
    const auto second = RawSocketTransport::open("ecat0");
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.error().code, "transport.in_use");
    ::close(squatter);
}

TEST_F(RawSocket, MissingPrivilegeIsNamedWithTheCommandThatGivesIt) {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    std::array<__user_cap_data_struct, 2> before{}, without{};
    ASSERT_EQ(::syscall(SYS_capget, &header, before.data()), 0);
    without = before;
    without[0].effective &= ~(1u << CAP_NET_RAW);
    ASSERT_EQ(::syscall(SYS_capset, &header, without.data()), 0);

    const auto refused = RawSocketTransport::open("ecat0");

    ASSERT_EQ(::syscall(SYS_capset, &header, before.data()), 0);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, "transport.no_privilege");
    EXPECT_THAT(refused.error().remedy, HasSubstr("AmbientCapabilities=CAP_NET_RAW"));
    EXPECT_TRUE(RawSocketTransport::open("ecat0").ok()) << "the refused one left no lock behind";
}

}  // namespace
}  // namespace taktwerk::ecat
