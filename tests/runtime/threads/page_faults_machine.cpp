// Page faults of the cycle's thread in a run in real time: a program that calls fork() marks every page of the machine to be copied, and the cycle pays
// for each that it writes next.
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>

#include "runtime/alarms.hpp"
#include "runtime/run/realtime_runner.hpp"
#include "tests/patience.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

std::atomic<bool> shall_fork{false};

class Forking final : public Program {
public:
    void declare(Declaration& d) override { d.task<&Forking::slow>("slow"); }
    void slow(TaskContext&) {
        if (!shall_fork.exchange(false)) return;
        const auto child = ::fork();
        if (child == 0) ::_exit(0);
        if (child > 0) ::waitpid(child, nullptr, 0);
    }
};

bool has(const Snapshot& s, MachineAlarm alarm) {
    return std::any_of(s.alarms.begin(), s.alarms.begin() + static_cast<std::ptrdiff_t>(s.alarm_count),
                       [&](const ActiveAlarm& each) { return each.fact.id == id(alarm); });
}

TEST(PageFaultsInOperation, AForkOfAProgramIsCountedAndTold) {
    shall_fork = false;
    auto config = machine_config(1);
    config.cycle = config.bus.cycle = 4ms;
    config.simulation.supervision = Supervision::relaxed;
    config.realtime.priority = 0;
    config.realtime.lock_memory = true;
    config.start_mode = Mode::automatic;
    config.programs.push_back({"p", {}, &entry_of<Forking>, {}, true});
    TaskConfig task;
    task.overrun = OverrunReaction::count;
    task.divisor = 2;
    task.program = "p";
    task.name = "slow";
    config.tasks.push_back(task);
    SystemClock clock;
    World world{config, clock.now()};
    auto built = Machine::build(config, world.transport());
    ASSERT_EQ(built.index(), 0u) << std::get<1>(built)[0].text();
    auto& machine = *std::get<0>(built);
    RealtimeRunner runner{machine, &world};
    const auto report = runner.start();
    ASSERT_TRUE(report.ok());
    const bool locked =
        std::any_of(report->items.begin(), report->items.end(), [](const auto& i) { return i.what == memory_locked && i.granted; });

    Instant up{};
    bool forked = false, told = false;
    std::uint64_t before = 0, after = 0;
    Patience patience{60'000};
    const auto served = runner.serve([&](Instant now) {
        const auto* s = machine.latest();
        if (machine.phase() != MachinePhase::running || s == nullptr) return patience.lasts(true);
        if (up == Instant{}) up = now;
        if (now - up > 1500ms && !forked) {  // the first second is not counted
            before = s->statistics.page_faults;
            forked = true;
            shall_fork = true;
        }
        told = told || (forked && has(*s, MachineAlarm::page_faults));
        after = s->statistics.page_faults;
        return patience.lasts(!(forked && after > before && (told || !locked)));
    });
    runner.finish();
    ::munlockall();
    ASSERT_TRUE(served.ok()) << served.error().text();
    EXPECT_TRUE(forked);
    EXPECT_GT(after, before);
    EXPECT_TRUE(told || !locked) << "memory is locked, so a fault is an alarm";
}

}  // namespace
}  // namespace taktwerk::runtime::testing
