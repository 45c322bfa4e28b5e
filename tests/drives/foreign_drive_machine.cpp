// A servo drive that nobody described (`profile: cia402`): the machine knows of it what its builder wrote, on the cable stands one of
// tests/drives/foreign/, each with a peculiarity of its own. What it makes of each, and each refusal's words. Identities are those of real
// devices; nothing else of these files is.

#include <gmock/gmock.h>

#include "config/drive_file/drive_loader.hpp"
#include "config/machine_file/machine_loader.hpp"
#include "config/reading/file_library.hpp"
#include "ecat/wire/sdo.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

MachineConfig press(const std::string& slave, const std::string& axis = "") {
    const std::string text =
        "version: 1\nname: foreign\ncycle: 1 ms\nstart_mode: manual\nbus:\n  interface: simulated\n  slaves:\n    - { name: press, " +
        slave +
        " }\naxes:\n  x:\n    slave: press\n    unit: mm\n    gearing: { counts_per_revolution: 10000, feed: 10 mm }\n"
        "    limits: { velocity: 200 mm/s, acceleration: 2000 mm/s2, jerk: 50000 mm/s3 }\n    following_error: { window: 5 mm }\n" +
        (axis.empty() ? "    homing: { kind: set_here }\n" : axis);
    config::LoadOptions options;
    options.drive_dirs = {std::string(TAKTWERK_SOURCE_DIR) + "/tests/drives/foreign"};
    auto loaded = config::load_machine_text(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/foreign.yaml", text, options);
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return machine_config(1);
    }
    return std::get<config::LoadedMachine>(std::move(loaded)).machine;
}

constexpr const char* unknown = "profile: cia402";

/// The same machine, with that drive of tests/drives/foreign/ on the cable: as a world, and as a machine that knows all of it.
MachineConfig with_drive(const std::string& name, const std::string& axis = "") {
    auto config = press(unknown, axis);
    const auto folder = std::string(TAKTWERK_SOURCE_DIR) + "/tests/drives/foreign/";
    auto loaded = config::load_drive(folder + name + ".yaml", {std::string(TAKTWERK_SOURCE_DIR) + "/config/drives"});
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return config;
    }
    const auto& drive = std::get<config::LoadedDrive>(loaded);
    config.bus.slaves[0].device = drive.device;
    config.bus.slaves[0].rx = drive.rx;
    config.bus.slaves[0].tx = drive.tx;
    config.axes[0].profile = drive.profile;
    return config;
}

/// The objects that go out in the frames of slave 0, by what is mapped.
std::string exchanged(const ecat::Master& bus, std::initializer_list<std::uint16_t> objects, bool out) {
    std::string text;
    for (const auto index : objects)
        if (out ? bus.maps_output(0, index, 0) : bus.maps_input(0, index, 0)) text += fmt::format("{:04X}h ", index);
    return text;
}
std::string outputs(const ecat::Master& bus) { return exchanged(bus, {0x6040, 0x607A, 0x6060, 0x60FF, 0x6071, 0x60B8}, true); }
std::string inputs(const ecat::Master& bus) {
    return exchanged(bus, {0x6041, 0x6064, 0x6061, 0x603F, 0x60FD, 0x6077, 0x60B9, 0x60BA, 0x60BB}, false);
}

std::vector<std::string> notes(TestMachine& m) {
    const auto all = m.machine->bus().notes();
    return {all.begin(), all.end()};
}

/// Why the machine does not come up.
Error refusal(const MachineConfig& config, const MachineConfig& there) {
    TestMachine m{config, there};
    const auto ok = m.runner->bring_up();
    EXPECT_FALSE(ok.ok()) << "it came up";
    return ok.ok() ? Error{} : ok.error();
}

/// Switches on, goes 40 mm and back, faults, is reset, goes on.
void expect_it_moves(TestMachine& m) {
    ASSERT_TRUE(m.up());
    m.enable(0);
    m.home(0);
    for (const double target : {40.0, 0.0}) {
        ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, target, 150).answer, Answer::accepted);
        ASSERT_TRUE(m.until([&] { return m.axis(0).in_position; }, 5s)) << m.alarms();
        EXPECT_NEAR(m.world.drive("x")->plant().position(), target * 1000, 50);
    }
    m.expect_no_jump();
}

TEST(ForeignDrive, WithoutAnyPeculiarityItMoves) {
    TestMachine m{press(unknown)};
    expect_it_moves(m);
    EXPECT_EQ(outputs(m.machine->bus()), "6040h 607Ah 6060h 60FFh 6071h 60B8h ");
    EXPECT_EQ(inputs(m.machine->bus()), "6041h 6064h 6061h 603Fh 60FDh 6077h 60B9h 60BAh 60BBh ");
    EXPECT_THAT(notes(m), Contains("slave 0 'press' (cia402): taken for it is vendor 00000000h product 00000402h revision 00000001h"));
    EXPECT_THAT(notes(m), Contains("slave 0 'press' (cia402): 1600h (6040h 607Ah 6060h 60FFh 6071h 60B8h) exchanged"));
}

// 60C2h: 1 ms and 250 us as times ten to the power of the index (IEC 61800-7-201).
TEST(ForeignDrive, ItIsToldTheTimeOverWhichItInterpolates) {
    TestMachine m{press(unknown)};
    ASSERT_TRUE(m.up());
    const auto& dictionary = m.world.network().slave(0).dictionary();
    EXPECT_EQ(dictionary.value(0x60C2, 1), 1);
    EXPECT_EQ(dictionary.value(0x60C2, 2), -3);

    auto quarter = press(unknown);
    quarter.cycle = 250us;
    TestMachine fast{quarter};
    ASSERT_TRUE(fast.up());
    EXPECT_EQ(fast.world.network().slave(0).dictionary().value(0x60C2, 1), 25);
    EXPECT_EQ(fast.world.network().slave(0).dictionary().value(0x60C2, 2), -5);
}

TEST(ForeignDrive, FixedPdosOfTheMakersRangeAreAssignedAsTheyAre) {
    TestMachine m{press(unknown), with_drive("fixed-pdos")};
    expect_it_moves(m);
    EXPECT_EQ(outputs(m.machine->bus()), "6040h 607Ah 6060h 60FFh 6071h ");
    EXPECT_EQ(inputs(m.machine->bus()), "6041h 6064h 6061h 603Fh 6077h ");
    EXPECT_THAT(notes(m), Contains("slave 0 'press' (cia402): 1702h (6040h 607Ah 60FFh 6071h 6060h) exchanged; without 60B8h"));
}

// Its frames carry no mode: the one in which the axis is moved is written by SDO, and none else is there.
TEST(ForeignDrive, AModeThatFramesDoNotCarryIsWrittenBefore) {
    TestMachine m{press(unknown), with_drive("no-mode-in-frames")};
    expect_it_moves(m);
    EXPECT_EQ(outputs(m.machine->bus()), "6040h 607Ah ");
    EXPECT_EQ(m.world.network().slave(0).dictionary().value(0x6060, 0), 8);
}

TEST(ForeignDrive, PdosThatOnlyTogetherAreEnoughAreAssignedTogether) {
    TestMachine m{press(unknown), with_drive("two-pdos")};
    expect_it_moves(m);
    // 1601h with 1602h: as much of the wish as any two of them have.
    EXPECT_EQ(outputs(m.machine->bus()), "6040h 607Ah 6060h 60FFh ");
    EXPECT_EQ(inputs(m.machine->bus()), "6041h 6064h 6061h ");
}

TEST(ForeignDrive, WhatItDoesNotTakeIsLeftOutTheLeastImportantFirst) {
    TestMachine m{press(unknown), with_drive("few-objects")};
    expect_it_moves(m);
    EXPECT_EQ(outputs(m.machine->bus()), "6040h 607Ah 6060h ");
    EXPECT_EQ(inputs(m.machine->bus()), "6041h 6064h 6061h ");
    EXPECT_THAT(notes(m),
                Contains("slave 0 'press' (cia402): 1A00h (6041h 6064h 6061h) exchanged; without 603Fh 60FDh 6077h 60B9h 60BAh 60BBh"));
}

TEST(ForeignDrive, WithoutTargetPositionItIsRefusedWithWhatItHas) {
    const auto error = refusal(press(unknown), with_drive("no-target-position"));
    EXPECT_EQ(error.code, "bus.no_process_data");
    EXPECT_EQ(error.subject, "slave 0 'press' (cia402)");
    EXPECT_EQ(
        error.what,
        "607Ah cannot be exchanged: its RxPDOs are 1600h (6040h 60FFh); it takes no other mapping: writing 1600h:00 was refused: abort "
        "06010002h object is read-only");
    EXPECT_EQ(error.remedy,
              "look up in its manual how the object is mapped, and say so in a drive file of its own (`based_on`, docs/drives.md)");
}

// 1C12h and 1C13h cannot be written: the PDOs in them are given what is wished for all the same.
TEST(ForeignDrive, WhereTheAssignmentIsFixedTheAssignedPdoIsFilled) {
    TestMachine m{press(unknown), with_drive("fixed-assignment")};
    expect_it_moves(m);
    EXPECT_EQ(outputs(m.machine->bus()), "6040h 607Ah 6060h 60FFh 6071h 60B8h ");
    EXPECT_EQ(inputs(m.machine->bus()), "6041h 6064h 6061h 603Fh 60FDh 6077h 60B9h 60BAh 60BBh ");
    EXPECT_THAT(notes(m), Contains("slave 0 'press' (cia402): 1601h (6040h 607Ah 6060h 60FFh 6071h 60B8h) exchanged"));
}

TEST(ForeignDrive, WhereNothingCanBeChangedItIsTakenAsItIs) {
    TestMachine m{press(unknown), with_drive("fixed-throughout")};
    expect_it_moves(m);
    EXPECT_EQ(outputs(m.machine->bus()), "6040h 607Ah 6060h ");
    EXPECT_THAT(notes(m), Contains("slave 0 'press' (cia402): 1600h (6040h 607Ah 6060h) exchanged; without 60FFh 6071h 60B8h"));
}

TEST(ForeignDrive, AFixedAssignmentWithoutTargetPositionIsRefusedWithWhatIsInIt) {
    const auto error = refusal(press(unknown), with_drive("fixed-to-speeds"));
    EXPECT_EQ(error.code, "bus.no_process_data");
    EXPECT_EQ(
        error.what,
        "607Ah cannot be exchanged: its RxPDOs are 1600h (6040h 60FFh); it takes no other mapping: writing 1600h:00 was refused: abort "
        "06010002h object is read-only");
}

// The same as a drive that somebody described: what is wanted is what it has, or the difference is told.
TEST(ForeignDrive, AFixedAssignmentOfADescribedDriveIsFineWhereItIsWhatIsWanted) {
    TestMachine m{with_drive("fixed-throughout")};
    ASSERT_TRUE(m.up());
    EXPECT_EQ(outputs(m.machine->bus()), "6040h 607Ah 6060h ");
    auto other = with_drive("fixed-throughout");
    for (const auto& pdo : other.bus.slaves[0].device->rx_pdos)
        if (pdo.index == 0x1601) other.bus.slaves[0].rx.assigned = {pdo};
    const auto error = refusal(other, with_drive("fixed-throughout"));
    EXPECT_EQ(error.code, "bus.pdo_mismatch");
    EXPECT_THAT(error.what, HasSubstr("the assignment could not be written"));
}

// A PDO that is exchanged and does not show what it carries has the content that the EEPROM says; nothing of it is left out of the frames.
TEST(ForeignDrive, AnAssignedPdoThatDoesNotShowItsContentIsThatOfTheEeprom) {
    TestMachine m{press(unknown), with_drive("fixed-throughout")};
    m.world.network().slave(0).abort_object(0x1600, 0, ecat::sdo_abort::no_object);
    expect_it_moves(m);
    EXPECT_EQ(outputs(m.machine->bus()), "6040h 607Ah 6060h ");
}

// The frames carry a limit that nobody asked for: it stays what the drive had in it.
TEST(ForeignDrive, AnOutputThatNobodyAskedForStaysWhatItWas) {
    TestMachine m{press(unknown), with_drive("speed-limit")};
    expect_it_moves(m);
    EXPECT_EQ(m.world.network().slave(0).dictionary().value(0x607F, 0), 900000);
}

// It answers that it has taken a mapping of six objects, and has one.
TEST(ForeignDrive, AMappingThatItAcceptsAndDoesNotTakeIsTold) {
    TestMachine m{press(unknown)};
    auto& dictionary = m.world.network().slave(0).dictionary();
    m.world.also = [&](Instant) {
        if (auto* count = dictionary.find(0x1600, 0); count != nullptr && count->get() > 1) count->set(1);
    };
    const auto ok = m.runner->bring_up();
    ASSERT_FALSE(ok.ok());
    EXPECT_EQ(ok.error().code, "bus.no_process_data");
    EXPECT_EQ(
        ok.error().what,
        "607Ah cannot be exchanged: its RxPDOs are 1600h (6040h); it takes no other mapping: it accepted another and does not show it");
}

// What it did not take was a question: a state that it refuses afterwards is not blamed on that.
TEST(ForeignDrive, WhatWasAskedOfItIsNoReasonForAnythingElse) {
    TestMachine m{press(unknown), with_drive("few-objects")};
    m.world.network().slave(0).refuse_state(ecat::sim::EsmState::safeop, 0x001D);
    const auto ok = m.runner->bring_up();
    ASSERT_FALSE(ok.ok());
    EXPECT_THAT(ok.error().text(), HasSubstr("001D"));
    EXPECT_THAT(ok.error().text(), ::testing::Not(HasSubstr("last SDO abort")));
    EXPECT_THAT(ok.error().text(), ::testing::Not(HasSubstr("was refused before")));
}

// Who was taken at the start is who has to come back; another in its place stays outside, and both are named.
TEST(ForeignDrive, AnotherThatComesBackInItsPlaceIsTold) {
    TestMachine m{press(unknown)};
    ASSERT_TRUE(m.up());
    // Words 10 and 11 of the EEPROM are the product code (ETG.1000.6 table 16): 00000402h.
    auto& image = m.world.network().slave(0).controller().eeprom().image();
    const auto comes_back_with = [&](std::byte low_byte) {
        m.world.set_slave_power("press", false);
        EXPECT_TRUE(m.until([&] { return !m.axis(0).online; }, 1s));
        image[20] = low_byte;
        m.world.set_slave_power("press", true);
    };
    comes_back_with(std::byte{0x03});
    m.run(10s);
    EXPECT_FALSE(m.axis(0).online);
    EXPECT_THAT(notes(m), Contains(HasSubstr("expected vendor 00000000h product 00000402h, found vendor 00000000h product 00000403h")));
    comes_back_with(std::byte{0x02});
    EXPECT_TRUE(m.until([&] { return m.axis(0).online; }, 20s)) << m.machine->bus_progress();
}

// It comes back with its status word where its position was: as many bytes, and none of them what it was.
TEST(ForeignDrive, WithOtherObjectsInAsManyBytesItIsNotTakenBack) {
    TestMachine m{press(unknown), with_drive("swapped-pdos")};
    ASSERT_TRUE(m.up());
    m.world.set_slave_power("press", false);
    ASSERT_TRUE(m.until([&] { return !m.axis(0).online; }, 1s));
    m.world.network().slave(0).abort_object(0x1A00, 0, ecat::sdo_abort::no_object);
    m.world.set_slave_power("press", true);
    m.run(10s);
    EXPECT_FALSE(m.axis(0).online);
    EXPECT_THAT(notes(m), Contains(HasSubstr("it came back with other PDOs than before")));
}

// The same drive with the position loop here: then 60FFh is what it must have.
TEST(ForeignDrive, MovedByVelocitiesItNeedsNoTargetPosition) {
    const std::string loop = "    homing: { kind: set_here }\n    control: { mode: velocity, kv: 20 }\n";
    TestMachine m{press(unknown, loop), with_drive("no-target-position", loop)};
    ASSERT_TRUE(m.up());
    EXPECT_EQ(outputs(m.machine->bus()), "6040h 60FFh ");
    m.enable(0);
    m.home(0);
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, 40, 150).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).in_position; }, 5s)) << m.alarms();
    EXPECT_NEAR(m.world.drive("x")->plant().position(), 40000, 100);
}

TEST(ForeignDrive, WithProfileModesAloneItIsRefusedWithTheModesThatItHas) {
    const auto error = refusal(press(unknown), with_drive("profile-modes"));
    EXPECT_EQ(error.code, "drive.no_mode");
    EXPECT_EQ(error.subject, "slave 'press' axis 1");
    EXPECT_EQ(error.what, "it has no csp, in which its axis is moved; it has hm, pp, pv (6502h = 0025h)");
    EXPECT_EQ(error.remedy,
              "a set-point each cycle needs csp or csv: profile modes alone move no axis over EtherCAT. If the drive's manual says that it "
              "has csp, and 6502h "
              "is wrong, state `modes: [csp]` at the slave");
}

TEST(ForeignDrive, WithCsvInsteadOfCspTheRemedyIsALoopHere) {
    const auto error = refusal(press(unknown), with_drive("no-csp"));
    EXPECT_EQ(error.what, "it has no csp, in which its axis is moved; it has csv, hm, pp, pv (6502h = 0125h)");
    EXPECT_EQ(error.remedy, "close the position loop here: `control: {mode: velocity, kv: ...}` of the axis");

    const std::string loop = "    homing: { kind: set_here }\n    control: { mode: velocity, kv: 20 }\n";
    TestMachine m{press(unknown, loop), with_drive("no-csp", loop)};
    ASSERT_TRUE(m.up());
    m.enable(0);
}

TEST(ForeignDrive, WithStatedModesTheRefusalNamesThose) {
    const auto error = refusal(press("profile: cia402, modes: [pp, hm]"), with_drive("profile-modes"));
    EXPECT_EQ(error.code, "drive.no_mode");
    EXPECT_EQ(error.what, "it has no csp, in which its axis is moved; it has hm, pp");
    EXPECT_THAT(error.remedy, ::testing::EndsWith("If the drive's manual says that it has csp, add csp to its `modes`"));
}

// Its frames carry no mode, and 6060h cannot be written either: it stays in profile position.
TEST(ForeignDrive, AModeThatItCannotBeGivenIsRefusedWithTheOneThatItIsIn) {
    const auto error = refusal(press(unknown), with_drive("mode-by-hand"));
    EXPECT_EQ(error.code, "drive.mode_not_taken");
    EXPECT_EQ(error.subject, "slave 'press' axis 1");
    EXPECT_EQ(error.what, "6060h is not in its process data, and written by SDO it stays at 1");
    EXPECT_EQ(error.remedy, "set the mode csp (8) at the drive itself, with its maker's tool");
}

// 6502h leaves out what the drive has: stated modes go before it.
TEST(ForeignDrive, StatedModesGoBefore6502h) {
    EXPECT_EQ(refusal(press(unknown), with_drive("wrong-6502h")).code, "drive.no_mode");
    TestMachine m{press("profile: cia402, modes: [csp, hm]"), with_drive("wrong-6502h")};
    expect_it_moves(m);
}

// 6502h shows a CSP that the drive does not take: it is not enabled, and the alarm says in which mode it stays.
TEST(ForeignDrive, AModeThatItShowsAndDoesNotTakeIsAnAlarm) {
    TestMachine m{press(unknown), with_drive("boastful-6502h")};
    ASSERT_TRUE(m.up());
    m.oracles[0].look_away("the drive does not take its mode");
    EXPECT_EQ(m.command(OperatorAction::power, 0, true).answer, Answer::accepted);
    EXPECT_FALSE(m.until([&] { return m.axis(0).powered; }, 5s));
    EXPECT_EQ(m.alarms(), "axis x: The drive is in mode none instead of cyclic position; ");
}

TEST(ForeignDrive, WhatIsNoDriveIsRefused) {
    const auto error = refusal(press(unknown), with_drive("io-module"));
    EXPECT_EQ(error.code, "drive.no_cia402");
    EXPECT_EQ(error.what, "its 1000h is 00030191h, device profile 401: no drive of CiA 402");
    EXPECT_EQ(error.remedy, "check the order of the slaves on the cable; a drive over SoE is not supported");
}

// 1000h of a modular device is that of ETG.5001; what its modules are stands elsewhere.
TEST(ForeignDrive, AModularDeviceMayBeADrive) {
    EXPECT_EQ(axes::cia402::other_device_type(0x00001389), std::nullopt);
    EXPECT_EQ(axes::cia402::other_device_type(0x00020192), std::nullopt);
    EXPECT_EQ(axes::cia402::other_device_type(0), "no device profile");
}

TEST(ForeignDrive, WithoutSync0ItIsRefusedAndRunsByItsFrames) {
    const auto error = refusal(press(unknown), with_drive("no-sync0"));
    EXPECT_EQ(error.code, "bus.no_sync0");
    EXPECT_EQ(error.subject, "slave 0 'press' (cia402)");
    EXPECT_EQ(error.what, "it does not work by SYNC0: its 1C32h:04 is 0003h, by arriving process data");
    EXPECT_EQ(error.remedy, "set `dc: false` at this slave");
    TestMachine m{press("profile: cia402, dc: false"), with_drive("no-sync0")};
    expect_it_moves(m);
}

TEST(ForeignDrive, AStatedIdentityIsCompared) {
    const auto stated = press("profile: cia402, identity: { vendor: 0x00100000, product: 0x000C010D }");
    TestMachine m{stated, with_drive("fixed-pdos")};
    ASSERT_TRUE(m.up());
    const auto error = refusal(stated, with_drive("io-module"));
    EXPECT_EQ(error.code, "bus.wrong_identity");
    EXPECT_EQ(error.what, "expected vendor 00100000h product 000C010Dh, found vendor 00000083h product 000000ABh revision 00000001h");
}

TEST(ForeignDrive, WhatItsMachineStatesIsAssumedNoMore) {
    const auto assumed = [](const MachineConfig& config) {
        std::vector<axes::AssumedPart> parts;
        for (const auto& one : config.axes[0].profile->assumptions) parts.push_back(one.part);
        return parts;
    };
    using Part = axes::AssumedPart;
    EXPECT_THAT(assumed(press(unknown)),
                AllOf(Contains(Part::identity), Contains(Part::controller), Contains(Part::process_data), Contains(Part::modes)));
    const auto stated = assumed(press("profile: cia402, identity: { vendor: 1, product: 2 }, modes: [csp]"));
    EXPECT_THAT(stated, ::testing::Not(Contains(Part::identity)));
    EXPECT_THAT(stated, ::testing::Not(Contains(Part::modes)));
    EXPECT_THAT(stated, Contains(Part::process_data));
    const auto described = assumed(with_drive("fixed-pdos"));
    EXPECT_THAT(described, ::testing::ElementsAre(Part::modes, Part::other, Part::other, Part::other, Part::other, Part::other, Part::other,
                                                  Part::other, Part::other));
}

// Those that are shipped and were made from collected facts: each names its source, and plays on a simulated cable.
TEST(ForeignDrive, EachThatIsShippedNamesItsSourceAndComesUp) {
    const std::string folder = std::string(TAKTWERK_SOURCE_DIR) + "/config/drives";
    int others = 0;
    for (const auto& name : config::file_names({folder})) {
        const auto loaded = config::load_drive(folder + "/" + name + ".yaml", {folder});
        ASSERT_TRUE(std::holds_alternative<config::LoadedDrive>(loaded))
            << name << ": " << std::get<std::vector<Error>>(loaded).front().text();
        const auto& drive = std::get<config::LoadedDrive>(loaded);
        if (!drive.profile->assumes(axes::AssumedPart::process_data) || name == "cia402") continue;
        SCOPED_TRACE(name);
        ++others;
        EXPECT_NE(drive.source, "");
        EXPECT_NE(drive.checked, "");
        EXPECT_TRUE(drive.device->stated.identity);
        EXPECT_NE(drive.device->identity.vendor, 0u);
        TestMachine m{press("profile: " + name)};
        ASSERT_TRUE(m.up());
        m.enable(0);
    }
    EXPECT_EQ(others, 24);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
