// Programs of direct moves and of lines of the tool, one behind the other at random, with curves between them, overridden and interrupted: each ends where it is to end, and no
// joint is ever beyond a limit or away from one motion (the rig's oracle, every cycle).

#include <gtest/gtest.h>

#include <random>

#include "axes/group/written_pose.hpp"
#include "tests/axes/group/flange_by_hand.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

class MixedProgram {
public:
    MixedProgram(std::uint64_t seed, const JogArm& arm)
        : random_(seed),
          arm_(arm_of(arm.description)),
          rig_(axes_of(arm), GroupRig::all_of(axes_of(arm), arm_)),
          at_(arm.start),
          start_(arm.start) {
        rig_.enable();
        auto there = line(arm.start, 60);
        there.kind = GroupCommandKind::direct_absolute;
        const auto first = rig_.give(there);
        EXPECT_TRUE(rig_.until([&] { return rig_.status(first.id) == CommandStatus::done; }, 20'000));
    }

    int curves() const { return curves_; }
    void run() {
        constexpr int commands = 12;
        std::vector<CommandId> ids;
        std::size_t finished = 0;
        for (int i = 0; i < 100'000 && !::testing::Test::HasFailure(); ++i) {
            if (static_cast<int>(ids.size()) < commands && uniform(0, 1) < 0.1) {
                const auto answer = rig_.submit(next());
                ASSERT_EQ(answer.error, ErrorId::none);
                ids.push_back(answer.id);
            }
            if (uniform(0, 1) < 0.002) {
                ASSERT_EQ(rig_.set(Override{uniform(0.2, 1), uniform(0.5, 1), uniform(0.5, 1)}), ErrorId::none);
            }
            if (rig_.view().interrupted) {
                ASSERT_EQ(rig_.submit(simply(GroupCommandKind::resume)).error, ErrorId::none);
            } else if (uniform(0, 1) < 0.001) {
                (void)rig_.submit(simply(GroupCommandKind::interrupt));
            }
            const auto before = rig_.view().active;
            rig_.step();
            const auto corner = rig_.view().corner;
            if (rig_.view().active != before && (corner == CornerPassed::as_asked || corner == CornerPassed::smaller)) ++curves_;
            while (finished < ids.size() && rig_.status(ids[finished]) == CommandStatus::done) ++finished;
            if (finished < ids.size()) {
                ASSERT_NE(rig_.status(ids[finished]), CommandStatus::error) << static_cast<int>(rig_.error_of(ids[finished]));
            }
            if (finished == commands && rig_.view().state == GroupState::GroupStandby) break;
        }
        EXPECT_EQ(finished, static_cast<std::size_t>(commands));
        for (std::size_t k = 0; k < arm_->joint_count(); ++k) EXPECT_NEAR(rig_.point()[k], at_[k], 1e-6) << k;
    }

private:
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

    /// Near the beginning, so that straight lines between the places stay in reach and away from singularities.
    GroupCommand next() {
        Joints joints{};
        for (std::size_t k = 0; k < arm_->joint_count(); ++k) joints[k] = at_[k] = start_[k] + uniform(-8, 8);
        GroupCommand command = line(at_, uniform(10, 90), static_cast<MC_BufferMode>(whole(2, 5)));
        if (whole(0, 1) == 0) {
            command.kind = GroupCommandKind::direct_absolute;
        } else {
            const auto pose = arm_->forward(joints, Pose{});
            EXPECT_TRUE(pose.miss.ok());
            const auto six = numbers_of(pose.pose);
            command.frame = mcMCS;
            command.target = {six[0], six[1], six[2], six[3], six[4], six[5]};
        }
        command.transition = static_cast<MC_TransitionMode>(whole(0, 4));
        const bool by_velocity = command.transition == mcTMStartVelocity || command.transition == mcTMConstantVelocity;
        command.transition_parameter = by_velocity ? uniform(0, 1) : uniform(0, 15);
        return command;
    }

    std::mt19937_64 random_;
    Arm arm_;
    GroupRig rig_;
    JointVector at_{}, start_{};
    int curves_ = 0;
};

/// A corner between a move of the axes and a line of the tool, either way round, gone at some pace.
class MixedCornerRun {
public:
    struct Case {
        JogArm arm;
        JointVector begin{}, corner{}, end{};  ///< of the axes; the line's far end is where they stand at that of its ends
        bool line_first = false;
        MC_TransitionMode transition = mcTMCornerDistance;
        double parameter = 0, slow = 20, fast = 60;
    };
    struct Pace {
        MC_BufferMode mode = mcBlendingLow;
        Override factors{};
        bool interrupted = false;
    };
    struct Place {
        double s = 0;
        JointVector q{}, slope{};
        double from_corner = 0;
    };

    MixedCornerRun(const Case& drawn, const Pace& pace)
        : case_(drawn),
          pace_(pace),
          arm_(arm_of(drawn.arm.description)),
          rig_(axes_of(drawn.arm), GroupRig::all_of(axes_of(drawn.arm), arm_)) {}

    std::vector<Place> places;
    CornerPassed corner = CornerPassed::none;
    bool refused = false;

    void run() {
        const std::size_t joints = arm_->joint_count();
        rig_.enable();
        const auto ready = rig_.give({.kind = GroupCommandKind::direct_absolute, .target = case_.begin});
        ASSERT_TRUE(rig_.until([&] { return rig_.status(ready.id) == CommandStatus::done; }, 20'000));
        rig_.run(20);
        ASSERT_EQ(rig_.set(pace_.factors), ErrorId::none);
        const Spot at_corner = flange_by_hand(case_.arm, case_.corner, {0, 0, -300});
        CommandId last = 0;
        rig_.step([&] {
            const auto one = rig_.submit(to(case_.corner, case_.line_first, case_.slow, mcAborting));
            auto second = to(case_.end, !case_.line_first, case_.fast, pace_.mode);
            second.transition = case_.transition;
            second.transition_parameter = case_.parameter;
            const auto two = rig_.submit(second);
            refused = one.error != ErrorId::none || two.error != ErrorId::none;
            last = two.id;
        });
        if (refused) return;
        const double gone = rig_.view().path_gone;
        for (int i = 0; i < 60'000; ++i) {
            if (pace_.interrupted && i % 301 == 150) rig_.step([&] { (void)rig_.submit(simply(GroupCommandKind::interrupt)); });
            else if (pace_.interrupted && rig_.view().interrupted) rig_.step([&] { (void)rig_.submit(simply(GroupCommandKind::resume)); });
            else rig_.step();
            if (rig_.status(last) == CommandStatus::error || rig_.view().state == GroupState::GroupErrorStop) refused = true;
            if (refused) return;
            if (rig_.status(last) == CommandStatus::active) corner = rig_.view().corner;
            Place p{rig_.view().path_gone - gone, rig_.point(), {}, 0};
            const double v = rig_.view().path_velocity;
            if (v > 0)
                for (std::size_t k = 0; k < joints; ++k) p.slope[k] = rig_.axis(k).set_velocity / v;
            p.from_corner =
                far(flange_by_hand(case_.arm, p.q, {rig_.view().tool_set[0], rig_.view().tool_set[1], rig_.view().tool_set[2]}), at_corner);
            if (v > 0) places.push_back(p);
            if (rig_.status(last) == CommandStatus::done) return;
        }
        FAIL() << "it hangs";
    }

private:
    GroupCommand to(const JointVector& q, bool by_line, double velocity, MC_BufferMode mode) const {
        GroupCommand command = line(q, velocity, mode);
        if (!by_line) {
            command.kind = GroupCommandKind::direct_absolute;
            return command;
        }
        Joints joints{};
        for (std::size_t k = 0; k < arm_->joint_count(); ++k) joints[k] = q[k];
        const auto six = numbers_of(arm_->forward(joints, Pose{}).pose);
        command.frame = mcMCS;
        command.target = {six[0], six[1], six[2], six[3], six[4], six[5]};
        return command;
    }

    Case case_;
    Pace pace_;
    Arm arm_;
    GroupRig rig_;
};

/// Of a place by its length between two of a run: Hermite's polynomial.
double between(const MixedCornerRun::Place& a, const MixedCornerRun::Place& b, double s, std::size_t k) {
    const double h = b.s - a.s, u = (s - a.s) / h, w = 1 - u;
    return a.q[k] * (1 + 2 * u) * w * w + b.q[k] * (1 + 2 * w) * u * u + h * u * w * (a.slope[k] * w - b.slope[k] * u);
}

// G-051, G-052, G-053, G-059, G-060, G-071: whatever pace, velocity rule, override or interruption, the members are at the same places at the same length of the path; parameters from
// a millionth to a million. A curve by its deviation passes the corner within that; one by its distance that is as it was asked for leaves and joins there.
TEST(GroupCornerProperty, ACurveBetweenAxesAndToolIsTheSameAtEveryPace) {
    int curves = 0, compared = 0;
    for (const auto& arm : every_kind_of_arm()) {
        bool known = false;
        for (const char* name : {"cartesian", "scara", "rotary_delta", "linear_delta", "six_with_wrist", "six_without_wrist"})
            known = known || arm.name == name;
        if (!known) continue;
        for (std::size_t i = 0; i < property_cases(2) && !HasFailure(); ++i) {
            SCOPED_TRACE(::testing::Message() << arm.name << " case " << i);
            std::mt19937_64 random(7000 + i);
            const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
            MixedCornerRun::Case drawn;
            drawn.arm = arm;
            drawn.begin = drawn.corner = drawn.end = arm.start;
            for (std::size_t k = 0; k < arm.turning.size(); ++k) {
                drawn.begin[k] += uniform(-9, 9);
                drawn.corner[k] += uniform(-9, 9);
                drawn.end[k] += uniform(-9, 9);
            }
            drawn.line_first = uniform(0, 1) < 0.5;
            constexpr std::array kinds{mcTMCornerDistance, mcTMMaxCornerDeviation, mcTMStartVelocity};
            drawn.transition = kinds[static_cast<std::size_t>(uniform(0, 2.999))];
            drawn.parameter = drawn.transition == mcTMStartVelocity ? uniform(0, 1)
                              : uniform(0, 1) < 0.3                 ? std::pow(10, uniform(-6, 6))
                                                                    : uniform(0.1, 8);
            MixedCornerRun one(drawn, {}),
                other(drawn, {mcBlendingHigh, Override{uniform(0.2, 0.9), uniform(0.3, 1), uniform(0.3, 1)}, true});
            one.run();
            if (HasFatalFailure() || one.refused) continue;
            other.run();
            ASSERT_FALSE(other.refused);
            if (one.corner != CornerPassed::stood) {  // an interruption may end in the corner: then nothing is passed
                EXPECT_EQ(one.corner, other.corner);
            }
            curves += one.corner == CornerPassed::as_asked || one.corner == CornerPassed::smaller ? 1 : 0;
            double nearest = 1e9, step = 0;
            for (std::size_t n = 0; n < one.places.size(); ++n) {
                nearest = std::min(nearest, one.places[n].from_corner);
                if (n > 0) step = std::max(step, std::abs(one.places[n].from_corner - one.places[n - 1].from_corner));
            }
            if (drawn.transition == mcTMMaxCornerDeviation) {
                EXPECT_LE(nearest, drawn.parameter * (1 + 1e-6) + step);
            }
            const bool curved = one.corner == CornerPassed::as_asked || one.corner == CornerPassed::smaller;
            std::size_t at = 0;
            for (const auto& p : other.places) {
                if (!curved) break;  // it stands in the corner
                while (at + 2 < one.places.size() && one.places[at + 1].s < p.s) ++at;
                const auto &a = one.places[at], &b = one.places[at + 1];
                if (p.s < a.s || p.s > b.s || b.s - a.s < 1e-9) continue;
                for (std::size_t k = 0; k < arm.turning.size(); ++k)
                    ASSERT_NEAR(p.q[k], between(a, b, p.s, k), 1e-6) << k << " at " << p.s << " of " << one.places.back().s;
                ++compared;
            }
            EXPECT_NEAR(one.places.back().s, other.places.back().s, 1e-3);
        }
    }
    EXPECT_GT(curves, 4);
    EXPECT_GT(compared, 2000);
}

// G-058, G-060, G-062
TEST(GroupCornerProperty, ProgramsOfAxesAndPosesArrive) {
    int curves = 0;
    for (const auto& arm : every_kind_of_arm()) {
        if (arm.name != "scara" && arm.name != "six_with_wrist" && arm.name != "rotary_delta") continue;
        for (std::size_t i = 0; i < property_cases(1) && !HasFailure(); ++i) {
            SCOPED_TRACE(::testing::Message() << arm.name << " program " << i);
            MixedProgram program(5000 + i, arm);
            program.run();
            curves += program.curves();
        }
    }
    EXPECT_GT(curves, 5);
}

}  // namespace
}  // namespace taktwerk::axes::test
