// Service side and cyclic side on two threads, as in real time. The value of this test is under the thread sanitizer; the
// time is still virtual: the cycle thread owns it and hands it over.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

TEST(Threads, ServiceAndCycleMeetOnlyInAtomics) {
    TestBus bus{"sts"};
    bus.master = std::make_unique<Master>(bus.transport, bus.config);
    bus.master->start();
    std::atomic<std::int64_t> now_ns{0};
    std::atomic<std::int64_t> seen_ns{0};
    std::atomic<bool> end{false};
    std::thread cycle{[&] {
        std::array<AlarmFact, 8> faults;
        for (Instant now{}; !end; now += 1ms) {
            bus.master->receive(now);
            (void)bus.master->active_faults(faults);
            if (!bus.master->outputs().empty()) bus.master->outputs()[0] = std::byte{1};
            bus.master->send(now);
            now_ns.store(now.time_since_epoch().count());
            // A virtual cycle is much faster than the scheduler: never more than 5 ms ahead of the service side.
            while (!end && now_ns.load() - seen_ns.load() > 5'000'000) std::this_thread::yield();
        }
    }};
    std::optional<SdoTicket> ticket;
    std::optional<Result<SdoResult>> answer;
    // Bounded in machine time: 60 s.
    while (now_ns.load() < 60'000'000'000 && bus.master->phase() != Master::Phase::failed && !answer) {
        const std::int64_t now = now_ns.load();
        bus.master->step(Instant{Duration{now}});
        seen_ns.store(now);
        if (bus.master->phase() != Master::Phase::operational) continue;
        if (!ticket) ticket = bus.master->upload(0, 0x6085, 0);
        answer = bus.master->poll(*ticket);
    }
    end = true;
    cycle.join();
    EXPECT_TRUE(answer && answer->ok()) << bus.why();
}

}  // namespace
}  // namespace taktwerk::ecat::test
