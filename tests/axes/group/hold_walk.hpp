#pragma once
// A random walk over what a program and a person ask of a group that he may hold: what both kinds of walk have in common. What the world around the group does,
// and what must stand still while it is held, is the walk's own.
//
// `expected`: he pressed, and it was taken: it is held until he lets it go, or somebody ends it who may.
// `own`: the program has interrupted it, and nothing has ended that.

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {

class HoldWalk {
public:
    HoldWalk(std::uint64_t seed, std::size_t moving, std::vector<MC_CoordSystem> jog_frames)
        : random_(seed), moving_(moving), jog_frames_(std::move(jog_frames)) {}
    virtual ~HoldWalk() = default;
    HoldWalk(const HoldWalk&) = delete;
    HoldWalk& operator=(const HoldWalk&) = delete;

    void walk(int cycles) {
        for (int i = 0; i < cycles && !::testing::Test::HasFailure(); ++i) {
            if (pause_-- <= 0) {
                if (chance(0.22)) person_asks();
                else program_asks();
                pause_ = chance(0.4) ? whole(0, 3) : whole(10, 220);
            }
            cycle();
        }
    }

    /// He lets it go, the program goes on with what it has interrupted itself: everything ends.
    void end() {
        if (::testing::Test::HasFailure()) return;
        say("end");
        person_overrides(1);
        (void)rig().set(Override{1, 1, 1});
        jog_ = 0;
        world_ends();
        for (int i = 0; i < 60'000 && !::testing::Test::HasFailure(); ++i) {
            let_go_of_stop();
            if (view().state == GroupState::GroupErrorStop) {
                if (view().powered && !view().resetting) (void)group().reset(Owner::program);
            } else if (view().held) {
                (void)person_continues();
            } else if (view().interrupted) {
                (void)submit({.kind = GroupCommandKind::resume}, "continue");
            } else if (settled() && pending_.empty()) {
                break;
            }
            cycle();
        }
        std::string open;
        for (const auto& [id, what] : pending_) open += " " + std::to_string(id) + " " + what;
        EXPECT_EQ(open, "") << "never end\n" << story_;
        EXPECT_TRUE(settled()) << name(view().state) << "\n" << story_;
    }

protected:
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    bool chance(double p) { return uniform(0, 1) < p; }

    virtual GroupRig& rig() = 0;
    /// Where the walk may end.
    [[nodiscard]] virtual bool settled() { return view().state == GroupState::GroupStandby; }
    virtual void world_ends() {}
    virtual GroupCommand drawn_move() = 0;
    /// What else a program, or the world, may do here.
    virtual void others_ask() = 0;
    /// Each cycle, behind what must hold everywhere.
    virtual void look_closer() = 0;
    /// Nobody holds it any more, or who may has ended it.
    virtual void let_go_told() = 0;
    /// It is held at rest, and he was told so.
    [[nodiscard]] virtual bool rests() const = 0;

    const GroupView& view() { return rig().view(); }
    AxisGroup& group() { return rig().groups[0]; }
    void say(const std::string& what) {
        const auto& now = view();
        story_ += std::to_string(cycles_) + " " + what + " (" + std::string(name(now.state)) + (now.held ? " held" : "") +
                  (now.interrupted ? " interrupted" : "") + (now.interrupting != 0 ? " brakes" : "") +
                  (now.track.axis.valid() ? now.track.in_sync ? " in sync" : " tracks" : "") + ")\n";
    }
    static std::string number(ErrorId error) { return std::to_string(static_cast<int>(error)); }

    Submitted submit(const GroupCommand& command, const std::string& what) {
        const bool held = rests();
        const auto answer = rig().submit(command);
        say("program: " + what + " -> " + number(answer.error));
        if (answer.error == ErrorId::none) note_own(command);
        if (answer.error == ErrorId::none && answer.id != 0) pending_[answer.id] = what;
        if (held) {
            ++tried;
            waited += answer.error == ErrorId::none && has_place_in_queue(command.kind);
        }
        return answer;
    }
    void disable() {
        if (submit({.kind = GroupCommandKind::disable}, "disable").error == ErrorId::none) let_go_told(), expected_ = false;
        enables_ = true;
    }
    std::string cycle_and_story() const { return "in cycle " + std::to_string(cycles_) + "\n" + story_; }

    std::map<CommandId, std::string> pending_;
    CommandId stop_ = 0, jog_ = 0;
    std::string story_;
    int cycles_ = 0, faults_ = 0;
    bool expected_ = false, own_ = false;

public:
    std::size_t tried = 0, waited = 0;  ///< commands while it was held at rest; motions of them that wait

private:
    /// What ends an interruption of the program's, as the standard has it.
    void note_own(const GroupCommand& command) {
        using enum GroupCommandKind;
        const bool aborts = command.kind == home || (has_place_in_queue(command.kind) && command.buffer_mode == mcAborting);
        if (command.kind == interrupt) own_ = true;
        else if (aborts || command.kind == resume || command.kind == stop || command.kind == GroupCommandKind::disable) own_ = false;
    }
    void give_move() {
        auto command = drawn_move();
        command.buffer_mode = chance(0.5) ? mcAborting : chance(0.5) ? mcBuffered : mcBlendingHigh;
        (void)submit(command, "move in " + std::to_string(command.frame) + ", mode " + std::to_string(command.buffer_mode));
    }
    void let_go_of_stop() {
        if (stop_ != 0) group().release_stop(stop_);
        stop_ = 0;
    }
    void begin_jog() {
        JointVector direction{};
        direction[static_cast<std::size_t>(whole(0, static_cast<int>(moving_) - 1))] = chance(0.5) ? 1 : -1;
        const auto frame = jog_frames_[static_cast<std::size_t>(whole(0, static_cast<int>(jog_frames_.size()) - 1))];
        const auto given = submit({.kind = GroupCommandKind::jog, .frame = frame, .target = direction}, "jog");
        if (given.error == ErrorId::none) jog_ = given.id, jog_way_ = direction, jog_left_ = whole(1, 300);
    }
    void program_asks() {
        using enum GroupCommandKind;
        switch (whole(0, 21)) {
            case 0:
            case 1:
            case 2:
            case 3:
            case 4:
            case 5: return give_move();
            case 6: return void(submit({.kind = halt}, "halt"));
            case 7:
                if (!chance(0.4)) return;
                if (const auto given = submit({.kind = stop}, "stop"); given.error == ErrorId::none) stop_ = given.id;
                return;
            case 8:
            case 9: return let_go_of_stop();
            case 10: return void(submit({.kind = interrupt}, "interrupt"));
            case 11:
            case 12: return void(submit({.kind = resume}, "continue"));
            case 13:
                return void(submit({.kind = GroupCommandKind::wait,
                                    .buffer_mode = chance(0.5) ? mcAborting : mcBuffered,
                                    .duration = std::chrono::milliseconds(whole(0, 200))},
                                   "wait"));
            case 14: return begin_jog();
            case 15: {
                const double factor = chance(0.6) ? 1 : chance(0.5) ? 0 : 0.3;
                say("program: override " + std::to_string(factor));
                return void(rig().set(Override{factor, 1, 1}));
            }
            default: return others_ask();
        }
    }

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
            let_go_told(), expected_ = false;
            EXPECT_EQ(view().interrupted || view().interrupting != 0, own_) << "what its program has interrupted it keeps so\n" << story_;
        } else {
            EXPECT_EQ(view().held, held);
        }
        return error;
    }
    void person_stops() {
        say("person: stop");
        group().halt();
        let_go_told(), expected_ = own_ = false;
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
            default: return person_overrides(1);
        }
    }

    void cycle() {
        ++cycles_;
        if (faults_ > 0 && --faults_ == 0) {
            for (auto& drive : rig().drives) drive->fault_code = 0;
            rig().powered.assign(rig().powered.size(), true);
            for (std::size_t i = 0; i < rig().axes.size(); ++i)
                if (!group().contains({static_cast<std::uint16_t>(i)})) (void)rig().axes[i].reset(Owner::program);
        }
        if (faults_ == 0 && view().state == GroupState::GroupErrorStop && !view().resetting && chance(0.05)) {
            say("program: reset");
            (void)group().reset(Owner::program);
        }
        if (enables_ && view().state == GroupState::GroupDisabled && rig().set(EnableGroup{}) == ErrorId::none) enables_ = false;
        if (jog_ != 0 && --jog_left_ > 0) {
            if (rig().set(HoldJog{.id = jog_, .direction = jog_way_}) != ErrorId::none) jog_ = 0;
        } else {
            jog_ = 0;
        }
        rig().step();
        rig().path.clear();
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
            EXPECT_EQ(now.path_velocity, 0) << cycle_and_story();
        }
        if (now.interrupted && !now.held) {
            EXPECT_TRUE(own_) << "nobody goes on with it " << cycle_and_story();
        }
        if (now.state == GroupState::GroupErrorStop) own_ = false;
        if (expected_) {
            EXPECT_TRUE(now.held) << "the hold is lost " << cycle_and_story();
        }
        look_closer();
    }

    std::mt19937_64 random_;
    std::size_t moving_;  ///< numbers of a jog's direction
    std::vector<MC_CoordSystem> jog_frames_;
    JointVector jog_way_{};
    int pause_ = 50, jog_left_ = 0;
    bool enables_ = false;
};

}  // namespace taktwerk::axes::test
