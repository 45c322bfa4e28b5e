// A program moves a group of axes over a whole machine: real frames, simulated drives, virtual time.

#include "axes/axis/alarms.hpp"
#include "axes/group/workspace.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "axes/planner/motion.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;
using namespace testing;
using axes::AxisState;

/// Powers, enables, then runs a triangle again and again; stops, halts and resets as it is told.
class Draws : public Program {
public:
    axes::GroupRef group;
    fb::MC_GroupPower power;
    fb::MC_GroupEnable enable;
    fb::MC_MoveLinearAbsolute first;
    fb::MC_MoveLinearRelative second;
    fb::MC_GroupStop stop;
    fb::MC_GroupReset reset;
    fb::MC_GroupReadStatus status;
    fb::MC_GroupReadError error;
    fb::MC_GroupReadActualPosition place;
    bool stops = false, resets = false, goes = true, in_machine = false;
    fb::MC_BufferMode second_mode = fb::mcBuffered;
    std::int64_t done = 0, aborted = 0, failed = 0, group_error = 0, state = 0;
    double x = 0, y = 0;

    void declare(Declaration& d) override {
        group = d.axis_group("table");
        d.block("first", first);
        d.monitor("done", done);
        d.monitor("aborted", aborted);
        d.monitor("failed", failed);
        d.monitor("group_error", group_error);
        d.monitor("state", state);
        d.monitor("x", x);
        d.monitor("y", y);
        d.monitor("stopped", stop.Done);
        d.operator_switch("stops", stops);
        d.operator_switch("resets", resets);
        d.operator_switch("goes", goes);
        d.task<&Draws::scan>("main");
    }
    void start() override {
        first.Execute = second.Execute = enable.Execute = false;
        stops = resets = false;
    }
    void scan(TaskContext& ctx) {
        for (auto* any : {&power.AxesGroup, &enable.AxesGroup, &first.AxesGroup, &second.AxesGroup, &stop.AxesGroup, &reset.AxesGroup,
                          &status.AxesGroup, &error.AxesGroup, &place.AxesGroup})
            *any = group;
        power.Enable = status.Enable = error.Enable = place.Enable = true;
        power(ctx);
        enable.Execute = power.Status;
        enable(ctx);
        status(ctx);
        stop.Execute = stops;
        stop(ctx);
        reset.Execute = resets;
        reset(ctx);
        first(ctx);
        if (first.Busy) second.Execute = true;
        second(ctx);
        const bool ready = status.GroupStandby && power.Status && goes && !stops;
        if (ready && !first.Execute) {
            first.CoordSystem = second.CoordSystem = in_machine ? fb::mcMCS : fb::mcACS;
            first.Position.A.Axes = {60, 80, 30};
            first.Position.C.Tcp = {.X = 60, .Y = 80, .Z = 30};
            second.Distance.A.Axes = {-60, -80, -30};
            second.Distance.C.Tcp = {.X = -60, .Y = -80, .Z = -30};
            first.Velocity = second.Velocity = 200;
            second.BufferMode = second_mode;
            first.Execute = true;
        }
        done += second.Done ? 1 : 0;
        aborted += first.CommandAborted || second.CommandAborted ? 1 : 0;
        failed += first.Error || second.Error ? 1 : 0;
        if (second.Done || second.CommandAborted || second.Error) first.Execute = second.Execute = false;
        error(ctx);
        place(ctx);
        group_error = error.GroupErrorID;
        x = place.Position[0];
        y = place.Position[1];
        state = status.GroupDisabled    ? 0
                : status.GroupStandby   ? 1
                : status.GroupMoving    ? 3
                : status.GroupStopping  ? 4
                : status.GroupErrorStop ? 5
                                        : 9;
    }
};
class DrawsInMachine : public Draws {
public:
    DrawsInMachine() { in_machine = true; }
};

std::shared_ptr<const axes::Kinematics> xyz() {
    return std::make_shared<const axes::Kinematics>(axes::Kinematics::make({.arm = axes::CartesianAxes{}}).value());
}

MachineConfig with_group(std::size_t axes, const ProgramEntry* (*entry)() = entry_of<Draws>,
                         std::shared_ptr<const axes::Kinematics> kinematics = {}) {
    auto config = with_program(axes, entry);
    axes::AxisGroupConfig group{.name = "table", .members = {}, .kinematics = kinematics};
    for (auto& binding : config.axes) {
        binding.axis.require_homed = false;
        group.members.push_back(binding.axis.name);
    }
    config.axis_groups.push_back(group);
    return config;
}

/// What must hold of the set-points in every cycle, whatever happens to the group, and the line that they have to be on.
struct GroupWatch {
    explicit GroupWatch(TestMachine& machine, std::size_t of) : m(machine), count(of), last(of) {
        const auto before = m.runner->after_cycle;
        m.runner->after_cycle = [this, before](Instant now) {
            if (before) before(now);
            look();
        };
    }
    void look() {
        if (m.machine->latest() == nullptr) return;  // before the first cycle
        std::vector<axes::MotionState> now;
        for (std::size_t i = 0; i < count; ++i) {
            const auto& view = m.axis(i);
            now.push_back({view.set_position, view.set_velocity, view.set_acceleration});
        }
        const double t = to_seconds(m.machine->config().cycle);
        for (std::size_t i = 0; i < count; ++i) {
            const auto& limits = m.machine->config().axes[i].axis.limits;
            const bool moves = m.axis(i).active_kind == axes::CommandKind::group_motion;
            if (moves && led) {
                worst_velocity = std::max(worst_velocity, std::abs(now[i].velocity) / limits.velocity);
                worst_jerk = std::max(worst_jerk, std::abs(now[i].acceleration - last[i].acceleration) / (limits.jerk * t));
                worst_gap =
                    std::max(worst_gap, std::abs(now[i].position - last[i].position - t * (now[i].velocity + last[i].velocity) / 2) /
                                            (limits.jerk * t * t * t));
            }
        }
        led = m.axis(0).active_kind == axes::CommandKind::group_motion;
        if (led) {
            ++cycles_led;
            const double s = now[0].position / 60;
            off = std::max(off, std::abs(now[1].position - 80 * s));
            if (count > 2) off = std::max(off, std::abs(now[2].position - 30 * s));
        }
        last = now;
    }
    void expect_clean() const {
        EXPECT_GT(cycles_led, 100u);
        EXPECT_LE(off, 1e-9 * 100) << "off the line";
        EXPECT_LE(worst_velocity, 1 + 1e-6);
        EXPECT_LE(worst_jerk, 1 + 1e-3);
        EXPECT_LE(worst_gap, 0.25 + 1e-3) << "position and velocity tell of two motions";
    }
    TestMachine& m;
    std::size_t count;
    std::vector<axes::MotionState> last;
    bool led = false;
    std::size_t cycles_led = 0;
    double off = 0, worst_velocity = 0, worst_jerk = 0, worst_gap = 0;
};

void draw(std::size_t count, const ProgramEntry* (*entry)(), const std::shared_ptr<const axes::Kinematics>& kinematics) {
    TestMachine m(with_group(count, entry, kinematics));
    GroupWatch watch(m, count);
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return variable(m, "done") >= 2; }, 60s)) << m.alarms();
    EXPECT_EQ(variable(m, "failed"), 0);
    EXPECT_EQ(m.alarms(), "");
    watch.expect_clean();
    m.expect_no_jump();
}

// G-033, G-036: two and three axes, over frames, there and back on one line.
TEST(AxisGroupMachine, TwoAxesDrawALine) { draw(2, entry_of<Draws>, nullptr); }
TEST(AxisGroupMachine, ThreeAxesDrawALine) { draw(3, entry_of<Draws>, nullptr); }
TEST(AxisGroupMachine, ThreeAxesDrawALineInMachineCoordinates) { draw(3, entry_of<DrawsInMachine>, xyz()); }

// G-063: the stop of a program stays on the path.
TEST(AxisGroupMachine, AStopOfTheProgramStaysOnTheLine) {
    TestMachine m(with_group(3));
    GroupWatch watch(m, 3);
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(1).set_velocity > 100; }, 20s));
    const auto& names = m.machine->layout().variables;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i].name == "stops") {
            EXPECT_EQ(m.command(OperatorAction::set_value, static_cast<std::uint16_t>(i), false, 1).answer, Answer::accepted);
        }
    ASSERT_TRUE(m.until([&] { return variable(m, "stopped") != 0; }, 3s));
    EXPECT_EQ(variable(m, "state"), 4);
    EXPECT_EQ(m.axis(0).set_velocity, 0);
    EXPECT_GE(variable(m, "aborted"), 1);
    watch.expect_clean();
    m.expect_no_jump();
}

// A person's stop of one member halts the whole group on its path.
TEST(AxisGroupMachine, APersonsStopOfOneAxisHaltsTheGroup) {
    TestMachine m(with_group(3));
    GroupWatch watch(m, 3);
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(1).set_velocity > 100; }, 20s));
    (void)m.machine->request_stop(2);
    m.run(300ms);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NE(m.axis(i).state, AxisState::ErrorStop) << i;
    EXPECT_GE(variable(m, "aborted"), 1);
    EXPECT_EQ(variable(m, "failed"), 0);
    watch.expect_clean();
    ASSERT_EQ(m.state().event_count, 1u) << "the one that ran; what waited ended with it";
    const auto& event = m.state().events[0];
    EXPECT_EQ(event.what, CommandEvent::What::aborted);
    EXPECT_EQ(event.group, 0);
    EXPECT_EQ(event.given.group_kind, axes::GroupCommandKind::linear_absolute);
    EXPECT_EQ(m.machine->layout().block_at(event.given.block), "p.first");
    EXPECT_EQ(event.by.owner, axes::Owner::operator_panel);
    EXPECT_EQ(event.by.group_kind, axes::GroupCommandKind::halt);
}

// So near the end of the way that it is over where it rests, and its program begins the next: that waits for the person.
TEST(AxisGroupMachine, WhatAPersonHasInterruptedNoNewCommandMoves) {
    TestMachine m(with_group(2));
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(1).set_velocity < -100; }, 20s)) << "on the way back, which nothing follows";
    ASSERT_TRUE(m.until([&] { return m.axis(1).set_velocity > -20; }, 20s)) << "it slows down for its end";
    EXPECT_EQ(m.command(OperatorAction::group_interrupt, 0).answer, Answer::accepted);
    EXPECT_FALSE(m.until([&] { return m.axis(1).set_velocity > 1; }, 3s));
    EXPECT_EQ(m.state().event_count, 0u);
    EXPECT_EQ(m.command(OperatorAction::group_continue, 0).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return m.axis(1).set_velocity > 20; }, 3s)) << "the program's next command";
}

// Who lets it go while it still brakes: nobody would go on with it where it stands. It stays his, and he is told to wait.
TEST(AxisGroupMachine, WhoContinuesWhileItBrakesHoldsItOn) {
    TestMachine m(with_group(2));
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(1).set_velocity > 100; }, 20s));
    EXPECT_EQ(m.command(OperatorAction::group_interrupt, 0).answer, Answer::accepted);
    const auto early = m.command(OperatorAction::group_continue, 0);
    EXPECT_EQ(early.answer, Answer::refused_by_axis);
    EXPECT_EQ(early.error, axes::ErrorId::state_forbids);
    ASSERT_TRUE(m.until([&] { return m.state().groups[0].interrupted; }, 3s));
    EXPECT_TRUE(m.state().groups[0].held);
    EXPECT_EQ(m.command(OperatorAction::group_continue, 0).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return m.axis(1).set_velocity > 100; }, 3s));
    m.expect_no_jump();
}

/// One motion behind the other, each when the one before is Done; and, told so, one of the first member alone.
class OneByOne : public Draws {
public:
    fb::MC_MoveRelative alone;
    AxisRef x_axis;
    bool alone_too = false;
    std::int64_t alone_error = 0;
    void declare(Declaration& d) override {
        group = d.axis_group("table");
        x_axis = d.axis("x");
        d.monitor("done", done);
        d.monitor("failed", failed);
        d.monitor("alone_error", alone_error);
        d.operator_switch("alone", alone_too);
        d.operator_switch("goes", goes);
        d.task<&OneByOne::scan>("main");
    }
    void scan(TaskContext& ctx) {
        for (auto* any : {&power.AxesGroup, &enable.AxesGroup, &first.AxesGroup, &status.AxesGroup}) *any = group;
        power.Enable = status.Enable = true;
        power(ctx);
        enable.Execute = power.Status;
        enable(ctx);
        status(ctx);
        alone.Axis = x_axis;
        alone.Distance = 1000;
        alone.Velocity = 50;
        alone.Execute = alone_too;
        alone(ctx);
        alone_error = static_cast<std::int64_t>(alone.ErrorID);
        first.Velocity = 200;
        if (status.GroupStandby && power.Status && goes) go();
        first(ctx);
        if (!first.Done && !first.Error) return;
        done += first.Done ? 1 : 0;
        failed += first.Error ? 1 : 0;
        first.Execute = false;
        first(ctx);
        if (goes) go();
        first(ctx);  // in the scan in which it is told
    }
    void go() {
        if (!first.Execute) first.Position.A.Axes = {done % 2 == 0 ? 60.0 : 0.0, done % 2 == 0 ? 80.0 : 0.0};
        first.Execute = true;
    }
};

void switch_to(TestMachine& m, std::string_view name, bool on) {
    const auto& names = m.machine->layout().variables;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i].name == name) (void)m.command(OperatorAction::set_value, static_cast<std::uint16_t>(i), false, on ? 1 : 0);
}

// At whichever cycle of its last ramp it is interrupted: what its program commands when the motion is Done, still while it brakes, is no error; it waits.
TEST(AxisGroupMachine, WhatFollowsWhereItBrakesForAPersonWaitsForHim) {
    for (const auto slow : {30.0, 20.0, 12.0, 6.0, 2.0}) {
        TestMachine m(with_group(2, entry_of<OneByOne>));
        ASSERT_TRUE(m.up());
        ASSERT_TRUE(m.until([&] { return m.axis(1).set_velocity > 100; }, 20s));
        ASSERT_TRUE(m.until([&] { return m.axis(1).set_velocity < slow; }, 20s));
        EXPECT_EQ(m.command(OperatorAction::group_interrupt, 0).answer, Answer::accepted);
        m.run(500ms);
        EXPECT_TRUE(m.state().groups[0].held) << slow;
        const double place = m.axis(1).set_position;
        m.run(300ms);
        EXPECT_EQ(m.axis(1).set_position, place) << slow;
        EXPECT_EQ(m.command(OperatorAction::group_continue, 0).answer, Answer::accepted);
        m.run(1500ms);
        EXPECT_GE(variable(m, "done"), 2) << slow;
        EXPECT_EQ(variable(m, "failed"), 0) << slow;
    }
}

// Nor does its program move one of its axes alone; what it moved so when a person interrupted the group comes to rest as by his stop.
TEST(AxisGroupMachine, AMemberOfWhatAPersonHoldsIsNotMovedAlone) {
    TestMachine m(with_group(2, entry_of<OneByOne>));
    ASSERT_TRUE(m.up());
    switch_to(m, "goes", false);
    ASSERT_TRUE(m.until(
        [&] { return m.state().groups[0].state == axes::GroupState::GroupStandby && m.axis(0).state == AxisState::Standstill; }, 20s));
    switch_to(m, "alone", true);
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity > 40; }, 3s));
    EXPECT_EQ(m.command(OperatorAction::group_interrupt, 0).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Standstill; }, 3s)) << "it was told that it comes to rest";
    EXPECT_TRUE(m.state().groups[0].held);

    const double place = m.axis(0).set_position;
    switch_to(m, "alone", false);
    m.run(20ms);
    switch_to(m, "alone", true);
    m.run(500ms);
    EXPECT_EQ(m.axis(0).set_position, place);
    EXPECT_EQ(variable(m, "alone_error"), static_cast<double>(axes::ErrorId::held_by_person));
    EXPECT_EQ(m.command(OperatorAction::group_continue, 0).answer, Answer::accepted);
    switch_to(m, "alone", false);
    m.run(20ms);
    switch_to(m, "alone", true);
    EXPECT_TRUE(m.until([&] { return m.axis(0).set_velocity > 40; }, 3s));
    m.expect_no_jump();
}

/// Its second command takes the first over.
class TakesOver : public Draws {
public:
    TakesOver() { second_mode = fb::mcAborting; }
};

// As of an axis: what another command of a program ends is told, with both; what a program stops itself is not.
TEST(AxisGroupMachine, WhatAnotherCommandEndsIsToldAndAnOwnStopIsNot) {
    TestMachine m(with_group(2, entry_of<TakesOver>));
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.state().event_count > 0; }, 10s));
    const auto& event = m.state().events[0];
    EXPECT_EQ(event.what, CommandEvent::What::aborted);
    EXPECT_EQ(event.given.group_kind, axes::GroupCommandKind::linear_absolute);
    EXPECT_EQ(event.by.group_kind, axes::GroupCommandKind::linear_relative);
    EXPECT_EQ(event.by.program, 0);
    EXPECT_EQ(event.error, axes::ErrorId::none);

    TestMachine stopped(with_group(2));
    ASSERT_TRUE(stopped.up());
    ASSERT_TRUE(stopped.until([&] { return stopped.axis(1).set_velocity > 100; }, 20s));
    const auto& names = stopped.machine->layout().variables;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i].name == "stops") (void)stopped.command(OperatorAction::set_value, static_cast<std::uint16_t>(i), false, 1);
    ASSERT_TRUE(stopped.until([&] { return variable(stopped, "stopped") != 0; }, 3s));
    EXPECT_GE(variable(stopped, "aborted"), 1);
    EXPECT_EQ(stopped.state().event_count, 0u);
}

// The program ends in the middle of a line: on the path to rest, then power goes.
TEST(AxisGroupMachine, TheEndOfTheProgramStopsOnTheLine) {
    TestMachine m(with_group(3));
    GroupWatch watch(m, 3);
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(1).set_velocity > 100; }, 20s));
    OperatorCommand end;
    end.action = OperatorAction::program_stop;
    end.index = 0;
    EXPECT_EQ(m.command(end).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Disabled; }, 3s));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(m.axis(i).state, AxisState::Disabled) << i;
    EXPECT_EQ(m.axis(0).set_velocity, 0);
    EXPECT_EQ(m.alarms(), "");
    watch.expect_clean();
    m.expect_no_jump();
}

// G-014: a member's drive loses its power in the middle of a line.
TEST(AxisGroupMachine, AMembersFaultEndsInGroupErrorStopAndTheOthersStayOnTheLine) {
    TestMachine m(with_group(3));
    ASSERT_TRUE(m.up());
    double worst = 0;
    bool led = false;
    m.runner->after_cycle = [&, before = m.runner->after_cycle](Instant now) {
        before(now);
        led = m.axis(0).active_kind == axes::CommandKind::group_motion;
        if (led) worst = std::max(worst, std::abs(m.axis(1).set_position * 60 - m.axis(0).set_position * 80) / 100);
    };
    ASSERT_TRUE(m.until([&] { return m.axis(1).set_velocity > 100; }, 20s));
    m.world.drive("z")->raise(0x2310);
    ASSERT_TRUE(m.until([&] { return variable(m, "state") == 5; }, 200ms));
    EXPECT_EQ(m.axis(2).state, AxisState::ErrorStop);
    EXPECT_TRUE(led) << "x and y are still led";
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Standstill && m.axis(1).state == AxisState::Standstill; }, 3s));
    EXPECT_LE(worst, 1e-9 * 100);
    EXPECT_EQ(variable(m, "group_error"), m.axis(2).error);
    EXPECT_GE(variable(m, "failed"), 1);
    EXPECT_EQ(variable(m, "aborted"), 0);
    m.expect_no_jump();
}

// What the machine lacks is said before anything runs, with the code of its cause.
TEST(AxisGroupMachine, AGroupThatIsNotThereIsAnError) {
    const auto codes = [](const MachineConfig& config) {
        World world(config, Instant{} + 1s);
        auto built = Machine::build(config, world.bus(), world.serial().lines(), world.modbus().exchanges());
        std::string all;
        if (const auto* errors = std::get_if<1>(&built))
            for (const auto& error : *errors) all += error.code + " ";
        return all;
    };
    auto config = with_group(2);
    EXPECT_EQ(codes(config), "");
    config.axis_groups[0].name = "tabel";
    EXPECT_NE(codes(config).find("program.unknown_axis_group"), std::string::npos) << codes(config);
    config.axis_groups[0].members.push_back("q");
    EXPECT_NE(codes(config).find("group.unknown_axis"), std::string::npos) << codes(config);
}

// What a program's group refuses is told once, with the block and the place; what it refuses again meanwhile is counted. Its first move leads through the
// room at x = 30: after half of its way.
TEST(AxisGroupMachine, ARefusedCommandIsAnEventWithItsPlace) {
    auto config = with_group(3, entry_of<DrawsInMachine>, xyz());
    axes::Workspace space;
    space.rooms.push_back({.name = "post", .shape = axes::WorkspaceRoom::Shape::box, .kept_free = true, .half = {5, 100, 100}});
    space.rooms[0].middle.position = {35, 0, 0};
    config.axis_groups[0].workspace = std::make_shared<const axes::Workspace>(space);
    TestMachine m{std::move(config)};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.state().event_count > 0; }, 5s)) << m.alarms();
    m.run(1s);
    const auto& s = m.state();
    std::vector<CommandEvent> of_group;
    for (std::size_t i = 0; i < s.event_count; ++i)
        if (s.events[i].group == 0) of_group.push_back(s.events[i]);
    ASSERT_FALSE(of_group.empty());
    const auto& event = of_group.front();
    EXPECT_EQ(event.what, CommandEvent::What::refused);
    EXPECT_EQ(event.error, axes::ErrorId::outside_workspace);
    EXPECT_EQ(event.given.group_kind, axes::GroupCommandKind::linear_absolute);
    EXPECT_EQ(event.given.program, 0);
    EXPECT_EQ(m.machine->layout().block_at(event.given.block), "p.first");
    EXPECT_EQ(event.place.at.room, 0);
    EXPECT_NEAR(event.place.at.part, 0.5, 1e-6);
    EXPECT_NEAR(event.place.at.point[0], 30, 1e-6);
    EXPECT_NEAR(event.place.at.point[1], 40, 1e-6);
    ASSERT_EQ(m.machine->layout().groups[0].rooms.size(), 1u);
    EXPECT_EQ(m.machine->layout().groups[0].rooms[0].name, "post");
    EXPECT_EQ(s.groups[0].refusal.why.error, axes::ErrorId::outside_workspace);
    std::size_t first_moves = 0;
    for (const auto& one : of_group) first_moves += one.given.group_kind == axes::GroupCommandKind::linear_absolute ? 1u : 0u;
    EXPECT_EQ(first_moves, 1u) << "again and again, told once";
}

// Of a command that ends because a drive failed the alarm is told, and which command that was.
TEST(AxisGroupMachine, WhatEndsWithTheGroupIsToldAsEnded) {
    TestMachine m{with_group(2)};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.state().groups[0].active != 0 && m.axis(0).set_velocity > 20; }, 5s));
    EXPECT_EQ(m.state().event_count, 0u);
    m.world.drive("x")->raise(0x2310);
    m.run(500ms);
    const auto& s = m.state();
    ASSERT_GE(s.event_count, 1u);
    const auto found = std::find_if(s.events.begin(), s.events.begin() + static_cast<std::ptrdiff_t>(s.event_count),
                                    [](const auto& e) { return e.group == 0 && e.what == CommandEvent::What::aborted; });
    ASSERT_NE(found, s.events.begin() + static_cast<std::ptrdiff_t>(s.event_count));
    EXPECT_EQ(found->axis_error, axes::id(axes::AxisAlarm::drive_fault));
    EXPECT_EQ(found->error_axis, 0) << "x";
}

}  // namespace
}  // namespace taktwerk::runtime
