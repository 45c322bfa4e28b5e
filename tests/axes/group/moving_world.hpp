#pragma once
// A group, a belt, a table and a pump under a careless hand: whatever may be asked of any of them at any moment, several things in a cycle. What is true of
// the objects is kept by hand beside it: the ways of their axes as they were gone, and 3 x 3 matrices.

#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <sstream>

#include "tests/axes/group/jog_arms.hpp"
#include "tests/axes/group/track_rig.hpp"

namespace taktwerk::axes::test {

struct MovingWorld : GroupRig {
    static std::vector<AxisConfig> all_axes(const JogArm& arm, AxisLimits master_limits) {
        auto axes = axes_of(arm);
        axes.push_back(group_axis("belt", master_limits));
        axes.push_back(group_axis("table", master_limits));
        axes.back().modulo = 360;
        axes.push_back(group_axis("pump", {.velocity = 300, .acceleration = 2000, .deceleration = 2000, .jerk = 40000}));
        return axes;
    }
    static std::vector<AxisGroupConfig> the_group(const JogArm& arm) {
        AxisGroupConfig group{.name = "g", .members = {}, .kinematics = arm_of(arm.description)};
        for (const auto& axis : axes_of(arm)) group.members.push_back(axis.name);
        return {group};
    }
    MovingWorld(const JogArm& arm, std::uint32_t seed, AxisLimits master_limits)
        : GroupRig(all_axes(arm, master_limits), the_group(arm)), dice(seed), start(arm.start), members(arm.turning.size()) {
        turns = groups[0].config().kinematics->commands();
        for (std::size_t m = 0; m < 2; ++m) at_before[m] = axis(members + m).set_position;
        enable();
        const auto ready = give({.kind = GroupCommandKind::direct_absolute, .target = start});
        EXPECT_TRUE(until([&] { return status(ready.id) == CommandStatus::done; }, 20000));
        observe();
    }

    double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(dice); }
    bool once_in(int n) { return std::uniform_int_distribution<int>(1, n)(dice) == 1; }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(dice); }

    // --- what is true -------------------------------------------------------------------------------------------------------
    struct Object {
        FrameTrack::Kind kind = FrameTrack::Kind::none;
        std::size_t master = 0;
        Six origin{}, place{};
        double reference = 0;  ///< way of the master
        std::uint32_t serial = 0;
    };
    struct Given {
        std::optional<Object> object;
        Six target{};
        bool absolute = false;
        Six machine{};
    };
    [[nodiscard]] HandFrame object_at(const Object& o) const {
        const double gone = way[o.master] - o.reference;
        const Six moved =
            o.kind == FrameTrack::Kind::table ? Six{0, 0, 0, 0, 0, 2 * std::numbers::pi * gone / 360} : Six{gone, 0, 0, 0, 0, 0};
        return hand_frame(o.origin) * hand_frame(moved) * hand_frame(o.place);
    }
    [[nodiscard]] HandFrame tool() const { return hand_frame(groups.equipment(ref)->frames.machine) * hand_frame(view().tool_set); }
    /// Seen from the machine.
    [[nodiscard]] HandFrame flange() const {
        Joints q{};
        for (std::size_t i = 0; i < members; ++i) q[i] = view().set_position[i];
        const Pose at = groups[0].config().kinematics->forward(q, Pose{}).pose;
        return hand_frame(numbers_of(at));
    }
    /// jerk * T^3 / 6 for a master whose jerk changes, twice where it changes its sign: of a table at this place.
    [[nodiscard]] double unforeseen(const Object& o, const HandFrame& at) const {
        const double t = to_seconds(cycle), way_of_it = 2 * axes[members + o.master].config().limits.jerk * t * t * t / 6;
        if (o.kind != FrameTrack::Kind::table) return way_of_it;
        double square = 0;
        for (std::size_t i = 0; i < 3; ++i) square += (at.o[i] - o.origin[i]) * (at.o[i] - o.origin[i]);
        return way_of_it * one_degree * std::sqrt(square);
    }
    [[nodiscard]] const Object* object_of(MC_CoordSystem frame) const {
        const auto serial = groups.equipment(ref)->frames.track_of(frame).serial;
        for (const auto& o : objects)
            if (serial != 0 && o.serial == serial) return &o;
        return nullptr;
    }

    // --- what is asked ------------------------------------------------------------------------------------------------------
    void note(const std::string& what) {
        if (log.size() > 60) log.erase(log.begin());
        log.push_back(std::to_string(path.size()) + ": " + what);
    }
    [[nodiscard]] std::string story() const {
        std::ostringstream all;
        for (const auto& line : log) all << line << "\n";
        all << "state " << static_cast<int>(view().state) << " error " << view().error << " active " << view().active << " kind "
            << static_cast<int>(view().active_kind) << " queued " << static_cast<int>(view().queued_count) << " sync "
            << view().track.in_sync << " track " << view().track.axis.valid() << " interrupted " << view().interrupted << " lock "
            << view().lock << " cycle " << path.size();
        return all.str();
    }
    AxisRef master(std::size_t m) const { return {static_cast<std::uint16_t>(members + m)}; }

    void move_master(std::size_t m) {
        auto& axis_of = axes[members + m];
        const double v = once_in(4) ? 0 : draw(-most_velocity, most_velocity);
        note("master " + std::to_string(m) + " " + std::to_string(v));
        (void)axis_of.submit(
            v == 0 ? AxisCommand{.kind = CommandKind::halt} : AxisCommand{.kind = CommandKind::move_velocity, .velocity = v},
            Owner::program);
    }
    void renumber_master(std::size_t m) {
        const double by = draw(-500, 500);
        const double was = axis(members + m).set_position;
        if (axes[members + m].set(SetPosition{.position = by, .relative = true}, Owner::program) != ErrorId::none) return;
        note("renumber " + std::to_string(m) + " by " + std::to_string(by) + " " + std::to_string(was) + " " +
             std::to_string(axis(members + m).set_position));
        at_before[m] += axis(members + m).set_position - was;
    }
    static constexpr std::array<MC_CoordSystem, 4> frames{mcPCS, mcPCS_2, mcPCS_3, mcPCS_8};
    void track_something() {
        Object o;
        const bool any_turn = turns[3] || turns[4] || turns[5];
        o.master = any_turn && once_in(2) ? 1 : 0;
        o.kind = o.master == 1 ? FrameTrack::Kind::table : FrameTrack::Kind::belt;
        o.origin = {draw(-200, 200), draw(-200, 200), draw(-30, 30), 0, 0, draw(-3, 3)};
        const bool all_turns = turns[3] && turns[4] && turns[5];
        if (o.kind == FrameTrack::Kind::belt ? once_in(2) : all_turns && once_in(2)) o.origin[3] = draw(-1, 1), o.origin[4] = draw(-1, 1);
        if (o.kind == FrameTrack::Kind::table) {  // near its centre, or the tool would have to go far
            const auto at = tool();
            for (std::size_t i = 0; i < 3; ++i) o.origin[i] = at.o[i] + draw(-60, 60);
        }
        HandFrame wanted = tool();
        for (double& x : wanted.o) x += draw(-8, 8);
        if (once_in(2)) wanted = wanted * hand_frame({0, 0, 0, 0, 0, draw(-1, 1)});
        o.place = hand_six(back(hand_frame(o.origin)) * wanted);
        o.reference = way[o.master];
        const auto frame = frames[static_cast<std::size_t>(whole(0, 3))];
        GroupCommand command{.kind = GroupCommandKind::track_frame, .frame = frame};
        command.track.kind = o.kind;
        command.track.master = master(o.master);
        command.track.origin = o.origin;
        command.track.object = o.place;
        command.execution = once_in(2) ? mcImmediately : once_in(2) ? mcQueued : mcDelayed;
        const auto answer = submit(command);
        note("track in " + std::to_string(frame) + " kind " + std::to_string(static_cast<int>(o.kind)) + " mode " +
             std::to_string(command.execution) + " -> " + std::to_string(static_cast<int>(answer.error)));
        if (answer.error == ErrorId::none) objects.push_back(o);
        if (answer.error == ErrorId::none) adopt();
        if (objects.size() > 40) objects.erase(objects.begin());
    }
    /// Which object stands in which frame now.
    void adopt() {
        const auto& f = groups.equipment(ref)->frames;
        for (const auto& t : f.tracks)
            for (auto& o : objects)
                if (t.moves() && o.serial == 0 && t.origin == o.origin && t.object == o.place) o.serial = t.serial;
    }
    void go_on_object() {
        const auto frame = frames[static_cast<std::size_t>(whole(0, 3))];
        const auto* o = object_of(frame);
        if (o == nullptr) return;
        GroupCommand move = line({}, draw(5, 60));
        move.frame = frame;
        constexpr std::array modes{mcAborting, mcBuffered, mcBlendingLow, mcBlendingPrevious, mcBlendingNext, mcBlendingHigh};
        move.buffer_mode = modes[static_cast<std::size_t>(whole(0, 5))];
        if (once_in(2)) move.transition = mcTMCornerDistance, move.transition_parameter = draw(0, 5);
        const auto rel = back(object_at(*o)) * tool();
        Given given{*o, hand_six(rel), true, groups.equipment(ref)->frames.machine};
        for (std::size_t i = 0; i < 3; ++i) given.target[i] += once_in(6) ? 0 : draw(-12, 12);
        if (turns[5] && once_in(2)) given.target = hand_six(hand_frame(given.target) * hand_frame({0, 0, 0, 0, 0, draw(-0.5, 0.5)}));
        if (once_in(5)) {
            move.kind = once_in(2) ? GroupCommandKind::linear_relative : GroupCommandKind::circular_relative;
            given.absolute = false;
            given.target = once_in(4) ? Six{} : Six{draw(-9, 9), draw(-9, 9), draw(-9, 9), 0, 0, 0};
            move.circle = {.mode = mcBORDER,
                           .aux = {given.target[0] / 2 + draw(-3, 3), given.target[1] / 2 + draw(-3, 3), given.target[2] / 2}};
        }
        for (std::size_t i = 0; i < 6; ++i) move.target[i] = given.target[i];
        give_noted(move, given);
    }
    void go_elsewhere() {
        GroupCommand move{.kind = GroupCommandKind::direct_absolute, .target = start, .dynamics = {.velocity = draw(20, 80)}};
        for (std::size_t i = 0; i < members; ++i) move.target[i] += draw(-3, 3);
        if (once_in(3)) {
            move = line({}, draw(10, 60));
            move.frame = mcMCS;
            for (std::size_t i = 0; i < 6; ++i) move.target[i] = view().tool_set[i] + (i < 3 ? draw(-10, 10) : 0);
        }
        move.buffer_mode = once_in(2) ? mcAborting : mcBuffered;
        give_noted(move, {});
    }
    void give_noted(const GroupCommand& move, const Given& given) {
        const auto answer = submit(move);
        note("move " + std::to_string(static_cast<int>(move.kind)) + " frame " + std::to_string(move.frame) + " mode " +
             std::to_string(move.buffer_mode) + " -> " + std::to_string(static_cast<int>(answer.error)) + " id " +
             std::to_string(answer.id));
        if (answer.error == ErrorId::none) commands[answer.id] = given;
        if (commands.size() > 200) commands.erase(commands.begin());
    }
    void simple(GroupCommandKind kind) {
        const auto answer = submit(simply(kind, once_in(2) ? PathDynamics{} : PathDynamics{0, 0, draw(200, 1500), 0}));
        note("simple " + std::to_string(static_cast<int>(kind)) + " -> " + std::to_string(static_cast<int>(answer.error)) + " id " +
             std::to_string(answer.id));
        if (kind == GroupCommandKind::stop && answer.error == ErrorId::none) lock = answer.id;
    }
    void couple() {
        FollowPath wanted{.slave = master(2), .numerator = whole(-5, 5), .denominator = whole(1, 4)};
        if (once_in(2)) wanted.acceleration = wanted.deceleration = draw(100, 3000);
        note("couple -> " + std::to_string(static_cast<int>(set(wanted))));
    }

    void deed() {
        if (once_in(3)) return void(once_in(2) ? track_something() : go_on_object());
        switch (whole(0, 21)) {
            case 0: return move_master(0);
            case 1: return move_master(1);
            case 2: return renumber_master(once_in(2) ? 1 : 0);
            case 3:
            case 4:
            case 5: return go_on_object();
            case 6: return go_elsewhere();
            case 7: {
                const double v = once_in(3) ? 0 : draw(0.1, 1);
                note("override " + std::to_string(v));
                (void)set(Override{.velocity = v, .acceleration = once_in(3) ? draw(0.3, 1) : 1, .jerk = 1});
                return;
            }
            case 8:
                note("override 1");
                (void)set(Override{});
                return;
            case 9: return simple(GroupCommandKind::halt);
            case 10: return simple(GroupCommandKind::interrupt);
            case 11:
            case 12: return simple(GroupCommandKind::resume);
            case 13: return once_in(2) ? simple(GroupCommandKind::stop) : void();
            case 14:
                if (lock != 0) groups.release_stop(ref, lock, Owner::program);
                lock = 0;
                return;
            case 15:
                if (!once_in(4)) return;
                return simple(GroupCommandKind::disable);
            case 16: {
                if (!once_in(4)) return;
                note("let go");
                groups[0].let_go();
                return;
            }
            case 17: {
                GroupCommand tool{.kind = GroupCommandKind::write_tool, .number = 1};
                tool.tool.frame = {draw(-5, 5), draw(-5, 5), draw(0, 10), 0, 0, 0};
                tool.execution = once_in(2) ? mcImmediately : mcQueued;
                if (once_in(2)) (void)submit(tool);
                const std::uint8_t number = once_in(2) ? 1 : 0;
                note("tool " + std::to_string(number));
                (void)set(SelectTool{number});
                return;
            }
            case 18: {
                GroupCommand fixed{.kind = GroupCommandKind::set_frame,
                                   .frame = once_in(2) ? mcMCS : frames[static_cast<std::size_t>(whole(0, 3))]};
                fixed.target = {draw(-20, 20), draw(-20, 20), draw(-20, 20), 0, 0, draw(-1, 1)};
                fixed.execution = once_in(2) ? mcImmediately : mcQueued;
                note("frame " + std::to_string(fixed.frame) + " -> " + std::to_string(static_cast<int>(submit(fixed).error)));
                return;
            }
            case 19: return trouble();
            case 20: return couple();
            default: return simple(GroupCommandKind::halt);
        }
    }
    void trouble() {
        if (!troubles || !once_in(3)) return;
        const auto i = static_cast<std::size_t>(whole(0, static_cast<int>(members) + 1));
        if (once_in(2)) {
            note("fault of " + std::to_string(i));
            drives[i]->fault_code = 0x5441;
        } else {
            note("power of " + std::to_string(i));
            powered[i] = false;
            (void)axes[i].power(false, true, true, Owner::program);
        }
        heal_at = path.size() + static_cast<std::size_t>(whole(50, 600));
    }
    void heal() {
        if (heal_at == 0 || path.size() < heal_at) return;
        heal_at = 0;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            drives[i]->fault_code = 0;
            powered[i] = true;
            if (axis(i).state == AxisState::ErrorStop) (void)axes[i].reset(Owner::program);
        }
        note("healed");
    }
    void recover() {
        if (view().state == GroupState::GroupErrorStop && once_in(40)) (void)groups.reset(ref, Owner::program), note("reset");
        if (view().state == GroupState::GroupDisabled && once_in(40)) (void)set(EnableGroup{}), note("enable");
    }

    /// A cycle in which it may occur to the hand to do something, or three things. It is nervous at some times and patient at others.
    void live() {
        if (once_in(1500)) patience = once_in(2) ? 30 : 250;
        const int deeds = once_in(patience) ? whole(1, 3) : 0;
        step([&] {
            heal();
            recover();
            for (int i = 0; i < deeds; ++i) deed();
            if (once_in(400)) served_every = once_in(2) ? 1 : static_cast<std::size_t>(whole(1, 9));
        });
        observe();
    }

    // --- what must hold -----------------------------------------------------------------------------------------------------
    void observe() {
        for (std::size_t m = 0; m < 2; ++m) {
            const double now_at = axis(members + m).set_position;
            double by = now_at - at_before[m];
            if (m == 1) by -= 360 * std::round(by / 360);
            way[m] += by;
            at_before[m] = now_at;
        }
        adopt();
        const auto& v = view();
        const auto object =
            std::find_if(objects.begin(), objects.end(), [&](const Object& o) { return o.serial != 0 && o.serial == v.track.serial; });
        const bool on = v.track.in_sync && object != objects.end();
        const auto held = back(flange()) * hand_frame(v.tool_set);
        const bool same = on && was_on && object->serial == was_serial && apart(held, was_held) < 1e-9;
        was_held = held;
        if (!same) seen_from = groups.equipment(ref)->frames.machine;  // what is set later bends nothing that is under way
        const auto place = hand_frame(seen_from) * hand_frame(v.tool_set);
        const auto rel = on ? back(object_at(*object)) * place : HandFrame{};
        if (same) slips(rel, unforeseen(*object, place));
        for (auto& [id, given] : commands) {
            if (!given.object || !given.absolute || checked.contains(id) || status(id) != CommandStatus::done) continue;
            checked[id] = true;
            if (v.track.in_sync && v.path_velocity == 0 && v.track.serial == given.object->serial && given.machine == seen_from)
                at_target(given);
        }
        was_on = on;
        was = rel;
        was_path = v.path_velocity;
        was_faster = std::abs(v.path_acceleration);
        was_serial = on ? object->serial : 0;
    }
    /// From one cycle to the next the tool goes on the object as far as the path does; jerk * T^3 / 6 for masters that change their acceleration.
    void slips(const HandFrame& rel, double slip) {
        double square = 0;
        for (std::size_t i = 0; i < 3; ++i) square += (rel.o[i] - was.o[i]) * (rel.o[i] - was.o[i]);
        // In between it may be faster than at both ends: by an eighth of what their accelerations make of a period.
        const double t = to_seconds(cycle);
        const double path_way = t * (std::max(view().path_velocity, was_path) + t * (std::abs(view().path_acceleration) + was_faster) / 8);
        EXPECT_LE(std::sqrt(square), path_way * (1 + 1e-6) + slip + 1e-8)
            << story() << "\nway " << way[0] << " " << way[1] << " masters " << axis(members).set_velocity << " "
            << axis(members + 1).set_velocity << " at " << axis(members + 1).set_position;
        ++compared;
    }
    void at_target(const Given& given) {
        const auto place = hand_frame(seen_from) * hand_frame(view().tool_set);
        const auto rel = back(object_at(*given.object)) * place;
        const double within = unforeseen(*given.object, place) + 1e-8;
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(rel.o[i], given.target[i], within) << i << "\n" << story();
        const bool all = turns[3] && turns[4] && turns[5];
        EXPECT_LE(all ? apart(rel, hand_frame(given.target)) : 0, 2e-6) << story();
        ++reached;
    }
    /// Nobody asks for anything any more: all of it ends.
    void calm_down() {
        served_every = 1;
        heal_at = 1;
        for (int i = 0; i < 3000; ++i) {
            step([&] {
                heal();
                if (i == 0) {
                    (void)set(Override{});
                    for (std::size_t m = 0; m < 2; ++m) (void)axes[members + m].submit({.kind = CommandKind::halt}, Owner::program);
                }
                if (lock != 0) groups.release_stop(ref, lock, Owner::program), lock = 0;
                if (view().interrupted) (void)submit(simply(GroupCommandKind::resume));
            });
            observe();
        }
        const auto quiet = [&] { return view().active == 0 && view().queued_count == 0; };
        EXPECT_TRUE(until(
            [&] {
                observe();
                return quiet() || view().state == GroupState::GroupErrorStop;
            },
            30000))
            << story();
        const auto settled = [&] {
            const auto& v = view();
            switch (v.state) {
                case GroupState::GroupDisabled:
                case GroupState::GroupStandby: return !groups[0].leads();
                case GroupState::GroupMoving: return v.track.in_sync;
                case GroupState::GroupErrorStop: return !groups[0].leads();
                default: return false;
            }
        };
        EXPECT_TRUE(until(settled, 5000)) << story();
        for (const auto& [id, given] : commands) {
            const auto s = status(id);
            EXPECT_TRUE(s != CommandStatus::active && s != CommandStatus::queued) << id << "\n" << story();
        }
        step([&] { groups[0].let_go(); });
        EXPECT_TRUE(until([&] { return !groups[0].leads(); }, 5000)) << story();
    }

    std::mt19937 dice;
    JointVector start{};
    std::size_t members;
    std::array<bool, 6> turns{};
    double most_velocity = 45;
    bool troubles = false;
    std::array<double, 2> way{}, at_before{};
    std::vector<Object> objects;
    std::map<CommandId, Given> commands;
    std::map<CommandId, bool> checked;
    bool was_on = false;
    HandFrame was;
    Six seen_from{};
    HandFrame was_held;
    double was_path = 0, was_faster = 0;
    std::uint32_t was_serial = 0;
    CommandId lock = 0;
    int patience = 60;
    std::size_t heal_at = 0;
    std::size_t compared = 0, reached = 0;
    std::vector<std::string> log;
};

}  // namespace taktwerk::axes::test
