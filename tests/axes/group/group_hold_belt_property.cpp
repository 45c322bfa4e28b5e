// What a person holds on a belt or beside it, whatever its program does meanwhile: a random walk over the commands of both, with a belt that runs, turns
// round, stops and fails, an axis that follows the path, and a group beside this one. Once it rests and he was told so, nothing of a program moves it where it
// stands, on the ground or on its object, until he lets it go.

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

#include "tests/axes/group/jog_rig.hpp"
#include "tests/axes/group/track_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

using enum GroupCommandKind;

/// X Y Z, a belt, and a pump, which is the only member of a second group.
struct BeltCell : GroupRig {
    static constexpr std::size_t belt = 3, pump = 4;
    static constexpr GroupRef second{1};
    BeltCell() : GroupRig(axes_of_cell(), groups_of_cell()) {
        enable();
        EXPECT_EQ(groups.set(second, EnableGroup{}, Owner::program), ErrorId::none);
        EXPECT_EQ(set(WriteJoggingDynamics{slow_jogging()}), ErrorId::none);
    }
    static std::vector<AxisConfig> axes_of_cell() {
        auto configs = named(3);
        configs.push_back(belt_axis());
        configs.push_back(group_axis("pump"));
        return configs;
    }
    static std::vector<AxisGroupConfig> groups_of_cell() {
        return {{.name = "g", .members = {"a0", "a1", "a2"}, .kinematics = cartesian_arm()},
                {.name = "h", .members = {"pump"}, .kinematics = {}}};
    }
};

class BeltWalk {
public:
    explicit BeltWalk(std::uint64_t seed) : random_(seed) {}

    void walk(int cycles) {
        for (int i = 0; i < cycles && !::testing::Test::HasFailure(); ++i) {
            if (pause_-- <= 0) {
                if (chance(0.25)) person_asks();
                else program_asks();
                pause_ = chance(0.4) ? whole(0, 3) : whole(10, 200);
            }
            cycle();
        }
    }
    /// He lets it go, the program goes on with what it has interrupted itself: everything ends.
    void end() {
        if (::testing::Test::HasFailure()) return;
        say("end");
        EXPECT_EQ(group().set_operators_override(1), ErrorId::none);
        (void)rig_.set(Override{1, 1, 1});
        jog_ = 0;
        run_belt(0);
        for (int i = 0; i < 60'000 && !::testing::Test::HasFailure(); ++i) {
            let_go_of_stop();
            const bool settled = view().state == GroupState::GroupStandby || (view().track.in_sync && view().active == 0);
            if (view().state == GroupState::GroupErrorStop) {
                if (view().powered && !view().resetting) (void)group().reset(Owner::program);
            } else if (view().held) {
                (void)person_continues();
            } else if (view().interrupted) {
                (void)submit({.kind = resume}, "continue");
            } else if (settled && pending_.empty()) {
                break;
            }
            cycle();
        }
        std::string open;
        for (const auto& [id, what] : pending_) open += " " + std::to_string(id) + " " + what;
        EXPECT_EQ(open, "") << "never end\n" << story_;
    }
    std::size_t on_ground = 0, on_belt = 0, tried = 0;

private:
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    bool chance(double p) { return uniform(0, 1) < p; }
    [[nodiscard]] const GroupView& view() const { return rig_.view(); }
    AxisGroup& group() { return rig_.groups[0]; }
    void say(const std::string& what) {
        story_ += std::to_string(cycles_) + " " + what + " (" + std::string(name(view().state)) + (view().held ? " held" : "") +
                  (view().interrupted ? " interrupted" : "") + (view().interrupting != 0 ? " brakes" : "") +
                  (view().track.axis.valid() ? view().track.in_sync ? " in sync" : " tracks" : "") + ")\n";
    }
    static std::string number(ErrorId error) { return std::to_string(static_cast<int>(error)); }

    // --- the program ---------------------------------------------------------------------------------------------------------------
    Submitted submit(const GroupCommand& command, const std::string& what) {
        const auto answer = rig_.submit(command);
        say("program: " + what + " -> " + number(answer.error));
        if (rest_ != Rest::none) ++tried;
        if (answer.error == ErrorId::none) note_own(command);
        if (answer.error == ErrorId::none && answer.id != 0) pending_[answer.id] = what;
        return answer;
    }
    /// What ends an interruption of the program's, as the standard has it.
    void note_own(const GroupCommand& command) {
        const bool aborts = has_place_in_queue(command.kind) && command.buffer_mode == mcAborting;
        if (command.kind == interrupt) own_ = true;
        else if (aborts || command.kind == resume || command.kind == stop || command.kind == disable) own_ = false;
    }
    void give_move() {
        GroupCommand command{.kind = chance(0.7) ? linear_absolute : linear_relative};
        command.frame = chance(0.85) ? mcPCS : chance(0.5) ? mcMCS : mcACS;
        for (std::size_t i = 0; i < 3; ++i) command.target[i] = command.kind == linear_relative ? uniform(-20, 20) : uniform(-60, 60);
        command.buffer_mode = chance(0.5) ? mcAborting : chance(0.5) ? mcBuffered : mcBlendingHigh;
        command.dynamics = {.velocity = uniform(20, 50)};
        (void)submit(command, "move in " + std::to_string(command.frame) + ", mode " + std::to_string(command.buffer_mode));
    }
    void track() {
        GroupCommand command{.kind = track_frame,
                             .frame = mcPCS,
                             .execution = chance(0.6)   ? mcImmediately
                                          : chance(0.5) ? mcQueued
                                                        : mcDelayed};
        command.track.kind = FrameTrack::Kind::belt;
        command.track.master = {BeltCell::belt};
        command.track.origin = {uniform(-50, 50), uniform(-50, 50), 0, 0, 0, uniform(-3, 3)};
        (void)submit(command, "track");
    }
    void run_belt(double velocity) {
        const auto answer =
            velocity == 0 ? rig_.axes[BeltCell::belt].submit({.kind = CommandKind::halt}, Owner::program)
                          : rig_.axes[BeltCell::belt].submit({.kind = CommandKind::move_velocity, .velocity = velocity}, Owner::program);
        say("belt: " + std::to_string(velocity) + " -> " + number(answer.error));
    }
    void let_go_of_stop() {
        if (stop_ != 0) group().release_stop(stop_);
        stop_ = 0;
    }
    void program_asks() {
        switch (whole(0, 19)) {
            case 0:
            case 1:
            case 2:
            case 3:
            case 4: return give_move();
            case 5:
            case 6: return track();
            case 7: return void(submit({.kind = halt}, "halt"));
            case 8:
                if (!chance(0.25)) return;
                if (const auto given = submit({.kind = stop}, "stop"); given.error == ErrorId::none) stop_ = given.id;
                return;
            case 9: return let_go_of_stop();
            case 10: return void(submit({.kind = interrupt}, "interrupt"));
            case 11:
            case 12: return void(submit({.kind = resume}, "continue"));
            case 13:
                return void(submit(
                    {.kind = GroupCommandKind::wait, .buffer_mode = chance(0.5) ? mcAborting : mcBuffered, .duration = 1ms * whole(0, 200)},
                    "wait"));
            case 14: {
                if (chance(0.5)) return run_belt(uniform(-25, 25));
                JointVector direction{};
                direction[static_cast<std::size_t>(whole(0, 2))] = chance(0.5) ? 1 : -1;
                const auto given = submit({.kind = jog, .frame = chance(0.5) ? mcACS : mcMCS, .target = direction}, "jog");
                if (given.error == ErrorId::none) jog_ = given.id, jog_way_ = direction, jog_left_ = whole(1, 300);
                return;
            }
            case 15: {
                const double factor = chance(0.6) ? 1 : chance(0.5) ? 0 : 0.3;
                say("program: override " + std::to_string(factor));
                return void(rig_.set(Override{factor, 1, 1}));
            }
            case 16: return run_belt(chance(0.2) ? 0 : uniform(-25, 25));
            case 17: {
                const auto error = rig_.set(FollowPath{.slave = {BeltCell::pump}, .numerator = whole(1, 2)});
                return say("program: pump follows -> " + number(error));
            }
            case 18: {
                const auto given = rig_.groups.submit(BeltCell::second, line({uniform(-50, 50)}, 30), Owner::program);
                return say("program: second group -> " + number(given.error));
            }
            case 19: return chance(0.5) ? world() : void();
        }
    }

    /// A fault, the end of the program, power that goes with another one, set-up mode: none of them lets go.
    void world() {
        const double which = uniform(0, 1);
        if (which < 0.2) {
            say("fault of the belt");
            rig_.drives[BeltCell::belt]->fault_code = 0x3130;
            faults_ = 30;
        } else if (which < 0.3) {
            if (submit({.kind = disable}, "disable").error == ErrorId::none) rest_ = Rest::none, expected_ = false;
            enables_ = true;
        } else if (which < 0.5) {
            say("shut down");
            group().shut_down({static_cast<std::uint16_t>(whole(0, 2))});
            // At rest on the ground nothing is led, and its commands stay.
            if (rest_ != Rest::ground && view().state == GroupState::GroupMoving) own_ = false;
            if (rest_ == Rest::belt) rest_ = Rest::none;
        } else {
            say("end of the program");
            group().let_go();
            jog_ = stop_ = 0;
            own_ = false;
            if (rest_ == Rest::belt) rest_ = Rest::none;
            if (which < 0.8) return;
            setup_ = !setup_;
            group().set_mode(setup_ ? OperatingMode::setup : OperatingMode::automatic);
        }
    }

    // --- the person ----------------------------------------------------------------------------------------------------------------
    void person_interrupts() {
        const auto error = group().hold();
        say("person: interrupt -> " + number(error));
        if (error != ErrorId::none) return;
        EXPECT_TRUE(view().held);
        expected_ = true;
    }
    ErrorId person_continues() {
        const bool held = view().held;
        const auto error = group().release_hold();
        say("person: continue -> " + number(error));
        if (error == ErrorId::none) {
            rest_ = Rest::none, expected_ = false;
            EXPECT_EQ(view().interrupted || view().interrupting != 0, own_) << "what its program has interrupted it keeps so\n" << story_;
        } else {
            EXPECT_EQ(view().held, held);
        }
        return error;
    }
    void person_asks() {
        switch (whole(0, 9)) {
            case 0:
            case 1:
            case 2:
            case 3:
            case 4: return person_interrupts();
            case 5:
            case 6: return void(person_continues());
            case 7:
                if (!chance(0.3)) return;
                say("person: stop");
                group().halt();
                rest_ = Rest::none, expected_ = own_ = false;
                return;
            default: {
                const double factor = chance(0.7) ? 1 : chance(0.5) ? 0 : 0.2;
                say("person: override " + std::to_string(factor));
                EXPECT_EQ(group().set_operators_override(factor), ErrorId::none);
            }
        }
    }

    void cycle() {
        ++cycles_;
        if (faults_ > 0 && --faults_ == 0) {
            for (auto& drive : rig_.drives) drive->fault_code = 0;
            (void)rig_.axes[BeltCell::belt].reset(Owner::program);
        }
        if (faults_ == 0 && view().state == GroupState::GroupErrorStop && !view().resetting && chance(0.05)) {
            say("program: reset");
            (void)group().reset(Owner::program);
        }
        if (enables_ && view().state == GroupState::GroupDisabled && rig_.set(EnableGroup{}) == ErrorId::none) enables_ = false;
        if (jog_ != 0 && --jog_left_ > 0) {
            if (rig_.set(HoldJog{.id = jog_, .direction = jog_way_}) != ErrorId::none) jog_ = 0;
        } else {
            jog_ = 0;
        }
        rig_.step();
        rig_.path.clear();
        look();
    }

    void look() {
        const auto& now = view();
        for (auto one = pending_.begin(); one != pending_.end();) {
            const auto status = now.status(one->first);
            const bool open = status == CommandStatus::active || status == CommandStatus::queued;
            one = open ? std::next(one) : pending_.erase(one);
        }
        if (now.interrupted && !now.held) {
            EXPECT_TRUE(own_) << "nobody goes on with it\n" << story_;
        }
        if (now.state == GroupState::GroupErrorStop) own_ = false;
        if (expected_) {
            EXPECT_TRUE(now.held) << "the hold is lost in cycle " << cycles_ << "\n" << story_;
        }
        const bool tracks = now.track.axis.valid();
        if (rest_ == Rest::ground) {
            EXPECT_FALSE(tracks) << "cycle " << cycles_ << "\n" << story_;
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_NEAR(rig_.axis(i).set_position, at_[i], 1e-3) << "axis " << i << " in cycle " << cycles_ << "\n" << story_;
        } else if (rest_ == Rest::belt && now.state != GroupState::GroupMoving) {
            rest_ = Rest::none;  // a stop or an error takes it off the belt, to rest beside it
        } else if (rest_ == Rest::belt) {
            EXPECT_TRUE(now.interrupted && tracks) << "cycle " << cycles_ << "\n" << story_;
            EXPECT_EQ(now.path_velocity, 0);
            if (!now.track.in_sync) rest_ = Rest::none;
        }
        if (rest_ == Rest::none && now.held && now.interrupted && now.powered) {
            if (!tracks) {
                rest_ = Rest::ground, ++on_ground;
                for (std::size_t i = 0; i < 3; ++i) at_[i] = rig_.axis(i).set_position;
            } else if (now.track.in_sync) {
                rest_ = Rest::belt, ++on_belt;
                serial_ = now.track.serial;
                seen_ = {now.tool_set[0], now.tool_set[1], now.tool_set[2]};
                belt_ = rig_.axis(BeltCell::belt).set_position;
            }
        }
        if (rest_ == Rest::belt) {  // as far from where it stood as the belt has gone
            EXPECT_EQ(now.track.serial, serial_) << story_;
            double square = 0;
            for (std::size_t i = 0; i < 3; ++i) square += (now.tool_set[i] - seen_[i]) * (now.tool_set[i] - seen_[i]);
            EXPECT_NEAR(std::sqrt(square), std::abs(rig_.axis(BeltCell::belt).set_position - belt_), 1e-3) << "cycle " << cycles_ << "\n"
                                                                                                           << story_;
        }
    }

    enum class Rest : std::uint8_t { none, ground, belt };
    std::mt19937_64 random_;
    BeltCell rig_;
    std::map<CommandId, std::string> pending_;
    JointVector at_{}, jog_way_{};
    std::array<double, 3> seen_{};
    double belt_ = 0;
    std::uint32_t serial_ = 0;
    CommandId stop_ = 0, jog_ = 0;
    std::string story_;
    int cycles_ = 0, pause_ = 50, faults_ = 0, jog_left_ = 0;
    Rest rest_ = Rest::none;
    bool expected_ = false, enables_ = false, own_ = false, setup_ = false;
};

TEST(GroupHoldOnBelt, NothingOfAProgramMovesWhatAPersonHolds) {
    std::size_t on_ground = 0, on_belt = 0, tried = 0;
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + property_cases(8) && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        BeltWalk walk(seed);
        walk.walk(8000);
        walk.end();
        on_ground += walk.on_ground;
        on_belt += walk.on_belt;
        tried += walk.tried;
    }
    EXPECT_GT(on_ground, 10u);
    EXPECT_GT(on_belt, 10u);
    EXPECT_GT(tried, 30u);
    std::printf("held at rest %zu times on the ground, %zu on a belt; %zu commands of a program meanwhile\n", on_ground, on_belt, tried);
}

}  // namespace
}  // namespace taktwerk::axes::test
