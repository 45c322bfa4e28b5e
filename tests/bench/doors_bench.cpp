// One frame there and back over a veth pair, by each door of the kernel. Twice: both ends played by one thread, which is what the doors
// themselves cost; and the far end a thread that sleeps until a frame comes, as slaves of another process are, a frame each millisecond. Makes its own
// network namespace. Arguments: frames (20000).
//
// Google Benchmark's arguments, which `./dev bench` hands to every program, are ignored.

#include <poll.h>
#include <sched.h>
#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "core/clock.hpp"
#include "ecat/transport/raw_socket.hpp"
#include "ecat/transport/xdp_transport.hpp"
#include "tests/ecat/transport/veth_pair.hpp"

namespace {

using namespace taktwerk;
using namespace std::chrono_literals;

bool realtime(int priority) {
    sched_param parameters{};
    parameters.sched_priority = priority;
    return ::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
}

/// Nanoseconds; sorted by row().
using Times = std::vector<std::int64_t>;

void row(const char* door, std::size_t bytes, const char* what, Times times) {
    if (times.empty()) return;
    std::sort(times.begin(), times.end());
    const auto us = [&](double part) {
        return static_cast<double>(times[static_cast<std::size_t>(part * static_cast<double>(times.size() - 1))]) / 1e3;
    };
    fmt::print("{:<26} {:>5} {:<22} {:>8.1f} {:>8.1f} {:>8.1f} {:>9.1f}\n", door, bytes, what, us(0), us(0.5), us(0.99), us(1));
}

std::vector<std::byte> frame(std::size_t size) {
    std::vector<std::byte> bytes(size, std::byte{0x5A});
    std::fill_n(bytes.begin(), 6, std::byte{0xFF});
    bytes[12] = std::byte{0x88};
    bytes[13] = std::byte{0xA4};
    return bytes;
}

/// False: nothing came for 100 ms.
bool fetch(ecat::Transport& by, std::span<std::byte> buffer, const Clock& clock) {
    const Instant patience = clock.now() + 100ms;
    for (Instant now{}; now < patience;) {
        now = clock.now();
        if (by.receive(buffer, now)) return true;
    }
    return false;
}

struct Measured {
    Times there_and_back, send, receive;
    int lost = 0;
};

Measured by_one_thread(ecat::Transport& near, ecat::Transport& far, std::size_t bytes, int frames) {
    const SystemClock clock;
    const auto out = frame(bytes);
    std::array<std::byte, ecat::max_frame_size> buffer{};
    Measured seen;
    for (int i = 0; i < frames; ++i) {
        const Instant begun = clock.now();
        near.send(out, begun);
        const Instant sent = clock.now();
        if (!fetch(far, buffer, clock)) {
            ++seen.lost;
            continue;
        }
        far.send(std::span{buffer}.first(bytes), clock.now());
        const Instant asked = clock.now();
        if (!fetch(near, buffer, clock)) {
            ++seen.lost;
            continue;
        }
        const Instant back = clock.now();
        seen.there_and_back.push_back((back - begun).count());
        seen.send.push_back((sent - begun).count());
        seen.receive.push_back((back - asked).count());
    }
    return seen;
}

Measured by_two_threads(ecat::Transport& near, ecat::RawSocketTransport& far, std::size_t bytes, int frames) {
    std::atomic<bool> stop{false};
    std::thread other_end{[&] {
        realtime(60);
        const SystemClock clock;
        std::array<std::byte, ecat::max_frame_size> buffer{};
        while (!stop.load()) {
            pollfd wait{far.descriptor(), POLLIN, 0};
            ::poll(&wait, 1, 1);
            while (const auto received = far.receive(buffer, clock.now())) far.send(std::span{buffer}.first(received->size), clock.now());
        }
    }};
    SystemClock clock;
    const auto out = frame(bytes);
    std::array<std::byte, ecat::max_frame_size> buffer{};
    Measured seen;
    Instant due = clock.now();
    for (int i = 0; i < frames; ++i) {
        due = std::max(due + 1ms, clock.now());
        clock.sleep_until(due);
        const Instant begun = clock.now();
        near.send(out, begun);
        if (fetch(near, buffer, clock)) seen.there_and_back.push_back((clock.now() - begun).count());
        else ++seen.lost;
    }
    stop = true;
    other_end.join();
    return seen;
}

enum class Door { packet, xdp_stack, xdp_driver };

void measure(const char* name, Door door, int frames) {
    if (!ecat::test::lay_veth_pair()) return;
    auto packet = ecat::RawSocketTransport::open("ecat0");
    auto far = ecat::RawSocketTransport::open("ecat1");
    if (!packet || !far) {
        fmt::print("{:<26} {}\n", name, (packet ? far : packet).error().text());
        return;
    }
    std::unique_ptr<ecat::XdpTransport> xdp;
    if (door != Door::packet) {
        using Places = ecat::XdpProgram::Places;
        auto opened = ecat::XdpTransport::open(**packet, door == Door::xdp_stack ? Places::stack : Places::driver);
        if (!opened) {
            fmt::print("{:<26} {}\n", name, opened.error().text());
            return;
        }
        xdp = std::move(*opened);
    }
    ecat::Transport& near = xdp ? static_cast<ecat::Transport&>(*xdp) : **packet;
    int lost = 0;
    for (const std::size_t bytes : {60u, 1514u}) {
        const auto alone = by_one_thread(near, **far, bytes, frames);
        row(name, bytes, "there and back", alone.there_and_back);
        row(name, bytes, "  of it: send", alone.send);
        row(name, bytes, "  of it: receive", alone.receive);
        lost += alone.lost;
    }
    const auto apart = by_two_threads(near, **far, 60, frames);
    row(name, 60, "far end asleep", apart.there_and_back);
    if (lost + apart.lost > 0) fmt::print("{:<26} {} frames lost\n", name, lost + apart.lost);
}

double load() {
    double minute = 0;
    return ::getloadavg(&minute, 1) == 1 ? minute : 0;
}

}  // namespace

int main(int argc, char** argv) {
    const int given = argc > 1 ? std::atoi(argv[1]) : 0;
    const int frames = given > 0 ? given : 20'000;
    if (const auto& problem = ecat::test::veth_network(); !problem.empty()) {
        fmt::print("doors: skipped, {}\n", problem);
        return 0;
    }
    utsname system{};
    ::uname(&system);
    const double before = load();
    fmt::print("One frame there and back over veth, {} each, us; Linux {}, {} CPUs, {}, load {:.2f} before.\n", frames, system.release,
               std::thread::hardware_concurrency(), realtime(70) ? "SCHED_FIFO" : "no real-time priority", before);
    fmt::print("{:<26} {:>5} {:<22} {:>8} {:>8} {:>8} {:>9}\n", "", "bytes", "", "min", "p50", "p99", "max");
    measure("AF_PACKET", Door::packet, frames);
    measure("AF_XDP before the stack", Door::xdp_stack, frames);
    measure("AF_XDP in the driver", Door::xdp_driver, frames);
    fmt::print("load {:.2f} after\n\n", load());
    // Taken once, over veth on this kind of machine while it was loaded: figures of others are no figures of this run.
    fmt::print(
        "Peers on AF_PACKET, from earlier runs over veth on such a machine, slaves in another process; p50 / p99 / p99.9 us:\n"
        "  SOEM (b410bf6), 1 ms, 8 slaves                 50-55 / 87-114 / 399-481\n"
        "  Taktwerk, the same slaves and cable            55-61 / 102-119 / 377-557\n"
        "  SOEM ec_sample, 1 ms, 2 slaves, tcpdump beside 40 / 1457 / 19387, max 34136\n"
        "  SOEM slaveinfo, one FPRD after another         26 / 205 / 1915, max 10838\n"
        "  KickCAT (f10386d) ds402_sinus, 1 ms, 1 drive   68 / 731 / 3596, max 7916\n"
        "  KickCAT easycat_example, 1 ms, 2 slaves        84 / 273 / 1643, max 17069\n");
    return 0;
}
