// The delta picker over a cable: `taktwerk sim` plays its drives on one end of a veth pair in a process of its own, `taktwerk run` moves the arm and the belt from the other. Real
// time, relaxed: what counts is that parts get from the belt into the tray, not when. Needs root; skipped otherwise.

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/alone/cable.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;

class DeltaPickerOnACable : public ::testing::Test {
protected:
    void SetUp() override {
        if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
        if (!cable.laid()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        std::filesystem::create_directories(folder / "machines");
        std::filesystem::create_directory_symlink(source / "config/drives", folder / "drives");
        write_machine();
    }
    void TearDown() override {
        if (!folder.empty()) std::filesystem::remove_all(folder);
    }
    /// config/machines/delta-picker.yaml on this cable with 8 ms. The arms may lag by some cycles of 250 deg/s.
    void write_machine() {
        std::ifstream in(source / "config/machines/delta-picker.yaml");
        std::stringstream all;
        all << in.rdbuf();
        auto text = all.str();
        const auto replace = [&](const std::string& from, const std::string& to) {
            const auto at = text.find(from);
            ASSERT_NE(at, std::string::npos) << from;
            text.replace(at, from.size(), to);
        };
        replace("interface: simulated", "interface: twk0");
        replace("cycle: 1 ms", "cycle: 8 ms");
        replace("&arm_error { window: 3 deg }", "&arm_error { window: 30 deg }");
        replace("window: 5 mm", "window: 50 mm");
        replace("library: delta_picker.so", "library: " + std::string(TAKTWERK_BINARY_DIR) + "/programs/delta_picker.so");
        text += "hmi: { socket: '" + socket() + "', lcm: { enabled: false } }\n";
        std::ofstream(file()) << text;
    }
    [[nodiscard]] std::string file() const { return folder / "machines/delta.yaml"; }
    [[nodiscard]] std::string socket() const { return folder / "socket"; }
    [[nodiscard]] Json state() const {
        std::string said;
        run({taktwerk, "monitor", "--once", "--json", "-s", socket()}, &said);
        auto out = Json::parse(said, nullptr, false);
        return out.is_object() && out.contains("variables") ? out : Json{};  // an error: this computer stalls, it is asked again
    }
    static double variable(const Json& state, const std::string& name) {
        if (!state.is_null())
            for (const auto& v : state.at("variables"))
                if (v.at("name") == name) return v.at("value").get<double>();
        return 0;
    }
    /// A stall of this computer may stop the machine, or silence the terminal of the emergency stop: then a person resets it and lets it go on, as the alarm says.
    void help(Child& slaves) const {
        if (seen.is_null() || seen.at("alarms").empty()) return;
        run({taktwerk, "reset", "-s", socket()});
        run({taktwerk, "start", "-s", socket()});
        slaves.say("input go_on 1");
        slaves.say("after 200ms input go_on 0");
    }
    bool until(Child& slaves, const std::function<bool(const Json&)>& condition, std::chrono::seconds patience) {
        const auto end = std::chrono::steady_clock::now() + patience;
        do {
            seen = state();
            if (!seen.is_null() && condition(seen)) return true;
            help(slaves);
        } while (std::chrono::steady_clock::now() < end);
        return false;
    }

    const Cable cable;
    std::filesystem::path folder;
    Json seen;
};

TEST_F(DeltaPickerOnACable, PartsGetFromTheBeltIntoTheTrayAndAFaultIsOvercome) {
    Child slaves(cable.at_slaves({taktwerk, "sim", file(), "--nic", "twk1"}));
    ASSERT_TRUE(slaves.says("slaves of 'delta-picker'", 30s)) << slaves.text();
    Child master(cable.at_master({taktwerk, "run", file()}));
    ASSERT_TRUE(master.says("running, automatic mode", 60s)) << master.text() << slaves.text();
    ASSERT_TRUE(until(
        slaves, [&](const Json& s) { return variable(s, "placed") >= 4; }, 120s))
        << seen << master.text();
    EXPECT_EQ(seen.at("groups").at(0).at("name"), "delta");

    slaves.say("drive-fault arm2 0x3130");
    ASSERT_TRUE(master.says("waits for a person", 20s)) << master.text();
    const double placed = variable(seen, "placed");
    ASSERT_TRUE(until(
        slaves, [&](const Json& s) { return variable(s, "placed") >= placed + 3; }, 120s))
        << seen << master.text();

    master.signal(SIGTERM);
    EXPECT_EQ(master.wait(30s), exit_ok) << master.text();
    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
}

}  // namespace
}  // namespace taktwerk::apps
