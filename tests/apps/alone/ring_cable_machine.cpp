// A ring in two processes: `taktwerk run` with two interfaces, and `taktwerk sim --nic --nic2` on the far ends of two veth pairs. Each cable is
// pulled and plugged in while an axis moves, at the simulated slaves and as a link that goes down. Needs root; skipped otherwise.

#include <filesystem>
#include <fstream>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/alone/cable.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

constexpr const char* ring_machine = R"(version: 1
name: ring
cycle: 4 ms
bus:
  interface: twk0
  ring: { interface2: twk2 }
  slaves:
    - { name: x_drive, profile: sv33-e }
    - { name: y_drive, profile: sv33-e }
    - { name: io, terminal: { inputs: 8, outputs: 8 } }
simulation: { supervision: relaxed }
axes:
  x:
    slave: x_drive
    unit: mm
    gearing: { counts_per_revolution: 131072, feed: 20 mm }
    limits: { velocity: 100 mm/s, acceleration: 500 mm/s2, jerk: 5000 mm/s3 }
    following_error: { window: 20 mm }
    homing: { kind: set_here }
  y:
    slave: y_drive
    unit: mm
    gearing: { counts_per_revolution: 131072, feed: 20 mm }
    limits: { velocity: 100 mm/s, acceleration: 500 mm/s2, jerk: 5000 mm/s3 }
    following_error: { window: 20 mm }
    homing: { kind: set_here }
)";

class RingOnTwoCables : public ::testing::Test {
protected:
    void SetUp() override {
        if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
        if (!cable.laid() || !cable.lay_second()) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        std::filesystem::create_directories(folder / "machines");
        std::filesystem::create_directory_symlink(source / "config/drives", folder / "drives");
        std::ofstream(file()) << ring_machine << "hmi: { socket: '" << socket() << "', lcm: { enabled: false } }\n";
    }
    void TearDown() override {
        if (!folder.empty()) std::filesystem::remove_all(folder);
    }
    [[nodiscard]] std::string file() const { return folder / "machines/ring.yaml"; }
    [[nodiscard]] std::string socket() const { return folder / "socket"; }

    void operate(std::vector<std::string> words) const {
        words.insert(words.begin(), taktwerk);
        words.insert(words.end(), {"-s", socket()});
        std::string said;
        EXPECT_EQ(run(std::move(words), &said), exit_ok) << said;
    }
    [[nodiscard]] Json state() const {
        std::string said;
        run({taktwerk, "monitor", "--once", "--json", "-s", socket()}, &said);
        auto out = Json::parse(said, nullptr, false);
        return out.is_object() && out.contains("bus") ? out : Json{};
    }
    /// Looks until the ring has this shape. What the machine said then is `seen`.
    bool until_ring_is(const std::string& shape) {
        for (const auto end = std::chrono::steady_clock::now() + 20s; std::chrono::steady_clock::now() < end;) {
            seen = state();
            const bool told =
                !seen.is_null() && (shape == "closed" || alarms().find("ring_broken") != std::string::npos);  // with the next frame
            if (told && seen.at("bus").at("ring") == shape) return true;
        }
        return false;
    }
    /// The kernel tells of a carrier up to a second after frames pass: until then the machine takes that interface for unplugged.
    [[nodiscard]] bool until_carrier(const char* nic) const {
        for (const auto end = std::chrono::steady_clock::now() + 10s; std::chrono::steady_clock::now() < end;) {
            std::string said;
            run(cable.at_master({"ip", "-br", "link", "show", nic}), &said);
            if (said.find(" UP ") != std::string::npos) return true;
        }
        return false;
    }
    [[nodiscard]] std::string alarms() const {
        std::string out;
        if (!seen.is_null())
            for (const auto& alarm : seen.at("alarms")) out += alarm.at("name").get<std::string>() + " ";
        return out;
    }
    const Cable cable;
    std::filesystem::path folder;
    Json seen;
};

TEST_F(RingOnTwoCables, NoCableTakesAnAxisAway) {
    Child slaves(cable.at_slaves({taktwerk, "sim", file(), "--nic", "twk1", "--nic2", "twk3"}));
    ASSERT_TRUE(slaves.says("slaves of 'ring' on twk1 and twk3", 20s)) << slaves.text();
    std::string scan;
    EXPECT_EQ(run(cable.at_master({taktwerk, "bus", "scan", "--machine", file()}), &scan), exit_ok) << scan;
    EXPECT_THAT(scan, HasSubstr("3 slaves, a closed ring"));
    Child master(cable.at_master({taktwerk, "run", file()}));
    ASSERT_TRUE(master.says("running, manual mode", 60s)) << master.text() << slaves.text();
    for (const char* axis : {"x", "y"}) {
        operate({"enable", axis, "--wait"});
        operate({"home", axis, "--wait"});
    }
    const auto pull = [&](const char* where, const char* shape) {
        slaves.say(std::string("unplug ") + where);
        ASSERT_TRUE(until_ring_is(shape)) << where << seen << master.text();
        EXPECT_THAT(alarms(), AllOf(HasSubstr("ring_broken"), Not(HasSubstr("slave_lost")), Not(HasSubstr("cable_broken")))) << where;
        slaves.say(std::string("plug ") + where);
        ASSERT_TRUE(until_ring_is("closed")) << where << seen;
    };
    pull("master", "first_silent");
    pull("y_drive", "open");
    pull("io", "open");
    pull("ring", "second_silent");
    // The carrier goes: the slave at the other end sees that, too.
    for (const auto& [nic, shape] : {std::pair{"twk0", "first_silent"}, std::pair{"twk2", "second_silent"}}) {
        const auto link = [&, nic = nic](const char* to) { return run(cable.at_master({"ip", "link", "set", nic, to})) == 0; };
        ASSERT_TRUE(link("down"));
        ASSERT_TRUE(until_ring_is(shape)) << nic << seen << master.text();
        EXPECT_THAT(alarms(), AllOf(HasSubstr("ring_broken"), Not(HasSubstr("link_down")))) << nic;
        ASSERT_TRUE(link("up"));
        ASSERT_TRUE(until_ring_is("closed")) << nic << seen;
        ASSERT_TRUE(until_carrier(nic)) << nic;
    }
    // Whatever a stall of this computer did meanwhile: all slaves are there.
    EXPECT_THAT(seen.at("slaves").dump(), Not(HasSubstr("\"fresh\":false"))) << master.text();
    master.signal(SIGTERM);
    EXPECT_EQ(master.wait(20s), exit_ok) << master.text();
    slaves.signal(SIGTERM);
    EXPECT_EQ(slaves.wait(10s), exit_ok) << slaves.text();
}

}  // namespace
}  // namespace taktwerk::apps
