// After arming, the cycle thread allocates nothing and makes no system call but those of waiting, sending and receiving. Proven on a
// thread of its own; and the proof is shown to fail when something forbidden is put in.

#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "core/guard/allocation_guard.hpp"
#include "core/realtime_guard.hpp"
#include "fb_library/all_blocks.hpp"
#include "runtime/tasks/program_library.hpp"
#include "tests/patience.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;

// Sanitizers make system calls of their own on every thread (the thread sanitizer at each allocation and lock of its shadow), and a
// restricted thread does not survive that. Under them the same machine runs unrestricted: the heap is still watched, and so are the threads.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool calls_can_be_watched = false;
#else
constexpr bool calls_can_be_watched = true;
#endif

/// What the program does wrong in its scans, set by a test.
std::atomic<int> misdeed{0};

class Shuttle final : public Program {
    AxisRef x_;
    MC_Power power_;
    MC_Home home_;
    MC_MoveAbsolute there_, back_;
    TON timer_;
    Output<bool> lamp_;
    std::unique_ptr<int> heap_;

public:
    void declare(Declaration& d) override {
        x_ = d.axis("x");
        lamp_ = d.output("lamp");
        d.task<&Shuttle::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power_.Axis = home_.Axis = there_.Axis = back_.Axis = x_;
        power_.Enable = true;
        power_(ctx);
        home_.Execute = power_.Status;
        home_(ctx);
        there_.Position = 100;
        there_.Velocity = back_.Velocity = 300;
        there_.Execute = home_.Done && !there_.Done && !back_.Busy;
        there_(ctx);
        back_.Execute = there_.Done || back_.Busy;
        back_(ctx);
        timer_.IN = there_.Busy;
        timer_.PT = 100ms;
        timer_(ctx);
        ctx.set(lamp_, timer_.Q);
        if (misdeed.load() == 1) heap_ = std::make_unique<int>(1);
        if (misdeed.load() == 2) ::syscall(SYS_getpid);
    }
};

MachineConfig config() {
    static const ProgramEntry entry{program_magic,
                                    sizeof(ProgramEntry),
                                    ProgramLibrary::expected_abi(),
                                    "0.1.0",
                                    "shuttle",
                                    []() -> Program* { return new Shuttle; },
                                    [](Program* p) { delete p; }};
    auto c = machine_config(3);
    c.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    ProgramConfig program;
    program.name = "p";
    program.entry = [] { return &entry; };
    program.autostart = true;
    c.programs.push_back(program);
    c.start_mode = Mode::automatic;
    return c;
}

/// Runs `cycles` on a fresh thread that may not allocate; the service side runs between them, unwatched, on the caller's thread.
struct Watched {
    std::uint64_t heap = 0;
    bool call_caught = false;
    std::string what;
};

Watched watch(TestMachine& m, int cycles, bool restrict_calls) {
    Watched result;
    ForbiddenSystemCalls forbidden;
    std::atomic<int> turn{0};  // 0: service, 1: cycle, 2: end
    std::thread cycle_thread{[&] {
        if (restrict_calls) {
            // The hand-over between the two threads of this test spins; it makes no call either.
            auto ok = restrict_cycle_thread_system_calls(SystemCallMode::record);
            if (!ok) result.what = "the restriction itself was refused";
        }
        for (;;) {
            int now = turn.load(std::memory_order_acquire);
            if (now == 2) break;
            if (now != 1) continue;
            const auto at = m.clock.now();
            {
                const NoAllocationScope scope;
                m.machine->cycle({at, at, 0});
                result.heap += scope.used().total();
            }
            turn.store(0, std::memory_order_release);
        }
        if (restrict_calls) forbidden = forbidden_system_calls();
    }};
    for (int i = 0; i < cycles; ++i) {
        m.clock.advance(1ms);
        turn.store(1, std::memory_order_release);
        for (Patience patience{100'000'000'000}; patience.lasts(turn.load(std::memory_order_acquire) != 0);) {}  // spins: minutes
        m.machine->service(m.clock.now());
    }
    turn.store(2, std::memory_order_release);
    cycle_thread.join();
    result.call_caught = forbidden.count > 0;
    if (result.call_caught) result.what += forbidden.text();
    return result;
}

struct CycleThread : ::testing::Test {
    void SetUp() override { misdeed = 0; }
    void TearDown() override { misdeed = 0; }
};

TEST_F(CycleThread, AllocatesNothingAndCallsNothingWhileAxesMoveAndFaultsHappen) {
    TestMachine m{config()};
    ASSERT_TRUE(m.up());
    const auto moving = watch(m, 1500, calls_can_be_watched);
    EXPECT_EQ(moving.heap, 0u);
    EXPECT_FALSE(moving.call_caught) << moving.what;
    ASSERT_GT(m.axis(0).set_position, 1.0) << "it has to move for this to prove anything";

    m.world.drive("x")->raise(0x3130);
    m.world.set_input("estop_ok", false);
    m.world.transport().faults.drop_answers = 5;
    const auto faulty = watch(m, 500, calls_can_be_watched);
    EXPECT_EQ(faulty.heap, 0u);
    EXPECT_FALSE(faulty.call_caught) << faulty.what;
    EXPECT_GT(m.state().alarm_count, 0u);
}

TEST_F(CycleThread, TheProofFailsWhenAProgramAllocates) {
    TestMachine m{config()};
    ASSERT_TRUE(m.up());
    misdeed = 1;
    EXPECT_GE(watch(m, 50, false).heap, 50u);
}

TEST_F(CycleThread, TheProofFailsWhenAProgramMakesASystemCall) {
    if (!calls_can_be_watched) GTEST_SKIP() << "sanitizers make system calls of their own";
    TestMachine m{config()};
    ASSERT_TRUE(m.up());
    misdeed = 2;
    const auto seen = watch(m, 50, true);
    EXPECT_TRUE(seen.call_caught) << seen.what;
}

}  // namespace
}  // namespace taktwerk::runtime::testing
