// `taktwerk bus why` where the bus does not stay up, or comes up only by a clock: on simulated slaves, in virtual time.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/in_process.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// `why` on a machine file with these slaves at 4 ms; `simulation`: the lines of that section.
Outcome why(const std::string& slaves, const std::string& simulation, const char* how) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / fmt::format("taktwerk-why-{}", ::getpid());
    fs::create_directories(folder / "machines");
    fs::create_directory_symlink(fs::path(TAKTWERK_SOURCE_DIR) / "config" / "drives", folder / "drives");
    const auto file = (folder / "machines" / "why.yaml").string();
    std::ofstream(file) << "version: 1\nname: why\ncycle: 4 ms\nbus:\n  interface: simulated\n  slaves:\n"
                        << slaves << "simulation:\n"
                        << simulation;
    std::vector<std::string> words{"bus", "why", "--machine", file};
    if (*how) words.emplace_back(how);
    auto said = in_process(std::move(words));
    fs::remove_all(folder);
    return said;
}

const std::string terminals =
    "    - { name: a, terminal: { inputs: 8, outputs: 8 } }\n    - { name: b, terminal: { inputs: 8, outputs: 8 } }\n";

std::string off_at(int ms) { return fmt::format("  events:\n    - {{ at: {} ms, slave_power_off: b }}\n", ms); }
std::string off_and_on_at(int ms) { return off_at(ms) + fmt::format("    - {{ at: {} ms, slave_power_on: b }}\n", ms + 20); }

// A slave that goes at any time until the end of the proof (one second in OP) is told: "nothing to explain" is said only where none went.
TEST(BusWhy, ASlaveThatLeavesOpDuringTheProofIsNamedAndIsNoSuccess) {
    enum { not_reached, not_kept, well };
    int before = not_reached, kept_not = 0, fell_at = 0;
    for (int at = 0; at <= 4000; at += 200) {
        const auto said = why(terminals, off_at(at), "--json");
        const auto json = said.json();
        const int now = json["operational"] == true ? well : json.contains("fell") ? not_kept : not_reached;
        EXPECT_EQ(said.code, now == well ? exit_ok : exit_bus) << at << " ms: " << said.out;
        EXPECT_GE(now, before) << at << " ms: later, but seen as earlier";
        before = now;
        if (now != not_kept) continue;
        ++kept_not;
        fell_at = at;
        ASSERT_EQ(json["fell"].size(), 1u) << said.out;
        EXPECT_THAT(json["fell"][0].get<std::string>(), AllOf(HasSubstr("slave 1 'b'"), HasSubstr("does not answer")));
        EXPECT_GT(json["working_counter_errors"], 0);
    }
    EXPECT_GE(kept_not, 4) << "a second of proof, looked at every 200 ms";
    EXPECT_EQ(before, well) << "the control: after the proof nobody looks";

    const auto text = why(terminals, off_at(fell_at), "");
    EXPECT_EQ(text.code, exit_bus);
    EXPECT_THAT(text.out, AllOf(HasSubstr("reaches OP but does not stay there"), HasSubstr("slave 1 'b'"), HasSubstr("does not answer"),
                                HasSubstr("wrong working counter"), Not(HasSubstr("nothing to explain")), Not(HasSubstr("slave 0"))));
}

// Gone for 20 ms (five cycles) and back in OP before the end: all slaves are in OP when it looks, and still it was no sound bus.
TEST(BusWhy, ASlaveThatIsBackInOpBeforeTheEndOfTheProofIsNamedToo) {
    int seen = 0;
    for (int at = 1000; at <= 1800; at += 100) {
        const auto said = why(terminals, off_and_on_at(at), "--json");
        EXPECT_EQ(said.code, exit_bus) << at << " ms: " << said.out;
        EXPECT_EQ(said.json()["operational"], false) << at;
        seen += said.out.find("came back") != std::string::npos;
    }
    EXPECT_GT(seen, 0) << "it comes back within the second of proof";
}

std::string drifting(const char* supervision, int ppm) {
    return fmt::format("  supervision: {}\n  slaves: {{ a: {{ drift: {} ppm }} }}\n", supervision, ppm);
}
const std::string one_drive = "    - { name: a, profile: sv33-e }\n";

// The cycle follows the reference clock as the machine's does: 100 ppm, what ETG.1000.4 permits two clocks to differ, and more.
TEST(BusWhy, LocksToAReferenceClockThatTheMachineLocksTo) {
    for (const int ppm : {-200, -100, 100, 200}) {
        const auto said = why(one_drive, drifting("strict", ppm), "--json");
        EXPECT_EQ(said.code, exit_ok) << ppm << " ppm: " << said.out << said.err;
    }
}

// 2 % is twice what the cycle can be corrected by. Strict, that is the reason; without real time the machine does not wait, nor does this.
TEST(BusWhy, WaitsForTheLockOnlyWhereTheMachineDoes) {
    const auto strict = why(one_drive, drifting("strict", 20000), "--json");
    EXPECT_EQ(strict.code, exit_bus);
    EXPECT_EQ(strict.json()["failure"]["code"], "bus.dc_not_locked") << strict.out;

    const auto relaxed = why(one_drive, drifting("relaxed", 20000), "--json");
    EXPECT_EQ(relaxed.code, exit_ok) << relaxed.out;
    EXPECT_EQ(relaxed.json()["operational"], true);
}

}  // namespace
}  // namespace taktwerk::apps
