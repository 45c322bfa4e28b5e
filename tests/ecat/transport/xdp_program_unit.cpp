// The program that picks EtherCAT, on an interface: who else may have one there, what becomes of it when its process dies, what is said where it
// cannot be.
#include "ecat/transport/xdp_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "ecat/transport/network_interface.hpp"
#include "tests/ecat/transport/doors.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;
using Place = XdpProgram::Place;
using Places = XdpProgram::Places;

struct XdpPort : ::testing::Test {
    void SetUp() override {
        if (!veth_network().empty()) GTEST_SKIP() << veth_network();
        ASSERT_TRUE(lay_veth_pair());
        const auto program = XdpProgram::load("ecat0");
        if (!program) GTEST_SKIP() << program.error().text();
        index = find_interface("ecat0")->index;
    }
    /// A program of its own, as another process would put it there. Nothing: it was refused with this code.
    std::string attach(std::optional<XdpProgram>& to, Places where) {
        auto program = XdpProgram::load("ecat0");
        if (!program) return program.error().code;
        const auto place = program->attach(index, where);
        if (!place) return place.error().code;
        to.emplace(std::move(*program));
        return *place == Place::driver ? "driver" : "stack";
    }
    unsigned index = 0;
};

TEST_F(XdpPort, TheDriverComesBeforeTheStack) {
    std::optional<XdpProgram> program;
    EXPECT_EQ(attach(program, Places::driver_or_stack), "driver") << "veth has one";
    program.reset();
    EXPECT_EQ(attach(program, Places::stack), "stack") << "free again";
}

// A bridge is Ethernet whose driver takes no program.
TEST_F(XdpPort, ADriverWithoutItLeavesTheStack) {
    ASSERT_TRUE(shell("ip link add plain0 type bridge && ip link set plain0 up"));
    index = find_interface("plain0")->index;
    std::optional<XdpProgram> program;
    EXPECT_EQ(attach(program, Places::driver), "transport.no_xdp");
    EXPECT_EQ(attach(program, Places::driver_or_stack), "stack");
    program.reset();
    EXPECT_TRUE(shell("ip link del plain0"));
}

TEST_F(XdpPort, SomebodyElsesProgramStays) {
    for (const auto theirs : {Places::driver, Places::stack})
        for (const auto ours : {Places::driver, Places::stack, Places::driver_or_stack}) {
            std::optional<XdpProgram> first, second;
            ASSERT_NE(attach(first, theirs), "transport.xdp_taken");
            EXPECT_EQ(attach(second, ours), "transport.xdp_taken");
        }
    std::optional<XdpProgram> theirs;
    ASSERT_EQ(attach(theirs, Places::stack), "stack");
    auto packet = RawSocketTransport::open("ecat0");
    ASSERT_TRUE(packet.ok());
    const auto refused = XdpTransport::open(**packet, Places::driver_or_stack);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, "transport.xdp_taken");
    EXPECT_THAT(refused.error().text(), HasSubstr("another XDP program is on it"));
    EXPECT_THAT(refused.error().remedy, HasSubstr("ip link set dev ecat0 xdp off"));
}

TEST_F(XdpPort, AProcessThatIsKilledLeavesNoProgramBehind) {
    for (const auto where : {Places::driver, Places::stack}) {
        int ready[2];
        ASSERT_EQ(::pipe(ready), 0);
        const pid_t child = ::fork();
        if (child == 0) {
            auto packet = RawSocketTransport::open("ecat0");
            const auto xdp = packet ? XdpTransport::open(**packet, where) : packet.error();
            const char said = xdp.ok() ? 'y' : 'n';
            (void)!::write(ready[1], &said, 1);
            ::pause();
            ::_exit(0);
        }
        char said = 0;
        ASSERT_EQ(::read(ready[0], &said, 1), 1);
        ::close(ready[0]);
        ::close(ready[1]);
        EXPECT_EQ(said, 'y');
        std::optional<XdpProgram> ours;
        EXPECT_EQ(attach(ours, where), "transport.xdp_taken") << "while it lives";

        ::kill(child, SIGKILL);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFSIGNALED(status));

        for (int i = 0; i < 1000 && !ours; ++i) {
            if (attach(ours, where) == "transport.xdp_taken") std::this_thread::sleep_for(1ms);
        }
        EXPECT_TRUE(ours);
    }
}

TEST_F(XdpPort, AQueueThatIsTakenIsNamed) {
    const auto first = XdpSocket::open("ecat0", index);
    ASSERT_TRUE(first.ok()) << first.error().text();
    const auto second = XdpSocket::open("ecat0", index);
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.error().code, "transport.no_xdp");
    EXPECT_THAT(second.error().what, HasSubstr("taking queue 0 failed"));
}

TEST_F(XdpPort, WithoutThePrivilegeItSaysWhichOnes) {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    std::array<__user_cap_data_struct, 2> before{}, without{};
    ASSERT_EQ(::syscall(SYS_capget, &header, before.data()), 0);
    without = before;
    without[0].effective &= ~((1u << CAP_NET_ADMIN) | (1u << CAP_SYS_ADMIN));
    without[1].effective &= ~(1u << (CAP_BPF - 32));
    ASSERT_EQ(::syscall(SYS_capset, &header, without.data()), 0);

    const auto refused = XdpProgram::load("ecat0");

    ASSERT_EQ(::syscall(SYS_capset, &header, before.data()), 0);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, "transport.no_xdp");
    EXPECT_THAT(refused.error().what, HasSubstr("lacks a privilege"));
    EXPECT_THAT(refused.error().remedy, HasSubstr("CAP_NET_RAW, CAP_NET_ADMIN and CAP_BPF"));
    EXPECT_THAT(refused.error().remedy, HasSubstr("`transport: packet`"));
}

}  // namespace
}  // namespace taktwerk::ecat::test
