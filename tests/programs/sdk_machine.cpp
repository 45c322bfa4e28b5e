// A machine builder's day: the SDK is installed, a program is built against it outside this tree, and the runtime takes it.

#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "programs/api/abi.hpp"
#include "runtime/tasks/io_image.hpp"
#include "runtime/tasks/program_host.hpp"
#include "runtime/tasks/program_library.hpp"
#include "tests/programs/installed_sdk.hpp"

namespace taktwerk::runtime {
namespace {

namespace fs = std::filesystem;
using taktwerk::testing::InstalledSdk;
using taktwerk::testing::Outcome;
using taktwerk::testing::run;
using taktwerk::testing::text_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Sdk : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        sdk = std::make_unique<InstalledSdk>();
        for (const char* file : {"CMakeLists.txt", "outside.cpp"})
            fs::copy_file(fs::path(TAKTWERK_SOURCE_DIR) / "tests/programs/outside" / file, sdk->project() / file);
        built = sdk->build_project();
    }
    static void TearDownTestSuite() { sdk.reset(); }
    static fs::path build() { return sdk->build(); }

    inline static std::unique_ptr<InstalledSdk> sdk;
    inline static Outcome built;
};

TEST_F(Sdk, BuildsAProgramThatKnowsNothingOfThisTree) {
    ASSERT_EQ(built.status, 0) << built.output;

    EXPECT_EQ(text_of(build() / "compile_commands.json").find(TAKTWERK_SOURCE_DIR), std::string::npos)
        << "a path into this tree leaks into the build";
    EXPECT_TRUE(fs::is_regular_file(build() / "outside.so")) << "the library has no prefix";
}

TEST_F(Sdk, HoldsOnlyWhatAProgramIncludes) {
    std::set<std::string> floors;
    for (const auto& entry : fs::directory_iterator(sdk->prefix() / "include" / "taktwerk")) floors.insert(entry.path().filename());
    EXPECT_THAT(floors, ElementsAre("axes", "core", "fb_library", "programs"));

    // What a program cannot include because all_blocks.hpp and entry.hpp do not: machine and drives stay inside.
    EXPECT_FALSE(fs::exists(sdk->prefix() / "include/taktwerk/axes/axis/axis.hpp"));
    EXPECT_FALSE(fs::exists(sdk->prefix() / "include/taktwerk/core/recorder.hpp"));
}

TEST_F(Sdk, ProgramIsLoadedAndItsNamesAreResolved) {
    ASSERT_EQ(built.status, 0) << built.output;
    MachineConfig config;
    config.axes.resize(2);
    config.axes[0].axis.name = "y";
    config.axes[1].axis.name = "x";
    config.io.resize(2);
    config.io[0].name = "start_button";
    config.io[1].name = "lamp";
    config.io[1].direction = IoDirection::output;
    ProgramConfig program;
    program.name = "cell";
    program.library = build() / "outside.so";
    program.parameters.push_back({"speed", 42});
    config.programs.push_back(program);

    std::vector<Error> errors;
    const IoImage io{config.io, config.cycle};
    axes::MotionTables tables;
    ProgramHost host{config, io, tables, errors};

    for (const auto& error : errors) ADD_FAILURE() << error.text();
    ASSERT_EQ(host.tasks().size(), 1u);
    EXPECT_EQ(host.tasks()[0].config.name, "main");
    EXPECT_EQ(host.parameters(), std::vector<double>{42});
    ASSERT_EQ(host.variables().size(), 1u);

    // One scan by hand: no axes are there to be seen, so the blocks say so, and the program's own alarm rises.
    TaskContext ctx;
    auto* instance = host.programs()[0].instance.get();
    instance->start();
    host.tasks()[0].function(instance, ctx);
    EXPECT_EQ(ProgramHost::read(host.variables()[0]), 1.0);
    EXPECT_EQ(ctx.alarms, 1u);
}

// Same sources, same SDK, but -O0, assertions and C++23 as the project's default: still the ABI of this runtime.
TEST_F(Sdk, FlagsOfTheProjectDoNotChangeTheAbi) {
    ASSERT_EQ(built.status, 0) << built.output;
    for (const char* file : {"outside.so", "outside_debug.so"}) {
        const auto library = ProgramLibrary::open(build() / file);
        ASSERT_TRUE(library.ok()) << library.error().text();
        EXPECT_EQ(library->entry().abi_hash, abi_hash()) << file;
    }
}

TEST_F(Sdk, MissingFunctionIsFoundWhenTheProgramIsLinked) {
    ASSERT_EQ(built.status, 0) << built.output;
    const auto source = sdk->project() / "outside.cpp";
    const auto before = text_of(source);
    std::ofstream(source, std::ios::app)
        << "extern \"C\" void nobody_defines_this();\n"
           "extern \"C\" __attribute__((visibility(\"default\"))) void call_it() { nobody_defines_this(); }\n";
    const auto again = run("'" TAKTWERK_CMAKE "' --build '" + build().string() + "' --target outside");
    std::ofstream(source) << before;

    EXPECT_NE(again.status, 0);
    EXPECT_THAT(again.output, HasSubstr("nobody_defines_this"));
}

}  // namespace
}  // namespace taktwerk::runtime
