#include "tests/campaign/campaign_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "ecat/alarms.hpp"
#include "tests/campaign/fault_injector.hpp"

namespace taktwerk::campaign {

namespace {

using namespace std::chrono_literals;
using ecat::Master;
using runtime::OperatorAction;
using runtime::testing::TestMachine;

// Bounds in machine time: whatever takes longer hangs.
constexpr Duration bring_up_limit = 60s;
constexpr Duration return_limit = 30s;
constexpr Duration stop_limit = 30s;
constexpr Duration settle = 300ms;

constexpr std::size_t axis_count = 2;

runtime::MachineConfig config() {
    auto machine = runtime::testing::machine_config(axis_count);
    for (auto& binding : machine.axes) binding.axis.homing.kind = axes::HomingKind::set_here;
    return machine;
}

Master::Phase bus_phase_of(Phase phase) {
    switch (phase) {
        case Phase::scanning: return Master::Phase::scanning;
        case Phase::preop: return Master::Phase::preop;
        case Phase::configuring: return Master::Phase::configuring;
        case Phase::safeop: return Master::Phase::safeop;
        case Phase::stopping: return Master::Phase::stopping;
        case Phase::standstill:
        case Phase::moving: break;
    }
    return Master::Phase::operational;
}

/// How long the phase takes on a bus without faults, at most: the fault strikes within it.
Duration longest(Phase phase) {
    switch (phase) {
        case Phase::scanning: return 40ms;
        case Phase::preop: return 5ms;
        case Phase::configuring: return 300ms;
        case Phase::safeop: return 30ms;
        case Phase::stopping: return 20ms;
        default: return 100ms;
    }
}

class Run {
public:
    Run(FaultKind kind, Phase phase, std::uint32_t seed)
        : phase_(phase),
          expected_(expected_end(kind, phase)),
          random_(seed * 1000 + static_cast<std::uint32_t>(kind) * 10 + static_cast<std::uint32_t>(phase)),
          m_(config()),
          fault_(m_, kind, random_) {
        m_.on_cycle = [this] { note_alarms(); };
    }
    RunResult go() {
        m_.machine->start_bus();
        if (phase_ <= Phase::safeop) during_bring_up();
        else if (phase_ == Phase::stopping) while_stopping();
        else in_operation();
        check_jumps();
        check_told();
        result_.story = story();
        return std::move(result_);
    }

private:
    void problem(std::string what) { result_.problems.push_back(std::move(what)); }
    Master& bus() { return m_.machine->bus(); }
    void cycle() {
        m_.run(m_.machine->config().cycle);
        note_alarms();
    }
    template <class Condition>
    bool until(Condition condition, Duration patience) {
        for (const Instant end = m_.clock.now() + patience; m_.clock.now() < end;) {
            if (condition()) return true;
            cycle();
        }
        return condition();
    }
    bool bring_up_ended() { return bus().phase() == Master::Phase::operational || bus().phase() == Master::Phase::failed; }
    void note_alarms() {
        std::array<AlarmFact, 64> facts;
        const std::size_t count = bus().active_faults(facts);
        standing_.clear();
        for (std::size_t i = 0; i < count; ++i) {
            seen_.insert(facts[i].id);
            standing_.insert(facts[i].id);
        }
    }
    void wait_within_phase() {
        const auto microseconds = static_cast<std::uint32_t>(longest(phase_) / 1us);
        const Duration delay = std::chrono::microseconds{std::uniform_int_distribution{0u, microseconds}(random_)};
        const auto wanted = bus_phase_of(phase_);
        const Instant strike = m_.clock.now() + delay;
        until([&] { return m_.clock.now() >= strike || bus().phase() != wanted; }, delay);
    }
    void strike_and_heal() {
        fault_.strike();
        do {
            fault_.step();
            cycle();
        } while (!fault_.over());
        fault_.heal();
    }

    void during_bring_up() {
        if (!until([&] { return bus().phase() == bus_phase_of(phase_); }, bring_up_limit)) return problem("the phase was never reached");
        wait_within_phase();
        strike_and_heal();
        if (!until([&] { return bring_up_ended(); }, bring_up_limit)) return problem("the bring-up does not end: " + bus().progress());
        // An error found at the last moment may have ended in OP first.
        if (bus().phase() == Master::Phase::operational) until([&] { return all_well(); }, return_limit);
        judge_bring_up();
    }

    void judge_bring_up() {
        if (bus().phase() == Master::Phase::failed) {
            result_.end = End::failed;
            if (!expected_.failed) problem("failed: " + bus().failure().text());
            if (bus().failure().what.empty() || bus().failure().remedy.empty()) problem("the failure does not say what and what to do");
            fault_.repair();
            m_.machine->start_bus();
            if (!until([&] { return bring_up_ended(); }, bring_up_limit) || bus().phase() != Master::Phase::operational)
                return problem("with the cause gone the next bring-up does not reach OP: " + bus().failure().text());
            if (!until([&] { return all_well(); }, return_limit)) problem("the next bring-up ends in OP, but not well");
            return;
        }
        judge_operation();
    }

    /// Every slave in OP, exchanged, and no condition of the bus holds. A drive that lost its set-points stays in its own fault
    /// until somebody resets it, and says so by an emergency: the bus is well all the same.
    bool all_well() {
        const bool condition =
            std::any_of(standing_.begin(), standing_.end(), [](AlarmId id) { return id != ecat::id(ecat::BusAlarm::slave_emergency); });
        if (bus().phase() != Master::Phase::operational || condition) return false;
        for (std::size_t s = 0; s < bus().slave_count(); ++s)
            if (!bus().health(s).fresh || bus().health(s).al_state != ecat::AlState::op) return false;
        return true;
    }
    bool an_announced_alarm_stands() {
        return std::any_of(standing_.begin(), standing_.end(),
                           [](AlarmId id) { return id != ecat::id(ecat::BusAlarm::reference_clock_lost); });
    }

    void judge_operation() {
        std::uint32_t in_a_row = 0;  // what was done in the last cycle shows in the next
        const bool well =
            until([&] { return (in_a_row = all_well() ? in_a_row + 1 : 0) >= 300; }, expected_.operational ? return_limit : Duration{2s});
        if (well) {
            result_.end = End::operational;
            if (!expected_.operational) problem("operational, although the cause is still there");
            return;
        }
        result_.end = expected_.degraded && an_announced_alarm_stands() ? End::degraded : End::none;
        if (result_.end == End::none) problem("does not return to OP within 30 s");
        if (!expected_.degraded) problem("slaves stay out of OP");
    }

    bool prepare_operation() {
        if (!until([&] { return bring_up_ended(); }, bring_up_limit) || bus().phase() != Master::Phase::operational || !m_.machine->arm()) {
            problem("the bus does not come up without a fault: " + bus().failure().text());
            return false;
        }
        m_.run(5ms);
        for (std::uint16_t i = 0; i < axis_count; ++i) {
            m_.enable(i);
            m_.home(i);
        }
        m_.run(100ms);
        return true;
    }

    void in_operation() {
        if (!prepare_operation()) return;
        if (phase_ == Phase::moving) {
            if (m_.command(OperatorAction::move_absolute, 0, false, 700, 150).answer != runtime::Answer::accepted)
                return problem("the move was refused");
            m_.until([&] { return m_.axis(0).set_velocity > 140; }, 3s);
        }
        seen_.clear();
        wait_within_phase();
        strike_and_heal();
        m_.run(settle);
        const bool stopped = m_.axis(0).state == axes::AxisState::ErrorStop || m_.axis(1).state == axes::AxisState::ErrorStop;
        judge_axes(stopped);
        judge_operation();
        if (result_.end == End::operational && stopped) reset();
        check_announced();
    }

    void judge_axes(bool stopped) {
        using Axes = ExpectedEnd::Axes;
        if (expected_.axes == Axes::run_on && stopped) problem("an axis stopped");
        if (expected_.axes == Axes::stop && !stopped) problem("no axis stopped");
    }
    void check_announced() {
        const auto& wanted = expected_.announced;
        if (wanted.empty() || std::any_of(wanted.begin(), wanted.end(), [&](AlarmId id) { return seen_.contains(id); })) return;
        problem("none of the documented alarms was raised");
    }
    /// What a person does afterwards. Nothing moves before.
    void reset() {
        if (!until([&] { return m_.axis(0).set_velocity == 0 && m_.axis(1).set_velocity == 0; }, 5s))
            problem("an axis in error does not stand");
        for (int attempt = 0; attempt < 20; ++attempt) {
            (void)m_.command(OperatorAction::reset);
            m_.run(500ms);
            if (m_.axis(0).state != axes::AxisState::ErrorStop && m_.axis(1).state != axes::AxisState::ErrorStop) break;
        }
        for (std::size_t i = 0; i < axis_count; ++i) {
            if (m_.axis(i).state == axes::AxisState::ErrorStop) problem("a reset does not end ErrorStop: " + m_.alarms());
            if (m_.axis(i).set_velocity != 0) problem("an axis moves without a command");
        }
    }

    void while_stopping() {
        if (!prepare_operation()) return;
        m_.machine->request_shutdown();
        if (!m_.until([&] { return m_.machine->phase() == runtime::MachinePhase::stopped; }, stop_limit))
            return problem("the machine does not stop");
        m_.machine->stop_bus();
        const Duration delay = std::chrono::microseconds{std::uniform_int_distribution{0u, 20'000u}(random_)};
        for (const Instant strike = m_.clock.now() + delay; m_.clock.now() < strike;) bare_cycle();
        fault_.strike();
        do {
            fault_.step();
            bare_cycle();
        } while (!fault_.over());
        fault_.heal();
        for (const Instant end = m_.clock.now() + stop_limit; m_.clock.now() < end && bus().phase() != Master::Phase::stopped;)
            bare_cycle();
        if (bus().phase() != Master::Phase::stopped) return problem("the bus does not stop: " + bus().progress());
        result_.end = End::stopped;
    }
    /// The runner ends with the machine; the bus goes down after it.
    void bare_cycle() {
        m_.clock.advance(m_.machine->config().cycle);
        const auto now = m_.clock.now();
        m_.machine->cycle({now, now, 0});
        m_.machine->service(now);
        m_.runner->after_cycle(now);
    }

    /// Stale or reordered frames may cost one increment: what was missed comes at once.
    void check_jumps() {
        for (std::size_t i = 0; i < axis_count; ++i) {
            const auto& binding = m_.machine->config().axes[i];
            const double most = binding.axis.limits.velocity * to_seconds(m_.machine->config().cycle) * (1 + 1e-9);
            if (m_.watch[i].largest_step > most)
                problem(
                    fmt::format("axis {} was given a set-point that jumps by {:.4f} u (most {:.4f})", i, m_.watch[i].largest_step, most));
            const double counts = std::abs(binding.axis.gearing.counts_per_unit());
            const double seen = m_.world.drive(m_.machine->layout().axes[i].name)->largest_increment();
            if (!expected_.drives_may_see_a_jump && seen > 2 * most * counts + 2)
                problem(fmt::format("the drive of axis {} saw its target jump by {:.1f} counts (most {:.1f})", i, seen, 2 * most * counts));
        }
    }

    /// Whatever happened to the bus, what the drives were told is what the axes showed.
    void check_told() {
        for (const auto& oracle : m_.oracles)
            if (!oracle.clean()) problem(oracle.report());
        if (phase_ > Phase::safeop && m_.oracles[0].motion().compared() < 100) problem("no motion was compared");
    }

    std::string story() {
        std::string out = fault_.deed() + "\n  raised:";
        for (const AlarmId id : seen_)
            out += fmt::format(" {}", find_alarm(ecat::bus_alarms, id) ? find_alarm(ecat::bus_alarms, id)->name : "?");
        out += "\n  standing:";
        for (const AlarmId id : standing_)
            out += fmt::format(" {}", find_alarm(ecat::bus_alarms, id) ? find_alarm(ecat::bus_alarms, id)->name : "?");
        for (std::size_t s = 0; s < bus().slave_count() && bus().phase() == Master::Phase::operational; ++s)
            out += fmt::format("\n  slave {}: AL {} fresh {} age {}", s, static_cast<int>(bus().health(s).al_state), bus().health(s).fresh,
                               bus().health(s).age);
        const auto notes = bus().notes();
        for (std::size_t i = notes.size() > 12 ? notes.size() - 12 : 0; i < notes.size(); ++i) out += "\n  note: " + notes[i];
        return out;
    }

    Phase phase_;
    ExpectedEnd expected_;
    std::mt19937 random_;
    TestMachine m_;
    FaultInjector fault_;
    std::set<AlarmId> seen_, standing_;
    RunResult result_;
};

}  // namespace

RunResult run_fault(FaultKind kind, Phase phase, std::uint32_t seed) { return Run{kind, phase, seed}.go(); }

}  // namespace taktwerk::campaign
