// The command as a user or a script meets it: exit codes, messages, and one short run in real time.

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/plot/trace_file.hpp"
#include "apps/terminal/exit_code.hpp"
#include "axes/words/types.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string machines = std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/";

class CommandLine : public ::testing::Test {
protected:
    CommandLine() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~CommandLine() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    std::string file(const std::string& name, const std::string& text) const {
        std::ofstream(path(name)) << text;
        return path(name);
    }
    static std::string text_of(const std::string& name) {
        std::ifstream in(name, std::ios::binary);
        std::ostringstream out;
        out << in.rdbuf();
        return out.str();
    }

    struct Outcome {
        int code;
        std::string text;
    };
    static Outcome command(std::vector<std::string> arguments, std::chrono::milliseconds patience = 20s) {
        arguments.insert(arguments.begin(), taktwerk);
        Child child(arguments);
        const int code = child.wait(patience);
        return {code, child.text()};
    }
    /// minimal.yaml with its own socket and without LCM: several tests may run at once.
    std::string private_machine(const std::string& more = "") const {
        auto text = text_of(machines + "minimal.yaml");
        text += "hmi: { socket: '" + path("socket") + "', lcm: { enabled: false } }\n" + more;
        std::filesystem::create_directories(folder_ + "/machines");
        std::filesystem::create_directory_symlink(std::filesystem::path(machines) / ".." / "drives", folder_ + "/drives");
        return file("machines/minimal.yaml", text);
    }
    Outcome to_machine(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"-s", path("socket")});
        return command(std::move(arguments));
    }

    std::string folder_;
};

TEST_F(CommandLine, WrongArgumentsAreUsageErrors) {
    EXPECT_EQ(command({}).code, exit_usage);
    EXPECT_EQ(command({"fly"}).code, exit_usage);
    EXPECT_EQ(command({"run", machines + "minimal.yaml", "--fast"}).code, exit_usage);
    EXPECT_EQ(command({"mode", "sleepy"}).code, exit_usage);
    EXPECT_EQ(command({"docs", "novels"}).code, exit_usage);
    EXPECT_EQ(command({"--help"}).code, exit_ok);
}

TEST_F(CommandLine, BadFilesEndWithAllTheirProblems) {
    const auto missing = command({"run", "/nowhere/machine.yaml"});
    EXPECT_EQ(missing.code, exit_bad_file);
    EXPECT_THAT(missing.text, HasSubstr("/nowhere/machine.yaml"));

    const auto bad = command({"check", file("bad.yaml", "version: 1\nname: bad\ncycle: 1 mm\nbsu: {}\n")});
    EXPECT_EQ(bad.code, exit_bad_file);
    EXPECT_THAT(bad.text, AllOf(HasSubstr("bad.yaml:3:"), HasSubstr("bad.yaml:4:")));

    EXPECT_EQ(command({"plot", "/nowhere/trace.csv"}).code, exit_bad_file);
    EXPECT_EQ(command({"plot", file("no_trace.csv", "a,b\n1,2\n")}).code, exit_bad_file);
}

// Nobody wants to mend a file twice. What follows from what was said already is not said: the names of a section that has errors.
TEST_F(CommandLine, CheckTellsTheErrorsOfTheFileAndOfItsProgramsAtOnce) {
    const std::string axis =
        "    slave: d\n    unit: mm\n    gearing: { counts_per_revolution: 131072, feed: 10 mm }\n"
        "    limits: { velocity: 300 mm/s, acceleration: 2000 mm/s2, jerk: none }\n    homing: { kind: set_here }\n";
    const auto machine = [&](const std::string& cycle, const std::string& name, const std::string& unit) {
        std::filesystem::create_directories(folder_ + "/machines");
        if (!std::filesystem::exists(folder_ + "/drives"))
            std::filesystem::create_directory_symlink(std::filesystem::path(machines) / ".." / "drives", folder_ + "/drives");
        auto wanted = axis;
        wanted.replace(wanted.find("300 mm/s"), 8, "300 " + unit);
        return file("machines/m.yaml", "version: 1\nname: m\ncycle: " + cycle +
                                           "\nbus: { interface: simulated, slaves: [{ name: d, profile: sv33-e }] }\naxes:\n  " + name +
                                           ":\n" + wanted + "programs:\n  p: { library: minimal.so, parameters: { speed: 3 } }\n");
    };
    const auto unknown_parameter = HasSubstr("there is no parameter 'speed'"), unknown_axis = HasSubstr("there is no axis 'x'");
    const auto both = command({"check", machine("1 mm", "y", "mm/s")});
    EXPECT_EQ(both.code, exit_bad_file);
    EXPECT_THAT(both.text, AllOf(HasSubstr("m.yaml:3:"), unknown_parameter, unknown_axis));
    const auto broken_axes = command({"check", machine("1 ms", "y", "bananas")});
    EXPECT_EQ(broken_axes.code, exit_bad_file);
    EXPECT_THAT(broken_axes.text, AllOf(HasSubstr("m.yaml:10:"), unknown_parameter, Not(unknown_axis)));
    const auto programs_alone = command({"check", machine("1 ms", "y", "mm/s")});
    EXPECT_EQ(programs_alone.code, exit_bad_file);
    EXPECT_THAT(programs_alone.text, AllOf(unknown_parameter, unknown_axis));
}

// Without a slave no frame comes back, and nobody shall look for a cable that a simulated bus does not have.
TEST_F(CommandLine, VirtualAxesAloneNeedASlave) {
    const auto machine = [&](const std::string& slaves) {
        std::filesystem::create_directories(folder_ + "/machines");
        if (!std::filesystem::exists(folder_ + "/devices"))
            std::filesystem::create_directory_symlink(std::filesystem::path(machines) / ".." / "devices", folder_ + "/devices");
        return file("machines/v.yaml", "version: 1\nname: v\ncycle: 1 ms\nbus: { interface: simulated, slaves: [" + slaves +
                                           "] }\naxes:\n  x: { unit: mm, gearing: { counts_per_revolution: 1000, feed: 10 mm }, "
                                           "limits: { velocity: 100 mm/s, acceleration: 1000 mm/s2, jerk: none } }\n");
    };
    const auto run = [&](const std::string& slaves) { return command({"run", machine(slaves), "--virtual-time", "--duration", "1s"}); };
    const auto says = AllOf(HasSubstr("a bus without a slave sends no frame back"), HasSubstr("{ name: coupler, device: ek1100 }"));
    const auto checked = command({"check", machine("")});
    EXPECT_EQ(checked.code, exit_ok) << checked.text;
    EXPECT_THAT(checked.text, AllOf(says, HasSubstr("1 remark to look at"))) << checked.text;
    const auto alone = run("");
    EXPECT_EQ(alone.code, exit_bad_file);
    EXPECT_THAT(alone.text, AllOf(says, Not(HasSubstr("cable"))));
    const auto with_coupler = run("{ name: coupler, device: ek1100 }");
    EXPECT_EQ(with_coupler.code, exit_ok) << with_coupler.text;
    EXPECT_THAT(with_coupler.text, HasSubstr("0 frames lost"));
}

TEST_F(CommandLine, CheckSaysWhatADriveDoesWhenTheMasterIsGone) {
    const auto checked = command({"check", machines + "demo.yaml"});
    EXPECT_EQ(checked.code, exit_ok) << checked.text;
    EXPECT_THAT(checked.text,
                AllOf(HasSubstr("if the master is gone"), HasSubstr("605Ah"), HasSubstr("Assumed about sv33-e"), HasSubstr("speed")));
}

// A shipped file with something of it exchanged, where its drives and devices are.
TEST_F(CommandLine, CheckSaysWhatHoldsInOneDirectionAndHowLongAnAnalogAxisRunsOn) {
    std::filesystem::create_directories(folder_ + "/machines");
    for (const char* kind : {"/drives", "/devices"})
        std::filesystem::create_directory_symlink(std::filesystem::path(machines) / ".." / (kind + 1), folder_ + kind);
    const auto check_of = [&](const std::string& name, const std::string& from, const std::string& to) {
        auto text = text_of(machines + name);
        text.replace(text.find(from), from.size(), to);
        return command({"check", file("machines/" + name, text)});
    };
    const auto belt = check_of("measuring-wheel.yaml", "jerk: 5000 mm/s3 }",
                               "jerk: 5000 mm/s3, positive: { velocity: 250 mm/s, torque: 0.5 }, negative: { deceleration: 300 mm/s2 } }");
    EXPECT_EQ(belt.code, exit_ok) << belt.text;
    EXPECT_THAT(belt.text, AllOf(HasSubstr("in positive direction at most: velocity 250 mm/s, torque 0.5 of the rated one\n"),
                                 HasSubstr("in negative direction at most: deceleration 300 mm/s2\n")));
    EXPECT_THAT(belt.text, HasSubstr("Assumed about sv33-e (axis belt), because"));
    const auto plain = command({"check", machines + "measuring-wheel.yaml"});
    EXPECT_THAT(plain.text, Not(HasSubstr("direction at most")));
    // The object of a drive that moves nothing here: what its manual leaves open concerns nobody.
    const auto watched = check_of("measuring-wheel.yaml", "    following_error: { window: 5 mm }", "    encoder: true");
    EXPECT_EQ(watched.code, exit_ok) << watched.text;
    EXPECT_THAT(watched.text, Not(HasSubstr("Assumed about")));
    const auto analog = check_of("analog-axis.yaml", "device: el4032 }", "device: el4032, sm_watchdog: 5 s }");
    EXPECT_EQ(analog.code, exit_ok) << analog.text;
    EXPECT_THAT(analog.text, AllOf(HasSubstr("when the master is gone, 'volts' keeps it for 5000 ms: at full velocity 2000 mm"),
                                   HasSubstr("take the set-point ('volts') away after 5000 ms and the enable ('do') after 10 ms")));
}

TEST_F(CommandLine, TwoRunsInVirtualTimeWriteTheSameBytes) {
    for (const char* name : {"one.csv", "two.csv"}) {
        const auto run = command({"run", machines + "demo.yaml", "--virtual-time", "--duration", "6s", "--trace", path(name)});
        ASSERT_EQ(run.code, exit_ok) << run.text;
    }
    const auto trace = text_of(path("one.csv"));
    EXPECT_GT(trace.size(), 100000u);
    EXPECT_TRUE(trace == text_of(path("two.csv")));
}

TEST_F(CommandLine, FiveKindsOfDriveAndASerialLineRunAlikeToo) {
    for (const char* name : {"one.csv", "two.csv"}) {
        const auto run = command(
            {"run", machines + "five-drives.yaml", "--simulate", "--virtual-time", "--duration", "30s", "--trace", path(name)}, 60s);
        ASSERT_EQ(run.code, exit_ok) << run.text;
    }
    const auto trace = text_of(path("one.csv"));
    EXPECT_GT(trace.size(), 1'000'000u);
    EXPECT_TRUE(trace == text_of(path("two.csv")));
}

TEST_F(CommandLine, WithoutARunningMachineCommandsSaySo) {
    for (const auto& arguments :
         {std::vector<std::string>{"monitor", "--once"}, {"enable", "x"}, {"jog", "x", "--velocity", "-5"}, {"reset"}}) {
        const auto answer = to_machine(arguments);
        EXPECT_EQ(answer.code, exit_no_runtime) << answer.text;
    }
    EXPECT_THAT(to_machine({"reset", "--json"}).text, HasSubstr(R"("ok":false)"));
}

TEST_F(CommandLine, AMissingNetworkInterfaceIsABusError) {
    auto text = text_of(private_machine());
    const std::string simulated = "interface: simulated";
    text.replace(text.find(simulated), simulated.size(), "interface: nonic7");
    const auto run = command({"run", file("machines/nic.yaml", text), "--duration", "1s"});
    EXPECT_EQ(run.code, exit_bus) << run.text;
    EXPECT_THAT(run.text, HasSubstr("nonic7"));
    EXPECT_EQ(command({"sim", machines + "minimal.yaml", "--nic", "nonic7"}).code, exit_bus);
}

// The one run in real time: commands over the socket, then SIGTERM in the middle of a motion. A host that stalls for some tens of
// milliseconds may delay the motion, but not stop it.
TEST_F(CommandLine, ARunningMachineIsOperatedAndEndsAlongItsRamp) {
    const auto relaxed = file("machines/relaxed.yaml", text_of(private_machine()) + "simulation: { supervision: relaxed }\n");
    Child runtime({taktwerk, "run", relaxed, "--trace", path("real.csv")});
    ASSERT_TRUE(runtime.says("running, manual mode", 20s)) << runtime.text();

    const auto refused = to_machine({"jog", "x", "--velocity", "5", "--for", "100ms"});
    EXPECT_EQ(refused.code, exit_refused) << refused.text;
    EXPECT_THAT(refused.text, HasSubstr("x"));
    EXPECT_EQ(to_machine({"enable", "w"}).code, exit_refused);
    EXPECT_EQ(to_machine({"start"}).code, exit_refused);

    ASSERT_EQ(to_machine({"enable", "x", "--wait"}).code, exit_ok);
    const auto homed = to_machine({"home", "x", "--wait"});
    ASSERT_EQ(homed.code, exit_ok) << homed.text;
    const auto jogged = to_machine({"jog", "x", "--velocity", "-20", "--for", "400ms"});
    EXPECT_EQ(jogged.code, exit_ok) << jogged.text;
    EXPECT_THAT(jogged.text, HasSubstr("stands at -"));
    EXPECT_THAT(to_machine({"monitor", "--once"}).text, AllOf(HasSubstr("SIMULATED"), HasSubstr("Standstill")));

    ASSERT_EQ(to_machine({"move", "x", "1000", "--velocity", "50"}).code, exit_ok);
    std::filesystem::path trace = path("real.csv");
    ::poll(nullptr, 0, 500);  // well into the motion
    runtime.signal(SIGTERM);
    EXPECT_EQ(runtime.wait(5s), exit_ok) << runtime.text();

    const auto recorded = read_trace(trace.string());
    ASSERT_TRUE(recorded) << recorded.error().text();
    const auto& x = recorded->axes.at(0);
    EXPECT_EQ(x.state.back(), static_cast<double>(axes::AxisState::Disabled));
    EXPECT_EQ(x.set_velocity.back(), 0);
    // minimal.yaml: 2000 mm/s2. At 50 mm/s the ramp takes 25 ms and a little for the jerk: nothing jumps between two cycles.
    double fastest = 0;
    for (std::size_t i = 1; i < x.set_position.size(); ++i) {
        EXPECT_LE(std::abs(x.set_velocity[i] - x.set_velocity[i - 1]), 2000 * 1e-3 * 1.001) << "row " << i;
        fastest = std::max(fastest, x.set_velocity[i]);
    }
    EXPECT_NEAR(fastest, 50, 0.5);
}

// Switched off in motion it stops first, for half a second here, and keeps its power so long.
TEST_F(CommandLine, WhoWaitsUntilAnAxisIsEnabledMayMoveIt) {
    auto text = text_of(private_machine()) + "simulation: { supervision: relaxed }\n";
    const std::string steep = "2000 mm/s2";
    text.replace(text.find(steep), steep.size(), "100 mm/s2");
    Child runtime({taktwerk, "run", file("machines/gentle.yaml", text)});
    ASSERT_TRUE(runtime.says("running, manual mode", 20s)) << runtime.text();
    ASSERT_EQ(to_machine({"enable", "x", "--wait"}).code, exit_ok);
    ASSERT_EQ(to_machine({"home", "x", "--wait"}).code, exit_ok);
    ASSERT_EQ(to_machine({"move", "x", "1000", "--velocity", "50"}).code, exit_ok);
    ::poll(nullptr, 0, 600);
    ASSERT_EQ(to_machine({"disable", "x"}).code, exit_ok);
    ASSERT_EQ(to_machine({"enable", "x", "--wait"}).code, exit_ok);
    const auto jogged = to_machine({"jog", "x", "--velocity", "5", "--for", "100ms"});
    EXPECT_EQ(jogged.code, exit_ok) << jogged.text;
}

// E.017 of the SV33-E (manual 5.4) needs a power cycle, which the axis knows at once: nobody waits for half a minute to hear less.
TEST_F(CommandLine, AResetThatIsInVainSaysWhyAtOnce) {
    Child runtime({taktwerk, "run", file("machines/relaxed.yaml", text_of(private_machine()) + "simulation: { supervision: relaxed }\n"),
                   "--simulate"});
    ASSERT_TRUE(runtime.says("running, manual mode", 20s)) << runtime.text();
    ASSERT_EQ(to_machine({"enable", "x", "--wait"}).code, exit_ok);
    ASSERT_EQ(to_machine({"simulate", "drive-fault", "x", "0x5530"}).code, exit_ok);
    ::poll(nullptr, 0, 300);
    const auto answer = to_machine({"reset", "x", "--wait", "--timeout", "20s"});
    EXPECT_NE(answer.code, exit_ok);
    EXPECT_THAT(answer.text, AllOf(HasSubstr("E.017"), HasSubstr("switch off and on")));
}

// A frozen runtime (a debugger, a stopped container) finds all that was asked of it meanwhile when it goes on: too late.
TEST_F(CommandLine, WhatWasAskedOfAFrozenRuntimeIsNotDoneWhenItGoesOn) {
    Child runtime({taktwerk, "run", file("machines/relaxed.yaml", text_of(private_machine()) + "simulation: { supervision: relaxed }\n"),
                   "--simulate"});
    ASSERT_TRUE(runtime.says("running, manual mode", 20s)) << runtime.text();
    const auto faulted = [&] {
        ::poll(nullptr, 0, 300);
        const auto alarms = to_machine({"alarms"});
        EXPECT_EQ(alarms.code, exit_ok) << alarms.text;
        return alarms.text.find("E.017") != std::string::npos;
    };
    runtime.signal(SIGSTOP);
    const auto asked = to_machine({"simulate", "drive-fault", "x", "0x5530"});
    EXPECT_EQ(asked.code, exit_no_runtime) << asked.text;
    EXPECT_THAT(asked.text, HasSubstr("did not answer in time"));
    runtime.signal(SIGCONT);
    EXPECT_FALSE(faulted());
    EXPECT_EQ(to_machine({"simulate", "drive-fault", "x", "0x5530"}).code, exit_ok) << "the control";
    EXPECT_TRUE(faulted());
}

TEST_F(CommandLine, ShutDownOnCommandIsAGoodEnd) {
    Child runtime({taktwerk, "run", private_machine()});
    ASSERT_TRUE(runtime.says("running, manual mode", 20s)) << runtime.text();
    EXPECT_EQ(to_machine({"shutdown"}).code, exit_ok);
    EXPECT_EQ(runtime.wait(5s), exit_ok) << runtime.text();
}

TEST_F(CommandLine, PlotNamesThePackageItMisses) {
    const auto trace = file(
        "t.csv",
        "time_s,emergency_stop,x.state,x.set_position,x.set_velocity,x.set_acceleration,x.set_jerk,x.actual_position,x.actual_velocity,"
        "x.following_error\n1,0,1,7,2,3,4,7,1,0\n2,0,1,8,2,3,4,7,1,0\n");
    Child plot({"env", "PATH=" + folder_, taktwerk, "plot", trace});
    EXPECT_EQ(plot.wait(10s), exit_bad_file);
    EXPECT_THAT(plot.text(), HasSubstr("apt-get install gnuplot-nox"));
    EXPECT_FALSE(std::filesystem::exists(path("t.svg")));
}

// gnuplot carries out what stands in backticks of its double-quoted strings: the control shows that it would here, too.
TEST_F(CommandLine, APlotCarriesOutNothingThatStandsInATrace) {
    Child control({"gnuplot", "-e", "x = \"`touch " + path("control") + "`\""});
    ASSERT_EQ(control.wait(10s), 0) << control.text();
    ASSERT_TRUE(std::filesystem::exists(path("control")));

    const auto attack = [&](const char* name) { return "`touch " + path(name) + "`"; };
    const auto trace =
        file("|t.csv", "time_s,emergency_stop,x" + attack("axis") + ".state,x" + attack("axis") + ".set_position[" + attack("unit") +
                           "'],x" + attack("axis") + ".set_velocity,x" + attack("axis") + ".set_acceleration,x" + attack("axis") +
                           ".set_jerk,x" + attack("axis") + ".actual_position,x" + attack("axis") + ".actual_velocity,x" + attack("axis") +
                           ".following_error," + attack("bit") + "\n1,0,1,7,2,3,4,7,1,0,0\n2,0,1,8,2,3,4,7,1,0,1\n");
    Child plot({taktwerk, "plot", trace, "--title", attack("title")});
    EXPECT_EQ(plot.wait(20s), exit_ok) << plot.text();
    EXPECT_TRUE(std::filesystem::exists(path("|t.svg"))) << "it is drawn all the same";
    for (const char* name : {"axis", "unit", "bit", "title"}) EXPECT_FALSE(std::filesystem::exists(path(name))) << name;
}

TEST_F(CommandLine, SigtermIsHeardBeforeTheBusIsUp) {
    Child runtime({taktwerk, "run", private_machine()});
    ASSERT_TRUE(runtime.says("bus", 10s)) << runtime.text();
    runtime.signal(SIGTERM);
    EXPECT_EQ(runtime.wait(5s), exit_ok) << runtime.text();
}

// For a monitoring, which reads one key whatever is the matter.
TEST_F(CommandLine, StatusOfAMachineThatDoesNotRunIsNotWell) {
    const auto status = command({"status", "--json", "-s", path("nobody")});
    EXPECT_EQ(status.code, exit_no_runtime);
    const auto told = nlohmann::json::parse(status.text, nullptr, false);
    ASSERT_TRUE(told.is_object()) << status.text;
    EXPECT_EQ(told["well"], false);
    EXPECT_EQ(told["unwell"].size(), 1u);
    EXPECT_EQ(told["error"]["code"], "socket.no_runtime");
}

TEST_F(CommandLine, DoctorTakesTheTimesThatItsOwnWordsName) {
    EXPECT_THAT(command({"doctor", "--no-measuring", "--cycle", "500us", "--computing", "200us"}).text, HasSubstr("for a cycle of 500 us"));
    const auto refused = command({"doctor", "--no-measuring", "--cycle", "0us"});
    EXPECT_EQ(refused.code, exit_usage);
}

// What a script reads is one JSON object, whatever was asked for and whether it could be done.
TEST_F(CommandLine, DoctorsJsonIsOneObjectAlsoWhereNothingMayBeDone) {
    for (const auto& words :
         {std::vector<std::string>{"--cycle", "5s"}, {"--cpu", "1000"}, {"--no-measuring"}, {"--no-measuring", "--nic", "none0"}}) {
        std::vector<std::string> all{"doctor", "--json"};
        all.insert(all.end(), words.begin(), words.end());
        const auto doctor = command(all);
        EXPECT_TRUE(nlohmann::json::parse(doctor.text, nullptr, false).is_object()) << doctor.text;
    }
}

TEST_F(CommandLine, DiagOfAFileThatIsNoneSaysSoAndWritesNothing) {
    for (const auto& wrong : {path("none.yaml"), folder_}) {
        const auto diag = command({"diag", wrong, "-o", path("x.tar")});
        EXPECT_EQ(diag.code, exit_bad_file) << diag.text;
        EXPECT_THAT(diag.text, HasSubstr(wrong));
        EXPECT_FALSE(std::filesystem::exists(path("x.tar")));
    }
}

}  // namespace
}  // namespace taktwerk::apps
