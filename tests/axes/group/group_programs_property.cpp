// Programs of one to two hundred moves on every kind of arm, disturbed in every way that is allowed: override, holds, commands and plans that come late. Each
// cycle (1 ms): every member inside its limits, set-points continuous in position, velocity and acceleration (the rig's look()), told with shown (its
// oracles), and the tool on its way: off the programmed line or arc only where a corner is rounded, by no more than was asked for. And the places that
// a disturbed program passes are those of an undisturbed one.
//
// TAKTWERK_PROGRAMS_FIRST=<seed> begins there; TAKTWERK_SOAK_FACTOR multiplies how many are run.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "tests/axes/group/drawn_program.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

struct ProgramTotals {
    std::size_t programs = 0, moves = 0, cycles = 0, rounded = 0, on_the_way = 0, holds = 0, halts = 0, overrides = 0, late = 0,
                compared = 0;
    double off = 0, turned_off = 0, beside = 0;  // as parts of their size; rad
};

struct Passed {
    JointVector q{}, velocity{};
    Pose pose;
    CommandId command = 0;
};

enum class Disturbed : unsigned char { not_at_all, in_time, late };

class ProgramRun {
public:
    ProgramRun(std::uint64_t seed, const JogArm& arm, const Arm& kinematics, const std::vector<DrawnMove>& moves, Disturbed disturbed,
               ProgramTotals& totals)
        : random_(seed),
          arm_(arm),
          kinematics_(kinematics),
          moves_(moves),
          disturbed_(disturbed),
          totals_(totals),
          rig_(axes_of(arm), kinematics) {}

    std::vector<Passed> passed;

    /// False: it was halted, and the rest was not gone.
    bool run() {
        for (std::size_t k = 0; k < rig_.axes.size(); ++k)
            EXPECT_EQ(rig_.axes[k].submit({.kind = CommandKind::home, .position = arm_.start[k]}, Owner::program).error, ErrorId::none);
        rig_.run(50);
        rig_.enable();
        rig_.path.clear();
        const std::size_t calm = disturbed_ == Disturbed::not_at_all ? 0 : 3000 + 1000 * moves_.size();
        const std::size_t most = calm + 20'000 + 5000 * moves_.size();
        const bool will_halt = disturbed_ != Disturbed::not_at_all && chance(0.1);
        while (cycle_ < most && !::testing::Test::HasFailure()) {
            give();
            if (cycle_ < calm) {
                disturb();
                if (will_halt && !halted_ && chance(0.0003)) halt();
            } else if (cycle_ == calm) {
                settle();
            }
            if (rig_.view().interrupted && cycle_ >= resumes_) {
                EXPECT_EQ(rig_.submit(simply(GroupCommandKind::resume)).error, ErrorId::none);
            }
            rig_.step();
            if (rig_.path.size() > 10'000) rig_.path.clear();
            ++cycle_;
            look();
            if (over()) break;
        }
        totals_.cycles += cycle_;
        if (::testing::Test::HasFailure()) return false;
        if (halted_) {
            EXPECT_EQ(rig_.view().state, GroupState::GroupStandby);
            return false;
        }
        EXPECT_EQ(finished_, moves_.size()) << "after " << cycle_ << " cycles";
        arrive();
        return true;
    }

private:
    bool chance(double p) { return std::uniform_real_distribution<double>(0, 1)(random_) < p; }
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }

    void give() {
        while (given_ < moves_.size() && !halted_ && rig_.view().queued_count < GroupView::most_waiting) {
            if (disturbed_ == Disturbed::late && !chance(given_ % 5 == 0 ? 0.01 : 0.1)) return;
            const auto answer = rig_.submit(moves_[given_].command);
            ASSERT_EQ(answer.error, ErrorId::none) << "move " << given_;
            ids_.push_back(answer.id);
            ++given_;
            if (disturbed_ == Disturbed::late) {
                ++totals_.late;
                return;
            }
        }
    }
    void disturb() {
        if (chance(0.002)) {
            const Override factors{chance(0.1) ? 0 : uniform(0.05, 1), uniform(0.3, 1), uniform(0.3, 1)};
            EXPECT_EQ(rig_.set(factors), ErrorId::none);
            ++totals_.overrides;
        }
        if (chance(0.001)) rig_.served_every = 1 + random_() % 30;
        if (!rig_.view().interrupted && chance(0.0007) && rig_.submit(simply(GroupCommandKind::interrupt)).error == ErrorId::none) {
            resumes_ = cycle_ + random_() % 300;
            ++totals_.holds;
        }
    }
    void settle() {
        rig_.served_every = 1;
        EXPECT_EQ(rig_.set(Override{1, 1, 1}), ErrorId::none);
    }
    void halt() {
        if (rig_.view().state != GroupState::GroupMoving) return;
        settle();
        if (rig_.submit(simply(GroupCommandKind::halt, {.deceleration = 1500, .jerk = 30'000})).error != ErrorId::none) return;
        halted_ = true;
        ++totals_.halts;
    }
    bool over() {
        if (halted_) return rig_.view().state == GroupState::GroupStandby;
        while (finished_ < ids_.size()) {
            ErrorId error = ErrorId::none;
            const auto status = rig_.view().status(ids_[finished_], &error);
            EXPECT_NE(status, CommandStatus::error) << "move " << finished_ << ": error " << static_cast<int>(error);
            EXPECT_NE(status, CommandStatus::aborted) << "move " << finished_;
            if (status != CommandStatus::done) break;
            ++finished_;
        }
        return finished_ == moves_.size() && rig_.view().state == GroupState::GroupStandby;
    }

    /// The tool is on the way of the active command, or on the curve that rounds one of its corners.
    void look() {
        const auto& view = rig_.view();
        ASSERT_EQ(view.error, 0);
        if (view.state != GroupState::GroupMoving || view.active == 0 || ids_.empty()) return;
        const auto at = std::find(ids_.begin(), ids_.end(), view.active);
        if (at == ids_.end()) return;
        const auto k = static_cast<std::size_t>(at - ids_.begin());
        Passed now{view.set_position, view.set_velocity, {}, view.active};
        Joints q{};
        for (std::size_t i = 0; i < max_joints; ++i) q[i] = view.set_position[i];
        now.pose = kinematics_->forward(q, {}).pose;
        if (disturbed_ != Disturbed::late && moves_.size() <= GroupView::most_waiting) passed.push_back(now);
        const Way& way = moves_[k].way;
        const auto place = way.nearest(now.q, now.pose);
        double size = way.length;
        for (std::size_t i = 0; i < 3; ++i) size += std::abs(now.pose.position[i]);
        if (way.kind == Way::Kind::joints)
            for (std::size_t i = 0; i < way.members; ++i) size += std::abs(now.q[i]);
        const double along = place.share * way.length, left = way.length - along;
        const bool on_it = place.off <= 1e-9 * size && place.turned_off <= 1e-9;
        if (k != last_) came_ = false;
        came_ = came_ || on_it;
        last_ = k;
        const bool rounded =
            along < reach(k, way.length) || (k + 1 < moves_.size() && left < reach(k + 1, way.length)) || on_mixed_curve(k, on_it);
        if (!rounded) {
            ASSERT_LE(place.off, 1e-9 * size) << "move " << k << " at " << along << " of " << way.length << ", cycle " << cycle_;
            ASSERT_LE(place.turned_off, 1e-9) << "move " << k << " at " << along << " of " << way.length << ", cycle " << cycle_;
            ++totals_.on_the_way;
            totals_.off = std::max(totals_.off, place.off / size);
            totals_.turned_off = std::max(totals_.turned_off, place.turned_off);
            return;
        }
        ++totals_.rounded;
        const double nearest = std::min(along, left),
                     allowed = std::max(most_off(k, along), k + 1 < moves_.size() ? most_off(k + 1, left) : 0);
        ASSERT_LE(place.off, allowed + 1e-9 * size) << "move " << k << ", " << nearest << " from a corner of it";
    }

    /// A curve between a way of the axes and one of the tool may be anywhere beside both, and the nearest place of either then says nothing: in front of
    /// move k until it is come to, behind it from where it is left.
    bool on_mixed_curve(std::size_t k, bool on_it) const {
        const auto curve = [&](std::size_t i) { return i > 0 && i < moves_.size() && mixed(i) && reach(i, moves_[i].way.length) > 0; };
        return !on_it && ((curve(k) && !came_) || (curve(k + 1) && came_));
    }
    /// In front of it a way of the axes meets one of the tool.
    bool mixed(std::size_t k) const { return (moves_[k].way.kind == Way::Kind::joints) != (moves_[k - 1].way.kind == Way::Kind::joints); }
    /// How far from the corner in front of move k a curve may begin or end, along either: 0 where none is asked for.
    double reach(std::size_t k, double length) const {
        if (k == 0) return 0;
        const auto& command = moves_[k].command;
        const bool curved = command.transition != mcTMNone && command.buffer_mode >= mcBlendingLow;
        if (!curved) return 0;
        const double half = 0.5 * length * (1 + 1e-9);
        if (mixed(k)) return half;
        // Of the arc that a curve has to be projected on, a little more.
        const bool lines = moves_[k].way.kind != Way::Kind::arc && moves_[k - 1].way.kind != Way::Kind::arc;
        return command.transition == mcTMCornerDistance ? std::min(half, (lines ? 1 + 1e-9 : 1.2) * command.transition_parameter) : half;
    }
    /// How far off its move a curve may be: by its deviation where that is what was asked for between lines; else by no more than its legs.
    double most_off(std::size_t k, double from_corner) const {
        if (k == 0) return 0;
        const auto& command = moves_[k].command;
        if (command.transition == mcTMNone || command.buffer_mode < mcBlendingLow) return 0;
        // Between a way of the axes and one of the tool lengths do not compare; how far such a curve is off its corner: group_corner_*.cpp.
        if (mixed(k)) return std::numeric_limits<double>::infinity();
        const bool lines = moves_[k].way.kind != Way::Kind::arc && moves_[k - 1].way.kind != Way::Kind::arc;
        const double legs = std::min(moves_[k].way.length, moves_[k - 1].way.length) / 2;
        if (from_corner > legs * 1.2) return 0;
        if (command.transition == mcTMMaxCornerDeviation && lines) return command.transition_parameter * (1 + 1e-6);
        return command.transition == mcTMCornerDistance ? std::min(legs, command.transition_parameter) : legs;
    }

    void arrive() {
        const Way& last = moves_.back().way;
        const auto& view = rig_.view();
        passed.push_back({view.set_position, {}, {}, ids_.back()});
        if (last.kind == Way::Kind::joints) {
            for (std::size_t k = 0; k < last.members; ++k) EXPECT_NEAR(view.set_position[k], last.to[k], 1e-9 * 100) << k;
            return;
        }
        Joints q{};
        for (std::size_t i = 0; i < max_joints; ++i) q[i] = view.set_position[i];
        const auto place = last.nearest(view.set_position, kinematics_->forward(q, {}).pose);
        EXPECT_NEAR(place.share, 1, 1e-9);
        EXPECT_LE(place.off, 1e-9 * 1000);
        EXPECT_LE(place.turned_off, 1e-9);
    }

    std::mt19937_64 random_;
    const JogArm& arm_;
    Arm kinematics_;
    const std::vector<DrawnMove>& moves_;
    Disturbed disturbed_;
    ProgramTotals& totals_;
    GroupRig rig_;
    std::vector<CommandId> ids_;
    std::size_t given_ = 0, finished_ = 0, cycle_ = 0, resumes_ = 0;
    bool halted_ = false;
    std::size_t last_ = 0;
    bool came_ = false;  // to the way of the active command
};

/// Between two places a cycle apart the members go, to the fourth power of it, as the cubic does that has both their velocities.
class Between {
public:
    Between(const Passed& a, const Passed& b, double time, std::size_t members) : a_(a), b_(b), time_(time), members_(members) {}
    [[nodiscard]] double square_to(const JointVector& q, double t) const {
        const double u = 1 - t, h00 = u * u * (1 + 2 * t), h10 = u * u * t * time_, h01 = t * t * (3 - 2 * t), h11 = -t * t * u * time_;
        double sum = 0;
        for (std::size_t k = 0; k < members_; ++k)
            sum += std::pow(h00 * a_.q[k] + h10 * a_.velocity[k] + h01 * b_.q[k] + h11 * b_.velocity[k] - q[k], 2);
        return sum;
    }
    [[nodiscard]] double distance_to(const JointVector& q) const {
        double low = 0, high = 1;
        for (int i = 0; i < 50; ++i) {
            const double one = low + 0.382 * (high - low), two = low + 0.618 * (high - low);
            (square_to(q, one) < square_to(q, two) ? high : low) = square_to(q, one) < square_to(q, two) ? two : one;
        }
        return std::sqrt(std::min({square_to(q, (low + high) / 2), square_to(q, 0), square_to(q, 1)}));
    }

private:
    const Passed &a_, &b_;
    double time_;
    std::size_t members_;
};

/// Every place of `disturbed` lies on the curve through those of `free`: to 1e-9 of its size, and what interpolating between them may cost: half of what it
/// does over twice the time, which is measured on them. By its order that is a sixteenth, an eighth where the jerk jumps between two cycles, and not every
/// place is as far from a cycle as those that are measured.
void compare(const std::vector<Passed>& free, const std::vector<Passed>& disturbed, std::size_t members, ProgramTotals& totals) {
    constexpr double cycle = 1e-3;
    if (free.size() < 4) return;
    std::vector<double> costs(free.size(), 0);
    for (std::size_t i = 1; i + 1 < free.size(); ++i)
        costs[i] = Between(free[i - 1], free[i + 1], 2 * cycle, members).distance_to(free[i].q);
    std::size_t near = 0;
    double size = 0;
    for (const auto& one : free)
        for (std::size_t k = 0; k < members; ++k) size = std::max(size, std::abs(one.q[k]));
    for (const Passed& now : disturbed) {
        // It goes the same way, and never back.
        double best = Between(free[near], free[near + 1], cycle, members).distance_to(now.q);
        for (std::size_t i = near + 1; i + 1 < free.size() && i < near + 200; ++i) {
            if (best <= 1e-10 * size) break;
            const double one = Between(free[i], free[i + 1], cycle, members).distance_to(now.q);
            if (one < best) {
                best = one;
                near = i;
            } else if (one > 100 * best + 1e-3 * size) {
                break;
            }
        }
        double cost = 0;
        for (std::size_t i = near > 2 ? near - 2 : 0; i < std::min(near + 4, costs.size()); ++i) cost = std::max(cost, costs[i]);
        // Where a corner is passed at rest between two cycles, no curve through them has it: it is as near as they can come in that time.
        if (free[near].command != free[near + 1].command) {
            double fastest = 0;
            for (std::size_t k = 0; k < members; ++k) fastest += std::abs(free[near].velocity[k]) + std::abs(free[near + 1].velocity[k]);
            cost += 2 * fastest * cycle;
        }
        totals.beside = std::max(totals.beside, (best - cost / 2) / size);
        ASSERT_LE(best, 1e-9 * size + cost / 2) << "beside the path at " << near;
    }
    ++totals.compared;
}

void run_program(std::uint64_t seed, const JogArm& arm, const Arm& kinematics, ProgramTotals& totals) {
    ProgramDraws draws(seed, arm, kinematics);
    // Three seconds of computing a program in the mean: in every test run only short ones.
    const int longest = std::getenv("TAKTWERK_SOAK_FACTOR") != nullptr ? 200 : 8;
    const auto moves = draws.program(std::min(draws.how_many(), longest));
    ASSERT_FALSE(moves.empty());
    ++totals.programs;
    totals.moves += moves.size();
    const auto disturbed = draws.chance(0.4) ? Disturbed::late : Disturbed::in_time;
    ProgramRun run(seed, arm, kinematics, moves, disturbed, totals);
    (void)run.run();
    // What is given at once is bent by nobody who comes late: then both have one path.
    if (::testing::Test::HasFailure() || disturbed == Disturbed::late || moves.size() > GroupView::most_waiting || !draws.chance(0.3))
        return;
    ProgramRun free(seed, arm, kinematics, moves, Disturbed::not_at_all, totals);
    if (free.run()) compare(free.passed, run.passed, arm.turning.size(), totals);
}

// G-025, G-040, G-041, G-051, G-052, G-055, G-058, G-071.
TEST(GroupPrograms, OfEveryLengthOnEveryKindOfArmKeepLimitsAndPath) {
    const auto arms = arms_of_programs();
    std::vector<Arm> kinematics;
    for (const auto& arm : arms) kinematics.push_back(arm_of(arm.description));
    const std::uint64_t first = first_program();
    ProgramTotals t;
    const std::size_t cases = property_cases(arms.size());
    for (std::uint64_t seed = first; seed < first + cases && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << " on " << arms[seed % arms.size()].name);
        run_program(seed, arms[seed % arms.size()], kinematics[seed % arms.size()], t);
    }
    std::printf(
        "seeds %llu to %llu: %zu programs, %zu moves, %zu cycles (%zu on lines and arcs, %zu on curves), %zu overrides, %zu holds, %zu "
        "halts, %zu commands "
        "late, %zu compared with the undisturbed; off the path %.1e of its size, %.1e rad, beside the undisturbed %.1e of it\n",
        static_cast<unsigned long long>(first), static_cast<unsigned long long>(first + cases - 1), t.programs, t.moves, t.cycles,
        t.on_the_way, t.rounded, t.overrides, t.holds, t.halts, t.late, t.compared, t.off, t.turned_off, t.beside);
    if (first != 1) return;
    EXPECT_GT(t.on_the_way, 1000u);
    EXPECT_GT(t.rounded, 300u);
    EXPECT_GT(t.overrides + t.holds + t.late, 10u);
}

}  // namespace
}  // namespace taktwerk::axes::test
