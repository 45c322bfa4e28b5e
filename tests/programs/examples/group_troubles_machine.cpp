// The machines of config/machines/ that have a group, each with its own program: whatever fails, at any moment, and whatever a person does; also while they
// come back. Nothing jumps (the oracles of every axis look on in each cycle), a person gets them going again by what docs/motion/group-ends.md and the
// program's own words say, they work on, and all of it is the same a second time.

#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/programs/examples/watched_machine.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::group_troubles {
namespace {

using namespace std::chrono_literals;
using axes::GroupState;
using runtime::OperatorAction;
using testing::WatchedMachine;

struct Case {
    const char* machine;
    std::vector<const char*> axes;    ///< with a drive that may fail
    std::vector<const char*> slaves;  ///< that may be lost
    const char* works;                ///< the switch that lets it go on
    const char* progress;             ///< a variable that grows while it works
    bool emergency_stop;
};
const std::vector<Case>& cases() {
    static const std::vector<Case> all{
        {"palletizer", {"shoulder", "elbow", "lift", "wrist"}, {"elbow_drive", "lift_drive"}, "works", "stacked", true},
        {"delta-picker", {"arm1", "arm2", "arm3", "belt"}, {"arm2_drive", "belt_drive"}, "picks", "placed", true},
        {"dispensing", {"near", "far", "across", "lift", "pump"}, {"far_drive", "pump_drive"}, "works", "covers", true},
        {"scara", {"shoulder", "elbow", "lift", "wrist"}, {"elbow_drive"}, "draws", "laps", false},
        {"engraver", {"x", "y", "z"}, {"y_drive"}, "engraves", "line", false},
    };
    return all;
}

class Day {
public:
    Day(const Case& of, std::uint32_t seed) : of_(of), random_(seed), m_(of.machine) {
        EXPECT_TRUE(m_.up());
        m_.on_cycle = [this] {
            for (const auto& axis : m_.state().axes) {
                std::uint64_t bits = 0;
                std::memcpy(&bits, &axis.set_position, sizeof bits);
                digest_ = (digest_ ^ bits) * 0x100000001b3;
            }
        };
    }
    ~Day() { m_.on_cycle = {}; }
    Day(const Day&) = delete;
    Day& operator=(const Day&) = delete;

    void work(std::size_t troubles) {
        ASSERT_TRUE(goes_on()) << m_.alarms();
        for (std::size_t i = 0; i < troubles && !::testing::Test::HasFailure(); ++i) {
            m_.run(1ms * below(4000));
            strike();
            m_.run(1ms * below(1500));
            if (below(4) == 0) strike();  // and one more, while it comes to rest
            heal();
            ASSERT_TRUE(goes_on()) << "after " << log_ << "; " << m_.alarms() << " group " << axes::name(m_.group().state) << ", mode "
                                   << static_cast<int>(m_.state().mode);
        }
    }
    [[nodiscard]] std::uint64_t digest() const { return digest_; }
    [[nodiscard]] const std::string& log() const { return log_; }

private:
    std::uint32_t below(std::uint32_t most) { return static_cast<std::uint32_t>(random_() % most); }
    void note(const std::string& what) { log_ += (log_.empty() ? "" : ", ") + what; }
    template <class T>
    const T& any(const std::vector<T>& all) {
        return all[below(static_cast<std::uint32_t>(all.size()))];
    }
    void mains(const std::string& axis, bool on) {
        runtime::SimulationEvent event;
        event.kind = runtime::SimulationEvent::Kind::main_power;
        event.target = axis;
        event.value = on ? 1 : 0;
        m_.world.happen(event);
    }

    void strike() {
        switch (below(of_.emergency_stop ? 12 : 11)) {
            case 0:
            case 1: {
                const std::string axis = any(of_.axes);
                note("drive fault of " + axis);
                m_.world.drive(axis)->raise(0x2310);
                break;
            }
            case 2: {
                const std::string axis = any(of_.axes);
                note("no mains at " + axis);
                mains(axis, false);
                healers_.emplace_back([this, axis] { mains(axis, true); });
                break;
            }
            case 3: {
                const std::string slave = any(of_.slaves);
                note("slave " + slave + " lost");
                m_.world.set_slave_power(slave, false);
                healers_.emplace_back([this, slave] { m_.world.set_slave_power(slave, true); });
                break;
            }
            case 4:
                note("cable cut");
                m_.world.transport().faults.link_down = true;
                healers_.emplace_back([this] { m_.world.transport().faults.link_down = false; });
                break;
            case 5:
                note("program stopped");
                (void)m_.command(OperatorAction::program_stop, 0);
                break;
            case 6:
                note("stop of everything");
                (void)m_.machine->request_stop(0xFFFF);
                break;
            case 7:
                note("group halted");
                (void)m_.command(OperatorAction::group_halt, 0);
                break;
            case 8:
                note("group interrupted");
                (void)m_.command(OperatorAction::group_interrupt, 0);
                break;
            case 9:
                note("manual mode");
                (void)m_.mode(runtime::Mode::manual);
                break;
            case 10: {
                const double factor = below(2) == 0 ? 0 : 0.3;
                note("override " + std::to_string(factor));
                (void)m_.command(OperatorAction::group_override, 0, false, factor);
                healers_.emplace_back([this] { (void)m_.command(OperatorAction::group_override, 0, false, 1); });
                break;
            }
            default:
                note("emergency stop");
                m_.world.set_input("estop_ok", false);
                healers_.emplace_back([this] { m_.world.set_input("estop_ok", true); });
                break;
        }
    }
    void heal() {
        for (auto& one : healers_) one();
        healers_.clear();
        m_.run(1500ms);
    }
    /// As a person does it: look what stands, reset, automatic, start, continue, the program's own switch.
    bool goes_on() {
        const auto before = m_.variable(of_.progress);
        for (int n = 0; n < 60; ++n) {
            if (m_.group().state == GroupState::GroupErrorStop || m_.state().alarm_count > 0) (void)m_.command(OperatorAction::reset);
            m_.run(200ms);
            if (m_.state().mode != runtime::Mode::automatic) (void)m_.mode(runtime::Mode::automatic);
            if (m_.state().mode == runtime::Mode::automatic) (void)m_.command(OperatorAction::program_start, 0);
            if (m_.group().interrupted) (void)m_.command(OperatorAction::group_continue, 0);
            const bool well = m_.group().state != GroupState::GroupErrorStop;
            if (well && m_.variable(of_.works) == 0) m_.set_switch(of_.works, true);
            if (m_.until([&] { return m_.variable(of_.progress) != before; }, 3s)) return true;
        }
        return false;
    }

    const Case& of_;
    std::mt19937 random_;
    std::vector<std::function<void()>> healers_;
    std::string log_;
    std::uint64_t digest_ = 0xcbf29ce484222325;
    WatchedMachine m_;
};

// TAKTWERK_SOAK_FACTOR draws more days.
TEST(GroupTroubles, AnythingAtAnyMoment) {
    for (std::size_t n = 0; n < property_cases(cases().size()) && !HasFailure(); ++n) {
        const auto& of = cases()[n % cases().size()];
        const auto seed = static_cast<std::uint32_t>(4000 + n);
        SCOPED_TRACE(::testing::Message() << of.machine << ", seed " << seed);
        std::uint64_t digests[2]{};
        std::string logs[2];
        for (int twice = 0; twice < 2 && !HasFailure(); ++twice) {
            Day day(of, seed);
            day.work(5);
            digests[twice] = day.digest();
            logs[twice] = day.log();
        }
        EXPECT_EQ(digests[0], digests[1]) << logs[0] << " | " << logs[1];
    }
}

}  // namespace
}  // namespace taktwerk::group_troubles
