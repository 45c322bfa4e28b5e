#include "tests/whole_machine/whole_run.hpp"

#include <algorithm>

#include "tests/whole_machine/hands.hpp"
#include "tests/whole_machine/recovery.hpp"
#include "tests/whole_machine/rig.hpp"
#include "tests/whole_machine/rogue.hpp"
#include "tests/whole_machine/troublemaker.hpp"

namespace taktwerk::whole {

namespace {

using runtime::MachinePhase;
using Bus = ecat::Master::Phase;

class Run {
public:
    Run(WholeRun& result, std::mt19937& random, const Wanted& wanted)
        : result_(result), random_(random), rig_(result.machine), troubles_(rig_, random), hands_(rig_, random) {
        draw(wanted.trouble);
        if (wanted.moment) result_.moment = *wanted.moment;
        const auto& config = rig_.m.machine->config();
        result_.cycle = config.cycle;
        for (const auto& axis : config.axes)
            result_.frames_supervised = result_.frames_supervised || (axis.profile && axis.profile->missed_frames_allowed > 0);
    }
    void go() {
        if (!rig_.problems.empty()) return finish();
        if (result_.moment == Moment::bringing_up) while_it_comes_up();
        else come_up();
        if (clean() && result_.moment == Moment::ending) while_it_ends();
        else if (clean()) in_operation();
        finish();
    }

private:
    [[nodiscard]] bool clean() const { return rig_.problems.empty(); }
    [[nodiscard]] std::uint32_t below(std::uint32_t most) { return static_cast<std::uint32_t>(random_() % most); }
    [[nodiscard]] Duration drawn(Duration most) { return std::chrono::microseconds{random_() % static_cast<std::uint64_t>(most / 1us)}; }
    [[nodiscard]] Bus bus_phase() const { return rig_.m.machine->bus().phase(); }

    void draw(std::string_view only) {
        const auto count = only.empty() ? 1 + (below(5) > 2) + (below(5) > 3) : 1;
        while (result_.troubles.size() < static_cast<std::size_t>(count)) {
            const auto source = static_cast<Source>(below(source_names.size()));
            const auto trouble = static_cast<Trouble>(below(trouble_names.size()));
            if (only.empty() ? source_of(trouble) == source && troubles_.possible(trouble) : name(trouble) == only)
                result_.troubles.push_back(trouble);
            if (!only.empty() && name(trouble) == only && !troubles_.possible(trouble)) {
                result_.troubles.clear();
                return rig_.problem(std::string(only) + " is not possible on this machine");
            }
        }
        constexpr std::array moments{Moment::bringing_up, Moment::by_hand, Moment::by_hand,    Moment::running,
                                     Moment::running,     Moment::running, Moment::recovering, Moment::ending};
        result_.moment = moments[below(moments.size())];
    }

    void one_cycle() {
        troubles_.step();
        rig_.cycle();
    }
    template <class Condition>
    bool until(Condition condition, Duration patience) {
        for (const auto end = rig_.now() + patience; rig_.now() < end;) {
            if (condition()) return true;
            one_cycle();
        }
        return condition();
    }
    void run(Duration time) {
        until([] { return false; }, time);
    }

    [[nodiscard]] bool came_up() {
        const auto before = rig_.now();
        if (!until([&] { return bus_phase() == Bus::operational || bus_phase() == Bus::failed; }, 120s)) {
            rig_.problem("the bring-up does not end: " + rig_.m.machine->bus_progress());
            return false;
        }
        (void)before;
        return bus_phase() == Bus::operational;
    }
    void arm() {
        rig_.happens(Deed::restart);
        if (const auto armed = rig_.m.machine->arm(); !armed) rig_.problem("not armed: " + armed.error().text());
    }
    void come_up() {
        rig_.m.machine->start_bus();
        if (!came_up()) return rig_.problem("it does not come up without a trouble");
        arm();
        run(50ms);
        rig_.strongest = Reaction::none;
    }
    void while_it_comes_up() {
        rig_.m.machine->start_bus();
        run(drawn(1200ms));
        strike_all();
        if (!came_up()) {
            const auto failure = rig_.m.machine->bus_failure();
            if (!failure || failure->what.empty() || failure->remedy.empty()) rig_.problem("the failure does not say what and what to do");
            result_.end = WholeEnd::failed_first;
            troubles_.heal();
            rig_.m.machine->start_bus();
            if (!came_up()) return rig_.problem("with the cause gone it does not come up: " + rig_.m.machine->bus().failure().text());
        }
        arm();
        run(50ms);
    }

    void strike_all() {
        for (const auto trouble : result_.troubles) {
            const auto blow = troubles_.strike(trouble);
            if (trouble == result_.troubles.front()) result_.length = blow.length;
            result_.delay = std::max(result_.delay, blow.delay);
            run(drawn(300ms));
        }
    }
    void person_acts() {
        if (below(300) == 0) hands_.do_anything();
    }
    void live(Duration time, bool with_a_person) {
        for (const auto end = rig_.now() + time; rig_.now() < end && !rig_.over();) {
            if (with_a_person) person_acts();
            one_cycle();
        }
    }

    void in_operation() {
        const bool by_hand = result_.moment == Moment::by_hand;
        if (by_hand) {
            rig_.mode(runtime::Mode::manual);
            run(20ms);
            (void)rig_.submit(runtime::OperatorAction::power, 0xFFFF, true);
            run(300ms);
            live(drawn(2s), true);
        } else if (result_.moment != Moment::bringing_up) {
            begin_work(rig_);
            live(200ms + drawn(3s), false);
        }
        if (result_.moment != Moment::bringing_up) {
            strike_all();
            if (result_.moment == Moment::recovering) {
                hands_.reset_all();
                result_.delay = std::max(result_.delay, troubles_.strike(result_.troubles.front()).delay);
            }
        }
        for (const auto end = rig_.now() + 20s; !troubles_.over() && rig_.now() < end;) live(10ms, by_hand);
        live(500ms, by_hand);
        troubles_.heal();
        result_.reaction = rig_.strongest;
        come_back();
    }

    void come_back() {
        if (!recover(rig_, hands_)) return;
        if (result_.end == WholeEnd::none) result_.end = WholeEnd::came_back;
        if (!end_in_order(rig_)) result_.end = WholeEnd::none;
    }

    void while_it_ends() {
        begin_work(rig_);
        live(200ms + drawn(2s), false);
        const auto longest = rig_.m.machine->longest_stop();
        (void)rig_.begins(Deed::end);
        rig_.m.machine->request_shutdown();
        const auto asked = rig_.now();
        run(drawn(100ms));
        for (const auto trouble : result_.troubles) (void)troubles_.strike(trouble);
        // A stall of the computer takes its time beside.
        const auto stalled = rig_.now() - asked;
        until([&] { return rig_.m.machine->phase() == MachinePhase::stopped || rig_.now() - asked > longest + stalled + 1s; }, 60s);
        if (rig_.m.machine->phase() != MachinePhase::stopped)
            rig_.problem(fmt::format("it does not stop within {} ms: {}", longest / 1ms, rig_.standing()));
        troubles_.heal();
        result_.reaction = rig_.strongest;
        if (!bus_down(rig_)) return;
        result_.end = WholeEnd::ended_in_order;
    }

    void finish() {
        rig_.gather();
        result_.problems = rig_.problems;
        result_.commands = rig_.commands;
        for (const auto& [alarm, count] : rig_.seen) result_.alarms.insert(alarm);
        result_.story = rig_.story();
        if (!result_.problems.empty()) result_.end = WholeEnd::none;
    }

    WholeRun& result_;
    std::mt19937& random_;
    Rig rig_;
    Troublemaker troubles_;
    Hands hands_;
};

}  // namespace

WholeRun run_whole(std::uint32_t seed, const Wanted& wanted) {
    WholeRun result;
    result.seed = seed;
    std::mt19937 random{seed};
    const auto drawn = machine_names[random() % machine_names.size()];
    result.machine = wanted.machine.empty() ? drawn : wanted.machine;
    Run{result, random, wanted}.go();
    return result;
}

}  // namespace taktwerk::whole
