// `taktwerk bus` on a bus with groups that come and go: who is not plugged in is no trouble, and who is, is named and in operation.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

/// The shipped tool changer, its tools in the rack or at the flange.
class ToolChanger {
public:
    ToolChanger(bool gripper, bool screwdriver) : gripper_(gripper), screwdriver_(screwdriver) {
        fs::create_directories(folder_ / "machines");
        for (const char* shared : {"drives", "devices"}) fs::create_directory_symlink(source / "config" / shared, folder_ / shared);
        std::ifstream from{source / "config" / "machines" / "tool-changer.yaml"};
        std::stringstream text;
        text << from.rdbuf();
        std::string file = text.str();
        connect(file, "tool_a", gripper);
        connect(file, "tool_b", screwdriver);
        std::ofstream{file_} << file;
    }
    ~ToolChanger() { fs::remove_all(folder_); }
    ToolChanger(const ToolChanger&) = delete;
    ToolChanger& operator=(const ToolChanger&) = delete;

    [[nodiscard]] Outcome bus(std::vector<std::string> words) const {
        words.insert(words.begin(), "bus");
        words.insert(words.end(), {"--machine", file_, "--simulate"});
        return in_process(std::move(words));
    }
    /// By position. The first socket of the junction is the gripper's.
    [[nodiscard]] std::vector<std::string> there() const {
        std::vector<std::string> names{"x_drive", "coupler", "sensors", "valves", "junction"};
        if (gripper_) names.insert(names.end(), {"gripper", "gripper_in", "gripper_out"});
        if (screwdriver_) names.emplace_back("screw_drive");
        return names;
    }
    [[nodiscard]] std::vector<std::string> absent() const {
        std::vector<std::string> groups;
        if (!gripper_) groups.emplace_back("tool_a");
        if (!screwdriver_) groups.emplace_back("tool_b");
        return groups;
    }

private:
    static void connect(std::string& file, const std::string& group, bool connected) {
        const std::string away = group + ": { connected: false";
        const auto at = file.find(away);
        ASSERT_NE(at, std::string::npos) << group;
        if (connected) file.replace(at, away.size(), group + ": { connected: true");
    }
    bool gripper_, screwdriver_;
    fs::path folder_ = fs::temp_directory_path() / fmt::format("taktwerk-tools-{}-{}{}", ::getpid(), gripper_, screwdriver_);
    std::string file_ = (folder_ / "machines" / "tools.yaml").string();
};

class BusWithGroups : public ::testing::TestWithParam<int> {
protected:
    ToolChanger machine_{(GetParam() & 1) != 0, (GetParam() & 2) != 0};
};

void all_are_named(const Outcome& scan, const ToolChanger& machine, const char* state) {
    ASSERT_EQ(scan.code, exit_ok) << scan.out << scan.err;
    const auto json = scan.json();
    std::vector<std::string> names;
    for (const auto& slave : json["slaves"]) {
        names.push_back(slave.value("name", ""));
        EXPECT_EQ(slave["state"], state) << names.back();
        EXPECT_FALSE(slave.contains("unreadable")) << slave.dump();
        EXPECT_FALSE(slave.contains("mismatch")) << slave.dump();
    }
    EXPECT_THAT(names, ElementsAreArray(machine.there()));
    EXPECT_EQ(json["absent_groups"].get<std::vector<std::string>>(), machine.absent());
    EXPECT_TRUE(json["remarks"].empty()) << json["remarks"].dump();
}

TEST_P(BusWithGroups, ScanNamesWhoIsThere) { all_are_named(machine_.bus({"scan", "--json"}), machine_, "INIT"); }

TEST_P(BusWithGroups, ScanInOperationSeesThemJoined) { all_are_named(machine_.bus({"scan", "--operational", "--json"}), machine_, "OP"); }

TEST_P(BusWithGroups, WhyHasNothingToExplain) {
    const auto why = machine_.bus({"why", "--json"});
    ASSERT_EQ(why.code, exit_ok) << why.out << why.err;
    const auto json = why.json();
    EXPECT_EQ(json["operational"], true);
    EXPECT_EQ(json["slaves"], machine_.there().size());
    EXPECT_EQ(json["absent_groups"].get<std::vector<std::string>>(), machine_.absent());
    EXPECT_EQ(json["working_counter_errors"], 0);
    EXPECT_TRUE(json["remarks"].empty()) << why.out;

    const auto text = machine_.bus({"why"});
    EXPECT_THAT(text.out, HasSubstr("nothing to explain"));
    for (const auto& group : machine_.absent()) EXPECT_THAT(text.out, HasSubstr("'" + group + "' is not plugged in"));
}

INSTANTIATE_TEST_SUITE_P(Tools, BusWithGroups, ::testing::Values(0, 1, 2, 3));

// Objects of a drive that came with a group, by its name and by its position.
TEST(BusWithGroup, ADriveOfAGroupIsReadInOperation) {
    const ToolChanger machine{false, true};
    for (const char* who : {"screw_drive", "5"}) {
        const auto read = machine.bus({"sdo", "read", who, "0x6041", "--operational"});
        EXPECT_EQ(read.code, exit_ok) << who << ": " << read.out << read.err;
    }
    const ToolChanger empty{false, false};
    const auto gone = empty.bus({"sdo", "read", "screw_drive", "0x6041", "--operational"});
    EXPECT_NE(gone.code, exit_ok) << gone.out;
}

}  // namespace
}  // namespace taktwerk::apps
