// The walls of docs/architecture.md: first on the real tree, then on small trees that break them (so that a checker that
// sees nothing fails too).

#include "tests/architecture/walls.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace taktwerk::architecture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<SourceFile>& tree() {
    static const std::vector<SourceFile> files = [] {
        std::vector<SourceFile> all;
        for (const auto& level : floor_levels())
            for (const auto& floor : level)
                for (auto& file : read_sources(TAKTWERK_SOURCE_DIR, floor)) all.push_back(std::move(file));
        return all;
    }();
    return files;
}

/// What CMake wrote from the taktwerk_library() lists.
const FolderGraph& tree_graph() {
    static const FolderGraph graph = [] {
        std::ostringstream text;
        text << std::ifstream(TAKTWERK_BINARY_DIR "/folders.txt").rdbuf();
        return parse_folder_graph(text.str());
    }();
    return graph;
}

std::string one_a_line(const Violations& violations) {
    std::string text;
    for (const auto& violation : violations) text += violation + "\n";
    return text;
}

#define EXPECT_NO_VIOLATIONS(call)                       \
    do {                                                 \
        const auto found = (call);                       \
        EXPECT_TRUE(found.empty()) << one_a_line(found); \
    } while (false)

TEST(Tree, IsReadAtAll) {
    ASSERT_FALSE(tree().empty());
    EXPECT_EQ(tree().front().path.substr(0, 5), "core/");
    EXPECT_EQ(tree_graph().count("core"), 1u);
    EXPECT_EQ(tree_graph().at("ecat/wire").count("core"), 1u);
}

TEST(Tree, FilesIncludeOnlyTheirOwnFloorOrLowerOnes) { EXPECT_NO_VIOLATIONS(check_floor_order(tree())); }
TEST(Tree, BusesAndLibrariesStayInTheFoldersThatOwnThem) { EXPECT_NO_VIOLATIONS(check_owned_includes(tree())); }
TEST(Tree, FoldersIncludeOnlyWhatTheyLink) { EXPECT_NO_VIOLATIONS(check_folder_links(tree(), tree_graph())); }
TEST(Tree, FoldersLinkOnlyLowerFloorsWithoutLoops) { EXPECT_NO_VIOLATIONS(check_folder_graph(tree_graph())); }
TEST(Tree, ControlCodeReadsNoClockAndDrawsNoRandomNumbers) { EXPECT_NO_VIOLATIONS(check_determinism(tree())); }
TEST(Tree, NamesSayWhoseIdeaAFileIs) { EXPECT_NO_VIOLATIONS(check_names(tree())); }

TEST(Tree, EveryFolderWithSourcesHasAReadme) {
    std::set<std::string> folders;
    for (const auto& file : tree()) folders.insert(folder_of(file.path));
    Violations missing;
    for (const auto& folder : folders)
        if (!std::filesystem::exists(std::filesystem::path(TAKTWERK_SOURCE_DIR) / folder / "README.md"))
            missing.push_back(folder + "/README.md");
    EXPECT_TRUE(missing.empty()) << one_a_line(missing);
}

TEST(FloorOrder, AFileMayIncludeItsOwnFloorAndLowerOnes) {
    EXPECT_NO_VIOLATIONS(check_floor_order({
        {"axes/axis/axis.hpp", "#include \"core/time.hpp\"\n#include \"axes/planner/profile.hpp\"\n#include <vector>\n"},
        {"apps/run.cpp", "#include \"config/load.hpp\"\n#include \"ecat/master.hpp\"\n"},
    }));
}

TEST(FloorOrder, AHigherFloorIsRefusedWithFileAndLine) {
    EXPECT_THAT(check_floor_order({{"core/clock.cpp", "#include \"core/clock.hpp\"\n#include \"axes/axis/axis.hpp\"\n"}}),
                ElementsAre("core/clock.cpp:2: includes axes/axis/axis.hpp, a higher floor"));
}

TEST(FloorOrder, OnlyAppsMayIncludeConfig) {
    EXPECT_THAT(check_floor_order({{"runtime/machine/machine.cpp", "#include \"config/load.hpp\"\n"}}),
                ElementsAre(HasSubstr("higher floor")));
    EXPECT_THAT(check_floor_order({{"hmi_bridge/gateway/gateway.cpp", "#include \"config/load.hpp\"\n"}}),
                ElementsAre(HasSubstr("higher floor")));
}

TEST(FloorOrder, TheTwoBusesNeverIncludeEachOther) {
    EXPECT_THAT(check_floor_order({{"modbus/serial.cpp", "#include \"ecat/master.hpp\"\n"}}), ElementsAre(HasSubstr("a sibling floor")));
    EXPECT_THAT(check_floor_order({{"ecat/dc/servo.cpp", "#include \"modbus/client.hpp\"\n"}}), ElementsAre(HasSubstr("a sibling floor")));
}

TEST(FloorOrder, IncludesAreWrittenFromTheRootAndNeverNameTests) {
    EXPECT_THAT(check_floor_order({{"core/a.cpp", "#include \"a.hpp\"\n#include \"../core/b.hpp\"\n#include \"tests/c.hpp\"\n"}}),
                ElementsAre(HasSubstr(":1: \"a.hpp\" is not written from"), HasSubstr(":2: \"../core/b.hpp\" is not"),
                            HasSubstr(":3: includes tests/")));
}

TEST(FloorOrder, AnIncludeInACommentDoesNotCount) {
    EXPECT_NO_VIOLATIONS(check_floor_order({{"core/a.hpp", "// #include \"apps/x.hpp\"\n/*\n#include \"apps/y.hpp\"\n*/\n"}}));
}

TEST(OwnedIncludes, OnTheMotionSideOnlyDriveCodeAndSimulationSeeABus) {
    EXPECT_THAT(check_owned_includes({
                    {"axes/axis/axis.cpp", "#include \"ecat/master.hpp\"\n"},
                    {"axes/drives/xp200/drive.cpp", "#include \"ecat/master.hpp\"\n"},
                    {"axes/drives/cia402/drive.cpp", "#include \"modbus/client.hpp\"\n"},
                    {"fb_library/motion/power.hpp", "#include \"ecat/master.hpp\"\n"},
                    {"programs/api/program.hpp", "#include \"modbus/client.hpp\"\n"},
                }),
                ElementsAre(HasSubstr("axes/axis/axis.cpp:1"), HasSubstr("axes/drives/xp200/"), HasSubstr("axes/drives/cia402/"),
                            HasSubstr("fb_library/motion/"), HasSubstr("programs/api/")));
    EXPECT_NO_VIOLATIONS(check_owned_includes({
        {"axes/drives/cia402/drive.cpp", "#include \"ecat/master.hpp\"\n"},
        {"axes/sim/servo.cpp", "#include \"ecat/sim/device_model.hpp\"\n#include \"modbus/server.hpp\"\n"},
        {"runtime/cycle.cpp", "#include \"ecat/master.hpp\"\n"},
    }));
}

TEST(OwnedIncludes, LibrariesStayWhereTheyAreWrapped) {
    EXPECT_THAT(
        check_owned_includes({
            {"runtime/snapshot.cpp", "#include <lcm/lcm-cpp.hpp>\n"},
            {"apps/run.cpp", "#include <yaml-cpp/yaml.h>\n"},
            {"ecat/coe/sdo.cpp", "#include <pugixml.hpp>\n"},
            {"runtime/cycle.cpp", "#include <modbus/modbus-tcp.h>\n"},
            {"hmi_bridge/socket/door.cpp", "#include <boost/asio.hpp>\n"},
            {"hmi_bridge/web/page_message.cpp", "#include <boost/beast.hpp>\n"},
            {"apps/hmi/hmi.cpp", "#include \"hmi_bridge/web/server/feed.hpp\"\n"},
            {"hmi_bridge/web/audit_log.cpp", "#include <sodium.h>\n"},
            {"runtime/bundle/trust.cpp", "#include <sodium.h>\n"},
            {"runtime/retain/kept_text.cpp", "#include <nlohmann/json.hpp>\n"},
            {"hmi_bridge/socket/json_history.cpp", "#include <sqlite3.h>\n"},
            {"runtime/scope_file/scope_file.cpp", "#include <zstd.h>\n"},
            {"core/ring.hpp", "#include <gtest/gtest_prod.h>\n"},
            {"fb_library/groups/move_linear.hpp", "#include <Eigen/Core>\n"},
        }),
        ElementsAre(HasSubstr("LCM"), HasSubstr("yaml-cpp"), HasSubstr("pugixml"), HasSubstr("libmodbus"), HasSubstr("Boost"),
                    HasSubstr("Boost"), HasSubstr("Boost"), HasSubstr("libsodium"), HasSubstr("libsodium"), HasSubstr("nlohmann-json"),
                    HasSubstr("SQLite"), HasSubstr("zstd"), HasSubstr("a test library"), HasSubstr("Eigen")));
    EXPECT_NO_VIOLATIONS(check_owned_includes({
        {"hmi_bridge/lcm/publisher.cpp", "#include <lcm/lcm-cpp.hpp>\n"},
        {"hmi_bridge/history/history_store.cpp", "#include <sqlite3.h>\n"},
        {"runtime/signature/sha256.cpp", "#include <sodium.h>\n"},
        {"runtime/compression/compression.cpp", "#include <zstd.h>\n"},
        {"runtime/bundle/manifest.cpp", "#include <nlohmann/json.hpp>\n"},
        {"config/load.cpp", "#include <yaml-cpp/yaml.h>\n"},
        {"ecat/esi/read.cpp", "#include <pugixml.hpp>\n"},
        {"modbus/tcp/tcp_exchange.cpp", "#include <modbus/modbus.h>\n"},
        {"axes/kinematics/chain.hpp", "#include <Eigen/Core>\n"},
        {"hmi_bridge/web/server/feed.hpp", "#include <boost/asio.hpp>\n"},
        {"apps/hmi/hmi.cpp", "#include \"hmi_bridge/web/server/web_server.hpp\"\n"},
    }));
}

const FolderGraph small_graph = parse_folder_graph(
    "core Threads::Threads\n"
    "ecat/wire core\n"
    "ecat/transport ecat/wire\n"
    "ecat/coe ecat/wire core\n"
    "ecat ecat/transport ecat/coe core\n");

TEST(FolderLinks, AFolderIncludesWhatItLinksDirectlyOrThroughOthers) {
    EXPECT_NO_VIOLATIONS(
        check_folder_links({{"ecat/transport/raw.cpp", "#include \"ecat/wire/frame.hpp\"\n#include \"core/time.hpp\"\n"}}, small_graph));
}

TEST(FolderLinks, AFolderThatIsNotLinkedIsRefused) {
    EXPECT_THAT(check_folder_links({{"ecat/wire/frame.cpp", "#include \"ecat/transport/transport.hpp\"\n"}}, small_graph),
                ElementsAre("ecat/wire/frame.cpp:1: includes ecat/transport/transport.hpp, but ecat/wire does not link ecat/transport"));
}

TEST(FolderLinks, HeadersAtTheTopOfAFloorAreVocabularyAsFarAsTheirOwnIncludesAllow) {
    const SourceFile plain{"ecat/device.hpp", "#include \"core/time.hpp\"\n"};
    const SourceFile master{"ecat/master.hpp", "#include \"ecat/device.hpp\"\n#include \"ecat/transport/transport.hpp\"\n"};

    EXPECT_NO_VIOLATIONS(check_folder_links({plain, {"ecat/coe/sdo.cpp", "#include \"ecat/device.hpp\"\n"}}, small_graph));
    EXPECT_THAT(check_folder_links({plain, master, {"ecat/coe/sdo.cpp", "#include \"ecat/master.hpp\"\n"}}, small_graph),
                ElementsAre(HasSubstr("ecat/coe does not link ecat/transport (through ecat/master.hpp)")));
}

TEST(FolderGraphRules, LoopsHigherFloorsAndUnknownFoldersAreRefused) {
    EXPECT_NO_VIOLATIONS(check_folder_graph(small_graph));
    EXPECT_THAT(
        check_folder_graph(parse_folder_graph("core axes/axis\naxes/axis core\n")),
        testing::IsSupersetOf({HasSubstr("core links axes/axis, not a lower floor"), HasSubstr("core links itself through others")}));
    EXPECT_THAT(check_folder_graph(parse_folder_graph("modbus ecat\necat\n")), ElementsAre(HasSubstr("not a lower floor")));
    EXPECT_THAT(check_folder_graph(parse_folder_graph("ecat/wire core\n")), ElementsAre(HasSubstr("core, which is no folder target")));
}

TEST(Determinism, ClocksSleepsAndRandomNumbersAreRefusedOnTheControlSide) {
    EXPECT_THAT(check_determinism({
                    {"axes/axis/a.cpp", "auto t = std::chrono::steady_clock::now();\n"},
                    {"runtime/b.cpp", "\nclock_gettime(CLOCK_MONOTONIC, &ts);\n"},
                    {"ecat/c.cpp", "gettimeofday(&tv, nullptr);\nstd::this_thread::sleep_for(1ms);\n"},
                    {"core/d.cpp", "int x = rand();\nstd::random_device seed;\n"},
                }),
                ElementsAre(HasSubstr("axes/axis/a.cpp:1"), HasSubstr("runtime/b.cpp:2"), HasSubstr("ecat/c.cpp:1"),
                            HasSubstr("ecat/c.cpp:2"), HasSubstr("core/d.cpp:1"), HasSubstr("core/d.cpp:2")));
}

TEST(Determinism, CoreOwnsTheClockAndTheBridgeStampsMessages) {
    EXPECT_NO_VIOLATIONS(check_determinism({
        {"core/clock.cpp", "clock_gettime(CLOCK_MONOTONIC, &ts);\n"},
        {"hmi_bridge/lcm/publisher.cpp", "auto t = std::chrono::system_clock::now();\n"},
        {"axes/axis/a.cpp",
         "// never clock_gettime() here\nraise(\"clock_gettime( failed\");\nauto operand(int);\ndouble Profile::time(double "
         "s);\nclock.sleep_until(at);\n"},
    }));
}

TEST(Names, WordsThatBelongToNobodyAreRefused) {
    EXPECT_THAT(
        check_names({{"core/utils.hpp", ""}, {"axes/common/x.cpp", ""}, {"runtime/task_manager.cpp", ""}, {"core/command.hpp", ""}}),
        testing::SizeIs(3));
}

TEST(SourceText, StringsAndDigitSeparatorsDoNotHideCode) {
    EXPECT_EQ(code_of("int a = 1'000; // x\n", Literals::blank), "int a = 1'000;     \n");
    EXPECT_EQ(code_of("f(\"// no comment\");", Literals::keep), "f(\"// no comment\");");
    EXPECT_EQ(code_of("f(\"ab\\\"c\"); g('\\'');", Literals::blank), "f(\"     \"); g('  ');");
    EXPECT_THAT(code_of("R\"(a \" // b)\" rand()", Literals::blank), HasSubstr("rand()"));
    EXPECT_THAT(include_lines("#include <a/b.h>  // why\n#  include \"c.hpp\"\n"), testing::SizeIs(2));
}

}  // namespace
}  // namespace taktwerk::architecture
