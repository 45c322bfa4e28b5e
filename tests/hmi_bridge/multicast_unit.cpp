// LCM over real UDP multicast, in a network namespace of the test's own; skipped where the system allows none.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <net/if.h>
#include <net/route.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <functional>
#include <string>

#include "hmi_bridge/hmi_bridge.hpp"
#include "hmi_bridge/lcm/lcm_bus.hpp"
#include "taktwerk_lcm/axis_state_v1_t.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;

constexpr const char* url = "udpm://239.255.76.67:7667?ttl=0";
constexpr int not_permitted = 77;

bool loopback_up() {
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    ifreq request{};
    std::strcpy(request.ifr_name, "lo");
    bool ok = ::ioctl(socket, SIOCGIFFLAGS, &request) == 0;
    request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP);
    ok = ok && ::ioctl(socket, SIOCSIFFLAGS, &request) == 0;
    ::close(socket);
    return ok;
}

/// What the two commands of the error message do.
bool multicast_on() {
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    ifreq request{};
    std::strcpy(request.ifr_name, "lo");
    bool ok = ::ioctl(socket, SIOCGIFFLAGS, &request) == 0;
    request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_MULTICAST);
    ok = ok && ::ioctl(socket, SIOCSIFFLAGS, &request) == 0;
    rtentry route{};
    const auto set = [](sockaddr& where, const char* address) {
        sockaddr_in in{};
        in.sin_family = AF_INET;
        ::inet_pton(AF_INET, address, &in.sin_addr);
        std::memcpy(&where, &in, sizeof in);
    };
    set(route.rt_dst, "224.0.0.0");
    set(route.rt_genmask, "240.0.0.0");
    std::string device = "lo";
    route.rt_dev = device.data();
    route.rt_flags = RTF_UP;
    ok = ok && ::ioctl(socket, SIOCADDRT, &route) == 0;
    ::close(socket);
    return ok;
}

/// Runs `body` in a child with a network namespace of its own: "" when all is well, else what is wrong.
std::string in_own_network(const std::function<std::string()>& body) {
    int pipe_ends[2];
    if (::pipe(pipe_ends) != 0) return "no pipe";
    const pid_t child = ::fork();
    if (child == 0) {
        ::alarm(60);  // what hangs in it ends; the pipe below then closes
        const bool own = (::unshare(CLONE_NEWNET) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0) && loopback_up();
        if (!own) ::_exit(not_permitted);
        const auto problem = body();
        [[maybe_unused]] const auto written = ::write(pipe_ends[1], problem.data(), problem.size());
        ::_exit(problem.empty() ? 0 : 1);
    }
    ::close(pipe_ends[1]);
    std::string problem(4096, '\0');
    const auto got = ::read(pipe_ends[0], problem.data(), problem.size());
    problem.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    ::close(pipe_ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == not_permitted) return "skip";
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
    return problem.empty() ? "the child died" : problem;
}

#define RUN_IN_OWN_NETWORK(body)                                                                              \
    do {                                                                                                      \
        const auto problem = in_own_network(body);                                                            \
        if (problem == "skip") GTEST_SKIP() << "this system does not allow a network namespace of one's own"; \
        EXPECT_EQ(problem, "");                                                                               \
    } while (false)

TEST(Multicast, WithoutARouteTheErrorNamesTheTwoCommandsThatMendIt) {
    RUN_IN_OWN_NETWORK([]() -> std::string {
        const auto bus = LcmBus::open(*parse_lcm_url(url));
        if (bus) return "LCM opened without a route";
        if (bus.error().code != "hmi.no_multicast_route") return bus.error().text();
        for (const auto* command : {"ip link set lo multicast on", "ip route add 224.0.0.0/4 dev lo"})
            if (bus.error().remedy.find(command) == std::string::npos) return "the remedy does not name " + std::string(command);
        return "";
    });
}

TEST(Multicast, WithoutARouteTheMachineRunsOnUnlessLcmIsRequired) {
    RUN_IN_OWN_NETWORK([]() -> std::string {
        test::FakeMachine machine;
        HmiConfig config;
        config.socket = "/tmp/taktwerk-multicast-test-" + std::to_string(::getpid());
        {
            auto bridge = HmiBridge::open(config, machine, {});
            if (!bridge) return "did not run on: " + bridge.error().text();
            if (!(*bridge)->lcm_problem()) return "no problem reported";
            (*bridge)->step(Instant{1s});
        }
        config.lcm_required = true;
        const auto required = HmiBridge::open(config, machine, {});
        if (required) return "ran without the required LCM";
        return required.error().code == "hmi.no_multicast_route" ? "" : required.error().text();
    });
}

TEST(Multicast, StateIsPublishedAndReceivedOnThisHost) {
    RUN_IN_OWN_NETWORK([]() -> std::string {
        if (!multicast_on()) return "skip";
        auto receiver = LcmBus::open(*parse_lcm_url(url));
        if (!receiver) return receiver.error().text();
        int axes = 0;
        std::string name;
        (*receiver)->subscribe("TAKTWERK_DEMO_AXIS_STATE", [&](std::span<const std::byte> bytes) {
            taktwerk_lcm::axis_state_v1_t message;
            if (message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0) return;
            name = message.name;
            ++axes;
        });
        test::FakeMachine machine;
        HmiConfig config;
        config.socket = "/tmp/taktwerk-multicast-test-" + std::to_string(::getpid());
        auto bridge = HmiBridge::open(config, machine, {});
        if (!bridge) return bridge.error().text();
        if ((*bridge)->lcm_problem()) return (*bridge)->lcm_problem()->text();
        (*bridge)->step(Instant{1s});
        // Three datagrams through the kernel and LCM's thread: the pipe says when; ten seconds are for a machine under load.
        for (int round = 0; round < 1000 && axes < 3; ++round) {
            (*receiver)->poll(16);
            if (axes < 3) ::poll(nullptr, 0, 10);
        }
        if (axes != 3) return "received " + std::to_string(axes) + " of 3 axes";
        return name == "turret" ? "" : "wrong name " + name;
    });
}

}  // namespace
}  // namespace taktwerk::hmi
