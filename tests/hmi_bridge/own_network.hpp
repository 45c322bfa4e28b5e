#pragma once
// A network namespace of a test's own, in a child of it; skipped where the system allows none.

#include <arpa/inet.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace taktwerk::hmi::test {

inline bool loopback_up() {
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    ifreq request{};
    std::strcpy(request.ifr_name, "lo");
    bool ok = ::ioctl(socket, SIOCGIFFLAGS, &request) == 0;
    request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP);
    ok = ok && ::ioctl(socket, SIOCSIFFLAGS, &request) == 0;
    ::close(socket);
    return ok;
}

/// What the two commands of hmi.no_multicast_route do.
inline bool multicast_on() {
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

/// Runs `body` in a child with a network namespace of its own: "" when all is well, "skip", else what is wrong.
inline std::string in_own_network(const std::function<std::string()>& body) {
    constexpr int not_permitted = 77;
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

}  // namespace taktwerk::hmi::test

#define RUN_IN_OWN_NETWORK(...)                                                                               \
    do {                                                                                                      \
        const auto problem = ::taktwerk::hmi::test::in_own_network(__VA_ARGS__);                              \
        if (problem == "skip") GTEST_SKIP() << "this system does not allow a network namespace of one's own"; \
        EXPECT_EQ(problem, "");                                                                               \
    } while (false)
