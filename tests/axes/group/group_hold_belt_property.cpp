// What a person holds on a belt or a table or beside it, whatever its program does meanwhile: a random walk over the commands of both, with a belt or table that runs,
// turns round, stops and fails, an axis that follows the path, and a group beside this one. Once it rests and he was told so, nothing of a program moves it where
// it stands, on the ground or on its object, until he lets it go.

#include <cstdio>

#include "tests/axes/group/hold_walk.hpp"
#include "tests/axes/group/jog_rig.hpp"
#include "tests/axes/group/track_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

/// X Y Z and a turn about Z; a belt, or a table of 360 u a turn; and a pump, which is the only member of a second group.
struct ConveyingCell : GroupRig {
    static constexpr std::size_t members = 4, conveyor = 4, pump = 5;
    static constexpr GroupRef second{1};
    explicit ConveyingCell(FrameTrack::Kind kind) : GroupRig(axes_of_cell(kind), groups_of_cell()) {
        enable();
        EXPECT_EQ(groups.set(second, EnableGroup{}, Owner::program), ErrorId::none);
        EXPECT_EQ(set(WriteJoggingDynamics{slow_jogging()}), ErrorId::none);
    }
    static std::vector<AxisConfig> axes_of_cell(FrameTrack::Kind kind) {
        auto configs = named(members);
        configs.push_back(belt_axis());
        if (kind == FrameTrack::Kind::table) configs.back().modulo = 360;
        configs.push_back(group_axis("pump"));
        return configs;
    }
    static std::vector<AxisGroupConfig> groups_of_cell() {
        KinematicsDescription turning{.arm = CartesianAxes{.turn_about = 2}};
        turning.joints[3].unit = std::numbers::pi / 180;
        return {{.name = "g", .members = {"a0", "a1", "a2", "a3"}, .kinematics = arm_of(turning)},
                {.name = "h", .members = {"pump"}, .kinematics = {}}};
    }
};

class ConveyorHoldWalk : public HoldWalk {
public:
    ConveyorHoldWalk(std::uint64_t seed, FrameTrack::Kind kind) : HoldWalk(seed, 3, {mcACS, mcMCS}), kind_(kind), rig_(kind) {}
    std::size_t on_ground = 0, on_object = 0;

private:
    GroupRig& rig() override { return rig_; }
    [[nodiscard]] bool settled() override {
        return view().state == GroupState::GroupStandby || (view().track.in_sync && view().active == 0);
    }
    void world_ends() override { run_conveyor(0); }

    GroupCommand drawn_move() override {
        GroupCommand command{.kind = chance(0.7) ? GroupCommandKind::linear_absolute : GroupCommandKind::linear_relative};
        command.frame = chance(0.85) ? mcPCS : chance(0.5) ? mcMCS : mcACS;
        const bool relative = command.kind == GroupCommandKind::linear_relative;
        for (std::size_t i = 0; i < 3; ++i) command.target[i] = relative ? uniform(-20, 20) : uniform(-60, 60);
        command.dynamics = {.velocity = uniform(20, 50)};
        return command;
    }
    void track() {
        GroupCommand command{.kind = GroupCommandKind::track_frame,
                             .frame = mcPCS,
                             .execution = chance(0.6)   ? mcImmediately
                                          : chance(0.5) ? mcQueued
                                                        : mcDelayed};
        command.track.kind = kind_;
        command.track.master = {ConveyingCell::conveyor};
        command.track.origin = {uniform(-50, 50), uniform(-50, 50), 0, 0, 0, uniform(-3, 3)};
        const auto given = submit(command, "track");
        if (given.error == ErrorId::none && chance(0.5))
            (void)submit(on_product(line({uniform(-60, 60), uniform(-60, 60)}, 50)), "move there");
    }
    void run_conveyor(double velocity) {
        auto& axis = rig_.axes[ConveyingCell::conveyor];
        const auto answer = velocity == 0 ? axis.submit({.kind = CommandKind::halt}, Owner::program)
                                          : axis.submit({.kind = CommandKind::move_velocity, .velocity = velocity}, Owner::program);
        say("conveyor: " + std::to_string(velocity) + " -> " + number(answer.error));
    }
    void others_ask() override {
        switch (whole(0, 7)) {
            case 0:
            case 1:
            case 2:
            case 3: return track();
            case 4: return run_conveyor(chance(0.2) ? 0 : uniform(-25, 25));
            case 5: {
                const auto error = rig_.set(FollowPath{.slave = {ConveyingCell::pump}, .numerator = whole(1, 2)});
                return say("program: pump follows -> " + number(error));
            }
            case 6: {
                const auto given = rig_.groups.submit(ConveyingCell::second, line({uniform(-50, 50)}, 30), Owner::program);
                return say("program: second group -> " + number(given.error));
            }
            default: return chance(0.5) ? world() : void();
        }
    }

    /// A fault, the end of the program, power that goes with another one, set-up mode: none of them lets go.
    void world() {
        const double which = uniform(0, 1);
        if (which < 0.2) {
            say("fault of the conveyor");
            rig_.drives[ConveyingCell::conveyor]->fault_code = 0x3130;
            faults_ = 30;
        } else if (which < 0.3) {
            disable();
        } else if (which < 0.5) {
            say("shut down");
            group().shut_down({static_cast<std::uint16_t>(whole(0, 2))});
            // At rest on the ground nothing is led, and its commands stay.
            if (rest_ != Rest::ground && view().state == GroupState::GroupMoving) own_ = false;
            if (rest_ == Rest::object) rest_ = Rest::none;
        } else {
            say("end of the program");
            group().let_go();
            jog_ = stop_ = 0;
            own_ = false;
            if (rest_ == Rest::object) rest_ = Rest::none;
            if (which < 0.8) return;
            setup_ = !setup_;
            group().set_mode(setup_ ? OperatingMode::setup : OperatingMode::automatic);
        }
    }

    [[nodiscard]] bool rests() const override { return rest_ != Rest::none; }
    void let_go_told() override { rest_ = Rest::none; }
    void look_closer() override {
        const auto& now = view();
        const bool tracks = now.track.axis.valid();
        if (rest_ == Rest::ground) {
            EXPECT_FALSE(tracks) << cycle_and_story();
            for (std::size_t i = 0; i < ConveyingCell::members; ++i)
                EXPECT_NEAR(rig_.axis(i).set_position, at_[i], 1e-3) << "axis " << i << " " << cycle_and_story();
        } else if (rest_ == Rest::object && now.state != GroupState::GroupMoving) {
            rest_ = Rest::none;  // a stop or an error takes it off the object, to rest beside it
        } else if (rest_ == Rest::object) {
            EXPECT_TRUE(now.interrupted && tracks) << cycle_and_story();
            EXPECT_EQ(now.path_velocity, 0) << cycle_and_story();
            if (!now.track.in_sync) rest_ = Rest::none;
        }
        if (rest_ == Rest::none && now.held && now.interrupted && now.powered) come_to_rest(tracks);
        if (rest_ == Rest::object) stands_on_object();
    }
    void come_to_rest(bool tracks) {
        const auto& now = view();
        if (!tracks) {
            rest_ = Rest::ground, ++on_ground;
            for (std::size_t i = 0; i < ConveyingCell::members; ++i) at_[i] = rig_.axis(i).set_position;
        } else if (now.track.in_sync) {
            rest_ = Rest::object, ++on_object;
            serial_ = now.track.serial;
            seen_ = now.tool_set;
            conveyed_ = rig_.axis(ConveyingCell::conveyor).set_position;
        }
    }
    /// As far from where it stood as the conveyor has gone; turned as far, on a table.
    void stands_on_object() {
        const auto& now = view();
        EXPECT_EQ(now.track.serial, serial_) << cycle_and_story();
        const double gone = rig_.axis(ConveyingCell::conveyor).set_position - conveyed_;
        double square = 0;
        for (std::size_t i = 0; i < 3; ++i) square += (now.tool_set[i] - seen_[i]) * (now.tool_set[i] - seen_[i]);
        const double turned = std::remainder(now.tool_set[5] - seen_[5], 2 * std::numbers::pi);
        if (kind_ == FrameTrack::Kind::belt) {
            EXPECT_NEAR(std::sqrt(square), std::abs(gone), 1e-3) << cycle_and_story();
            EXPECT_NEAR(turned, 0, 1e-6) << cycle_and_story();
        } else {
            EXPECT_NEAR(std::remainder(turned - gone * std::numbers::pi / 180, 2 * std::numbers::pi), 0, 1e-5) << cycle_and_story();
            EXPECT_NEAR(now.tool_set[2], seen_[2], 1e-6) << cycle_and_story();
            chord(square, turned);
        }
    }
    /// All chords of a turn belong to one radius.
    void chord(double square, double turned) {
        const double half = std::abs(std::sin(turned / 2));
        if (half < 0.05) return;
        const double radius = std::sqrt(square) / (2 * half);
        if (radius_serial_ == on_object) {
            EXPECT_NEAR(radius, radius_, 2e-2) << cycle_and_story();
        }
        radius_serial_ = on_object;
        radius_ = radius;
        ++chords;
    }

    enum class Rest : std::uint8_t { none, ground, object };
    FrameTrack::Kind kind_;
    ConveyingCell rig_;
    JointVector at_{};
    std::array<double, 6> seen_{};
    double conveyed_ = 0, radius_ = 0;
    std::size_t radius_serial_ = 0;
    std::uint32_t serial_ = 0;
    Rest rest_ = Rest::none;
    bool setup_ = false;

public:
    std::size_t chords = 0;
};

void hold_on(FrameTrack::Kind kind, std::uint64_t first, std::uint64_t count) {
    std::size_t on_ground = 0, on_object = 0, tried = 0, chords = 0;
    for (std::uint64_t seed = first; seed < first + count && !::testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        ConveyorHoldWalk walk(seed, kind);
        walk.walk(8000);
        walk.end();
        on_ground += walk.on_ground;
        on_object += walk.on_object;
        tried += walk.tried;
        chords += walk.chords;
    }
    EXPECT_GT(on_ground, 10u);
    EXPECT_GT(on_object, 10u);
    EXPECT_GT(tried, 30u);
    if (kind == FrameTrack::Kind::table) {
        EXPECT_GT(chords, 100u);
    }
    std::printf("held at rest %zu times on the ground, %zu on an object; %zu commands of a program meanwhile\n", on_ground, on_object,
                tried);
}

TEST(GroupHoldOnBelt, NothingOfAProgramMovesWhatAPersonHolds) { hold_on(FrameTrack::Kind::belt, first_program(), property_cases(8)); }
TEST(GroupHoldOnTable, NothingOfAProgramMovesWhatAPersonHolds) { hold_on(FrameTrack::Kind::table, first_program(), property_cases(8)); }

}  // namespace
}  // namespace taktwerk::axes::test
