// Ways to hold up a stop, each staged on a whole machine: real frames, real sockets, virtual time. What blocks is not called at all (the
// service side, the programs' hooks, the disk, a slower task); what floods, floods. Each time an axis moves, somebody wants it to stop,
// and what counts is in which cycle after the bytes reached the process the ramp begins, and when the axis stands.
//
// docs/stopping.md carries the figures; TAKTWERK_REGENERATE=1 writes them.

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include <fmt/format.h>

#include "fb_library/all_blocks.hpp"
#include "hmi_bridge/hmi_bridge.hpp"
#include "hmi_bridge/runtime_link.hpp"
#include "tests/hmi_bridge/caller.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::hmi {
namespace {

using namespace std::chrono_literals;
using runtime::testing::RunsX;
using runtime::testing::TestMachine;
using test::Caller;

/// A program that moves x, with a slower task that nobody runs when the test says so.
class Mover final : public RunsX {
public:
    Mover() { velocity = 100; }
    void declare(Declaration& d) override {
        RunsX::declare(d);
        d.task<&Mover::plan>("plan");
    }
    void plan(TaskContext&) {}
};

/// Who moves x.
enum class By { operator_move, jog, program };

runtime::MachineConfig config(By by) {
    auto config = runtime::testing::with_program(2, &runtime::testing::entry_of<Mover>);
    runtime::TaskConfig slow;
    slow.name = "plan";
    slow.program = "p";
    slow.divisor = 4;
    slow.overrun = runtime::OverrunReaction::count;
    config.tasks.push_back(slow);
    if (by == By::program) return config;
    config.programs[0].autostart = false;
    config.start_mode = runtime::Mode::manual;
    return config;
}

class Rig {
public:
    explicit Rig(By by = By::operator_move) : m(config(by)) {
        EXPECT_TRUE(m.up());
        for (const std::uint16_t axis : std::array<std::uint16_t, 2>{0, 1}) {
            if (by == By::program) break;
            m.enable(axis);
            m.home(axis);
        }
        HmiConfig hmi;
        hmi.lcm = false;
        hmi.socket = folder + "/demo.sock";
        auto opened = HmiBridge::open(hmi, link, {.log = {}, .wall_utime = [] { return wall; }, .bus = nullptr, .door = DoorThread::own});
        EXPECT_TRUE(opened) << opened.error().text();
        bridge = std::move(opened).value();
    }
    ~Rig() {
        bridge.reset();
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    static std::string new_folder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "taktwerk-stop-XXXXXX").string();
        return ::mkdtemp(pattern.data());
    }

    /// The worst order there is: what has just come is read after the cycle.
    void cycle() {
        auto& machine = *m.machine;
        m.clock.advance(machine.config().cycle + machine.bus().period_correction());
        const auto now = m.clock.now();
        m.world.apply_events(now);
        if (!cycle_hangs) machine.cycle({now, now, 0});
        if (!slow_task_hangs) machine.run_slow_tasks();
        if (!service_hangs) {
            machine.service_bus(now);
            bridge->step(now);
        }
        if (!programs_hang) machine.service_programs();
        if (!disk_hangs) machine.service_disk(now);
        bridge->door().step(now);
        if (each_cycle) each_cycle();
    }
    void cycles(int count) {
        for (; count > 0; --count) cycle();
    }
    Caller call() { return Caller{folder + "/demo.sock"}; }
    Caller called() {
        auto caller = call();
        cycle();
        return caller;
    }
    std::vector<Caller> eight() {
        std::vector<Caller> all;
        for (std::size_t i = 0; i < SocketServer::max_connections; ++i) all.push_back(called());
        return all;
    }
    std::string ask(const Caller& caller, const std::string& line) {
        caller.say(line + "\n");
        std::string answer;
        for (int i = 0; i < 20 && answer.empty(); ++i) {
            cycle();
            answer = caller.hear();
        }
        return answer;
    }
    const axes::AxisView& x() { return m.state().axes[0]; }
    void until_speed(double velocity) {
        for (int i = 0; i < 5000 && x().set_velocity != velocity; ++i) cycle();
        ASSERT_EQ(x().set_velocity, velocity);
    }

    static constexpr std::int64_t wall = 1'700'000'000'000'000;
    std::string folder = new_folder();
    TestMachine m;
    RuntimeLink link{*m.machine};
    std::unique_ptr<HmiBridge> bridge;
    std::function<void()> each_cycle;
    bool service_hangs = false, programs_hang = false, disk_hangs = false, slow_task_hangs = false, cycle_hangs = false;
};

const std::string stop_line = "{\"id\":900000,\"cmd\":\"stop\"}\n";

struct Way {
    const char* held_up_by;  // what stands in the way
    const char* stopped_by;
    /// Stages it while x moves, then stops x. What it returns lives until the axis stands.
    std::function<std::shared_ptr<void>(Rig&)> stage;
    By by = By::operator_move;  // jog: by the first client, `holder`
};

template <class T>
std::shared_ptr<void> keep(T value) {
    return std::make_shared<T>(std::move(value));
}

std::shared_ptr<void> flooded(Rig& rig, std::string line) {
    auto all = std::make_shared<std::vector<Caller>>(rig.eight());
    rig.each_cycle = [all, line] {
        for (const auto& caller : *all) caller.flood(line);
    };
    rig.cycles(20);
    auto ninth = std::make_shared<Caller>(rig.call());
    ninth->say(stop_line);
    return ninth;
}

Caller* holder = nullptr;  // of By::jog

const std::vector<Way>& ways() {
    static const std::vector<Way> known{
        {"nothing (for comparison)", "stop",
         [](Rig& r) {
             auto c = r.called();
             c.say(stop_line);
             return keep(std::move(c));
         }},
        {"service thread stands (LCM that hangs, a bus script, a bug)", "stop",
         [](Rig& r) {
             auto c = r.called();
             r.service_hangs = true;
             r.cycles(3000);
             c.say(stop_line);
             return keep(std::move(c));
         }},
        {"service thread stands", "shutdown",
         [](Rig& r) {
             auto c = r.called();
             r.service_hangs = true;
             r.cycles(3000);
             c.say("{\"id\":1,\"cmd\":\"shutdown\"}\n");
             return keep(std::move(c));
         }},
        {"start() of a program waits", "stop",
         [](Rig& r) {
             auto c = r.called();
             r.programs_hang = true;
             r.cycles(100);
             c.say(stop_line);
             return keep(std::move(c));
         }},
        {"a disk does not take the positions (fsync)", "stop",
         [](Rig& r) {
             auto c = r.called();
             r.disk_hangs = true;
             r.cycles(3000);
             c.say(stop_line);
             return keep(std::move(c));
         }},
        {"a slower task never returns", "stop",
         [](Rig& r) {
             auto c = r.called();
             r.slow_task_hangs = true;
             r.cycles(100);
             EXPECT_EQ(r.m.machine->program_at_work(), "task 'plan' of program 'p'");
             c.say(stop_line);
             return keep(std::move(c));
         },
         By::program},
        {"the cycle's inbox is full", "stop",
         [](Rig& r) {
             auto c = r.called();
             runtime::OperatorCommand filler;
             filler.action = runtime::OperatorAction::acknowledge_alarms;
             auto* machine = r.m.machine.get();
             r.each_cycle = [machine, filler] {
                 for (Patience patience; patience.lasts(machine->submit(filler));) {}
             };
             r.cycles(50);
             c.say(stop_line);
             return keep(std::move(c));
         }},
        {"16 commands of the same client wait for their answers", "stop",
         [](Rig& r) {
             auto c = r.called();
             r.service_hangs = true;
             for (int i = 1; i <= 16; ++i) c.say(fmt::format("{{\"id\":{},\"cmd\":\"acknowledge\"}}\n", i));
             r.cycles(3);
             c.say(stop_line);
             return keep(std::move(c));
         }},
        {"8 clients that say nothing", "stop",
         [](Rig& r) {
             auto idle = std::make_shared<std::vector<Caller>>(r.eight());
             auto c = r.call();
             c.say(stop_line);
             return keep(std::pair{idle, std::move(c)});
         }},
        {"8 clients that flood `acknowledge`", "stop", [](Rig& r) { return flooded(r, "{\"id\":1,\"cmd\":\"acknowledge\"}\n"); }},
        {"8 clients that flood `jog` renewals", "stop",
         [](Rig& r) { return flooded(r, "{\"id\":1,\"cmd\":\"jog\",\"axis\":\"y\",\"velocity\":5}\n"); }},
        {"8 clients that flood `state` and never read", "stop", [](Rig& r) { return flooded(r, "{\"cmd\":\"state\"}\n"); }},
        {"8 clients that flood binary rubbish", "stop", [](Rig& r) { return flooded(r, "\x01\xff\xfe{]\n"); }},
        {"8 clients with lines of 64 KiB", "stop", [](Rig& r) { return flooded(r, std::string(SocketServer::max_line - 1, 'x') + "\n"); }},
        {"8 clients with half a line each", "stop",
         [](Rig& r) {
             auto all = std::make_shared<std::vector<Caller>>(r.eight());
             for (const auto& c : *all) c.say("{\"id\":1,\"cmd\":\"sto");
             r.cycles(5);
             auto ninth = r.call();
             ninth.say(stop_line);
             return keep(std::pair{all, std::move(ninth)});
         }},
        {"40 connections at once", "stop",
         [](Rig& r) {
             std::vector<Caller> all;
             for (int i = 0; i < 8; ++i) all.push_back(r.call());
             auto ours = r.called();
             for (int i = 0; i < 32; ++i) all.push_back(r.call());
             ours.say(stop_line);
             return keep(std::pair{std::move(all), std::move(ours)});
         }},
        {"the client's own 3000 commands before it", "stop",
         [](Rig& r) {
             auto c = r.called();
             std::string lines;
             for (int i = 1; i <= 3000; ++i) lines += fmt::format("{{\"id\":{},\"cmd\":\"acknowledge\"}}\n", i);
             c.say(lines + stop_line);
             return keep(std::move(c));
         }},
        {"a clock 1.5 s behind in `utime`", "stop",
         [](Rig& r) {
             auto c = r.called();
             c.say(fmt::format("{{\"id\":1,\"cmd\":\"stop\",\"utime\":{}}}\n", Rig::wall - 1'500'000));
             return keep(std::move(c));
         }},
        {"a clock a day ahead in `utime`", "shutdown",
         [](Rig& r) {
             auto c = r.called();
             c.say(fmt::format("{{\"id\":1,\"cmd\":\"shutdown\",\"utime\":{}}}\n", Rig::wall + 86'400'000'000));
             return keep(std::move(c));
         }},
        {"no `id`, a used one, a key nobody knows", "stop",
         [](Rig& r) {
             auto c = r.called();
             c.say("{\"cmd\":\"stop\",\"axis\":\"x\",\"please\":true}\n");
             return keep(std::move(c));
         }},
        {"no signal thread: raised in the handler (SIGTERM, SIGINT, SIGHUP)", "signal",
         [](Rig& r) {
             r.service_hangs = r.programs_hang = r.disk_hangs = r.slow_task_hangs = true;
             r.m.machine->request_shutdown();
             return std::shared_ptr<void>{};
         }},
        {"service thread stands", "a jog let go",
         [](Rig& r) {
             r.service_hangs = true;
             holder->say("{\"id\":900,\"cmd\":\"jog\",\"axis\":\"x\",\"velocity\":0}\n");
             return std::shared_ptr<void>{};
         },
         By::jog},
        {"service thread stands", "the jogging client lost",
         [](Rig& r) {
             r.service_hangs = true;
             holder->hang_up();
             return std::shared_ptr<void>{};
         },
         By::jog},
        {"a second client that moves the jogged axis", "a jog let go",
         [](Rig& r) {
             auto second = r.called();
             const auto answer = r.ask(second, R"({"id":1,"cmd":"move","axis":"x","position":700,"velocity":140})");
             EXPECT_THAT(answer, ::testing::HasSubstr("command.no_control")) << "refused while the other holds it";
             holder->say("{\"id\":900,\"cmd\":\"jog\",\"axis\":\"x\",\"velocity\":0}\n");
             return keep(std::move(second));
         },
         By::jog},
        {"8 clients that flood, the holder among them", "the jogging client lost",
         [](Rig& r) {
             auto others = std::make_shared<std::vector<Caller>>();
             for (int i = 0; i < 7; ++i) others->push_back(r.called());
             r.each_cycle = [others] {
                 for (const auto& c : *others) c.flood("{\"id\":1,\"cmd\":\"acknowledge\"}\n");
             };
             r.cycles(20);
             holder->hang_up();
             return std::static_pointer_cast<void>(others);
         },
         By::jog},
    };
    return known;
}

struct Measured {
    int ramp_begins = -1;  // cycles
    double stands_ms = -1;
};

Measured measure(const Way& way) {
    Rig rig{way.by};
    auto first = rig.called();
    holder = &first;
    const double speed = way.by == By::jog ? 20 : 100;
    const auto renew = way.by == By::jog ? std::function<void()>{[&, id = 100]() mutable {
        if (id % 20 == 0) first.say(fmt::format("{{\"id\":{},\"cmd\":\"jog\",\"axis\":\"x\",\"velocity\":20}}\n", id));
        ++id;
    }}
                                         : std::function<void()>{};
    if (way.by != By::program) {
        const auto started = rig.ask(first, way.by == By::jog ? R"({"id":1,"cmd":"jog","axis":"x","velocity":20,"press":true})"
                                                              : R"({"id":1,"cmd":"move","axis":"x","position":790,"velocity":100})");
        EXPECT_THAT(started, ::testing::HasSubstr("\"ok\":true")) << started;
    }
    rig.each_cycle = renew;
    rig.until_speed(speed);
    const auto kept = way.stage(rig);
    EXPECT_EQ(rig.x().set_velocity, speed) << way.held_up_by << ": it still moves when the stop comes";

    Measured out;
    const auto from = rig.m.clock.now();
    for (int i = 1; i <= 10'000; ++i) {
        rig.cycle();
        if (out.ramp_begins < 0 && rig.x().set_acceleration < 0) out.ramp_begins = i;
        if (rig.x().set_velocity == 0) {
            out.stands_ms = to_seconds(rig.m.clock.now() - from) * 1e3;
            break;
        }
    }
    rig.each_cycle = {};
    rig.m.expect_no_jump();
    return out;
}

std::string table() {
    std::string out = "| held up by | stopped by | the ramp begins | the axis stands |\n|---|---|---|---|\n";
    for (const auto& way : ways()) {
        const auto got = measure(way);
        EXPECT_GE(got.ramp_begins, 1) << way.held_up_by << ", " << way.stopped_by;
        EXPECT_LE(got.ramp_begins, 2) << way.held_up_by << ", " << way.stopped_by;
        EXPECT_GT(got.stands_ms, 0) << way.held_up_by << ", " << way.stopped_by;
        out += fmt::format("| {} | {} | in cycle {} | {:.0f} ms |\n", way.held_up_by, way.stopped_by, got.ramp_begins, got.stands_ms);
    }
    return out;
}

TEST(Stopping, EachWayToHoldUpAStopEndsWithinTwoCyclesAsThePageSays) {
    const auto measured = table();
    const std::string begin = "<!-- measured: tests/hmi_bridge/stopping_machine.cpp -->\n", end = "<!-- end -->\n";
    const auto path = std::string(TAKTWERK_SOURCE_DIR) + "/docs/stopping.md";
    std::ostringstream read;
    read << std::ifstream(path).rdbuf();
    auto page = read.str();
    const auto from = page.find(begin), to = page.find(end);
    ASSERT_NE(from, std::string::npos);
    ASSERT_NE(to, std::string::npos);
    if (std::getenv("TAKTWERK_REGENERATE")) {
        page.replace(from + begin.size(), to - from - begin.size(), measured);
        std::ofstream(path) << page;
        return;
    }
    EXPECT_EQ(page.substr(from + begin.size(), to - from - begin.size()), measured);
}

// What is given before a stop and comes to its turn behind it must not start what the stop has ended.
TEST(Stopping, AMoveOfABlockedServiceSideDoesNotStartBehindAStop) {
    Rig rig;
    auto client = rig.called();
    rig.service_hangs = true;
    client.say("{\"id\":1,\"cmd\":\"move\",\"axis\":\"x\",\"position\":100,\"velocity\":50}\n");
    rig.cycles(5);
    client.say("{\"id\":2,\"cmd\":\"stop\"}\n");
    rig.cycles(5);
    rig.service_hangs = false;
    std::string heard;
    for (int i = 0; i < 50; ++i) {
        rig.cycle();
        heard += client.hear();
        ASSERT_EQ(rig.x().set_velocity, 0.0);
    }
    EXPECT_THAT(heard, ::testing::HasSubstr("command.stale"));
    EXPECT_THAT(rig.ask(client, R"({"id":3,"cmd":"move","axis":"x","position":100,"velocity":50})"), ::testing::HasSubstr("\"ok\":true"));
    rig.until_speed(50);
}

TEST(Stopping, AMoveWithoutATimeThatWaitedTwentySecondsIsNotCarriedOut) {
    for (const bool closes : {false, true}) {
        Rig rig;
        auto client = rig.called();
        rig.service_hangs = true;
        client.say("{\"id\":1,\"cmd\":\"move\",\"axis\":\"x\",\"position\":100,\"velocity\":50}\n");
        rig.cycles(5);
        if (closes) client.hang_up();
        rig.cycles(20'000);
        rig.service_hangs = false;
        for (int i = 0; i < 50; ++i) {
            rig.cycle();
            ASSERT_EQ(rig.x().set_velocity, 0.0);
        }
    }
}

}  // namespace
}  // namespace taktwerk::hmi
