// Drive files that are based on another, and what a machine file may state of a drive that nobody described. Types of objects: IEC 61800-7-201.

#include <gmock/gmock.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "config/drive_file/startup_entry.hpp"
#include "config/machine_file/machine_loader.hpp"
#include "tests/config/loaded_drive.hpp"

namespace taktwerk::config {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;

/// A folder with drive files of the test's own.
class UndescribedDrive : public ::testing::Test {
protected:
    UndescribedDrive() : folder_(std::filesystem::temp_directory_path() / ("taktwerk_based_on_" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~UndescribedDrive() override { std::filesystem::remove_all(folder_); }

    std::string file(const std::string& name, const std::string& text) {
        auto path = (folder_ / (name + ".yaml")).string();
        std::ofstream(path) << text;
        return path;
    }
    LoadedDrive load(const std::string& name, const std::string& text) {
        auto loaded = load_drive(file(name, text), {drives_});
        if (const auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
            for (const auto& error : *errors) ADD_FAILURE() << error.text();
            return {std::make_shared<ecat::DeviceDescription>(), std::make_shared<axes::DriveProfile>(), {}, {}, {}};
        }
        return std::get<LoadedDrive>(std::move(loaded));
    }
    std::vector<Error> problems(const std::string& name, const std::string& text) {
        auto loaded = load_drive(file(name, text), {drives_});
        auto* errors = std::get_if<std::vector<Error>>(&loaded);
        return errors ? *errors : std::vector<Error>{};
    }
    std::vector<Error> machine_problems(const std::string& slave) {
        LoadOptions options;
        options.drive_dirs = {drives_};
        auto loaded = load_machine_text(
            "machine.yaml",
            "version: 1\nname: m\ncycle: 1 ms\nbus:\n  interface: simulated\n  slaves:\n    - { name: a, " + slave +
                " }\naxes:\n  x:\n    slave: a\n    unit: mm\n    gearing: { counts_per_revolution: 10000, feed: 10 mm }\n"
                "    limits: { velocity: 100 mm/s, acceleration: 1000 mm/s2, jerk: 10000 mm/s3 }\n",
            options);
        auto* errors = std::get_if<std::vector<Error>>(&loaded);
        return errors ? *errors : std::vector<Error>{};
    }

    const std::string drives_ = std::string(TAKTWERK_SOURCE_DIR) + "/config/drives";
    std::filesystem::path folder_;
    const std::string head_ = "version: 1\nbased_on: cia402\nname: own\nvendor: v\ntitle: t\n";
};

// Index, sub-index and type of the objects of the standard that go into frames or start-up lists.
TEST_F(UndescribedDrive, ObjectsHaveTheTypesOfTheStandard) {
    using ecat::DataType;
    const std::map<std::pair<std::uint16_t, std::uint8_t>, DataType> standard{
        {{0x1000, 0}, DataType::U32}, {{0x603F, 0}, DataType::U16}, {{0x6040, 0}, DataType::U16}, {{0x6041, 0}, DataType::U16},
        {{0x6060, 0}, DataType::I8},  {{0x6061, 0}, DataType::I8},  {{0x6064, 0}, DataType::I32}, {{0x606C, 0}, DataType::I32},
        {{0x6071, 0}, DataType::I16}, {{0x6077, 0}, DataType::I16}, {{0x607A, 0}, DataType::I32}, {{0x607C, 0}, DataType::I32},
        {{0x6081, 0}, DataType::U32}, {{0x6083, 0}, DataType::U32}, {{0x6084, 0}, DataType::U32}, {{0x6085, 0}, DataType::U32},
        {{0x6098, 0}, DataType::I8},  {{0x6099, 1}, DataType::U32}, {{0x6099, 2}, DataType::U32}, {{0x609A, 0}, DataType::U32},
        {{0x60B8, 0}, DataType::U16}, {{0x60B9, 0}, DataType::U16}, {{0x60BA, 0}, DataType::I32}, {{0x60C2, 1}, DataType::U8},
        {{0x60C2, 2}, DataType::I8},  {{0x60F4, 0}, DataType::I32}, {{0x60FD, 0}, DataType::U32}, {{0x60FF, 0}, DataType::I32},
        {{0x6502, 0}, DataType::U32}};
    const auto d = drive("cia402");
    for (const auto& [address, type] : standard) {
        const auto* object = find_object(*d.device, address.first, address.second);
        ASSERT_NE(object, nullptr) << std::hex << address.first;
        EXPECT_EQ(object->type, type) << std::hex << address.first;
    }
    // CSP, CSV, CST, HM, PP, PV, PT: bits 7, 8, 9, 5, 0, 2, 3.
    EXPECT_EQ(default_of(*d.device, 0x6502), 0x3AD);
    EXPECT_FALSE(d.device->stated.identity);
    EXPECT_FALSE(d.device->stated.controller);
    EXPECT_FALSE(d.device->stated.process_data);
}

TEST_F(UndescribedDrive, AFileOfItsOwnGoesBeforeTheOneThatItIsBasedOn) {
    const auto d = load("own", head_ +
                                   "identity: { vendor: 0x11, product: 0x22, revision: 3 }\n"
                                   "motion: { velocity_counts_per_unit: 10, homing_methods: [33, 35] }\n"
                                   "objects:\n  - { object: 607Ch, name: home offset, type: I16 }\n");
    EXPECT_EQ(d.device->identity.vendor, 0x11u);
    EXPECT_TRUE(d.device->stated.identity);
    EXPECT_FALSE(d.device->stated.controller);
    EXPECT_EQ(d.profile->velocity_counts_per_unit, 10);
    EXPECT_EQ(d.profile->torque_rated_raw, 1000) << "what it does not say is the base's";
    EXPECT_THAT(d.profile->homing_methods, ElementsAre(33, 35));
    EXPECT_EQ(find_object(*d.device, 0x607C, 0)->type, ecat::DataType::I16);
    EXPECT_EQ(std::ranges::count(d.device->objects, 0x607C, &ecat::ObjectEntry::index), 1);
    EXPECT_NE(find_object(*d.device, 0x6040, 0), nullptr);
    EXPECT_FALSE(d.profile->alarms.empty()) << "the base's alarm file lies beside the base";
    // Settled are identity, unit of velocity and homing methods.
    EXPECT_EQ(d.profile->assumptions.size(), drive("cia402").profile->assumptions.size() - 3);
}

TEST_F(UndescribedDrive, WithAMappingItsProcessDataIsStated) {
    const auto d = load(
        "own",
        head_ +
            "mapping:\n  rx: [{ pdo: 1600h, objects: [6040h, 607Ah, 6060h] }]\n  tx: [{ pdo: 1A00h, objects: [6041h, 6064h, 6061h] }]\n");
    EXPECT_TRUE(d.device->stated.process_data);
    EXPECT_TRUE(d.rx.required.empty());
}

TEST_F(UndescribedDrive, AFaultOfWhatItSaysStandsAtItsLineAndOfTheRestAtBasedOn) {
    const auto own = problems("own", head_ + "motion: { modes: [cspp] }\n");
    ASSERT_EQ(own.size(), 1u);
    EXPECT_THAT(own[0].subject, EndsWith("own.yaml:6:19"));
    // The base's mapping with PDOs that do not take it.
    const auto of_base =
        problems("own", head_ +
                            "pdo:\n  rx: { max_entries: 2, assigned: [1600h], available: [{ pdo: 1600h, objects: [6040h] }] }\n"
                            "  tx: { assigned: [1A00h], available: [{ pdo: 1A00h, objects: [6041h] }] }\n");
    ASSERT_EQ(of_base.size(), 1u);
    EXPECT_THAT(of_base[0].subject, EndsWith("own.yaml:2:11"));
    EXPECT_EQ(of_base[0].what, "PDO 1600h maps 6 objects, the drive takes 2");
}

TEST_F(UndescribedDrive, ABaseThatIsNotThereAndOneThatHasABaseAreRefused) {
    auto errors = problems("own", "version: 1\nbased_on: cia401\nname: own\nvendor: v\ntitle: t\n");
    ASSERT_FALSE(errors.empty());
    EXPECT_EQ(errors[0].code, "config.based_on");
    EXPECT_THAT(errors[0].subject, EndsWith("own.yaml:2:11"));
    EXPECT_EQ(errors[0].what, "there is no drive file 'cia401' to base it on");
    EXPECT_EQ(errors[0].remedy, "correct the name: `based_on: cia402`");

    (void)file("middle", head_);
    errors = problems("own", "version: 1\nbased_on: middle\nname: own\nvendor: v\ntitle: t\n");
    ASSERT_FALSE(errors.empty());
    EXPECT_EQ(errors[0].what, "'middle' is based on another file itself");
    EXPECT_EQ(errors[0].remedy, "name the file that all of them are based on");
}

TEST_F(UndescribedDrive, WhatADriveFileSaysNoMachineStates) {
    auto errors = machine_problems("profile: sv33-e, identity: { vendor: 1, product: 2 }");
    ASSERT_EQ(errors.size(), 1u) << (errors.empty() ? "" : errors.back().text());
    EXPECT_EQ(errors[0].text(), "machine.yaml:7:35: the drive file of sv33-e says who it is. remove `identity`, or correct the drive file");
    errors = machine_problems("profile: sv33-e, modes: [csp]");
    ASSERT_EQ(errors.size(), 1u) << (errors.empty() ? "" : errors.back().text());
    EXPECT_EQ(errors[0].text(),
              "machine.yaml:7:35: the drive file of sv33-e says which modes it has. remove `modes`, or correct the drive file");
    EXPECT_TRUE(machine_problems("profile: cia402, identity: { vendor: 1, product: 2 }, modes: [csp]").empty());
}

}  // namespace
}  // namespace taktwerk::config
