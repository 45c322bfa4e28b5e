// Tables that a program declares: taken into the machine's tables, and checked before the machine starts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "runtime/tasks/program_host.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// What the machine makes of a program's declarations.
template <class P>
struct Declared {
    explicit Declared(std::vector<CamConfig> cams = {}) {
        config.cams = std::move(cams);
        ProgramConfig program;
        program.name = "cell";
        program.entry = &entry_of<P>;
        config.programs.push_back(program);
        host.emplace(config, io, tables, errors);
        self = static_cast<P*>(host->programs().at(0).instance.get());
    }
    MachineConfig config;
    IoImage io{{}, {}};
    axes::MotionTables tables;
    std::vector<Error> errors;
    std::optional<ProgramHost> host;
    P* self = nullptr;
};

struct Good final : Program {
    axes::CamRef cam, later;
    axes::TimeTableRef times;
    axes::CamSwitchRef switches;
    axes::TrackRef tracks;
    void declare(Declaration& d) override {
        cam = d.cam("flap", std::array{axes::CamPoint{0, 0}, axes::CamPoint{10, 5}}, 8);
        later = d.cam("filled later", {}, 16);
        times = d.time_table("lift", std::array{axes::TimePoint{0ms, 0}, axes::TimePoint{10ms, 3}});
        switches = d.cam_switches("knives", std::array{axes::CamSwitch{.track = 2, .first = 1, .last = 2}});
        tracks = d.tracks("valves", std::array{axes::TrackOptions{}, axes::TrackOptions{.hysteresis = 0.5}});
    }
    void scan(TaskContext&) {}
};

TEST(DeclaredTables, AreInTheMachinesTablesWithTheirRoom) {
    Declared<Good> machine;
    ASSERT_TRUE(machine.errors.empty()) << machine.errors[0].text();

    const auto* cam = machine.tables.cam(machine.self->cam);
    ASSERT_NE(cam, nullptr);
    EXPECT_EQ(cam->rows().size(), 2u);
    EXPECT_EQ(cam->points.size(), 8u);
    EXPECT_EQ(machine.tables.cam(machine.self->later)->used, 0u);
    EXPECT_EQ(machine.tables.cam(machine.self->later)->points.size(), 16u);
    EXPECT_EQ(machine.tables.time_table(machine.self->times)->rows()[1].value, 3);
    EXPECT_EQ(machine.tables.cam_switches(machine.self->switches)[0].track, 2);
    EXPECT_EQ(machine.tables.track_options(machine.self->tracks)[1].hysteresis, 0.5);
}

struct Bad final : Program {
    void declare(Declaration& d) override {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        d.cam("alone", std::array{axes::CamPoint{0, 0}});
        d.cam("back", std::array{axes::CamPoint{0, 0}, axes::CamPoint{5, 1}, axes::CamPoint{5, 2}});
        d.cam("turn",
              std::array{axes::CamPoint{.master = 0, .slave = 0, .segment = axes::CamSegment::harmonic_combination}, axes::CamPoint{5, 1}});
        d.cam("nan", std::array{axes::CamPoint{0, 0}, axes::CamPoint{5, nan}});
        d.time_table("still", std::array{axes::TimePoint{10ms, 0}, axes::TimePoint{0ms, 3}});
        d.cam_switches("track", std::array{axes::CamSwitch{.track = 33}});
        d.cam_switches("time", std::array{axes::CamSwitch{.mode = axes::CamSwitchMode::time}});
        d.tracks("many", std::vector<axes::TrackOptions>(33));
        d.tracks("hysteresis", std::array{axes::TrackOptions{.hysteresis = -1}});
    }
    void scan(TaskContext&) {}
};

TEST(DeclaredTables, EveryUnusableOneIsNamedWithTheReason) {
    Declared<Bad> machine;
    std::vector<std::string> texts;
    for (const auto& error : machine.errors) {
        EXPECT_EQ(error.code, "program.table");
        texts.push_back(error.text());
    }
    EXPECT_THAT(texts,
                ElementsAre(HasSubstr("cam 'alone' cannot be used: it has one point"),
                            HasSubstr("cam 'back' cannot be used: point 3: the master's position 5 is not beyond 5"),
                            HasSubstr("cam 'turn' cannot be used: point 1: its law cannot"), HasSubstr("cam 'nan' cannot be used: point 2"),
                            HasSubstr("time table 'still' cannot be used: row 2"),
                            HasSubstr("'track' cannot be used: switch 1 is on track 33"), HasSubstr("'time' cannot be used: switch 1"),
                            HasSubstr("'many' cannot be used: it has 33 tracks"), HasSubstr("'hysteresis' cannot be used: track 1")));
}

struct FromTheFile final : Program {
    axes::CamRef flap, again, wrong;
    void declare(Declaration& d) override {
        flap = d.cam("flap");
        again = d.cam("flap");
        wrong = d.cam("flop");
    }
    void scan(TaskContext&) {}
};

// Who changes the points of one changes nobody else's.
TEST(DeclaredTables, MayStandInTheMachineFile) {
    Declared<FromTheFile> machine{{{.name = "flap", .points = {{.master = 0, .slave = 0}, {.master = 5, .slave = 2}}}}};
    ASSERT_EQ(machine.errors.size(), 1u);
    EXPECT_EQ(machine.errors[0].code, "program.unknown_cam");
    EXPECT_THAT(machine.errors[0].text(), HasSubstr("did you mean 'flap'?"));

    machine.tables.cam(machine.self->flap)->points[1].slave = 9;
    ASSERT_EQ(machine.tables.cam(machine.self->again)->used, 2u);
    EXPECT_EQ(machine.tables.cam(machine.self->again)->points[1].slave, 2);
    EXPECT_EQ(machine.tables.cam(machine.self->wrong), nullptr);
}

struct References final : Program {
    axes::InputRef input;
    axes::OutputRef drive;
    axes::TriggerRef trigger;
    void declare(Declaration& d) override {
        input = d.input_ref("buttons");
        drive = d.drive_outputs("x");
        trigger = d.trigger_input("buttons", 3);
    }
    void scan(TaskContext&) {}
};

TEST(DeclaredReferences, OfNamesThatTheMachineLacksAreErrors) {
    Declared<References> machine;
    ASSERT_EQ(machine.errors.size(), 3u);
    EXPECT_EQ(machine.errors[0].code, "program.unknown_input");
    EXPECT_EQ(machine.errors[1].code, "program.unknown_axis");
    EXPECT_EQ(machine.errors[2].code, "program.unknown_input");
    EXPECT_EQ(machine.self->input, axes::InputRef{});
    EXPECT_EQ(machine.self->trigger.source, axes::TriggerSource::input);
    EXPECT_EQ(machine.self->trigger.bit, 3);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
