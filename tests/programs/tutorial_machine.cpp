// docs/programming.md is true: its project is cut out of the page, built against an installed SDK, and run in virtual time.

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/machine_file/machine_loader.hpp"
#include "runtime/run/virtual_runner.hpp"
#include "runtime/world/world.hpp"
#include "tests/programs/installed_sdk.hpp"

namespace taktwerk::runtime {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using taktwerk::testing::text_of;

std::string page() { return text_of(fs::path(TAKTWERK_SOURCE_DIR) / "docs/programming.md"); }

/// The fenced block whose first line begins with `start`.
std::string block(const std::string& start) {
    const auto text = page();
    const auto begin = text.find("\n" + start);
    if (begin == std::string::npos) return {};
    return text.substr(begin + 1, text.find("\n```", begin) - begin);
}

double variable(const Machine& machine, const Snapshot& state, std::string_view name) {
    for (std::size_t i = 0; i < machine.layout().variables.size(); ++i)
        if (machine.layout().variables[i].name == name) return state.variables[i];
    ADD_FAILURE() << "no variable " << name;
    return 0;
}

TEST(Tutorial, ShowsTheSmallestExampleAsItIs) {
    EXPECT_THAT(page(), ::testing::HasSubstr(text_of(fs::path(TAKTWERK_SOURCE_DIR) / "programs/examples/minimal.cpp")));
}

// The file's events: button at 1 s, a part from 2 s to 2.2 s, another from 3 s on. jam_time is 1.5 s, so the belt stops at 4.5 s.
TEST(Tutorial, ItsFeederCountsPartsAndStopsAtAJam) {
    const taktwerk::testing::InstalledSdk sdk;
    for (const auto& [file, start] : {std::pair{"CMakeLists.txt", "# CMakeLists.txt"}, std::pair{"feeder.cpp", "// feeder.cpp"},
                                      std::pair{"feeder.yaml", "# feeder.yaml"}}) {
        ASSERT_FALSE(block(start).empty()) << file << " is not on the page";
        std::ofstream(sdk.project() / file) << block(start);
    }
    const auto built = sdk.build_project();
    ASSERT_EQ(built.status, 0) << built.output;
    config::LoadOptions options;
    options.drive_dirs.push_back(TAKTWERK_SOURCE_DIR "/config/drives");
    auto loaded = config::load_machine(sdk.project() / "feeder.yaml", options);
    if (const auto* errors = std::get_if<1>(&loaded))
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
    ASSERT_EQ(loaded.index(), 0u);
    auto config = std::move(std::get<0>(loaded).machine);
    VirtualClock clock;
    World world{config, clock.now()};
    auto result = Machine::build(std::move(config), world.transport());
    ASSERT_EQ(result.index(), 0u);
    auto& machine = *std::get<0>(result);
    VirtualRunner runner{machine, world, clock};
    const auto until = [&](Duration at) { runner.run_for(at - (clock.now() - Instant{})); };
    const auto up = runner.bring_up();
    ASSERT_TRUE(up.ok()) << up.error().text();

    until(2900ms);
    EXPECT_NEAR(machine.latest()->axes[0].set_velocity, 120, 1e-9);  // the machine file's speed, not the program's default
    EXPECT_EQ(variable(machine, *machine.latest(), "parts"), 1);
    EXPECT_EQ(machine.latest()->outputs[0], 1) << "the lamp is steady while the belt moves";

    until(6s);
    EXPECT_EQ(machine.latest()->axes[0].set_velocity, 0);
    EXPECT_EQ(variable(machine, *machine.latest(), "parts"), 2);
    EXPECT_EQ(machine.latest()->outputs[0], 0);
    ASSERT_EQ(machine.latest()->alarm_count, 1u);
    EXPECT_EQ(machine.describe(machine.latest()->alarms[0].fact).english, "A part is jammed at the sensor");
}

}  // namespace
}  // namespace taktwerk::runtime
