// What a person holds, whatever its program does meanwhile: a random walk over the commands of both on several arms. Once it rests and he was told so, no
// member moves by a program's will until he lets it go, or ends it; behind that every command comes to an end.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>

#include "tests/axes/group/drawn_program.hpp"
#include "tests/axes/group/group_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

using enum GroupCommandKind;

class HeldWalk {
public:
    HeldWalk(std::uint64_t seed, const JogArm& arm, const Arm& kinematics)
        : random_(seed), moves_(ProgramDraws(seed, arm, kinematics).program(8)), rig_(axes_of(arm), kinematics) {
        for (std::size_t i = 0; i < rig_.axes.size(); ++i)
            EXPECT_EQ(rig_.axes[i].submit({.kind = CommandKind::home, .position = arm.start[i]}, Owner::program).error, ErrorId::none);
        rig_.run(50);
        rig_.enable();
        EXPECT_EQ(rig_.set(WriteJoggingDynamics{jogging_of_arms()}), ErrorId::none);
    }

    void walk(int cycles) {
        for (int i = 0; i < cycles && !::testing::Test::HasFailure(); ++i) {
            if (pause_-- <= 0) {
                ask();
                pause_ = chance(0.4) ? whole(0, 3) : whole(10, 250);
            }
            cycle();
        }
    }

    /// He lets it go, the program goes on with what it has interrupted itself: everything ends.
    void end() {
        if (::testing::Test::HasFailure()) return;
        say("end");
        person_overrides(1);
        (void)rig_.set(Override{1, 1, 1});
        jog_ = 0;
        for (int i = 0; i < 60'000 && !::testing::Test::HasFailure(); ++i) {
            let_go_of_stop();
            if (view().state == GroupState::GroupErrorStop) {
                if (view().powered && !view().resetting) (void)group().reset(Owner::program);
            } else if (view().held) {
                (void)person_continues();
            } else if (view().interrupted) {
                (void)submit({.kind = resume});
            } else if (view().state == GroupState::GroupStandby && pending_.empty()) {
                break;
            }
            cycle();
        }
        std::string open;
        for (const auto& [id, what] : pending_) open += " " + std::to_string(id) + " " + what;
        EXPECT_EQ(open, "") << "never end\n" << story_;
        EXPECT_EQ(view().state, GroupState::GroupStandby);
    }

    std::size_t rests = 0, tried = 0,
                waited = 0;  ///< how often it was held at rest; motions that were commanded meanwhile; those that waited

private:
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    bool chance(double p) { return uniform(0, 1) < p; }
    [[nodiscard]] const GroupView& view() const { return rig_.view(); }
    AxisGroup& group() { return rig_.groups[0]; }
    void say(const std::string& what) { story_ += std::to_string(cycles_) + " " + what + "\n"; }

    // --- the program ---------------------------------------------------------------------------------------------------------------
    Submitted submit(const GroupCommand& command, const std::string& what = "") {
        const auto answer = rig_.submit(command);
        say("program: " + (what.empty() ? "kind " + std::to_string(static_cast<int>(command.kind)) : what) + " -> " +
            std::to_string(static_cast<int>(answer.error)));
        if (answer.error == ErrorId::none) note_own(command);
        if (answer.error == ErrorId::none && answer.id != 0)
            pending_[answer.id] = what.empty() ? std::to_string(static_cast<int>(command.kind)) : what;
        return answer;
    }
    /// What ends an interruption of the program's, as the standard has it.
    void note_own(const GroupCommand& command) {
        const bool aborts = has_place_in_queue(command.kind) && command.buffer_mode == mcAborting;
        if (command.kind == interrupt) own_ = true;
        else if (aborts || command.kind == resume || command.kind == stop || command.kind == disable) own_ = false;
    }
    void give_move() {
        auto command = moves_[static_cast<std::size_t>(whole(0, static_cast<int>(moves_.size()) - 1))].command;
        command.buffer_mode = chance(0.5) ? mcAborting : chance(0.5) ? mcBuffered : mcBlendingHigh;
        command.dynamics = {.velocity = uniform(40, 200)};
        const bool told = told_;
        const auto answer = submit(command, "move, mode " + std::to_string(command.buffer_mode));
        if (!told) return;
        ++tried;
        waited += answer.error == ErrorId::none;
    }
    void let_go_of_stop() {
        if (stop_ != 0) group().release_stop(stop_);
        stop_ = 0;
    }
    void program_asks() {
        switch (whole(0, 17)) {
            case 0:
            case 1:
            case 2:
            case 3:
            case 4:
            case 5: return give_move();
            case 6: return void(submit({.kind = halt}, "halt"));
            case 7:
                if (const auto given = submit({.kind = stop}, "stop"); given.error == ErrorId::none) stop_ = given.id;
                return;
            case 8: return let_go_of_stop();
            case 9: return void(submit({.kind = interrupt}, "interrupt"));
            case 10:
            case 11: return void(submit({.kind = resume}, "continue"));
            case 12:
                return void(submit(
                    {.kind = GroupCommandKind::wait, .buffer_mode = chance(0.5) ? mcAborting : mcBuffered, .duration = 1ms * whole(0, 200)},
                    "wait"));
            case 13: return void(submit({.kind = home}, "home"));
            case 14: {
                JointVector direction{};
                direction[static_cast<std::size_t>(whole(0, static_cast<int>(rig_.axes.size()) - 1))] = chance(0.5) ? 1 : -1;
                const auto given = submit({.kind = jog, .target = direction}, "jog");
                if (given.error == ErrorId::none) jog_ = given.id, jog_way_ = direction, jog_left_ = whole(1, 300);
                return;
            }
            case 15: {
                GroupCommand frame{.kind = set_frame, .frame = mcPCS, .execution = chance(0.5) ? mcDelayed : mcQueued};
                return void(submit(frame, "frame"));
            }
            case 16: {
                const double factor = chance(0.6) ? 1 : chance(0.5) ? 0 : 0.3;
                say("program: override " + std::to_string(factor));
                return void(rig_.set(Override{factor, 1, 1}));
            }
            case 17:
                if (!chance(0.3)) return;
                if (submit({.kind = disable}, "disable").error == ErrorId::none) told_ = expected_ = false;
                enables_ = true;
                return;
        }
    }

    // --- the person ----------------------------------------------------------------------------------------------------------------
    void person_interrupts() {
        const auto error = group().hold();
        say("person: interrupt -> " + std::to_string(static_cast<int>(error)));
        if (error != ErrorId::none) return;
        EXPECT_TRUE(view().held);
        expected_ = true;
    }
    ErrorId person_continues() {
        const bool held = view().held;
        const auto error = group().release_hold();
        if (error == ErrorId::none) {
            told_ = expected_ = false;
            EXPECT_EQ(view().interrupted || view().interrupting != 0, own_) << "what its program has interrupted it keeps so\n" << story_;
        } else {
            EXPECT_EQ(view().held, held);
        }
        say("person: continue -> " + std::to_string(static_cast<int>(error)));
        return error;
    }
    void person_stops() {
        say("person: stop");
        group().halt();
        told_ = expected_ = own_ = false;
    }
    void person_overrides(double factor) {
        say("person: override " + std::to_string(factor));
        EXPECT_EQ(group().set_operators_override(factor), ErrorId::none);
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
            case 7: return chance(0.3) ? person_stops() : void();
            case 8: return person_overrides(chance(0.6) ? 1 : chance(0.5) ? 0 : 0.2);
            case 9: return person_overrides(1);
        }
    }
    void world() {
        const auto i = static_cast<std::size_t>(whole(0, static_cast<int>(rig_.axes.size()) - 1));
        if (chance(0.5)) {
            say("fault of " + std::to_string(i));
            rig_.drives[i]->fault_code = 0x3130;
            faults_ = 30;
        } else {
            say("program: power off " + std::to_string(i));
            rig_.powered[i] = false;
            (void)rig_.axes[i].power(false, false, false, Owner::program);
            faults_ = 60;
        }
    }
    void ask() {
        const bool person = chance(0.2);
        if (person) return person_asks();
        if (chance(0.01)) return world();
        program_asks();
    }

    void cycle() {
        ++cycles_;
        if (faults_ > 0 && --faults_ == 0) {
            for (auto& drive : rig_.drives) drive->fault_code = 0;
            rig_.powered.assign(rig_.powered.size(), true);
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
            const bool open = status == CommandStatus::active || status == CommandStatus::queued || now.interrupting == one->first ||
                              now.disabling == one->first;
            one = open ? std::next(one) : pending_.erase(one);
        }
        if (now.interrupted) {
            EXPECT_EQ(now.path_velocity, 0);
            EXPECT_TRUE(now.state == GroupState::GroupStandby || now.state == GroupState::GroupStopping ||
                        now.state == GroupState::GroupErrorStop)
                << name(now.state);
        }
        if (now.interrupted && !now.held) {
            EXPECT_TRUE(own_) << "nobody goes on with it\n" << story_;
        }
        if (now.state == GroupState::GroupErrorStop) own_ = false;
        // He pressed, and it was taken: it is held until he lets it go, or somebody ends it who may.
        if (expected_) {
            EXPECT_TRUE(now.held) << "the hold is lost\n" << story_;
        }
        if (!told_ && now.held && now.interrupted && now.powered) {
            told_ = true;
            ++rests;
            for (std::size_t i = 0; i < rig_.axes.size(); ++i) rest_[i] = rig_.axis(i).set_position;
        }
        if (!told_) return;
        for (std::size_t i = 0; i < rig_.axes.size(); ++i) {
            if (!rig_.axis(i).powered) continue;
            EXPECT_NEAR(rig_.axis(i).set_position, rest_[i], 1e-3) << "axis " << i << " in cycle " << cycles_ << "\n" << story_;
        }
    }

    std::mt19937_64 random_;
    std::vector<DrawnMove> moves_;
    GroupRig rig_;
    std::map<CommandId, std::string> pending_;
    JointVector rest_{}, jog_way_{};
    CommandId stop_ = 0, jog_ = 0;
    std::string story_;
    int cycles_ = 0, pause_ = 50, faults_ = 0, jog_left_ = 0;
    bool told_ = false, expected_ = false, enables_ = false;
    bool own_ = false;  // the program has interrupted, and nothing has ended that
};

TEST(GroupHold, NothingOfAProgramMovesWhatAPersonHolds) {
    const auto arms = arms_of_programs();
    std::vector<Arm> kinematics;
    for (const auto& arm : arms) kinematics.push_back(arm_of(arm.description));
    std::size_t rests = 0, tried = 0, waited = 0;
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + property_cases(8) && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << " on " << arms[seed % arms.size()].name);
        HeldWalk walk(seed, arms[seed % arms.size()], kinematics[seed % arms.size()]);
        walk.walk(6000);
        walk.end();
        rests += walk.rests;
        tried += walk.tried;
        waited += walk.waited;
    }
    EXPECT_GT(rests, 15u);
    EXPECT_GT(waited, 30u);
    std::printf("held %zu times at rest; of %zu motions that were commanded meanwhile %zu waited\n", rests, tried, waited);
}

}  // namespace
}  // namespace taktwerk::axes::test
