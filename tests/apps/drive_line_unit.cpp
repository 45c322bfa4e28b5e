// `taktwerk drive` on an XP200: on the simulated line of a machine file, and on a pseudo-terminal that stands for a port of this PC.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "apps/bus/session.hpp"
#include "apps/terminal/exit_code.hpp"
#include "axes/sim/xp200/station.hpp"
#include "config/drive_file/drive_loader.hpp"
#include "core/clock.hpp"
#include "modbus/line/pseudo_terminal.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using namespace std::chrono_literals;

/// XP200 'u_drive' at station 1, as its machine file has it; each call begins with mains just on.
Outcome on_line(std::vector<std::string> words, const std::string& file = serial_axis) {
    words.insert(words.end(), {"--machine", file, "--simulate"});
    return drive(std::move(words));
}

class DriveOnLine : public ::testing::Test {
protected:
    DriveOnLine() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~DriveOnLine() override { std::filesystem::remove_all(folder_); }
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }
    static std::string text_of(const std::string& file) {
        std::ifstream in(file);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// serial-axis.yaml with an alarm at once.
    std::string with_alarm(int code) {
        namespace fs = std::filesystem;
        const fs::path source = std::string(TAKTWERK_SOURCE_DIR) + "/config";
        fs::create_directories(path("machines"));
        if (!fs::exists(path("drives"))) fs::create_directory_symlink(source / "drives", path("drives"));
        auto file = path("machines/x.yaml");
        std::ofstream(file) << text_of(source / "machines/serial-axis.yaml")
                            << "\nsimulation: { events: [ { at: 1 ms, drive_fault: u, code: " << code << " } ] }\n";
        return file;
    }

private:
    std::string folder_;
};

TEST_F(DriveOnLine, IsIdentifiedByItsMachineFileAndByWhatItSays) {
    const auto one = on_line({"identify", "u_drive"});
    EXPECT_EQ(one.code, exit_ok) << one.err;
    EXPECT_THAT(one.out, AllOf(HasSubstr("'u_drive' (xp200), station 1"), HasSubstr("drive code"), HasSubstr("two's complement")));
    const auto all = on_line({"identify", "--json"}).json();
    ASSERT_EQ(all.size(), 2u) << "the terminal on the bus, and the drive";
    EXPECT_EQ(all[1]["profiles"], Json::array({"xp200"}));
}

// Pr063 as the machine file sets it, Pr066 as delivered (5.4.1): -300 %, in two's complement on the wire.
TEST_F(DriveOnLine, ValuesAreReadAndWrittenByTheManualsNames) {
    const auto got = on_line({"get", "u_drive", "Pr063", "Pr066"});
    EXPECT_EQ(got.code, exit_ok) << got.err;
    EXPECT_THAT(got.out, AllOf(HasSubstr("= 200 ms"), HasSubstr("= -300 %")));
    const auto set = on_line({"set", "u_drive", "Pr005=80"});
    EXPECT_EQ(set.code, exit_ok) << set.err;
    EXPECT_THAT(set.out, AllOf(HasSubstr("50 Hz"), HasSubstr("80 Hz"), HasSubstr("lost at power off")));
    EXPECT_EQ(on_line({"set", "u_drive", "Pr005=4000"}).code, exit_usage) << "1 to 3000 (5.1.1)";
    const auto params = on_line({"params", "u_drive", "--filter", "Pr06", "--json"}).json();
    ASSERT_EQ(params.size(), 9u) << "Pr060 to Pr069 without Pr062 (5.1.1)";
    for (const auto& row : params) EXPECT_TRUE(row.contains("value")) << row["parameter"];
}

// 9.6.6: 41h stores all at once, and the drive is left alone for 5 s.
TEST_F(DriveOnLine, StoringIsAskedForAndTakesItsTime) {
    const auto stored = on_line({"set", "u_drive", "Pr005=80", "--store"});
    EXPECT_EQ(stored.code, exit_ok) << stored.err;
    EXPECT_THAT(stored.out, HasSubstr("Stored in the EEPROM, all parameters"));
}

// 5.4.2: Pr120 to Pr124 force inputs, Pr098 the enable: no command line may move a motor, or defeat its limit switches.
TEST_F(DriveOnLine, NothingIsForced) {
    for (const char* what : {"Pr098=1", "Pr120=10000", "Pr122=1", "Pr123=10"}) {
        const auto set = on_line({"set", "u_drive", what});
        EXPECT_EQ(set.code, exit_refused) << what;
        EXPECT_THAT(set.err, HasSubstr("at the panel")) << what;
    }
    EXPECT_EQ(on_line({"set", "u_drive", "Pr122=0"}).code, exit_ok);
}

TEST_F(DriveOnLine, AWholeSetGoesToAFileAndBack) {
    const auto file = path("u.yaml");
    EXPECT_EQ(on_line({"save", "u_drive", file}).code, exit_ok);
    auto text = text_of(file);
    // Of Pr005 the manual prints two factory values, so what it has is written down; Pr006 has the one that is printed.
    EXPECT_THAT(text, AllOf(HasSubstr("drive: xp200"), HasSubstr("Pr063: 200 ms"), HasSubstr("Pr105: -15"), HasSubstr("Pr005: 50 Hz"),
                            Not(HasSubstr("Pr006"))));
    EXPECT_THAT(on_line({"diff", "u_drive", file}).out, HasSubstr("as " + file));
    text.replace(text.find("Pr063: 200 ms"), 13, "Pr063: 250 ms");
    std::ofstream(file) << text;
    const auto diff = on_line({"diff", "u_drive", file, "--json"}).json();
    ASSERT_EQ(diff["differences"].size(), 1u);
    EXPECT_EQ(diff["differences"][0]["parameter"], "Pr063");
    const auto restored = on_line({"restore", "u_drive", file, "--json"}).json();
    EXPECT_TRUE(restored["ok"]) << restored;
    ASSERT_EQ(restored["changes"].size(), 1u) << restored;
}

// 6.1: alarm 12 (overcurrent) clears by 43h, 3 (undervoltage) by no word of the line.
TEST_F(DriveOnLine, AnAlarmIsReadInTheManualsWordsAndClearedWhereItCanBe) {
    EXPECT_THAT(on_line({"alarms", "u_drive"}).out, HasSubstr("no alarm"));
    const auto clearable = with_alarm(12);
    const auto alarm = on_line({"alarms", "u_drive"}, clearable);
    EXPECT_EQ(alarm.code, exit_ok) << alarm.err;
    EXPECT_THAT(alarm.out, AllOf(HasSubstr("E12"), HasSubstr("overcurrent"), HasSubstr("过电流"), Not(HasSubstr("603Fh")),
                                 HasSubstr("cause:"), HasSubstr("remedy:"), HasSubstr("MC_Reset")));
    const auto reset = on_line({"reset", "u_drive"}, clearable);
    EXPECT_EQ(reset.code, exit_ok) << reset.err;
    EXPECT_THAT(reset.out, HasSubstr("cleared"));
    const auto lasting = on_line({"reset", "u_drive"}, with_alarm(3));
    EXPECT_EQ(lasting.code, exit_refused);
    EXPECT_THAT(lasting.err, HasSubstr("off and on"));
}

/// A drive behind a port of this PC: a pseudo-terminal that a thread serves.
class Served {
public:
    Served() : profile_(load()), drive_(*profile_, axes::sim::PlantConfig{}, {.start_up = 0ms, .saving = 100ms}) {
        for (const auto& [number, value] : {std::pair{181, 7}, {182, 3}, {4, 1}, {108, 9}})
            drive_.servo().parameters().commission(static_cast<std::uint16_t>(number), value);
        auto opened = modbus::PseudoTerminal::open({.baud = 38400});
        if (!opened) throw std::runtime_error(opened.error().text());
        terminal_ = std::move(*opened);
        terminal_->connect(drive_);
        drive_.servo().power_on(clock_.now());
        thread_ = std::thread([this] {
            while (!stop_.load()) {
                terminal_->step(clock_.now());
                clock_.sleep_until(clock_.now() + 200us);
            }
        });
    }
    ~Served() {
        stop_.store(true);
        thread_.join();
    }
    [[nodiscard]] std::string port() const { return terminal_->path(); }

private:
    static std::shared_ptr<const axes::DriveProfile> load() {
        const auto loaded = config::load_drive(TAKTWERK_SOURCE_DIR "/config/drives/xp200.yaml");
        return std::get<config::LoadedDrive>(loaded).profile;
    }
    SystemClock clock_;
    std::shared_ptr<const axes::DriveProfile> profile_;
    axes::sim::xp200::Drive drive_;
    std::unique_ptr<modbus::PseudoTerminal> terminal_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

// The machine file only says where the drive files are, which an installed command knows by itself.
TEST_F(DriveOnLine, APortNeedsNoMachineThatHasIt) {
    Served drive_there;
    const auto call = [&](std::vector<std::string> words) {
        words.insert(words.end(), {"--line", drive_there.port(), "--baud", "38400", "--machine", serial_axis});
        return drive(std::move(words));
    };
    const auto got = call({"get", "7", "Pr004", "Pr181"});
    EXPECT_EQ(got.code, exit_ok) << got.err;
    EXPECT_THAT(got.out, AllOf(HasSubstr("Pr004"), HasSubstr("= 1"), HasSubstr("= 7")));
    const auto set = call({"set", "7", "Pr138=100"});
    EXPECT_EQ(set.code, exit_ok) << set.err;
    EXPECT_THAT(call({"get", "7", "Pr138"}).out, HasSubstr("= 100 r/min")) << "it is the same drive";

    const auto silent = call({"get", "8", "Pr004"});
    EXPECT_EQ(silent.code, exit_bus);
    EXPECT_THAT(silent.err, AllOf(HasSubstr("no answer"), HasSubstr("Pr181")));
    EXPECT_EQ(call({"get", "u_drive", "Pr004"}).code, exit_usage) << "a station is a number";
    EXPECT_EQ(drive({"get", "7", "Pr004", "--line", "/dev/no-such-port", "--machine", serial_axis}).code, exit_bus);
}

}  // namespace
}  // namespace taktwerk::apps
