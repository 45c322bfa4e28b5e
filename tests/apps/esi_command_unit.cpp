// `taktwerk esi` as a user meets it, on a file of a vendor that does not exist.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string works = (source / "tests/apps/esi/works.xml").string();

Outcome esi(std::vector<std::string> words) {
    words.insert(words.begin(), "esi");
    return in_process(std::move(words));
}

TEST(EsiCommand, ListShowsTypeIdentityAndNamesOfWhatIsNotReplaced) {
    const auto list = esi({"list", works});
    EXPECT_EQ(list.code, exit_ok) << list.err;
    EXPECT_THAT(list.out, AllOf(HasSubstr("Works (vendor 0000270Fh), 6 devices"),
                                HasSubstr("DI2    00000D14h  00020000h  2 digital inputs · 2 路数字输入"), HasSubstr("SERVO"),
                                HasSubstr("1 revision older or hidden")));
    EXPECT_THAT(list.out, Not(HasSubstr("first edition")));
    EXPECT_THAT(esi({"list", works, "--all"}).out, HasSubstr("first edition"));
}

TEST(EsiCommand, ListAsJsonHoldsAllOfThem) {
    const auto json = esi({"list", works, "--json"}).json();
    EXPECT_EQ(json["vendor"], 9999);
    ASSERT_EQ(json["devices"].size(), 6u);
    EXPECT_EQ(json["devices"][0]["hidden"], true);
    EXPECT_EQ(json["devices"][1]["revision"], 0x20000);
    EXPECT_EQ(json["devices"][1]["group"], "Terminals");
}

TEST(EsiCommand, ShowHasEveryPartOfTheDevice) {
    const auto show = esi({"show", works, "--device", "ai1"});
    EXPECT_EQ(show.code, exit_ok) << show.err;
    EXPECT_THAT(show.out, AllOf(HasSubstr("vendor 0000270Fh product 00000A12h revision 00030000h"), HasSubstr("ports: E-bus, E-bus"),
                                HasSubstr("E-bus: takes 130 mA"), HasSubstr("Dictionary (5 values)"), HasSubstr("profile 5001"),
                                HasSubstr("mailbox out"), HasSubstr("not enabled")));
    EXPECT_THAT(show.out, AllOf(HasSubstr("TxPDO 1A00h Standard: in SM3, fixed, not with 1A01h"), HasSubstr("6000h:11"), HasSubstr("gap"),
                                HasSubstr("TxPDO 1A01h Compact: not assigned"), HasSubstr("complete access"), HasSubstr("also FoE"),
                                HasSubstr("an answer may take 2000 ms")));
    EXPECT_THAT(show.out, AllOf(HasSubstr("50 Hz filter"), HasSubstr("0300h"), HasSubstr("bus cycle, shift 10 us"),
                                HasSubstr("Settings: Filter"), HasSubstr("Device/Su (1, first in line 53)")));
}

TEST(EsiCommand, ShowHasSlotsAndModules) {
    const auto show = esi({"show", works, "--device", "BOX"});
    EXPECT_THAT(show.out, AllOf(HasSubstr("at most 4 slots; of each the PDOs are 1h further, the objects 10h"),
                                HasSubstr("Terminal (0 to 4): 11h, 12h"), HasSubstr("Module DI4 (11h) 4 inputs"),
                                HasSubstr("Module AO1 (12h) 1 analog output")));
}

TEST(EsiCommand, ShowAsJsonHoldsTheSame) {
    const auto json = esi({"show", works, "--device", "AI1", "--json"}).json();
    EXPECT_EQ(json["product"], 0xA12);
    EXPECT_EQ(json["sync_managers"].size(), 4u);
    EXPECT_EQ(json["tx"][0]["excludes"][0], 0x1A01);
    EXPECT_EQ(json["op_modes"][1]["sync0_shift_ns"], 10000);
    EXPECT_EQ(json["mailbox"]["init_commands"][0]["data"], "0100");
    EXPECT_EQ(json["objects"].size(), 5u);
    EXPECT_EQ(json["unread"][0]["path"], "Device/Su");
}

TEST(EsiCommand, AnotherRevisionIsTakenWhenAsked) {
    EXPECT_THAT(esi({"show", works, "--device", "DI2"}).out, HasSubstr("revision 00020000h"));
    EXPECT_THAT(esi({"show", works, "--device", "DI2", "--revision", "0x10000"}).out, HasSubstr("hidden: newer ones take its place"));
    const auto none = esi({"show", works, "--device", "DI2", "--revision", "new"});
    EXPECT_EQ(none.code, exit_usage);
    EXPECT_THAT(none.err, HasSubstr("'new' is no revision"));
}

TEST(EsiCommand, WhatIsWrongInADeviceIsShownWithItsPlace) {
    const auto torn = esi({"show", works, "--device", "TORN"});
    EXPECT_EQ(torn.code, exit_bad_file);
    EXPECT_THAT(torn.out, AllOf(HasSubstr("Wrong in the file: it cannot be used like this"),
                                HasSubstr("works.xml:104:12 (Device 'TORN'/TxPdo/Entry)")));
}

TEST(EsiCommand, WhatIsNotThereIsRefused) {
    const auto several = esi({"show", works});
    EXPECT_EQ(several.code, exit_usage);
    EXPECT_THAT(several.err, HasSubstr("it holds 5 types of device"));
    const auto no_file = esi({"list", "/nowhere/a.xml"});
    EXPECT_EQ(no_file.code, exit_bad_file);
    EXPECT_THAT(no_file.err, HasSubstr("/nowhere/a.xml: the file cannot be read"));
    EXPECT_THAT(no_file.out, IsEmpty());
    EXPECT_EQ(esi({"list", demo}).code, exit_bad_file) << "a machine file is no ESI file";
}

class EsiImportCommand : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = testing::TempDir() + "esi-XXXXXX";
        ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
        folder = pattern;
        std::filesystem::create_directories(folder / "devices");
        std::filesystem::create_directories(folder / "machines");
        std::filesystem::copy(source / "config/devices/ek1100.yaml", folder / "devices");
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    [[nodiscard]] std::string device(const std::string& name) const { return (folder / "devices" / (name + ".yaml")).string(); }
    /// A machine file around these slaves and points.
    [[nodiscard]] std::string machine(const std::string& slaves_and_io) const {
        auto path = (folder / "machines" / "m.yaml").string();
        std::ofstream(path) << "version: 1\nname: m\ncycle: 1 ms\nbus:\n  interface: simulated\n  slaves:\n" << slaves_and_io;
        return path;
    }
    static std::string text_of(const std::string& path) {
        std::ifstream file(path);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::filesystem::path folder;
};

// The whole way of a machine builder: his vendor's file, a device file, a machine file that `check` accepts and that runs on the simulated bus.
TEST_F(EsiImportCommand, WhatItWritesIsTakenByCheckAndComesUpOnTheSimulatedBus) {
    for (const char* type : {"DI2", "AI1", "BOX", "SERVO"}) {
        std::string name = type;
        std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        const auto import = esi({"import", works, "--device", type, "-o", device(name)});
        ASSERT_EQ(import.code, exit_ok) << import.err;
        EXPECT_THAT(import.out, AllOf(HasSubstr("In the vendor's file, and not in this one"), HasSubstr("is written")));
    }
    const auto file = machine(
        "    - { name: box, device: box, modules: [{ slot: 0, module: DI4 }, { slot: 2, module: AO1 }] }\n"
        "    - { name: servo, device: servo, dc: true }\n"
        "    - { name: coupler, device: ek1100 }\n"
        "    - { name: di, device: di2 }\n"
        "    - { name: ai, device: ai1 }\n"
        "io:\n  inputs:\n    start: { slave: di, channel: channel_2_input }\n    level: { slave: ai, channel: value, scale: { from: [0, "
        "32767], to: [4 mA, 20 mA] } }\n"
        "    gate: { slave: box, object: 6000h:01 }\n    at: { slave: servo, channel: position_actual_value }\n");
    const auto check = in_process({"check", file});
    EXPECT_EQ(check.code, exit_ok) << check.out << check.err;
    const auto up = in_process({"bus", "state", "op", "--machine", file, "--simulate", "--for", "20ms", "--json"});
    ASSERT_EQ(up.code, exit_ok) << up.out << up.err;
    for (const auto& slave : up.json()["slaves"]) EXPECT_EQ(slave["state"], "OP") << slave;
}

// A slave that the machine file does not know is named by its vendor's file.
TEST_F(EsiImportCommand, AFolderOfFilesNamesSlavesOnTheBus) {
    std::filesystem::create_directories(folder / "vendors");
    std::filesystem::copy(works, folder / "vendors");
    ASSERT_EQ(esi({"import", works, "--device", "DI2", "--revision", "0x10000", "-o", device("di2")}).code, exit_ok);
    const auto file = machine("    - { name: coupler, device: ek1100 }\n    - { name: di, device: di2 }\n");
    const auto vendors = (folder / "vendors").string();
    const auto scan = in_process({"bus", "scan", "--machine", file, "--simulate", "--esi", vendors});
    EXPECT_EQ(scan.code, exit_ok) << scan.err;
    EXPECT_THAT(scan.out, AllOf(HasSubstr("DI2: 2 digital inputs, first edition (works.xml)\n"), HasSubstr("no file describes it")));
    const auto json = in_process({"bus", "scan", "--machine", file, "--simulate", "--esi", vendors, "--json"}).json();
    EXPECT_FALSE(json["slaves"][0].contains("esi"));
    EXPECT_EQ(json["slaves"][1]["esi"]["type"], "DI2");
    EXPECT_EQ(json["slaves"][1]["esi"]["revision"], 0x10000);
    const auto nowhere = in_process({"bus", "scan", "--machine", file, "--simulate", "--esi", vendors + "/none"});
    EXPECT_EQ(nowhere.code, exit_bad_file);
    EXPECT_THAT(nowhere.err, HasSubstr("the folder cannot be read"));
}

// From a bus to a machine file that `check` takes: a known coupler and drive, a slave that only its vendor's file knows, one that nobody knows.
TEST_F(EsiImportCommand, InitWritesAMachineFileOfTheBus) {
    std::filesystem::copy(source / "config/drives", folder / "drives");
    ASSERT_EQ(esi({"import", works, "--device", "AI1", "-o", device("ai1")}).code, exit_ok);
    ASSERT_EQ(esi({"import", works, "--device", "BOX", "-o", device("box")}).code, exit_ok);
    const auto bus = machine(
        "    - { name: x, profile: sv33-e }\n    - { name: coupler, device: ek1100 }\n    - { name: ai, device: ai1 }\n    - { name: box, "
        "device: box, modules: [{ slot: 0, module: DI4 }] }\n");
    // The new cell knows neither of the vendor's devices; his file does, once it is in the folder.
    const auto cell = folder / "cell";
    std::filesystem::create_directories(cell / "devices");
    std::filesystem::copy(source / "config/devices/ek1100.yaml", cell / "devices");
    std::filesystem::copy(source / "config/drives", cell / "drives");
    const auto file = (cell / "machines" / "first.yaml").string();
    const auto blind = in_process({"bus", "init", "--machine", bus, "--simulate", "-o", file});
    ASSERT_EQ(blind.code, exit_ok) << blind.err;
    EXPECT_THAT(blind.out, HasSubstr("4 slaves, 2 of them unknown"));
    EXPECT_THAT(text_of(file),
                AllOf(HasSubstr("extra_slaves: ignore"), HasSubstr("- { name: sv33_e_0, profile: sv33-e, position: 0 }"),
                      HasSubstr("# position 2: vendor 0000270Fh product 00000A12h revision 00030000h: no file describes it")));
    EXPECT_EQ(in_process({"check", file}).code, exit_ok) << in_process({"check", file}).err;

    std::filesystem::create_directories(folder / "vendors");
    std::filesystem::copy(works, folder / "vendors");
    const auto second = (cell / "machines" / "second.yaml").string();
    const auto seeing = in_process({"bus", "init", "--machine", bus, "--simulate", "--esi", (folder / "vendors").string(), "-o", second});
    ASSERT_EQ(seeing.code, exit_ok) << seeing.err;
    EXPECT_TRUE(std::filesystem::exists(cell / "devices" / "ai1.yaml"));
    const auto text = text_of(second);
    EXPECT_THAT(text, AllOf(HasSubstr("- { name: ai1_2, device: ai1 }"), HasSubstr("- { name: box_3, device: box }"),
                            HasSubstr("ai1_2_value: { slave: ai1_2, channel: value }"), HasSubstr("axis1:\n    slave: sv33_e_0\n"),
                            HasSubstr("FILL IN"), Not(HasSubstr("extra_slaves"))));
    const auto check = in_process({"check", second});
    EXPECT_EQ(check.code, exit_ok) << check.out << check.err;
    const auto again = in_process({"bus", "init", "--machine", bus, "--simulate", "-o", second});
    EXPECT_EQ(again.code, exit_bad_file) << "never over what somebody filled in";
    EXPECT_THAT(again.err, HasSubstr("there is such a file already"));
}

// An IS620N and an SV33-E have the same identity: the file that was written from a manual is named, the other told.
TEST_F(EsiImportCommand, InitNamesOfTwoDrivesTheOneThatAManualDescribes) {
    std::filesystem::copy(source / "config/drives", folder / "drives");
    const auto bus = machine("    - { name: x, profile: is620n }\n");
    const auto cell = folder / "cell";
    std::filesystem::create_directories(cell / "machines");
    std::filesystem::copy(source / "config/drives", cell / "drives");
    const auto file = (cell / "machines" / "first.yaml").string();
    const auto init = in_process({"bus", "init", "--machine", bus, "--simulate", "-o", file});
    ASSERT_EQ(init.code, exit_ok) << init.err;
    EXPECT_THAT(text_of(file), AllOf(HasSubstr("profile: sv33-e"), HasSubstr("it may be is620n as well"), Not(HasSubstr("cia402"))));
}

TEST_F(EsiImportCommand, WithoutAFileTheTextGoesOutAndTheReportBesideIt) {
    const auto import = esi({"import", works, "--device", "DI2"});
    EXPECT_EQ(import.code, exit_ok);
    EXPECT_THAT(import.out,
                AllOf(HasSubstr("name: di2\n"), HasSubstr("channel_1_input: { input: 6000h:01"), Not(HasSubstr("not in this one"))));
    EXPECT_THAT(import.err, HasSubstr("contents of its EEPROM: it brings its own"));
}

TEST_F(EsiImportCommand, AFileThatIsThereIsNotWrittenOver) {
    ASSERT_EQ(esi({"import", works, "--device", "DI2", "-o", device("di2")}).code, exit_ok);
    const auto again = esi({"import", works, "--device", "DI2", "-o", device("di2")});
    EXPECT_EQ(again.code, exit_bad_file);
    EXPECT_THAT(again.err, HasSubstr("there is such a file already"));
    EXPECT_EQ(esi({"import", works, "--device", "DI2", "-o", device("di2"), "--replace"}).code, exit_ok);
}

// Not even device files beside it.
TEST_F(EsiImportCommand, InitOverAFileThatIsThereWritesNothing) {
    std::filesystem::copy(source / "config/drives", folder / "drives");
    ASSERT_EQ(esi({"import", works, "--device", "AI1", "-o", device("ai1")}).code, exit_ok);
    const auto bus = machine("    - { name: x, profile: sv33-e }\n    - { name: ai, device: ai1 }\n");
    std::filesystem::create_directories(folder / "vendors");
    std::filesystem::copy(works, folder / "vendors");
    const auto cell = folder / "cell/machines/cell.yaml";
    std::filesystem::create_directories(cell.parent_path());
    std::ofstream(cell) << "mine\n";
    const auto init =
        in_process({"bus", "init", "--machine", bus, "--simulate", "--esi", (folder / "vendors").string(), "-o", cell.string()});
    EXPECT_EQ(init.code, exit_bad_file);
    EXPECT_THAT(init.err, HasSubstr("there is such a file already"));
    EXPECT_EQ(text_of(cell), "mine\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "cell/devices"));
}

TEST_F(EsiImportCommand, InitKeepsTheRing) {
    std::filesystem::copy(source / "config/drives", folder / "drives");
    const auto bus = (folder / "machines" / "ring.yaml").string(), made = (folder / "machines" / "made.yaml").string();
    std::ofstream(bus) << "version: 1\nname: m\ncycle: 1 ms\nbus:\n  interface: simulated\n  ring: { interface2: simulated }\n  slaves:\n"
                          "    - { name: x, profile: sv33-e }\n    - { name: y, profile: sv33-e }\n";
    EXPECT_EQ(in_process({"bus", "init", "--machine", bus, "--simulate", "-o", made}).code, exit_ok);
    EXPECT_THAT(text_of(made), HasSubstr("  interface: simulated\n  ring: { interface2: simulated }\n"));
    EXPECT_EQ(in_process({"check", made}).code, exit_ok);
}

TEST_F(EsiImportCommand, APlaceThatCannotBeIsAnErrorAndNoCrash) {
    const auto bus = machine("    - { name: coupler, device: ek1100 }\n");
    const auto long_name = (folder / "machines" / (std::string(300, 'x') + ".yaml")).string();
    const auto init = in_process({"bus", "init", "--machine", bus, "--simulate", "-o", long_name});
    EXPECT_EQ(init.code, exit_bad_file);
    EXPECT_THAT(init.err, HasSubstr("the file cannot be written"));
    const auto here = (std::filesystem::path(long_name).parent_path() / std::string(300, 'y') / "di2.yaml").string();
    EXPECT_EQ(esi({"import", works, "--device", "DI2", "-o", here}).code, exit_bad_file);
}

TEST_F(EsiImportCommand, AFileThatNoMachineWouldFindIsRefused) {
    for (const char* name : {"di2.yml", "di2"}) {
        const auto path = (folder / "devices" / name).string();
        const auto import = esi({"import", works, "--device", "DI2", "-o", path});
        EXPECT_EQ(import.code, exit_usage);
        EXPECT_THAT(import.err, HasSubstr("say -o " + device("di2")));
        EXPECT_FALSE(std::filesystem::exists(path));
    }
}

TEST_F(EsiImportCommand, WhatCannotBeUsedWritesNothing) {
    const auto torn = esi({"import", works, "--device", "TORN", "-o", device("torn")});
    EXPECT_EQ(torn.code, exit_bad_file);
    EXPECT_THAT(torn.err, HasSubstr("works.xml:104:12 (Device 'TORN'/TxPdo/Entry): it has no BitLen"));
    const auto named = esi({"import", works, "--device", "DI2", "-o", (folder / "2 inputs.yaml").string()});
    EXPECT_EQ(named.code, exit_usage);
    EXPECT_THAT(named.err, HasSubstr("call the file di2.yaml"));
    EXPECT_FALSE(std::filesystem::exists(device("torn")));
}

}  // namespace
}  // namespace taktwerk::apps
