// Every kind of arm among rooms that its tool's point keeps out of and rooms that it stays in, drawn around the place where it stands: lines, arcs, moves
// of the axes, curves between them, halts, jogs, and a belt that carries it on. In every cycle the tool is where it may be, to a billionth; one that begins
// where it may not only gets out of there. The rig's oracle looks at every member beside.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "axes/group/workspace.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "tests/axes/group/jog_arms.hpp"
#include "tests/axes/group/track_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

using Point = std::array<double, 3>;

class Draw {
public:
    explicit Draw(std::uint64_t seed) : random_(seed) {}
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    bool once_in(int n) { return whole(1, n) == 1; }
    /// Sizes of every order alike.
    double size(double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); }
    Point direction() {
        for (;;) {
            const Point d{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
            const double length = std::hypot(d[0], d[1], d[2]);
            if (length > 0.1 && length <= 1) return {d[0] / length, d[1] / length, d[2] / length};
        }
    }
    std::array<double, 4> orientation() {
        if (once_in(3)) return {1, 0, 0, 0};
        const auto about = direction();
        const double half = uniform(-1.5, 1.5);
        return {std::cos(half), std::sin(half) * about[0], std::sin(half) * about[1], std::sin(half) * about[2]};
    }

private:
    std::mt19937_64 random_;
};

/// Around a point, from thinner than a hair to larger than the arm.
Rooms drawn_rooms(Draw& draw, const Point& here, bool begins_inside) {
    Rooms rooms;
    const auto room_at = [&](double distance, bool kept_free) {
        WorkspaceRoom room{.name = "r" + std::to_string(rooms.size()), .kept_free = kept_free};
        const auto d = draw.direction();
        for (std::size_t i = 0; i < 3; ++i) room.middle.position[i] = here[i] + distance * d[i];
        room.middle.orientation = draw.orientation();
        return room;
    };
    if (draw.once_in(2)) {  // it stays in there: the point is inside
        auto cell = room_at(0, false);
        cell.half = {draw.uniform(20, 300), draw.uniform(20, 300), draw.uniform(20, 300)};
        if (draw.once_in(3)) {
            cell.shape = WorkspaceRoom::Shape::cylinder;
            cell.half[1] = cell.half[0];
        }
        rooms.push_back(cell);
        if (draw.once_in(3)) {
            auto beside = room_at(cell.half[0], false);
            beside.half = {draw.uniform(20, 100), draw.uniform(20, 100), draw.uniform(20, 100)};
            rooms.push_back(beside);
        }
    }
    for (int n = draw.whole(1, 5); n > 0; --n) {
        auto stone = room_at(draw.size(1, 250), true);
        stone.half = {draw.size(0.05, 80), draw.size(0.05, 80), draw.size(0.05, 80)};
        if (draw.once_in(3)) {
            stone.shape = WorkspaceRoom::Shape::cylinder;
            stone.half[1] = stone.half[0];
        }
        // As the point is where it may be, unless this is about one that is not.
        if (Workspace{{stone}}.clearance(here) > 0.01) rooms.push_back(stone);
    }
    if (begins_inside) {
        auto around = room_at(draw.uniform(0, 4), true);
        around.half = {draw.uniform(5, 60), draw.uniform(5, 60), draw.uniform(5, 60)};
        rooms.push_back(around);
    }
    if (rooms.empty()) {
        auto wall = room_at(60, true);
        wall.half = {500, 500, 1};
        if (Workspace{{wall}}.clearance(here) > 0) rooms.push_back(wall);
    }
    return rooms;
}

Joints first_of(const JointVector& values) {
    Joints joints{};
    for (std::size_t i = 0; i < max_joints; ++i) joints[i] = values[i];
    return joints;
}

/// The tool's point by the members' set-points, and the rooms.
class Eye {
public:
    Eye(Arm arm, Rooms rooms) : arm_(std::move(arm)), space_{std::move(rooms)} {}
    void look(const GroupView& view) {
        const auto at = arm_->forward(first_of(view.set_position), tool);
        if (!at.miss.ok()) return;  // rods that do not meet: no place
        const auto& p = at.pose.position;
        const double room = space_.clearance(p), digits = 2e-9 * std::max({1.0, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
        nearest = std::min(nearest, std::abs(room));
        ASSERT_GE(room, std::min(0.0, least_) - digits)
            << "at " << p[0] << ", " << p[1] << ", " << p[2] << ": by " << room - least_ << ", error " << view.error;
        // Each member on its own ramp, some of them sooner at rest: that stop keeps where it began.
        if (view.state != GroupState::GroupErrorStop) least_ = std::max(least_, room);
    }
    Pose tool{};
    double nearest = 1e9;

private:
    Arm arm_;
    Workspace space_;
    double least_ = -1e9;
};

class RoomWalk {
public:
    RoomWalk(std::uint64_t seed, const JogArm& arm)
        : draw_(seed),
          arm_(arm),
          kinematics_(arm_of(arm.description)),
          tool_{0, 0, 0, 0, 0, 0},
          rooms_(rooms_at_start()),
          rig_(axes_of(arm), kinematics_, rooms_),
          eye_(kinematics_, rooms_) {
        eye_.tool.position = {tool_[0], tool_[1], tool_[2]};
    }

    void go(int moves) {
        for (auto& axis : rig_.axes)
            ASSERT_EQ(axis.submit({.kind = CommandKind::home, .position = 0}, Owner::program).error, ErrorId::none);
        rig_.run(50);
        // By the members alone: a group would look at the rooms on the way.
        for (std::size_t i = 0; i < arm_.turning.size(); ++i)
            ASSERT_EQ(
                rig_.axes[i].submit({.kind = CommandKind::move_absolute, .position = arm_.start[i], .velocity = 40}, Owner::program).error,
                ErrorId::none);
        ASSERT_TRUE(rig_.until(
            [&] {
                for (std::size_t i = 0; i < arm_.turning.size(); ++i)
                    if (rig_.axis(i).state != AxisState::Standstill || rig_.axis(i).set_position != arm_.start[i]) return false;
                return true;
            },
            9000));
        ASSERT_EQ(rig_.set(WriteJoggingDynamics{jogging_of_arms()}), ErrorId::none);
        GroupCommand write{.kind = GroupCommandKind::write_tool, .execution = mcImmediately, .number = 1};
        write.tool.frame = tool_;
        ASSERT_EQ(rig_.give(write).error, ErrorId::none);
        ASSERT_EQ(rig_.set(SelectTool{1}), ErrorId::none);
        rig_.run(3);
        for (int i = 0; i < moves && !::testing::Test::HasFailure(); ++i) {
            if (draw_.once_in(3)) jog();
            else move();
        }
    }
    [[nodiscard]] int refused() const { return refused_; }
    [[nodiscard]] int gone() const { return gone_; }
    [[nodiscard]] int stood_at_walls() const { return walls_; }

private:
    Rooms rooms_at_start() {
        if (draw_.once_in(2)) tool_ = {draw_.uniform(-60, 60), draw_.uniform(-60, 60), draw_.uniform(-100, 100), 0, 0, 0};
        Pose tool;
        tool.position = {tool_[0], tool_[1], tool_[2]};
        const auto here = kinematics_->forward(first_of(arm_.start), tool);
        EXPECT_TRUE(here.miss.ok());
        return drawn_rooms(draw_, here.pose.position, draw_.once_in(5));
    }
    void step() {
        rig_.step();
        eye_.look(rig_.view());
    }
    void settle(int most) {
        for (int i = 0; i < most && rig_.view().state != GroupState::GroupStandby && !::testing::Test::HasFailure(); ++i) step();
        ASSERT_EQ(rig_.view().state, GroupState::GroupStandby);
    }

    GroupCommand drawn_move(MC_BufferMode mode) {
        GroupCommand c;
        c.buffer_mode = mode;
        c.dynamics = {.velocity = draw_.size(5, 300)};
        const double far = draw_.size(2, 200);
        const auto d = draw_.direction();
        switch (draw_.whole(0, 3)) {
            case 0:
            case 1:
                c.kind = GroupCommandKind::linear_relative;
                c.frame = mcMCS;
                c.target = {far * d[0], far * d[1], far * d[2]};
                if (kinematics_->commands()[5] && draw_.once_in(3)) c.target[5] = draw_.uniform(-0.8, 0.8);
                break;
            case 2: {
                c.kind = GroupCommandKind::circular_relative;
                c.frame = mcMCS;
                c.target = {far * d[0], far * d[1], far * d[2]};
                const auto aside = draw_.direction();
                const double out = far * draw_.uniform(0.05, 0.9);
                c.circle = {.mode = mcBORDER, .aux = {}};
                for (std::size_t i = 0; i < 3; ++i) c.circle.aux[i] = c.target[i] / 2 + out * aside[i];
                break;
            }
            default:
                c.kind = GroupCommandKind::direct_relative;
                c.frame = mcACS;
                for (std::size_t i = 0; i < arm_.turning.size(); ++i)
                    c.target[i] = draw_.once_in(3) ? 0 : draw_.uniform(-1, 1) * (arm_.turning[i] ? 60 : 100);
                if (arm_.askew) c.target[1] = c.target[0];
                break;
        }
        if (mode >= mcBlendingLow) {
            c.transition = draw_.once_in(2) ? mcTMCornerDistance : mcTMMaxCornerDeviation;
            c.transition_parameter = draw_.size(0.5, 60);
        }
        return c;
    }
    void move() {
        std::vector<CommandId> ids;
        const auto give = [&](MC_BufferMode mode) {
            Submitted answer;
            const auto command = drawn_move(mode);
            rig_.step([&] { answer = rig_.submit(command); });
            eye_.look(rig_.view());
            if (answer.error == ErrorId::none) ids.push_back(answer.id);
        };
        give(mcAborting);
        for (int more = draw_.whole(0, 2); more > 0; --more) give(draw_.once_in(3) ? mcBuffered : mcBlendingHigh);
        if (draw_.once_in(3)) {
            for (int i = draw_.whole(10, 900); i > 0 && !::testing::Test::HasFailure(); --i) step();
            if (draw_.once_in(2)) give(mcAborting);
            else rig_.step([&] { (void)rig_.submit(simply(GroupCommandKind::halt, {.deceleration = draw_.size(50, 900)})); });
            eye_.look(rig_.view());
        }
        settle(40000);
        for (const auto id : ids) {
            if (rig_.status(id) == CommandStatus::done) ++gone_;
            if (rig_.status(id) == CommandStatus::error && rig_.error_of(id) == ErrorId::outside_workspace) ++refused_;
        }
    }
    void jog() {
        rig_.frame = draw_.once_in(2) ? mcACS : mcMCS;
        rig_.pins = {};
        const int slots = rig_.frame == mcACS ? static_cast<int>(arm_.turning.size()) : 3;
        JointVector d{};
        for (int n = draw_.whole(1, 3); n > 0; --n) d[static_cast<std::size_t>(draw_.whole(0, slots - 1))] = draw_.once_in(2) ? 1 : -1;
        if (rig_.frame == mcACS && arm_.askew) d[1] = d[0];
        rig_.held = {};
        rig_.held.velocity = rig_.held.acceleration = 1;
        rig_.held.direction = d;
        for (int i = draw_.whole(50, 3000); i > 0 && !::testing::Test::HasFailure(); --i) {
            rig_.hold_for(1);
            eye_.look(rig_.view());
        }
        if (rig_.view().jog_end == JogEnd::workspace) ++walls_;
        rig_.held.direction = {};
        rig_.hold_for(1);
        eye_.look(rig_.view());
        settle(9000);
        rig_.hold_for(2);
    }

    Draw draw_;
    const JogArm& arm_;
    Arm kinematics_;
    SixNumbers tool_;
    Rooms rooms_;
    JogRig rig_;
    Eye eye_;
    int refused_ = 0, gone_ = 0, walls_ = 0;
};

TEST(GroupWorkspaceProperty, NoArmLeadsItsToolThroughAWall) {
    const auto arms = every_kind_of_arm();
    int refused = 0, gone = 0, walls = 0;
    for (std::size_t i = 0; i < property_cases(arms.size()) && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << "walk " << i << " of " << arms[i % arms.size()].name);
        RoomWalk walk(9100 + i, arms[i % arms.size()]);
        walk.go(8);
        refused += walk.refused();
        gone += walk.gone();
        walls += walk.stood_at_walls();
    }
    EXPECT_GT(refused, 3);
    EXPECT_GT(gone, 15);
    EXPECT_GT(walls, 0);
}

// --- a belt carries the tool ---------------------------------------------------------------------------------------------------------

class Carried {
public:
    explicit Carried(std::uint64_t seed)
        : draw_(seed),
          arm_(arm_of({.arm = CartesianAxes{}})),
          rooms_(drawn_rooms(draw_, {0, 0, 0}, draw_.once_in(6))),
          eye_(arm_, rooms_) {}

    /// How it ended: 0, or the group's error.
    std::uint16_t go() {
        TrackRig rig(GroupRig::named(3), arm_, belt_axis(), rooms_);
        const auto step = [&] {
            rig.step();
            eye_.look(rig.view());
        };
        const auto along = draw_.direction();
        Six origin{};
        origin[5] = std::atan2(along[1], along[0]);
        origin[4] = -std::asin(along[2]);
        EXPECT_EQ(rig.track(origin, {}).error, ErrorId::none);
        const auto way = draw_.direction();
        const double far = draw_.size(0.5, 10);
        (void)rig.give(on_product(line({far * way[0], far * way[1], far * way[2]}, 40)));
        for (int change = 0; change < 5; ++change) {
            rig.drive_belt(draw_.uniform(-45, 45));
            eye_.look(rig.view());
            if (draw_.once_in(2)) {
                const auto aside = draw_.direction();
                const double by = draw_.size(1, 20);
                (void)rig.give(on_product(line_by({by * aside[0], by * aside[1], by * aside[2]}, 30)));
                eye_.look(rig.view());
            }
            for (int i = draw_.whole(100, 1500); i > 0 && !::testing::Test::HasFailure(); --i) step();
            if (rig.view().state == GroupState::GroupErrorStop) break;
        }
        for (int i = 0; i < 600 && !::testing::Test::HasFailure(); ++i) step();
        return rig.view().error;
    }

private:
    Draw draw_;
    Arm arm_;
    Rooms rooms_;
    Eye eye_;
};

TEST(GroupWorkspaceProperty, NoBeltCarriesTheToolThroughAWall) {
    int ended = 0, gone = 0;
    for (std::size_t i = 0; i < property_cases(40) && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << "belt " << i);
        Carried carried(31000 + i);
        const auto error = carried.go();
        if (error == static_cast<std::uint16_t>(ErrorId::frame_limit)) ++ended;
        if (error == 0) ++gone;
    }
    EXPECT_GT(ended, 5);
    EXPECT_GT(gone, 5);
}

}  // namespace
}  // namespace taktwerk::axes::test
